//! Where a map lies on the Earth, as its file says it.

/// The PROJ string of an OpenDRIVE text. One with an `<offset>` in its header has none: its coordinates are not those
/// of the projection.
pub fn of(text: &str) -> Option<String> {
    let header = text.split("</header>").next().filter(|header| !header.contains("<offset"))?;
    let inside = header.split_once("<geoReference>")?.1.split_once("</geoReference>")?.0.trim();
    let plain = inside.strip_prefix("<![CDATA[").and_then(|data| data.strip_suffix("]]>")).unwrap_or(inside).trim();
    (!plain.is_empty()).then(|| plain.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_projection_is_that_of_the_header() {
        let utm = "+proj=utm +zone=32 +datum=WGS84";
        let file = |inside: &str| format!("<OpenDRIVE><header>{inside}</header><road/></OpenDRIVE>");
        for inside in [utm.to_owned(), format!("<![CDATA[{utm}]]>"), format!("\n <![CDATA[ {utm} ]]>\n")] {
            let text = file(&format!("<geoReference>{inside}</geoReference>"));
            assert_eq!(of(&text).as_deref(), Some(utm), "{text}");
        }
        for inside in ["", "<geoReference/>", "<geoReference></geoReference>"] {
            assert_eq!(of(&file(inside)), None);
        }
        let moved = format!("<offset x=\"1\"/><geoReference>{utm}</geoReference>");
        assert_eq!(of(&file(&moved)), None);
    }
}
