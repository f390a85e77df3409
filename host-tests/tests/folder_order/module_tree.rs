//! The modules of a crate without those for tests, and which of them each one names.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use proc_macro2::{TokenStream, TokenTree};

use crate::imports::{self, Import};

type ReadFile = dyn Fn(&Path) -> Option<String>;

/// The text of a file by its path under the crate's `src`.
pub struct Sources(Box<ReadFile>);

impl Sources {
    pub fn new(read: impl Fn(&Path) -> Option<String> + 'static) -> Self {
        Self(Box::new(read))
    }

    fn tokens(&self, file: &Path) -> Vec<TokenTree> {
        let text = (self.0)(file).unwrap_or_else(|| panic!("no {}", file.display()));
        let stream: TokenStream = text.parse().expect("Rust");
        stream.into_iter().collect()
    }
}

/// A module with the modules inside it.
#[derive(Debug, Default)]
pub struct Module {
    /// Path from the crate's root, whose own path is empty.
    path: Vec<String>,
    children: BTreeMap<String, Module>,
    /// Paths that the module names, from the crate's root.
    pub imports: Vec<Import>,
}

impl Module {
    /// The crate whose root is this file, `lib.rs` or `main.rs`.
    pub fn load(sources: &Sources, root: &str) -> Self {
        let tokens = sources.tokens(Path::new(root));
        Self::of(sources, Vec::new(), Path::new(""), tokens)
    }

    fn of(sources: &Sources, path: Vec<String>, folder: &Path, tokens: Vec<TokenTree>) -> Self {
        let mut module = Self {
            path,
            ..Self::default()
        };
        let mut rest = Vec::new();
        let mut tokens = without_tests(tokens).into_iter().peekable();
        while let Some(token) = tokens.next() {
            let name = match (&token, tokens.peek()) {
                (TokenTree::Ident(word), Some(TokenTree::Ident(name))) if word == "mod" => {
                    name.to_string()
                }
                _ => {
                    rest.push(token);
                    continue;
                }
            };
            let path = [module.path.clone(), vec![name.clone()]].concat();
            let inner_folder = folder.join(&name);
            let content = match tokens.nth(1) {
                Some(TokenTree::Group(body)) => body.stream().into_iter().collect(),
                _ => sources.tokens(&file_of(&inner_folder)),
            };
            let child = Self::of(sources, path, &inner_folder, content);
            module.children.insert(name, child);
        }
        module.imports = imports::of(&rest, &module);
        module
    }

    /// Last part of its path; empty for the crate's root.
    pub fn name(&self) -> &str {
        self.path.last().map_or("", String::as_str)
    }

    pub fn path(&self) -> &[String] {
        &self.path
    }

    /// The modules directly inside this one, in the order of their names.
    pub fn children(&self) -> impl Iterator<Item = &Self> {
        self.children.values()
    }

    pub fn child(&self, name: &str) -> Option<&Self> {
        self.children.get(name)
    }

    /// This module and all inside it.
    pub fn all(&self) -> Vec<&Self> {
        let inner = self.children().flat_map(Self::all);
        [self].into_iter().chain(inner).collect()
    }
}

fn file_of(module_folder: &Path) -> PathBuf {
    module_folder.with_extension("rs")
}

/// Items under `#[cfg(test)]` are left out.
fn without_tests(tokens: Vec<TokenTree>) -> Vec<TokenTree> {
    let mut kept = Vec::new();
    let mut tokens = tokens.into_iter();
    while let Some(token) = tokens.next() {
        if is_test_only(&token) {
            kept.pop();
            tokens.find(ends_item);
        } else {
            kept.push(token);
        }
    }
    kept
}

/// What follows the `#` of the attribute.
fn is_test_only(token: &TokenTree) -> bool {
    let text = token.to_string();
    text.split_whitespace().collect::<String>() == "[cfg(test)]"
}

fn ends_item(token: &TokenTree) -> bool {
    match token {
        TokenTree::Punct(sign) => sign.as_char() == ';',
        TokenTree::Group(group) => group.delimiter() == proc_macro2::Delimiter::Brace,
        _ => false,
    }
}
