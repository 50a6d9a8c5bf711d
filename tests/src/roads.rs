//! OpenDRIVE texts of any size: chains of roads, straight or winding, and streets that cross.

use std::fmt::Write;

/// How sharply a winding road bends, 1/m.
const CURVATURE: f64 = 0.005;

/// A road of one section with a lane and a sidewalk on either side.
pub struct Road {
    /// Its id, and 1 more the one after it.
    pub id: usize,
    /// Metres.
    pub length_m: f64,
    /// Its `<geometry>` elements.
    pub plan: String,
    /// Whether a road with the next lower and the next higher id touch its ends.
    pub linked: [bool; 2],
    /// Its `<laneSection>` elements.
    pub sections: String,
    /// What else it holds: profiles, objects, signals.
    pub extra: String,
}

impl Road {
    /// A straight road from a place in a direction.
    pub fn straight(id: usize, [x, y, hdg]: [f64; 3], length_m: f64) -> Self {
        let plan = geometry(0.0, [x, y, hdg], length_m, "<line/>");
        Self { id, length_m, plan, linked: [false; 2], sections: section(0.0, ""), extra: String::new() }
    }

    /// A road along the x axis that swings out and back; and where it ends.
    pub fn winding(id: usize, x: f64, length_m: f64) -> (Self, f64) {
        let (part_m, mut plan) = (length_m / 4.0, String::new());
        let [mut at, mut y, mut hdg] = [x, 0.0, 0.0_f64];
        for (k, curvature) in [CURVATURE, -CURVATURE, -CURVATURE, CURVATURE].into_iter().enumerate() {
            let arc = format!("<arc curvature=\"{curvature}\"/>");
            plan += &geometry(k as f64 * part_m, [at, y, hdg], part_m, &arc);
            let end = hdg + curvature * part_m;
            (at, y) = (at + (end.sin() - hdg.sin()) / curvature, y - (end.cos() - hdg.cos()) / curvature);
            hdg = end;
        }
        (Self { plan, ..Self::straight(id, [x, 0.0, 0.0], length_m) }, at)
    }

    fn text(&self) -> String {
        let Self { id, length_m, plan, sections, extra, .. } = self;
        let link = |tag: &str, id: usize, contact: &str| {
            format!("<{tag} elementType=\"road\" elementId=\"{id}\" contactPoint=\"{contact}\"/>")
        };
        let before = if self.linked[0] { link("predecessor", id - 1, "end") } else { String::new() };
        let after = if self.linked[1] { link("successor", id + 1, "start") } else { String::new() };
        format!(
            "<road id=\"{id}\" length=\"{length_m}\" junction=\"-1\"><link>{before}{after}</link><planView>{plan}\
             </planView><lanes>{sections}</lanes>{extra}</road>\n"
        )
    }
}

/// A `<geometry>` with its shape.
pub fn geometry(s: f64, [x, y, hdg]: [f64; 3], length_m: f64, shape: &str) -> String {
    format!("<geometry s=\"{s}\" x=\"{x}\" y=\"{y}\" hdg=\"{hdg}\" length=\"{length_m}\">{shape}</geometry>")
}

/// A `<laneSection>`; `marks` go to the lane on the right.
pub fn section(s: f64, marks: &str) -> String {
    let lane = |id: i32, kind: &str, width: f64, marks: &str| {
        format!(
            "<lane id=\"{id}\" type=\"{kind}\"><link><predecessor id=\"{id}\"/><successor id=\"{id}\"/></link>\
             <width sOffset=\"0\" a=\"{width}\" b=\"0\" c=\"0\" d=\"0\"/>{marks}</lane>"
        )
    };
    let center = "<lane id=\"0\" type=\"none\"><roadMark sOffset=\"0\" type=\"broken\" width=\"0.12\"/></lane>";
    format!(
        "<laneSection s=\"{s}\"><left>{}{}</left><center>{center}</center><right>{}{}</right></laneSection>",
        lane(2, "sidewalk", 2.0, ""),
        lane(1, "driving", 3.5, ""),
        lane(-1, "driving", 3.5, marks),
        lane(-2, "sidewalk", 2.0, ""),
    )
}

/// A whole file.
pub fn file(roads: &[Road]) -> String {
    let mut text = String::from("<?xml version=\"1.0\"?>\n<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\n");
    roads.iter().for_each(|road| write!(text, "{}", road.text()).expect("writing to a string"));
    text + "</OpenDRIVE>\n"
}

/// Winding roads, each joined to the next.
pub fn winding(roads: usize, length_m: f64) -> String {
    let mut x = 0.0;
    let chain = (0..roads).map(|id| {
        let (road, end) = Road::winding(id, x, length_m);
        x = end;
        Road { linked: [id > 0, id + 1 < roads], ..road }
    });
    file(&chain.collect::<Vec<_>>())
}

/// Streets from west to east and from south to north, `pitch_m` apart, that cross on the level.
pub fn crossing(streets: usize, pitch_m: f64) -> String {
    let length_m = pitch_m * streets as f64;
    let street = |id: usize| {
        let aside = (id / 2) as f64 * pitch_m;
        let place = if id.is_multiple_of(2) { [0.0, aside, 0.0] } else { [aside, 0.0, std::f64::consts::FRAC_PI_2] };
        Road::straight(id, place, length_m)
    };
    file(&(0..2 * streets).map(street).collect::<Vec<_>>())
}
