//! The paths that one item of a file names: in `use` lines, in code, and among the tokens of macros.

use std::collections::BTreeSet;

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, Meta, UseTree};

use super::attributes::for_tests_only;

/// A path as it stands in a file, from its first segment.
#[derive(Clone, Debug)]
pub struct Mention {
    pub path: Vec<String>,
    pub line: usize,
    pub how: How,
}

/// Where a path stands.
#[derive(Clone, Debug, PartialEq)]
pub enum How {
    /// In a `use` line, which binds `name`, or all names with `None`.
    Use { name: Option<String>, public: bool },
    /// In code.
    Code,
}

/// Reads the mentions of an item, of all that stands in it too.
pub fn of(item: &Item) -> Vec<Mention> {
    let mut reader = Reader::default();
    reader.visit_item(item);
    reader.mentions
}

#[derive(Default)]
struct Reader {
    mentions: Vec<Mention>,
    /// Names that patterns of the function being read bind.
    locals: BTreeSet<String>,
}

impl Reader {
    fn mention(&mut self, path: Vec<String>, line: usize, how: How) {
        self.mentions.push(Mention { path, line, how });
    }

    /// A path in code. One word in small letters may be a variable: it counts when it is called, or
    /// when no pattern of its function binds it.
    fn code(&mut self, path: Vec<String>, line: usize, called: bool) {
        let variable = path.len() == 1 && !called && self.locals.contains(&path[0]);
        if !variable {
            self.mention(path, line, How::Code);
        }
    }

    fn use_tree(&mut self, before: &[String], tree: &UseTree, public: bool) {
        let with = |name: String| [before, &[name]].concat();
        let line = tree.span().start().line;
        let mut bind = |path, name| self.mention(path, line, How::Use { name, public });
        match tree {
            UseTree::Path(tree) => self.use_tree(&with(tree.ident.to_string()), &tree.tree, public),
            UseTree::Group(group) => group.items.iter().for_each(|item| self.use_tree(before, item, public)),
            UseTree::Glob(_) => bind(before.to_vec(), None),
            UseTree::Name(name) if name.ident == "self" => bind(before.to_vec(), before.last().cloned()),
            UseTree::Name(name) => bind(with(name.ident.to_string()), Some(name.ident.to_string())),
            UseTree::Rename(name) if name.ident == "self" => bind(before.to_vec(), Some(name.rename.to_string())),
            UseTree::Rename(name) => bind(with(name.ident.to_string()), Some(name.rename.to_string())),
        }
    }

    /// Reads a function with the variables that it binds.
    fn function(&mut self, locals: BTreeSet<String>, read: impl FnOnce(&mut Self)) {
        let outer = std::mem::replace(&mut self.locals, locals);
        read(self);
        self.locals = outer;
    }

    fn tokens(&mut self, tokens: TokenStream) {
        let trees: Vec<TokenTree> = tokens.into_iter().collect();
        let mut at = 0;
        while at < trees.len() {
            let here = at;
            at += 1;
            match &trees[here] {
                TokenTree::Group(group) => self.tokens(group.stream()),
                TokenTree::Ident(_) if begins_path(&trees, here) => at = self.path_of_tokens(&trees, here),
                _ => {}
            }
        }
    }

    /// Reads the path that begins at a token, and gives where it ends.
    fn path_of_tokens(&mut self, trees: &[TokenTree], start: usize) -> usize {
        let mut path = vec![trees[start].to_string()];
        let mut end = start + 1;
        while is_punct(trees.get(end), ':') && is_punct(trees.get(end + 1), ':') {
            let Some(TokenTree::Ident(next)) = trees.get(end + 2) else { break };
            path.push(next.to_string());
            end += 3;
        }
        let arguments = |t: &TokenTree| matches!(t, TokenTree::Group(g) if g.delimiter() == Delimiter::Parenthesis);
        let called = is_punct(trees.get(end), '!') || trees.get(end).is_some_and(arguments);
        if path.len() > 1 || called || path[0].starts_with(char::is_uppercase) {
            self.code(path, trees[start].span().start().line, called);
        }
        end
    }
}

