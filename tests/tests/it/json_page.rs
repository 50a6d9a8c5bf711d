//! `docs/json.md` is made from the types: every one that is written as JSON, with its fields and what they mean.
//! `AEYE_BLESS=1` writes it anew.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs;
use std::path::{Path, PathBuf};

use syn::{Attribute, Fields, GenericArgument, Item, PathArguments, Type};

const HEAD: &str = "\
# JSON

Every line that `aeye --json` prints, and every `.json` and `.jsonl` file, begins with `\"type\"` and `\"version\"`. These are the types; the
rules are in [command-line.md](command-line.md). Units are in the names of the fields: `_s` seconds, `_ms` milliseconds, `_m` metres, `km`
kilometres, `_kmh` km/h, `_mps` m/s, `_mps2` m/s², `_deg` degrees, `_pct` percent, `_px` pixels; ticks are sixtieths of a simulated second.

This page is made from the program's types by a test (`AEYE_BLESS=1 cargo test --release -p tests --test it json_page`).
";

/// A struct or an enum of the program.
struct Known {
    file: PathBuf,
    item: Item,
}

/// All of them by name, and what is written as JSON: name of the type, struct, file, and where it is written.
#[derive(Default)]
struct Sources {
    known: BTreeMap<String, Vec<Known>>,
    typed: BTreeMap<String, (String, PathBuf, String)>,
}

impl Sources {
    fn read(&mut self, folder: &Path) {
        let entries = fs::read_dir(folder).expect("a readable folder").map(|entry| entry.expect("an entry").path());
        for path in entries.collect::<BTreeSet<_>>() {
            if path.is_dir() {
                self.read(&path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let text = fs::read_to_string(&path).expect("a text");
                syn::parse_file(&text).expect("Rust").items.into_iter().for_each(|item| self.add(&path, item));
            }
        }
    }

    fn add(&mut self, file: &Path, item: Item) {
        let name = match &item {
            Item::Struct(item) if is_serialised(&item.attrs) => item.ident.to_string(),
            Item::Enum(item) if is_serialised(&item.attrs) => item.ident.to_string(),
            Item::Impl(item) => {
                let is_typed = item.trait_.as_ref().is_some_and(|(path, ..)| last(path) == "Typed");
                if let (true, Some(name), Type::Path(of)) = (is_typed, constant(item), &*item.self_ty) {
                    self.typed.insert(name, (last(&of.path), file.to_owned(), doc(&item.attrs)));
                }
                return;
            }
            _ => return,
        };
        self.known.entry(name).or_default().push(Known { file: file.to_owned(), item });
    }

    /// That of a name, nearest to a file.
    fn find(&self, name: &str, near: &Path) -> Option<&Known> {
        let shared =
            |known: &&Known| known.file.components().zip(near.components()).take_while(|(a, b)| a == b).count();
        self.known.get(name)?.iter().max_by_key(|known| (known.file == near, shared(known)))
    }
}

fn is_serialised(attributes: &[Attribute]) -> bool {
    attributes.iter().filter(|attribute| attribute.path().is_ident("derive")).any(|attribute| {
        let mut found = false;
        let _ = attribute.parse_nested_meta(|meta| {
            found |= meta.path.is_ident("Serialize");
            Ok(())
        });
        found
    })
}

fn last(path: &syn::Path) -> String {
    path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default()
}

/// The string of the constant `TYPE`.
fn constant(item: &syn::ItemImpl) -> Option<String> {
    item.items.iter().find_map(|item| match item {
        syn::ImplItem::Const(constant) => match &constant.expr {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value()),
            _ => None,
        },
        _ => None,
    })
}

fn doc(attributes: &[Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| match &attribute.meta {
        syn::Meta::NameValue(meta) if meta.path.is_ident("doc") => match &meta.value {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value().trim().to_owned()),
            _ => None,
        },
        _ => None,
    });
    lines.collect::<Vec<_>>().join(" ").replace("[`", "`").replace("`]", "`").replace('|', "\\|")
}

/// The words of `#[serde(...)]`, such as `flatten` and `rename = "x"`.
fn serde(attributes: &[Attribute]) -> Vec<(String, Option<String>)> {
    let mut words = Vec::new();
    for attribute in attributes.iter().filter(|attribute| attribute.path().is_ident("serde")) {
        let _ = attribute.parse_nested_meta(|meta| {
            let value = meta.value().ok().and_then(|value| value.parse::<syn::LitStr>().ok()).map(|text| text.value());
            words.push((last(&meta.path), value));
            Ok(())
        });
    }
    words
}

