//! Lines over an axis, as a picture in SVG that needs no style of its own. The same values give the
//! same bytes.

use std::fmt::Write;

/// Width and height of one plot, pixels.
const SIZE_PX: (f64, f64) = (480.0, 300.0);
/// Room for the numbers and names around the lines: left, right, top, bottom, pixels.
const MARGIN_PX: (f64, f64, f64, f64) = (52.0, 16.0, 34.0, 40.0);
/// Most intervals between the numbers of an axis.
const INTERVALS: f64 = 6.0;
const INK: &str = "#1d2329";
const SOFT: &str = "#5d6873";
const GRID: &str = "#dde2e7";

/// Lines that share their axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot<'a> {
    /// What is shown.
    pub title: &'a str,
    /// From left to right.
    pub x: Axis<'a>,
    /// From bottom to top.
    pub y: Axis<'a>,
    /// In the order in which they are drawn and named.
    pub lines: Vec<Line<'a>>,
}

/// An axis with its range; `low < high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis<'a> {
    /// Its name, with the unit.
    pub name: &'a str,
    /// Where it begins.
    pub low: f64,
    /// Where it ends.
    pub high: f64,
}

/// A line through points.
#[derive(Clone, Debug, PartialEq)]
pub struct Line<'a> {
    /// What it is.
    pub name: &'a str,
    /// As in `#1f6feb`.
    pub colour: &'a str,
    /// `(x, y)`, from left to right; a `y` that is no number leaves a gap.
    pub points: Vec<(f64, f64)>,
}

impl Axis<'_> {
    /// Where `value` lies on the axis: 0 at its begin, 1 at its end.
    fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Round numbers on the axis, with the digits they need behind the point.
    fn ticks(&self) -> (Vec<f64>, usize) {
        let rough = (self.high - self.low) / INTERVALS;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|n| n * power).into_iter().find(|step| *step >= rough * (1.0 - 1e-9));
        let step = step.unwrap_or(10.0 * power);
        let (first, last) = ((self.low / step - 1e-9).ceil() as i64, (self.high / step + 1e-9).floor() as i64);
        let digits = (-step.log10() - 1e-9).ceil().max(0.0) as usize;
        ((first..=last).map(|n| n as f64 * step).collect(), digits)
    }
}

/// Plots side by side, as an SVG file.
pub fn row(plots: &[Plot<'_>]) -> String {
    let (width, height) = (SIZE_PX.0 * plots.len() as f64, SIZE_PX.1);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"system-ui, sans-serif\" font-size=\"11\">\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>"
    );
    for (i, plot) in plots.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = write!(out, "<g transform=\"translate({})\">", SIZE_PX.0 * i as f64);
        plot.draw(&mut out);
        out.push_str("</g>");
    }
    out.push_str("</svg>\n");
    out
}

