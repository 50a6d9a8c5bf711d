//! Catalogs: files of vehicles, manoeuvres, routes and so on, to whose entries a text refers. They are put into the text, so that
//! it needs no other file.

use std::collections::BTreeMap;
use std::ops::Range;

use roxmltree::{Document, Node};

use super::document::{self, BYTES, Shared, line_of, shown};
use crate::story::error::StoryError;

/// How deep entries may refer to others.
const DEPTH: usize = 8;
/// Most folders of catalogs, and longest expression with the values of its parameters, bytes.
const FOLDERS: usize = 50;
const EXPRESSION: usize = 10_000;
/// Elements whose references are passed over with all else in them.
const UNREAD: [&str; 4] = ["ObjectController", "Controller", "AssignControllerAction", "ControllerAction"];

/// The folders of the catalogs of a text, as that calls them, up to so many.
pub fn folders(text: &str) -> Vec<String> {
    let Ok(document) = document::parse(text) else { return Vec::new() };
    let shared = Shared::of(&document);
    let locations = document.descendants().filter(|n| n.has_tag_name("CatalogLocations"));
    let paths = locations.flat_map(|n| n.descendants()).filter(|n| n.has_tag_name("Directory")).take(FOLDERS);
    let mut found: Vec<String> = Vec::new();
    for path in paths.filter_map(|n| shared.value(n, n.attribute("path")?).ok()) {
        if !found.contains(&path) {
            found.push(path);
        }
    }
    found
}

/// Entries of catalogs by the names of these and their own.
type Entries<'a> = BTreeMap<(&'a str, &'a str), Node<'a, 'a>>;

/// A text with the entries of catalogs in place of references to them, each on the line of the reference. Who plays may be
/// told by an entry that is not there.
///
/// # Errors
/// When an entry is not there that is no entity, or all of them come to too much.
pub fn put_in(text: &str, catalogs: &[(String, String)]) -> Result<String, StoryError> {
    document::check_version(&document::parse(text)?)?;
    let mut documents = Vec::new();
    let mut broken = None;
    for (file, catalog) in catalogs {
        match document::parse(catalog) {
            Ok(parsed) => documents.push(parsed),
            Err(error) => broken = broken.or(Some(format!("; catalog {file}: {error}"))),
        }
    }
    let mut entries = Entries::new();
    for catalog in
        documents.iter().flat_map(|file| file.root_element().children().filter(|n| n.has_tag_name("Catalog")))
    {
        for entry in catalog.children().filter(Node::is_element) {
            if let (Some(of), Some(name)) = (catalog.attribute("name"), entry.attribute("name")) {
                entries.entry((of, name)).or_insert(entry);
            }
        }
    }
    let mut text = text.to_owned();
    for _ in 0..DEPTH {
        let Some(next) = once(&text, &entries, broken.as_deref().unwrap_or_default())? else { return Ok(text) };
        text = next;
    }
    let document = document::parse(&text)?;
    let first = references(&document).next().unwrap_or(document.root_element());
    let name = shown(first.attribute("entryName").unwrap_or_default());
    let reason =
        format!("entries of its catalogs refer to each other more than {DEPTH} times, {name} the last of them");
    Err(StoryError::at(line_of(first), reason))
}

/// The references of a text that are read; what is in one goes with it.
fn references<'a>(document: &'a Document<'a>) -> impl Iterator<Item = Node<'a, 'a>> {
    let is_reference = |n: &Node<'_, '_>| n.has_tag_name("CatalogReference");
    let is_read = move |n: &Node<'_, '_>| {
        !n.ancestors().skip(1).any(|above| UNREAD.contains(&above.tag_name().name()) || is_reference(&above))
    };
    document.descendants().filter(is_reference).filter(is_read)
}

/// Puts the entries of all references in; nothing where there is none.
fn once(text: &str, entries: &Entries<'_>, broken: &str) -> Result<Option<String>, StoryError> {
    let document = document::parse(text)?;
    let shared = Shared::of(&document);
    let (mut edits, mut bytes) = (Vec::new(), text.len());
    for reference in references(&document) {
        let named = |name: &str| {
            let text = reference.attribute(name).unwrap_or_default();
            shared.value(reference, text).unwrap_or_else(|_| text.to_owned())
        };
        let (catalog, entry) = (named("catalogName"), named("entryName"));
        match entries.get(&(catalog.as_str(), entry.as_str())) {
            Some(found) => {
                let too_much = || {
                    let most = format!("expected at most {} MiB with the entries of its catalogs", BYTES >> 20);
                    StoryError::at(line_of(reference), most)
                };
                // Declarations that are not put in are read all the same.
                let read = found.range().len();
                let left = BYTES.saturating_sub(bytes).checked_sub(read).ok_or_else(too_much)?;
                let put = put(*found, &assigned(reference), left + read).ok_or_else(too_much)?;
                bytes += put.len().max(read);
                edits.push((reference.range(), put));
            }
            None if reference.parent_element().is_some_and(|n| n.has_tag_name("ScenarioObject")) => {}
            None => {
                let reason = format!(
                    "<CatalogReference> names {} of the catalog {}, which is in none of the files of <CatalogLocations>{broken}",
                    shown(&entry),
                    shown(&catalog)
                );
                return Err(StoryError::at(line_of(reference), reason));
            }
        }
    }
    Ok((!edits.is_empty()).then(|| edited(text, 0, edits)))
}

