//! Small crates with and without circles, made up to test what finds them.

use super::modules::Files;
use super::report;

/// The circles of a crate `toy` of these files.
fn circles(files: &[(&str, &str)]) -> Vec<String> {
    let files: Files = files.iter().map(|(path, text)| (path.to_string(), text.to_string())).collect();
    report::of_package("toy", &files).expect("a crate that can be read")
}

fn assert_free(files: &[(&str, &str)]) {
    assert_eq!(circles(files), Vec::<String>::new());
}

fn assert_circle(files: &[(&str, &str)], arrows: &[&str]) {
    let found = circles(files);
    let lines: Vec<&str> = found.iter().flat_map(|text| text.lines().skip(1)).map(str::trim).collect();
    assert_eq!(lines, arrows, "\n{}", found.concat());
}

const TWO: [(&str, &str); 2] = [("lib.rs", "mod a;\nmod b;"), ("b.rs", "use crate::a::One;\npub struct Two;")];

#[test]
fn a_circle_of_two_files_is_told_with_names_and_lines() {
    let [lib, b] = TWO;
    let found = circles(&[lib, b, ("a.rs", "\nuse crate::b::Two;\npub struct One;")]);
    assert_eq!(found, ["circle of 2 files\n  a.rs -> b.rs: Two (line 2)\n  b.rs -> a.rs: One (line 1)\n"]);
}

#[test]
fn paths_of_every_kind_are_arrows() {
    let [lib, b] = TWO;
    for (a, line) in [
        ("use crate::{b::{self, Two}};", 1),
        ("use super::b::{Two as Other};", 1),
        ("use super::b;\npub fn f() -> b::Two {}", 2),
        ("use crate::b as other;\nstruct S(Vec<Option<other::Two>>);", 2),
        ("use super::b::*;\nstruct S(Two);", 2),
        ("use super::*;\nstruct S(b::Two);", 2),
        ("fn f() { let _ = crate::b::Two; }", 1),
        ("fn f(x: X) {\nmatch x { super::b::Two => {} } }", 2),
        ("fn f() { vec![\n1, crate::b::Two::new(1)]; }", 2),
        ("fn f() {\n use crate::b::Two; }", 2),
        ("impl\ncrate::b::Two for X {}", 2),
        ("macro_rules! m { () => { $crate::b::Two } }", 1),
        ("#[serde(with = \"crate::b::Two\")]\nstruct S;", 1),
        ("mod inner { use super::super::b::Two; }", 1),
    ] {
        let [forth, back] = [format!("a.rs -> b.rs: Two (line {line})"), "b.rs -> a.rs: One (line 1)".to_owned()];
        let glob = format!("a.rs -> b.rs: * (line 1), Two (line {line})");
        let forth = if a.contains("b::*") { glob } else { forth };
        assert_circle(&[lib, b, ("a.rs", &format!("{a}\npub struct One;"))], &[&forth, &back]);
    }
}

#[test]
fn what_only_looks_like_a_path_is_no_arrow() {
    let [lib, b] = TWO;
    for a in [
        "//! See [`crate::b::Two`].",
        "use super::b;",
        "use std::b::Two;",
        "use ::b::Two;",
        "pub(in crate::b) fn f() { x.b(); \"crate::b::Two\"; }",
        "fn f(b: u8) { println!(\"{}\", b.Two); }",
        "use self::c::Two; mod c { pub struct Two; }",
    ] {
        assert_free(&[lib, b, ("a.rs", &format!("{a}\npub struct One;"))]);
    }
}

#[test]
fn a_circle_through_reexports_is_found() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;\npub use a::One;\npub use c::Three as Drei;"),
        ("a.rs", "use crate::b::Two;\npub struct One;"),
        ("b.rs", "use crate::Drei;\npub struct Two;"),
        ("c/mod.rs", "mod deep;\npub use deep::*;"),
        ("c/deep.rs", "use crate::One;\npub struct Three;"),
    ];
    let [of_files, of_folders] = &circles(&files)[..] else { panic!("not two circles") };
    assert!(of_files.contains("  b.rs -> c/deep.rs: Three (line 1)\n  c/deep.rs -> a.rs: One (line 1)"), "{of_files}");
    assert!(of_folders.starts_with("circle of 3 parts of a folder\n  c -> a.rs, by\n"), "{of_folders}");
}

#[test]
fn a_longer_knot_is_told_by_its_shortest_way() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;"),
        ("a.rs", "use crate::b::B;\nuse crate::c::C;\npub struct A;"),
        ("b.rs", "use crate::c::C;\npub struct B;"),
        ("c.rs", "use crate::a::A;\npub struct C;"),
    ];
    assert_circle(&files, &["a.rs -> c.rs: C (line 2)", "c.rs -> a.rs: A (line 1)", "tied to it: b.rs"]);
}

#[test]
fn a_facade_is_neither_a_circle_nor_a_shield() {
    let lib = ("lib.rs", "pub mod map;\npub use map::{Road, Lane};\npub use self::map::road::LENGTH;");
    let lane = ("map/lane.rs", "pub struct Lane;");
    let facade = "mod road;\nmod lane;\npub use self::{road::{Road}, lane::*};";
    assert_free(&[
        lib,
        lane,
        ("map/mod.rs", facade),
        ("map/road.rs", "use crate::Lane;\nuse super::lane;\nstruct Road;"),
    ]);
    assert_free(&[lib, lane, ("map.rs", facade), ("map/road.rs", "use crate::map::Lane;\npub struct Road;")]);
    let works = format!("{facade}\npub const UNIT: u8 = 1;\npub fn bake() -> Road {{ todo() }}");
    let files = [lib, lane, ("map/mod.rs", &works), ("map/road.rs", "use super::UNIT;\npub struct Road;")];
    assert_circle(&files, &["map/mod.rs -> map/road.rs: Road (line 5)", "map/road.rs -> map/mod.rs: UNIT (line 1)"]);
}