impl Plot<'_> {
    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (left, right, top, bottom) = MARGIN_PX;
        let (width, height) = (SIZE_PX.0 - left - right, SIZE_PX.1 - top - bottom);
        (left + self.x.share(x) * width, top + (1.0 - self.y.share(y)) * height)
    }

    fn draw(&self, out: &mut String) {
        self.draw_axes(out);
        let mut name_x = MARGIN_PX.0 + 12.0 + 7.0 * self.title.chars().count() as f64;
        text(
            out,
            (MARGIN_PX.0, 20.0),
            "start",
            INK,
            &format!("<tspan font-weight=\"600\">{}</tspan>", escape(self.title)),
        );
        for line in &self.lines {
            for part in line.points.split(|(_, y)| !y.is_finite()).filter(|part| !part.is_empty()) {
                self.draw_line(out, part, line.colour);
            }
            let _ =
                write!(out, "<rect x=\"{name_x:.1}\" y=\"14\" width=\"12\" height=\"3\" fill=\"{}\"/>", line.colour);
            text(out, (name_x + 16.0, 20.0), "start", SOFT, &escape(line.name));
            name_x += 32.0 + 6.5 * line.name.chars().count() as f64;
        }
    }

    fn draw_line(&self, out: &mut String, points: &[(f64, f64)], colour: &str) {
        let places = points.iter().map(|point| self.place(*point));
        if let [point] = points {
            let (x, y) = self.place(*point);
            let _ = write!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2\" fill=\"{colour}\"/>");
            return;
        }
        let path: Vec<String> = places.map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = write!(
            out,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.8\" stroke-linejoin=\"round\"/>",
            path.join(" ")
        );
    }

    fn draw_axes(&self, out: &mut String) {
        let (xs, digits) = self.x.ticks();
        for x in xs {
            let ((at, bottom), (_, top)) = (self.place((x, self.y.low)), self.place((x, self.y.high)));
            rule(out, (at, bottom), (at, top));
            text(out, (at, bottom + 14.0), "middle", SOFT, &format!("{x:.digits$}"));
        }
        let (ys, digits) = self.y.ticks();
        for y in ys {
            let ((left, at), (right, _)) = (self.place((self.x.low, y)), self.place((self.x.high, y)));
            rule(out, (left, at), (right, at));
            text(out, (left - 6.0, at + 4.0), "end", SOFT, &format!("{y:.digits$}"));
        }
        let (middle, bottom) = self.place((0.5 * (self.x.low + self.x.high), self.y.low));
        text(out, (middle, bottom + 30.0), "middle", SOFT, &escape(self.x.name));
        let (_, centre) = self.place((self.x.low, 0.5 * (self.y.low + self.y.high)));
        let _ = write!(out, "<g transform=\"translate(14 {centre:.1}) rotate(-90)\">");
        text(out, (0.0, 0.0), "middle", SOFT, &escape(self.y.name));
        out.push_str("</g>");
    }
}

fn rule(out: &mut String, from: (f64, f64), to: (f64, f64)) {
    let ((x1, y1), (x2, y2)) = (from, to);
    let _ = write!(
        out,
        "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"{GRID}\" stroke-width=\"1\"/>"
    );
}

fn text(out: &mut String, (x, y): (f64, f64), anchor: &str, colour: &str, content: &str) {
    let _ = write!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{content}</text>");
}

/// A text as the content of an element.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_on_an_axis_are_round_and_within_it() {
        let ticks = |low, high| Axis { name: "", low, high }.ticks();
        assert_eq!(ticks(0.0, 1.0), (vec![0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0], 1));
        assert_eq!(ticks(1.0, 30.0), (vec![5.0, 10.0, 15.0, 20.0, 25.0, 30.0], 0));
        assert_eq!(ticks(0.0, 0.05).1, 2);
        assert_eq!(ticks(-3.0, 0.0).0, [-3.0, -2.5, -2.0, -1.5, -1.0, -0.5, 0.0]);
    }

    #[test]
    fn lines_lie_where_their_values_are_and_gaps_stay_open() {
        let points = vec![(0.0, 0.0), (1.0, 1.0), (2.0, f64::NAN), (3.0, 0.5), (4.0, 1.0)];
        let axis = |high| Axis { name: "a < b", low: 0.0, high };
        let line = Line { name: "l", colour: "#000", points };
        let plot = Plot { title: "t", x: axis(4.0), y: axis(1.0), lines: vec![line] };
        let (left, right, top, bottom) = MARGIN_PX;
        assert_eq!(plot.place((0.0, 0.0)), (left, SIZE_PX.1 - bottom));
        assert_eq!(plot.place((4.0, 1.0)), (SIZE_PX.0 - right, top));
        let svg = row(&[plot.clone(), plot]);
        assert_eq!(svg.matches("<polyline").count(), 4, "two parts in each of two plots");
        assert!(svg.contains("a &lt; b") && !svg.contains("NaN"), "{svg}");
    }
}