/// What a reference gives the parameters of its entry.
fn assigned(reference: Node<'_, '_>) -> BTreeMap<String, String> {
    let all = reference.descendants().filter(|n| n.has_tag_name("ParameterAssignment"));
    let pair = |n: Node<'_, '_>| {
        let name = n.attribute("parameterRef")?.trim_start_matches('$');
        Some((name.to_owned(), n.attribute("value")?.to_owned()))
    };
    all.filter_map(pair).collect()
}

/// The text of an entry on one line, with the values of its parameters; nothing where that has more than so many bytes.
fn put(entry: Node<'_, '_>, assigned: &BTreeMap<String, String>, most: usize) -> Option<String> {
    let declarations = entry.children().find(|n| n.has_tag_name("ParameterDeclarations"));
    let declared = declarations.into_iter().flat_map(|n| n.children());
    let usual = |n: Node<'_, '_>| {
        Some((n.attribute("name")?.trim_start_matches('$').to_owned(), n.attribute("value")?.to_owned()))
    };
    let mut values: BTreeMap<String, String> = declared.filter_map(usual).collect();
    values.extend(assigned.iter().map(|(name, value)| (name.clone(), value.clone())));
    let attributes = entry.descendants().filter(Node::is_element).flat_map(|n| n.attributes());
    let own = declarations.map(|n| n.range());
    let told = attributes.filter(|a| a.value().starts_with('$'));
    let told = told.filter(|a| own.as_ref().is_none_or(|own| !own.contains(&a.range_value().start)));
    let all = entry.range();
    let mut bytes = all.len();
    let mut edits = Vec::new();
    for attribute in told {
        let value = escaped(&with_values(attribute.value(), &values)?);
        bytes += value.len();
        if bytes > most {
            return None;
        }
        edits.push((attribute.range_value(), value));
    }
    edits.extend(own.map(|range| (range, String::new())));
    let text = edited(&entry.document().input_text()[all.clone()], all.start, edits).replace(['\n', '\r'], " ");
    (text.len() <= most).then_some(text)
}

/// A parameter or an expression with the values of those that are known; nothing where that is too long.
fn with_values(text: &str, values: &BTreeMap<String, String>) -> Option<String> {
    let Some(expression) = text.strip_prefix("${") else {
        return Some(values.get(text.trim_start_matches('$')).cloned().unwrap_or_else(|| text.to_owned()));
    };
    let (mut out, mut rest) = ("${".to_owned(), expression);
    while let Some(at) = rest.find('$') {
        let (before, from) = rest.split_at(at);
        let end = from[1..].find(|c: char| !c.is_alphanumeric() && c != '_').map_or(from.len(), |end| end + 1);
        out += before;
        match values.get(&from[1..end]) {
            Some(value) => match value.strip_prefix("${").and_then(|value| value.strip_suffix('}')) {
                Some(inner) => out += &format!("({inner})"),
                None => out += value,
            },
            None => out += &from[..end],
        }
        if out.len() > EXPRESSION {
            return None;
        }
        rest = &from[end..];
    }
    Some(out + rest)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;").replace('\'', "&apos;")
}

/// A text that begins at a place of a whole one, with some ranges of that replaced.
fn edited(text: &str, begins: usize, mut edits: Vec<(Range<usize>, String)>) -> String {
    edits.sort_by_key(|(range, _)| range.start);
    let (mut out, mut at) = (String::new(), begins);
    for (range, new) in edits {
        out += &text[at - begins..range.start - begins];
        out += &new;
        at = range.end;
    }
    out + &text[at - begins..]
}

#[cfg(test)]
mod tests {
    use super::*;

    const CATALOG: &str = r#"<OpenSCENARIO><FileHeader/><Catalog name="Moves">
<Maneuver name="brake"><ParameterDeclarations><ParameterDeclaration name="mps" parameterType="double" value="4"/>
<ParameterDeclaration name="s" parameterType="double" value="2"/></ParameterDeclarations>
<Event name="$s" value="$mps" sum="${$mps * $s + $other}"/>
</Maneuver></Catalog></OpenSCENARIO>"#;

