//! A street that is hard to drive: it takes seconds until somebody on foot is in the way.

use std::fmt::Write as _;
use std::fs;
use std::ops::RangeInclusive;
use std::path::Path;

/// Length of the street, metres.
const LENGTH: u32 = 300;
/// Where its crosswalks are, metres, and how far apart.
const CROSSWALKS: RangeInclusive<u32> = 40..=272;
const APART: usize = 8;

/// Writes its OpenDRIVE file.
pub fn street(path: &Path) {
    let lane = |id: i32, kind: &str, width: f32| {
        format!(
            r#"<lane id="{id}" type="{kind}" level="false"><width sOffset="0" a="{width}" b="0" c="0" d="0"/></lane>"#
        )
    };
    let side = |sign: i32| {
        [(1, "driving", 3.5), (2, "shoulder", 0.5), (3, "sidewalk", 2.5)].map(|(n, k, w)| lane(sign * n, k, w))
    };
    let ([one, two, three], right) = (side(1), side(-1).concat());
    let mut crosswalks = String::new();
    for (id, s) in CROSSWALKS.step_by(APART).enumerate() {
        let corner =
            |(i, (s, t)): (usize, (u32, i32))| format!(r#"<cornerRoad id="{i}" s="{s}" t="{t}" dz="0" height="0"/>"#);
        let corners = [(s - 2, -4), (s + 2, -4), (s + 2, 4), (s - 2, 4)].into_iter().enumerate().map(corner);
        let corners: String = corners.collect();
        write!(
            crosswalks,
            r#"<object id="{}" type="crosswalk" name="zebra" s="{s}" t="0" zOffset="0" hdg="0" orientation="none" length="4" width="8"><outlines><outline id="0" closed="true">{corners}</outline></outlines></object>"#,
            id + 2
        )
        .expect("a string takes all");
    }
    let text = format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<OpenDRIVE><header revMajor="1" revMinor="6" name="street" version="1" north="0" south="0" east="0" west="0"/>
<road length="{LENGTH}" id="1" junction="-1"><link/><type s="0" type="town"><speed max="50" unit="km/h"/></type>
<planView><geometry s="0" x="0" y="0" hdg="0" length="{LENGTH}"><line/></geometry></planView>
<lanes><laneSection s="0"><left>{three}{two}{one}</left><center><lane id="0" type="none" level="false"/></center>
<right>{right}</right></laneSection></lanes><objects>{crosswalks}</objects><signals/></road>
</OpenDRIVE>
"#
    );
    fs::write(path, text).expect("writable");
}