#[test]
fn a_facade_calls_a_child_of_the_same_name() {
    let facade = |body: &str| format!("mod run;\npub use run::run;\npub struct Plan;\nfn f(run: u8) {{ {body} }}");
    let child = ("run/run.rs", "use super::Plan;\npub fn run(_: Plan) {}");
    let lib = ("lib.rs", "mod run;");
    assert_free(&[lib, ("run/mod.rs", &facade("run + 1;")), child]);
    let arrows = ["run/mod.rs -> run/run.rs: run (line 4)", "run/run.rs -> run/mod.rs: Plan (line 1)"];
    assert_circle(&[lib, ("run/mod.rs", &facade("run(Plan);")), child], &arrows);
}

#[test]
fn folders_make_a_circle_without_one_of_files() {
    let files = [
        ("lib.rs", "mod world;\nmod lights;"),
        ("world/mod.rs", "mod a;\npub mod b;"),
        ("world/a.rs", "use crate::lights::red::Red;"),
        ("world/b.rs", "pub struct B;"),
        ("lights.rs", "pub mod red;\nmod c;"),
        ("lights/red.rs", "pub struct Red;"),
        ("lights/c.rs", "use crate::world::b::B;"),
    ];
    let expected = [
        "lights -> world, by",
        "lights/c.rs -> world/b.rs: B (line 1)",
        "world -> lights, by",
        "world/a.rs -> lights/red.rs: Red (line 1)",
    ];
    assert_circle(&files, &expected);
    assert_free(&files.map(|(path, text)| (path, if path == "lights/c.rs" { "" } else { text })));
}

#[test]
fn a_circle_of_files_hides_none_of_folders() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;"),
        ("a.rs", "use crate::b::B;\nuse crate::c::C;\npub struct A;"),
        ("b.rs", "use crate::a::A;\npub struct B;"),
        ("c/mod.rs", "use crate::a::A;\npub struct C;"),
    ];
    let [of_files, of_folders] = &circles(&files)[..] else { panic!("not two circles") };
    assert!(of_files.contains("a.rs -> b.rs: B (line 1)"), "{of_files}");
    assert!(of_folders.contains("a.rs -> c, by\n    a.rs -> c/mod.rs: C (line 2)"), "{of_folders}");
}

#[test]
fn tests_may_import_what_they_like() {
    let [lib, b] = TWO;
    for test in [
        "#[cfg(test)]\nmod tests { use crate::b::Two; }",
        "#[cfg(all(test, unix))]\nmod tests { use crate::b::Two; }",
        "#[cfg(test)]\nuse crate::b::Two;",
        "#[test]\nfn f() { crate::b::Two; }",
        "mod tests;",
        "mod testing;",
        "#[cfg(test)]\nmod absent;",
    ] {
        let a = format!("{test}\npub struct One;");
        let taken = "use crate::b::Two;";
        assert_free(&[lib, b, ("a.rs", &a), ("a/tests.rs", taken), ("a/testing.rs", taken)]);
    }
    let a = "#[cfg(any(test, unix))]\nuse crate::b::Two;\npub struct One;";
    assert_circle(&[lib, b, ("a.rs", a)], &["a.rs -> b.rs: Two (line 2)", "b.rs -> a.rs: One (line 1)"]);
}

#[test]
fn a_program_knows_its_library_by_name() {
    let files = [
        ("lib.rs", "pub mod a;"),
        ("a.rs", "pub struct One;"),
        ("main.rs", "mod cli;\nuse toy::a::One;\npub struct Main;"),
        ("cli.rs", "use crate::Main;\nuse toy::a::One;"),
    ];
    assert_free(&files);
    let main = ("main.rs", "mod cli;\nuse cli::Cli;\npub struct Main;");
    let cli = ("cli.rs", "use crate::Main;\npub struct Cli;");
    assert_circle(&[main, cli], &["cli.rs -> main.rs: Main (line 1)", "main.rs -> cli.rs: Cli (line 2)"]);
}

#[test]
fn macros_are_followed_to_their_file() {
    let files = [
        ("lib.rs", "#[macro_use]\nmod a;\nmod b;"),
        ("a.rs", "use crate::b::Two;\nmacro_rules! list { () => {} }"),
        ("b.rs", "list!();\npub struct Two;"),
    ];
    assert_circle(&files, &["a.rs -> b.rs: Two (line 1)", "b.rs -> a.rs: list (line 1)"]);
}

#[test]
fn what_cannot_be_read_is_an_error() {
    for (text, expected) in [("fn (", "lib.rs: "), ("mod a;", "lib.rs: no file for `mod a`")] {
        let files = Files::from([("lib.rs".to_owned(), text.to_owned())]);
        let error = report::of_package("toy", &files).expect_err("a crate that cannot be read");
        assert!(error.starts_with(expected), "{error}");
    }
}
