//! `aeye map` as a process: what is in maps, what was not understood of their files, and pictures of them.

mod common;

use std::fs;
use std::path::Path;

use common::{aeye, names, run};
use serde_json::Value;

/// A road with a lane, and much that means nothing here.
const ODD: &str = r#"<OpenDRIVE><header revMajor="1" revMinor="7" vendor="somebody"/>
<road id="12" length="300" junction="-1">
<link><successor elementType="road" elementId="99" contactPoint="start"/></link>
<type s="0" type="town" country="DE"><speed max="30" unit="km/h"/></type>
<planView><geometry s="0" x="0" y="0" hdg="0" length="300"><line/></geometry></planView>
<elevationProfile><elevation s="0" a="2" b="0.05" c="0" d="0"/></elevationProfile>
<lanes><laneSection s="0"><center><lane id="0" type="none"/></center><right>
<lane id="-1" type="driving"><width sOffset="0" a="3.5"/><roadMark sOffset="0" type="solid" color="yellow"/>
<material sOffset="0" surface="lava"/></lane>
<lane id="-2" type="tram"><width sOffset="0" a="3"/></lane>
<lane id="-3" type="sidewalk"><width sOffset="0" a="2"/></lane></right></laneSection></lanes>
<objects><object id="1" type="gantry" s="20" t="0" length="1" width="9" height="6"/>
<station id="2" name="Central" type="small"/></objects>
<signals><signal id="3" s="31" t="-9" type="101" subtype="10" country="DE" dynamic="no" orientation="+"/>
<signal id="4" s="60" t="-9" type="101" subtype="10" country="DE" dynamic="no" orientation="+"/></signals>
</road></OpenDRIVE>"#;

/// What is told of a map as JSON.
fn told(folder: &Path, file: &str) -> Value {
    let (code, out, said) = run(aeye(folder, "map inspect --json").arg(file));
    assert_eq!((code, said.as_str(), out.lines().count()), (Some(0), "", 1), "{file}");
    serde_json::from_str(&out).expect("JSON")
}

#[test]
fn a_bundled_map_is_told_by_its_name() {
    let dir = tempfile::tempdir().expect("a folder");
    let city = told(dir.path(), "city");
    let network = kernel::map::bundled("city").expect("bundled");
    assert_eq!((city["type"].as_str(), city["name"].as_str()), (Some("aeye.map"), Some("city")));
    assert_eq!(city["digest"], format!("{:032x}", network.digest));
    assert_eq!((city["traffic_side"].as_str(), city["bus_stops"].as_u64()), (Some("right"), Some(12)));
    assert_eq!(city["reach"]["dead_ends"], 0);
    assert_eq!(city["junctions"]["count"].as_u64(), Some(network.junctions.len() as u64));
    let sum = |list: &str, key: &str| -> f64 {
        city[list].as_array().expect("a list").iter().filter_map(|line| line[key].as_f64()).sum()
    };
    let driving: f64 = network.lanes.iter().map(|lane| f64::from(lane.length_m)).sum();
    assert!((sum("lanes", "km") - driving / 1000.0).abs() < 0.01 && sum("limits", "km") > 1.0);
    assert_eq!(sum("props", "named") + sum("props", "made_up"), network.props.len() as f64);
    let (code, text, _) = run(&mut aeye(dir.path(), "map inspect city rural"));
    assert_eq!((code, text.matches("\nreach        every driving lane leads to every other").count()), (Some(0), 2));
    assert!(text.starts_with("map          city (city, OpenDRIVE 1.6)\ndigest       "), "{text}");
}