/// Whether the word at a place of a token list is not a field, a method, a lifetime or the rest of a path.
fn begins_path(trees: &[TokenTree], at: usize) -> bool {
    let before = |back: usize, c| at >= back && is_punct(trees.get(at - back), c);
    let of_value = before(1, '.') && !before(2, '.');
    let of_path = before(1, ':') && before(2, ':');
    !of_value && !of_path && !before(1, '\'')
}

fn is_punct(tree: Option<&TokenTree>, c: char) -> bool {
    matches!(tree, Some(TokenTree::Punct(p)) if p.as_char() == c)
}

/// Names bound by the patterns of a function.
#[derive(Default)]
struct Locals(BTreeSet<String>);

impl Visit<'_> for Locals {
    fn visit_pat_ident(&mut self, pattern: &syn::PatIdent) {
        self.0.insert(pattern.ident.to_string());
        visit::visit_pat_ident(self, pattern);
    }
}

fn locals(read: impl FnOnce(&mut Locals)) -> BTreeSet<String> {
    let mut locals = Locals::default();
    read(&mut locals);
    locals.0
}

fn segments(path: &syn::Path) -> Vec<String> {
    path.segments.iter().map(|s| s.ident.to_string()).collect()
}

/// Paths among the texts of an attribute, as in `#[serde(with = "hex")]`.
fn paths_in_texts(attribute: &Attribute) -> Vec<Vec<String>> {
    let tokens = match &attribute.meta {
        Meta::List(list) if !list.path.is_ident("doc") => list.tokens.clone(),
        _ => return Vec::new(),
    };
    let texts = tokens.into_iter().filter_map(|tree| syn::parse2::<syn::LitStr>(tree.into()).ok());
    texts.filter_map(|text| text.parse::<syn::Path>().ok()).map(|path| segments(&path)).collect()
}

impl<'a> Visit<'a> for Reader {
    fn visit_item(&mut self, item: &'a Item) {
        if !for_tests_only(item) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'a ImplItem) {
        let ImplItem::Fn(function) = item else { return visit::visit_impl_item(self, item) };
        let bound = locals(|l| l.visit_impl_item_fn(function));
        self.function(bound, |reader| visit::visit_impl_item(reader, item));
    }

    fn visit_item_fn(&mut self, item: &'a syn::ItemFn) {
        self.function(locals(|l| l.visit_item_fn(item)), |reader| visit::visit_item_fn(reader, item));
    }

    fn visit_trait_item_fn(&mut self, item: &'a syn::TraitItemFn) {
        self.function(locals(|l| l.visit_trait_item_fn(item)), |reader| visit::visit_trait_item_fn(reader, item));
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        let public = !matches!(item.vis, syn::Visibility::Inherited);
        if item.leading_colon.is_none() {
            self.use_tree(&[], &item.tree, public);
        }
    }

    fn visit_expr_call(&mut self, call: &'a syn::ExprCall) {
        if let syn::Expr::Path(function) = &*call.func
            && function.path.leading_colon.is_none()
        {
            self.code(segments(&function.path), function.path.span().start().line, true);
        }
        visit::visit_expr_call(self, call);
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        if path.leading_colon.is_none() {
            self.code(segments(path), path.span().start().line, false);
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'a syn::Macro) {
        self.code(segments(&call.path), call.path.span().start().line, true);
        self.tokens(call.tokens.clone());
    }

    fn visit_attribute(&mut self, attribute: &'a Attribute) {
        let line = attribute.span().start().line;
        for path in paths_in_texts(attribute) {
            self.code(path, line, true);
        }
    }

    /// `pub(in crate::a)` is no import.
    fn visit_vis_restricted(&mut self, _: &'a syn::VisRestricted) {}
}
