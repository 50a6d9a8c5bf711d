//! Lights, signs and bus stops as symbols that can be told at any size.

use std::fmt::Write;

use glam::{Vec2, Vec3Swizzles};
use kernel::map::{MapData, PropKind, SIGN_BUS_STOP, SIGN_LIMIT, SIGN_STOP, SIGN_YIELD};

use super::frame::{Key, Swatch};
use super::sheet::{Sheet, cm};

/// A symbol, drawn within 10 units of its middle.
pub struct Symbol {
    pub id: &'static str,
    name: &'static str,
    pub shape: &'static str,
}

const LIGHT: Symbol = Symbol {
    id: "light",
    name: "traffic light",
    shape: "<rect x=\"-5\" y=\"-10\" width=\"10\" height=\"20\" rx=\"3\" fill=\"#1d2329\"/><circle cy=\"-6\" r=\"2.6\" fill=\"#e5372f\"/>\
            <circle r=\"2.6\" fill=\"#f0b71e\"/><circle cy=\"6\" r=\"2.6\" fill=\"#36a853\"/>",
};
const STOP: Symbol = Symbol {
    id: "stop",
    name: "stop sign",
    shape: "<path d=\"M-4 -9.5h8l5.5 5.5v8l-5.5 5.5h-8l-5.5-5.5v-8z\" fill=\"#c8202a\" stroke=\"#fff\" stroke-width=\"1.5\"/>\
            <path d=\"M-5 0h10\" stroke=\"#fff\" stroke-width=\"3\"/>",
};
const YIELD: Symbol = Symbol {
    id: "yield",
    name: "give way",
    shape: "<path d=\"M-9 -7.5h18l-9 16z\" fill=\"#fff\" stroke=\"#c8202a\" stroke-width=\"3\" stroke-linejoin=\"round\"/>",
};
const LIMIT: Symbol = Symbol {
    id: "limit",
    name: "speed limit",
    shape: "<circle r=\"8.5\" fill=\"#fff\" stroke=\"#c8202a\" stroke-width=\"2.5\"/>",
};
const BUS: Symbol = Symbol {
    id: "bus-stop",
    name: "bus stop",
    shape: "<circle r=\"9\" fill=\"#f3c300\" stroke=\"#1c7a3c\" stroke-width=\"2\"/>\
            <path d=\"M-3 -4.5v9m6 -9v9m-6 -4.5h6\" fill=\"none\" stroke=\"#1c7a3c\" stroke-width=\"2\"/>",
};

/// Draws every light, sign and bus stop.
pub fn all(sheet: &Sheet, map: &MapData, out: &mut String, keys: &mut Vec<Key>) {
    // Those nearest to the road on top.
    let mut placed: Vec<(&Symbol, Vec2, Option<u32>)> = Vec::new();
    for prop in map.props.iter().filter(|prop| prop.kind == PropKind::Sign) {
        let (symbol, number) = match prop.variant {
            SIGN_STOP => (&STOP, None),
            SIGN_YIELD => (&YIELD, None),
            SIGN_BUS_STOP => continue,
            variant if variant >= SIGN_LIMIT => (&LIMIT, Some(variant - SIGN_LIMIT)),
            _ => continue,
        };
        placed.push((symbol, prop.position.xy(), number));
    }
    let stops = map.bus_stops.iter().map(|stop| map.lane_point(stop.lane, stop.s_m).position.xy());
    placed.extend(stops.map(|place| (&BUS, place, None)));
    placed.extend(map.light_heads.iter().map(|head| (&LIGHT, head.position.xy(), None)));
    let radius_m = sheet.metres(6.0, 0.7, 9.0);
    let scale = f64::from(radius_m) * 10.0;
    for symbol in [&LIMIT, &STOP, &YIELD, &BUS, &LIGHT] {
        if placed.iter().any(|(other, ..)| other.id == symbol.id) {
            // Writing to a string cannot fail.
            let _ = writeln!(
                out,
                "<defs><g id=\"{}\" transform=\"scale({scale:.2})\">{}</g></defs>",
                symbol.id, symbol.shape
            );
            keys.push(Key { swatch: Swatch::Symbol(symbol.shape), name: symbol.name });
        }
    }
    let _ = writeln!(
        out,
        "<g class=\"signs\" fill=\"#1d2329\" text-anchor=\"middle\" font-size=\"{}\">",
        cm(0.85 * radius_m)
    );
    for (symbol, place, number) in placed {
        let [x, y] = sheet.cm(place);
        let _ = writeln!(out, "<use href=\"#{}\" x=\"{x}\" y=\"{y}\"/>", symbol.id);
        if let Some(number) = number {
            let _ = writeln!(out, "<text x=\"{x}\" y=\"{}\">{number}</text>", y + cm(0.3 * radius_m));
        }
    }
    out.push_str("</g>\n");
}
