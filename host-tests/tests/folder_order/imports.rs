//! The paths in a module's tokens that lead to other modules of the crate.

use std::slice::Iter;

use proc_macro2::{Delimiter, TokenTree};

use crate::module_tree::Module;

/// One path, from the crate's root.
#[derive(Clone, Debug)]
pub struct Import {
    pub path: Vec<String>,
    /// Its last part under the name that a `use` gives it.
    pub name: Option<String>,
}

/// The paths in `tokens`, which are those of `module` outside the modules in it. A path begins with `crate`, `super` or
/// `self`; in a `use` also with a module inside.
pub fn of(tokens: &[TokenTree], module: &Module) -> Vec<Import> {
    let mut found = Vec::new();
    collect(tokens, module, &mut found);
    found
}

fn collect(tokens: &[TokenTree], module: &Module, found: &mut Vec<Import>) {
    let mut tokens = tokens.iter();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Ident(word) if word == "use" => {
                let tree: Vec<_> = tokens
                    .by_ref()
                    .take_while(|token| !is_sign(token, ';'))
                    .cloned()
                    .collect();
                for mut import in use_tree(&tree) {
                    let relative = std::mem::take(&mut import.path);
                    if let Some(path) = from_root(&relative, module, true) {
                        found.push(Import { path, ..import });
                    }
                }
            }
            TokenTree::Ident(word) => {
                let mut path = vec![word.to_string()];
                follow(&mut path, &mut tokens);
                if let Some(path) = from_root(&path, module, false) {
                    found.push(Import { path, name: None });
                }
            }
            TokenTree::Group(group) => {
                let inner: Vec<_> = group.stream().into_iter().collect();
                collect(&inner, module, found);
            }
            _ => {}
        }
    }
}

/// Adds each `::name` that comes next.
fn follow(path: &mut Vec<String>, tokens: &mut Iter<'_, TokenTree>) {
    while let [first, second, TokenTree::Ident(name), ..] = tokens.as_slice() {
        if !is_sign(first, ':') || !is_sign(second, ':') {
            return;
        }
        path.push(name.to_string());
        tokens.nth(2);
    }
}

/// All paths of what stands between `use` and `;`, as written.
fn use_tree(tokens: &[TokenTree]) -> Vec<Import> {
    let mut path = Vec::new();
    let mut renamed = None;
    let mut tokens = tokens.iter();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Ident(word) if word == "as" => {
                renamed = tokens.next().map(ToString::to_string);
            }
            TokenTree::Ident(word) if word == "self" && !path.is_empty() => {}
            TokenTree::Ident(word) => path.push(word.to_string()),
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
                return in_braces(&path, group.stream().into_iter().collect());
            }
            _ => {}
        }
    }
    let name = renamed.or_else(|| path.last().cloned());
    vec![Import { path, name }]
}

fn in_braces(prefix: &[String], tokens: Vec<TokenTree>) -> Vec<Import> {
    let branches = tokens.split(|token| is_sign(token, ','));
    let branches = branches.filter(|branch| !branch.is_empty());
    let inner = branches.flat_map(|branch| {
        let [first, rest @ ..] = branch else {
            return Vec::new();
        };
        if rest.is_empty() && first.to_string() == "self" {
            return vec![Import {
                path: Vec::new(),
                name: prefix.last().cloned(),
            }];
        }
        use_tree(branch)
    });
    inner
        .map(|import| Import {
            path: [prefix, &import.path].concat(),
            ..import
        })
        .collect()
}

/// `None` for a path that leads out of the crate, or to a name that the module has from a `use`.
fn from_root(path: &[String], module: &Module, in_use: bool) -> Option<Vec<String>> {
    let (first, rest) = path.split_first()?;
    let own = module.path();
    match first.as_str() {
        "crate" => Some(rest.to_vec()),
        "self" if !rest.is_empty() => Some([own, rest].concat()),
        "super" => {
            let ups = path.iter().take_while(|part| *part == "super").count();
            let base = own.get(..own.len().checked_sub(ups)?)?;
            Some([base, path.get(ups..)?].concat())
        }
        name if in_use && module.child(name).is_some() => Some([own, path].concat()),
        _ => None,
    }
}

fn is_sign(token: &TokenTree, sign: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == sign)
}