#[test]
fn what_is_not_understood_is_told_with_number_and_place() {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("odd.xodr"), ODD).expect("writable");
    let odd = told(dir.path(), "odd.xodr");
    let groups = odd["not_understood"].as_array().expect("a list");
    for (kind, what, count, first) in [
        ("reference", "<successor> to road 99", 1, "road 12"),
        ("signal", "type 101, subtype 10, country DE", 2, "road 12, s 31.0 m"),
        ("object", "type gantry", 1, "road 12, s 20.0 m"),
        ("lane", "type tram", 1, "road 12, section 0, lane -2"),
        ("road mark", "colour yellow", 1, "road 12, s 0.0 m"),
        ("surface", "material lava", 1, "road 12, section 0, lane -1"),
        ("element", "<station> in <objects>", 1, "road 12"),
    ] {
        let group = groups.iter().find(|group| group["kind"] == kind && group["what"] == what);
        let group = group.unwrap_or_else(|| panic!("{kind} {what} is not among {groups:#?}"));
        assert_eq!((group["count"].as_u64(), group["first"].as_str()), (Some(count), Some(first)), "{group}");
    }
    assert_eq!((odd["vendor"].as_str(), odd["countries"][0].as_str()), (Some("somebody"), Some("DE")));
    assert_eq!((odd["version"].as_u64(), odd["opendrive"].as_str()), (Some(3), Some("1.7")));
    let gradient = odd["relief"]["gradient_pct"].as_f64().expect("a number");
    assert!((gradient - 5.0).abs() < 0.1 && odd["relief"]["steepest"] == "12/-1", "{}", odd["relief"]);
    assert_eq!((odd["limits"][0]["kmh"].as_f64(), odd["reach"]["dead_ends"].as_u64()), (Some(30.0), Some(1)));
    let (_, text, _) = run(&mut aeye(dir.path(), "map inspect odd.xodr"));
    let line = "signal       type 101, subtype 10, country DE: is in none of the catalogues, 2 times, first at road 12, s 31.0 m";
    assert!(text.lines().any(|told| told == line), "{text}");
}

#[test]
fn damaged_files_are_refused_in_a_sentence_and_the_rest_is_told() {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("half.xodr"), &ODD[..900]).expect("writable");
    fs::write(dir.path().join("bare.xodr"), "<OpenDRIVE/>").expect("writable");
    fs::write(dir.path().join("odd.xodr"), ODD).expect("writable");
    for (arguments, code, begins) in [
        ("map inspect half.xodr", 1, "error: half.xodr: line "),
        ("map inspect bare.xodr", 1, "error: bare.xodr: the whole file: expected a road "),
        ("map inspect none.xodr", 1, "error: none.xodr: "),
        ("map inspect atlantis", 2, "error: unknown map \"atlantis\": expected one of city, "),
        ("map draw half.xodr --out m.svg", 1, "error: half.xodr: line "),
        ("map draw atlantis --out m.svg", 2, "error: unknown map"),
        ("map draw odd.xodr --out none/m.svg", 1, "error: none/m.svg: "),
        ("map draw odd.xodr --out odd.xodr", 1, "error: odd.xodr: exists already; expected a new file"),
    ] {
        let (got, out, said) = run(&mut aeye(dir.path(), arguments));
        assert_eq!((got, out.as_str(), said.lines().count()), (Some(code), "", 1), "{arguments}: {said}");
        assert!(said.starts_with(begins), "{arguments}: {said}");
    }
    let (code, out, said) = run(&mut aeye(dir.path(), "map inspect bare.xodr odd.xodr --json"));
    assert_eq!((code, out.lines().count(), said.lines().count()), (Some(1), 1, 2), "{said}");
    assert!(said.ends_with("error: 1 of 2 files failed\n"), "{said}");
    assert_eq!(names(dir.path()), ["bare.xodr", "half.xodr", "odd.xodr"]);
}

#[test]
fn a_picture_is_the_same_each_time_and_never_takes_the_place_of_another() {
    let dir = tempfile::tempdir().expect("a folder");
    let drawn = |arguments: &str| {
        let (code, out, said) = run(&mut aeye(dir.path(), arguments));
        assert_eq!((code, said.as_str()), (Some(0), ""), "{arguments}");
        out
    };
    let read = |name: &str| fs::read_to_string(dir.path().join(name)).expect("a picture");
    let told: Value = serde_json::from_str(&drawn("map draw rural --out a.svg --json")).expect("JSON");
    drawn("map draw rural --out b.svg");
    assert_eq!((told["type"].as_str(), told["out"].as_str()), (Some("aeye.map.drawing"), Some("a.svg")));
    assert_eq!(told["bytes"].as_u64(), Some(read("a.svg").len() as u64));
    assert!(read("a.svg") == read("b.svg"));
    drawn("map draw rural --size 300 --out small.svg");
    assert!(read("small.svg").len() < read("a.svg").len() + 1000 && read("small.svg") != read("a.svg"));
    let before = read("a.svg");
    let (code, _, said) = run(&mut aeye(dir.path(), "map draw city --out a.svg"));
    assert_eq!((code, said.as_str()), (Some(1), "error: a.svg: exists already; expected a new file\n"));
    assert!(read("a.svg") == before);
    assert_eq!(names(dir.path()), ["a.svg", "b.svg", "small.svg"]);
}
