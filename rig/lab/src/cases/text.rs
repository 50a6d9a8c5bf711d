//! Cases as a table.

use base::say::printable;
use base::words;

use super::line::CaseLine;

/// What stands above the columns.
const HEAD: [&str; 11] =
    ["file", "label", "verdict", "map", "weather", "checkpoint", "km/h", "TTC s", "overlooked", "review", "tags"];

/// A table of cases: what is not known of any of them has no column.
pub fn table(lines: &[CaseLine]) -> String {
    let rows: Vec<[String; HEAD.len()]> = lines.iter().map(cells).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or_default();
    let shown: Vec<(usize, usize)> =
        (0..HEAD.len()).map(|column| (column, width(column))).filter(|(_, width)| *width > 0).collect();
    let line = |cells: &dyn Fn(usize) -> String| {
        let padded = shown.iter().map(|(column, width)| {
            let (text, width) = (cells(*column), (*width).max(HEAD[*column].len()));
            format!("{text}{}", " ".repeat(width.saturating_sub(text.chars().count())))
        });
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let head = line(&|column| HEAD[column].to_owned());
    let body = rows.iter().map(|row| line(&|column| row[column].clone()));
    std::iter::once(head).chain(body).collect::<Vec<_>>().join("\n")
}

fn cells(line: &CaseLine) -> [String; HEAD.len()] {
    let text = |text: &Option<String>| text.clone().unwrap_or_default();
    let measured = line.measured.as_ref();
    let weather = line.weather.clone().unwrap_or_else(|| line.conditions.join("+"));
    let worst = measured.and_then(|measured| measured.overlooked.first());
    let cells = [
        line.file.clone(),
        text(&line.label),
        text(&line.verdict),
        line.map.clone(),
        weather,
        text(&line.checkpoint),
        words::kmh(line.speed_mps),
        measured.and_then(|measured| measured.min_ttc_s).map_or_else(String::new, |s| format!("{s:.1}")),
        worst.map_or_else(String::new, |worst| format!("{}: {}", worst.actor, worst.pixels)),
        text(&line.review),
        line.tags.join(","),
    ];
    cells.map(|cell| printable(&cell).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_those_of_which_anything_is_known() {
        let line = |file: &str, tags: &[&str]| CaseLine {
            file: file.into(),
            map: "city".into(),
            speed_mps: 10.0,
            tags: tags.iter().map(ToString::to_string).collect(),
            ..CaseLine::default()
        };
        let text = table(&[line("a.case.mcap", &[]), line("bb\n.case.mcap", &["x", "y"])]);
        let lines: Vec<&str> = text.lines().collect();
        let expected =
            ["file            map   km/h  tags", "a.case.mcap     city  36", "bb\\n.case.mcap  city  36    x,y"];
        assert_eq!(lines, expected);
    }
}
