//! The table of `docs/openscenario.md` is made from the one that the reader refuses by. `AEYE_BLESS=1` writes it anew.

use std::fs;
use std::path::Path;

use kernel::story::{ELEMENTS, Support};

const TABLE: &str = "## Elements\n\n";

fn table() -> String {
    let said = |support: Support| match support {
        Support::Yes => "yes",
        Support::Partly => "partly",
        Support::Ignored => "passed over",
        Support::No => "no",
    };
    let row =
        |(element, support, note): &(&str, Support, &str)| format!("| `{element}` | {} | {note} |\n", said(*support));
    let rows: String = ELEMENTS.iter().map(row).collect();
    format!("{TABLE}| element | read | |\n|---|---|---|\n{rows}")
}

#[test]
fn the_page_says_what_the_reader_reads() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/openscenario.md");
    let page = fs::read_to_string(&path).expect("the page is there");
    let head = page.split(TABLE).next().unwrap_or_default();
    let expected = format!("{head}{}", table());
    if std::env::var("AEYE_BLESS").is_ok() {
        fs::write(&path, &expected).expect("writable");
    }
    let page = fs::read_to_string(&path).expect("the page is there");
    assert!(page == expected, "docs/openscenario.md: its table is another than that of kernel::story::ELEMENTS");
}