    fn with(reference: &str) -> Result<String, StoryError> {
        let text = format!("<A>\n<ManeuverGroup>{reference}</ManeuverGroup>\n</A>");
        put_in(&text, &[("moves.xosc".to_owned(), CATALOG.to_owned())])
    }

    #[test]
    fn an_entry_takes_the_place_of_its_reference_with_its_values() {
        let plain = with(r#"<CatalogReference catalogName="Moves" entryName="brake"/>"#).expect("it is there");
        assert!(plain.contains(r#"<Event name="2" value="4" sum="${4 * 2 + $other}"/>"#), "{plain}");
        assert!(!plain.contains("ParameterDeclaration") && plain.lines().count() == 3, "{plain}");
        let given = with(
            r#"<CatalogReference catalogName="Moves" entryName="brake"><ParameterAssignments>
<ParameterAssignment parameterRef="$mps" value="${$fast - 1}"/></ParameterAssignments></CatalogReference>"#,
        );
        let given = given.expect("it is there");
        assert!(given.contains(r#"value="${$fast - 1}" sum="${($fast - 1) * 2 + $other}""#), "{given}");
    }

    #[test]
    fn what_is_not_there_is_named() {
        let error = with(r#"<CatalogReference catalogName="Moves" entryName="turn"/>"#).expect_err("it is not there");
        assert_eq!(error.line, 2);
        assert!(
            error.reason.starts_with("<CatalogReference> names \"turn\" of the catalog \"Moves\", which"),
            "{error}"
        );
    }

    #[test]
    fn entries_that_refer_to_themselves_are_refused() {
        let own = CATALOG.replace("<Event", "<CatalogReference catalogName=\"Moves\" entryName=\"brake\"/><Event");
        let text =
            "<A><ManeuverGroup><CatalogReference catalogName=\"Moves\" entryName=\"brake\"/></ManeuverGroup></A>";
        let error = put_in(text, &[("own.xosc".to_owned(), own)]).expect_err("it has no end");
        assert!(error.reason.contains("refer to each other"), "{error}");
    }

    #[test]
    fn references_in_references_and_bombs_of_them_come_to_an_end() {
        let one = r#"<CatalogReference catalogName="Moves" entryName="brake"/>"#;
        let nested = with(
            r#"<CatalogReference catalogName="Moves" entryName="brake"><CatalogReference catalogName="Moves" entryName="brake"/></CatalogReference>"#,
        );
        assert_eq!(nested, with(one));
        let big = CATALOG.replace("<Event", &format!("<Event note=\"{}\"", "x".repeat(1 << 20)));
        let text = format!("<A>\n<ManeuverGroup>\n{}</ManeuverGroup></A>", format!("{one}\n").repeat(400));
        let error = put_in(&text, &[("big.xosc".to_owned(), big)]).expect_err("it is too much");
        assert!(error.line > 10 && error.reason.starts_with("expected at most 16 MiB"), "{error}");
        let given = r#"<CatalogReference catalogName="Moves" entryName="brake"><ParameterAssignments><ParameterAssignment parameterRef="mps" value="VALUE"/></ParameterAssignments></CatalogReference>"#;
        let sum = CATALOG.replace("${$mps * $s", &format!("${{{}", "$mps ".repeat(3000)));
        let text = format!("<A><ManeuverGroup>{}</ManeuverGroup></A>", given.replace("VALUE", &"1".repeat(1 << 20)));
        assert!(put_in(&text, &[("sum.xosc".to_owned(), sum)]).is_err());
    }

    #[test]
    fn a_catalog_that_is_broken_is_told_where_an_entry_is_missing() {
        let files = [("moves.xosc".to_owned(), CATALOG.to_owned()), ("bad.xosc".to_owned(), "<Open".to_owned())];
        let text = |entry: &str| {
            format!(
                "<A><ManeuverGroup><CatalogReference catalogName=\"Moves\" entryName=\"{entry}\"/></ManeuverGroup></A>"
            )
        };
        assert!(put_in(&text("brake"), &files).is_ok());
        let error = put_in(&text("turn"), &files).expect_err("it is not there").to_string();
        assert!(error.contains("catalog bad.xosc: line 1"), "{error}");
    }

    #[test]
    fn folders_are_those_of_the_locations() {
        let text = r#"<A><CatalogLocations><VehicleCatalog><Directory path="cat/v"/></VehicleCatalog>
<RouteCatalog><Directory path="cat/v"/></RouteCatalog><ManeuverCatalog><Directory path="m"/></ManeuverCatalog></CatalogLocations></A>"#;
        assert_eq!(folders(text), ["cat/v", "m"]);
    }
}