fn has(words: &[(String, Option<String>)], word: &str) -> bool {
    words.iter().any(|(name, _)| name == word)
}

fn value<'a>(words: &'a [(String, Option<String>)], word: &str) -> Option<&'a str> {
    words.iter().find(|(name, _)| name == word)?.1.as_deref()
}

fn in_case(name: &str, case: Option<&str>) -> String {
    let mut words = String::new();
    for (i, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && i > 0 {
            words.push('-');
        }
        words.extend(letter.to_lowercase());
    }
    match case {
        Some("lowercase") => words.replace('-', ""),
        Some("snake_case") => words.replace('-', "_"),
        Some("kebab-case") => words,
        _ => name.to_owned(),
    }
}

/// Writes the page.
struct Page<'a> {
    sources: &'a Sources,
    /// Structs that have yet to be told, by name, and from where.
    waiting: VecDeque<(String, PathBuf)>,
    told: BTreeSet<String>,
    text: String,
    undocumented: Vec<String>,
}

impl Page<'_> {
    fn section(&mut self, heading: &str, name: &str, near: &Path, about: &str) {
        let Some(known) = self.sources.find(name, near) else { panic!("{name} near {} is unknown", near.display()) };
        self.text.push_str(&format!("\n{heading}\n\n"));
        let own = match &known.item {
            Item::Struct(item) => doc(&item.attrs),
            Item::Enum(item) => doc(&item.attrs),
            _ => String::new(),
        };
        self.text
            .push_str(&[about, &own].iter().filter(|t| !t.is_empty()).map(|t| format!("{t}\n")).collect::<String>());
        self.text.push_str("\n| field | value | meaning |\n|---|---|---|\n");
        self.rows(name, near);
    }

    fn rows(&mut self, name: &str, near: &Path) {
        let sources = self.sources;
        let Some(known) = sources.find(name, near) else { panic!("{name} is unknown") };
        match &known.item {
            Item::Struct(item) => {
                for field in &item.fields {
                    let words = serde(&field.attrs);
                    let Some(ident) = field.ident.as_ref().filter(|_| !has(&words, "skip")) else { continue };
                    if has(&words, "flatten") {
                        let (inner, _) = self.named(&field.ty, &known.file).expect("a struct is flattened");
                        self.rows(&inner, &known.file);
                        continue;
                    }
                    let key = value(&words, "rename").map_or_else(|| ident.to_string(), str::to_owned);
                    let (mut kind, meaning) = (self.kind(&field.ty, &known.file), doc(&field.attrs));
                    if has(&words, "skip_serializing_if") {
                        kind = kind.replace(", or null", "") + ", or left out";
                    }
                    if meaning.is_empty() || kind.trim_start_matches(", or null").is_empty() {
                        self.undocumented.push(format!("{}: {name}.{key}", known.file.display()));
                    }
                    self.text.push_str(&format!("| `{key}` | {kind} | {meaning} |\n"));
                }
            }
            Item::Enum(item) => self.alternatives(item, &known.file),
            _ => {}
        }
    }

    /// An enum with a tag and a content.
    fn alternatives(&mut self, item: &syn::ItemEnum, file: &Path) {
        let words = serde(&item.attrs);
        let names: Vec<_> = item.variants.iter().map(|v| format!("`\"{}\"`", variant(v, &words))).collect();
        let (tag, content) = (value(&words, "tag").unwrap_or("kind"), value(&words, "content").unwrap_or("value"));
        let fields = item.variants.iter().flat_map(|variant| variant.fields.iter());
        let kinds: Vec<_> = fields.map(|field| self.kind(&field.ty, file)).collect();
        self.text.push_str(&format!("| `{tag}` | {} | which kind |\n", names.join(", ")));
        self.text.push_str(&format!("| `{content}` | {} | by the kind |\n", kinds.join(", or ")));
    }

    /// A struct or enum of the program behind references and boxes.
    fn named(&self, ty: &Type, near: &Path) -> Option<(String, bool)> {
        match ty {
            Type::Reference(reference) => self.named(&reference.elem, near),
            Type::Path(path) => {
                let name = last(&path.path);
                if name == "Box" || name == "Option" {
                    return arguments(&path.path).first().and_then(|inner| self.named(inner, near));
                }
                let known = self.sources.find(&name, near)?;
                Some((name, matches!(known.item, Item::Struct(_))))
            }
            _ => None,
        }
    }

    fn kind(&mut self, ty: &Type, near: &Path) -> String {
        match ty {
            Type::Reference(reference) => self.kind(&reference.elem, near),
            Type::Tuple(tuple) => {
                let each: Vec<_> = tuple.elems.iter().map(|ty| self.kind(ty, near)).collect();
                format!("[{}]", each.join(", "))
            }
            Type::Array(array) => format!("list of {}", self.kind(&array.elem, near)),
            Type::Slice(slice) => format!("list of {}", self.kind(&slice.elem, near)),
            Type::Path(path) => self.of_path(&path.path, near),
            _ => "value".into(),
        }
    }

    fn of_path(&mut self, path: &syn::Path, near: &Path) -> String {
        let name = last(path);
        let inner: Vec<String> = arguments(path).iter().map(|ty| self.kind(ty, near)).collect();
        match (name.as_str(), inner.as_slice()) {
            ("Option", [inner]) => format!("{inner}, or null"),
            ("Vec", [inner]) => format!("list of {inner}"),
            ("BTreeMap", [_, inner]) => format!("object of {inner}"),
            ("Box", [inner]) => inner.clone(),
            ("String" | "str" | "PathBuf" | "Provenance" | "Metric" | "Pseudonym" | "RunOutcome", _) => "string".into(),
            ("bool", _) => "true or false".into(),
            ("f32" | "f64", _) => "number".into(),
            ("usize" | "u8" | "u16" | "u32" | "u64" | "i32" | "i64" | "Tick", _) => "integer".into(),
            _ => self.of_name(&name, near),
        }
    }

    fn of_name(&mut self, name: &str, near: &Path) -> String {
        let Some(known) = self.sources.find(name, near) else { return "value".into() };
        match &known.item {
            Item::Enum(item) if item.variants.iter().all(|v| matches!(v.fields, Fields::Unit)) => {
                let words = serde(&item.attrs);
                let names: Vec<_> = item.variants.iter().map(|v| format!("`\"{}\"`", variant(v, &words))).collect();
                names.join(", ")
            }
            _ => {
                self.waiting.push_back((name.to_owned(), known.file.clone()));
                format!(
                    "[{name}](#{})",
                    title(name, &known.file).to_lowercase().replace(' ', "-").replace(['/', '.', '(', ')'], "")
                )
            }
        }
    }
}

