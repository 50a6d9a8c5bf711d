//! Plots of the documentation, which are drawn by the tests of what they show.
#![allow(clippy::disallowed_methods, reason = "tests may read files and the environment")]
#![allow(dead_code, reason = "each test file uses some of it")]

/// What is told along one side of a chart.
pub struct Axis<'a> {
    pub label: &'a str,
    pub range: [f64; 2],
    pub ticks: &'a [f64],
}

/// Part of a picture, pixels from its upper left corner.
#[derive(Clone, Copy)]
pub struct Area {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

/// Values over other values.
pub struct Chart {
    area: Area,
    ranges: [[f64; 2]; 2],
    svg: String,
}

/// Anchors of a text.
pub const START: &str = "start";
pub const MIDDLE: &str = "middle";
pub const END: &str = "end";

pub const BLACK: &str = "black";
pub const BLUE: &str = "#1f77b4";
pub const ORANGE: &str = "#d9620d";
pub const GREEN: &str = "#2a8a2a";
pub const RED: &str = "#c62828";
pub const GREY: &str = "#777";

impl Chart {
    /// The empty chart: what `y` means is said above, `x` below.
    pub fn new(area: Area, x: &Axis<'_>, y: &Axis<'_>) -> Self {
        let mut chart = Self { area, ranges: [x.range, y.range], svg: String::new() };
        for tick in y.ticks {
            let (_, at) = chart.at(x.range[0], *tick);
            chart.svg += &format!("<path d=\"M{:.1} {at:.1}H{:.1}\" stroke=\"#ddd\"/>\n", area.left, area.right);
            chart.text([area.left - 6.0, at + 4.0], END, BLACK, &tick.to_string());
        }
        for tick in x.ticks {
            let (at, _) = chart.at(*tick, y.range[0]);
            chart.text([at, area.bottom + 16.0], MIDDLE, BLACK, &tick.to_string());
        }
        if !x.label.is_empty() {
            chart.text([0.5 * (area.left + area.right), area.bottom + 36.0], MIDDLE, BLACK, x.label);
        }
        chart.text([area.left - 50.0, area.top - 19.0], START, BLACK, y.label);
        chart
    }

    /// Where a place on the chart is in the picture.
    pub fn at(&self, x: f64, y: f64) -> (f64, f64) {
        let Area { left, top, right, bottom } = self.area;
        let [across, up] = self.ranges;
        (
            left + (x - across[0]) / (across[1] - across[0]) * (right - left),
            bottom - (y - up[0]) / (up[1] - up[0]) * (bottom - top),
        )
    }

    /// A text at a place of the picture.
    pub fn text(&mut self, [x, y]: [f64; 2], anchor: &str, colour: &str, text: &str) {
        let fill = if colour == BLACK { String::new() } else { format!(" fill=\"{colour}\"") };
        self.svg += &format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\"{fill}>{text}</text>\n");
    }

    /// A text beside a place of the chart, so many pixels to the right and down.
    pub fn beside(&mut self, place: (f64, f64), [right, down]: [f64; 2], anchor: &str, colour: &str, text: &str) {
        let (x, y) = self.at(place.0, place.1);
        self.text([x + right, y + down], anchor, colour, text);
    }

    pub fn dot(&mut self, colour: &str, place: (f64, f64)) {
        let (x, y) = self.at(place.0, place.1);
        self.svg += &format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{colour}\"/>\n");
    }

    pub fn square(&mut self, colour: &str, place: (f64, f64)) {
        let (x, y) = self.at(place.0, place.1);
        let (x, y) = (x - 3.5, y - 3.5);
        self.svg += &format!("<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"7\" height=\"7\" fill=\"{colour}\"/>\n");
    }

    /// A line through places; `style` is further attributes.
    pub fn line(&mut self, colour: &str, style: &str, places: impl IntoIterator<Item = (f64, f64)>) {
        let steps = places.into_iter().enumerate().map(|(k, (x, y))| {
            let (x, y) = self.at(x, y);
            format!("{}{x:.1} {y:.1}", if k == 0 { "M" } else { "L" })
        });
        let steps = steps.collect::<String>();
        self.svg += &format!("<path d=\"{steps}\" fill=\"none\" stroke=\"{colour}\"{style}/>\n");
    }

    /// Many points of one colour, so many pixels wide.
    pub fn cloud(&mut self, colour: &str, width: f64, places: impl IntoIterator<Item = (f64, f64)>) {
        let points = places.into_iter().map(|(x, y)| {
            let (x, y) = self.at(x, y);
            format!("M{x:.1} {y:.1}h0")
        });
        let points = points.collect::<String>();
        let style = format!("stroke-width=\"{width}\" stroke-linecap=\"round\"");
        self.svg += &format!("<path d=\"{points}\" stroke=\"{colour}\" {style}/>\n");
    }
}

/// A picture, so many pixels wide and high.
pub fn picture([width, height]: [u32; 2], charts: &[Chart]) -> String {
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    charts.iter().for_each(|chart| svg += &chart.svg);
    svg + "</svg>\n"
}

/// The picture of a name in the documentation is this one; `AEYE_BLESS=1` draws it.
pub fn agrees_with_plot(name: &str, svg: &str) {
    let path = format!("{}/../docs/{name}.svg", env!("CARGO_MANIFEST_DIR"));
    if std::env::var("AEYE_BLESS").is_ok_and(|bless| bless == "1") {
        std::fs::write(&path, svg).expect("docs can be written");
    }
    let golden =
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("docs/{name}.svg: {e} (AEYE_BLESS=1 draws it)"));
    assert!(golden == svg, "docs/{name}.svg shows something else; AEYE_BLESS=1 draws it anew");
}