/// What a part is called: two of the same name are told apart by their files.
fn title(name: &str, file: &Path) -> String {
    let parts: Vec<_> = file.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    let from = parts.iter().rposition(|part| part == "rig").map_or(0, |at| at + 1);
    let place: Vec<_> = parts[from..].iter().filter(|part| *part != "src" && *part != "mod.rs").cloned().collect();
    format!("{name} ({})", place.join("/").trim_end_matches(".rs"))
}

fn variant(variant: &syn::Variant, of: &[(String, Option<String>)]) -> String {
    let own = serde(&variant.attrs);
    value(&own, "rename").map_or_else(|| in_case(&variant.ident.to_string(), value(of, "rename_all")), str::to_owned)
}

fn arguments(path: &syn::Path) -> Vec<&Type> {
    match path.segments.last().map(|segment| &segment.arguments) {
        Some(PathArguments::AngleBracketed(list)) => {
            let types = list.args.iter().filter_map(|argument| match argument {
                GenericArgument::Type(ty) => Some(ty),
                _ => None,
            });
            types.collect()
        }
        _ => Vec::new(),
    }
}

#[test]
fn the_page_on_json_lists_every_type_with_its_fields() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let mut sources = Sources::default();
    let crates = ["base", "drivers", "study", "measures", "viewers", "lab", "live", "aeye"];
    crates.iter().for_each(|name| sources.read(&root.join("rig").join(name).join("src")));
    assert!(sources.typed.len() > 25, "only {:?}", sources.typed.keys());
    let mut page = Page {
        sources: &sources,
        waiting: VecDeque::new(),
        told: BTreeSet::new(),
        text: HEAD.to_owned(),
        undocumented: Vec::new(),
    };
    for (typed, (name, file, about)) in &sources.typed {
        page.section(&format!("## `{typed}`"), name, file, about);
    }
    page.text.push_str("\n# Parts\n");
    while let Some((name, file)) = page.waiting.pop_front() {
        let title = title(&name, &file);
        if page.told.insert(title.clone()) {
            page.section(&format!("## {title}"), &name, &file, "");
        }
    }
    assert!(page.undocumented.is_empty(), "no doc comment or no type on\n{}", page.undocumented.join("\n"));
    let path = root.join("docs/json.md");
    if std::env::var_os("AEYE_BLESS").is_some() {
        fs::write(&path, &page.text).expect("writable");
    }
    let there = fs::read_to_string(&path).unwrap_or_default();
    assert!(there == page.text, "docs/json.md is stale; AEYE_BLESS=1 makes it anew");
}
