//! The pages that exist in both languages, and where a link on them leads.

use crate::blocks::{Block, Kind, blocks};
use robot_host_tests::links::{resolved, slug};
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

const CHINESE_README: &str = "README.zh-CN.md";
const CHINESE_FOLDER: &str = "docs/zh-CN";
/// Suffix of the description of a link that leads from one language to the other.
const OTHER_LANGUAGE: &str = ", in the other language";

pub struct Page {
    /// Path from the repository's root, with `/` as separator.
    pub path: String,
    pub blocks: Vec<Block>,
}

impl Page {
    pub fn new(path: &str, text: &str) -> Self {
        let path = path.to_owned();
        let blocks = blocks(text);
        Self { path, blocks }
    }

    pub fn headings(&self) -> impl Iterator<Item = &Block> {
        let is_heading = |block: &&Block| matches!(block.kind, Kind::Heading(_));
        self.blocks.iter().filter(is_heading)
    }
}

/// A page in both languages.
pub struct Pair {
    pub english: Page,
    pub chinese: Page,
}

/// All pairs, by the path of the English page.
#[derive(Default)]
pub struct Site(pub BTreeMap<String, Pair>);

impl Site {
    /// The Chinese README, all of the Chinese folder, and the English page of each.
    pub fn read() -> Self {
        let root = root();
        let folder = fs::read_dir(root.join(CHINESE_FOLDER)).unwrap();
        let mut names: Vec<String> = folder
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .map(|name| format!("{CHINESE_FOLDER}/{name}"))
            .collect();
        names.push(CHINESE_README.to_owned());
        let page = |path: &str| {
            let text = fs::read_to_string(root.join(path));
            Page::new(
                path,
                &text.unwrap_or_else(|error| panic!("{path}: {error}")),
            )
        };
        let pairs = names.iter().map(|path| {
            let english = english_path(path);
            let pair = Pair {
                english: page(&english),
                chinese: page(path),
            };
            (english, pair)
        });
        Self(pairs.collect())
    }

    /// Where a link on `page` leads, in words that are the same in both languages if the place is.
    pub fn place(&self, page: &Page, target: &str) -> String {
        if target.contains("://") {
            return target.to_owned();
        }
        let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
        let path = match file {
            "" => page.path.clone(),
            file => resolved(&page.path, file).unwrap_or_default(),
        };
        let Some(pair) = self.0.get(&english_path(&path)) else {
            return format!("{path}#{anchor}").trim_end_matches('#').to_owned();
        };
        let from_english = page.path == english_path(&page.path);
        let to_english = path == pair.english.path;
        let there = if to_english {
            &pair.english
        } else {
            &pair.chinese
        };
        let mut headings = there.headings();
        let heading = match anchor {
            "" => String::new(),
            anchor => match headings.position(|block| slug(&block.text) == anchor) {
                Some(number) => format!(", heading {number}"),
                None => return format!("{path}#{anchor}, which is no heading there"),
            },
        };
        let language = if from_english == to_english {
            ""
        } else {
            OTHER_LANGUAGE
        };
        format!("{}{heading}{language}", pair.english.path)
    }
}

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The path of the English page; that of any other file is its own.
fn english_path(path: &str) -> String {
    match path.strip_prefix(CHINESE_FOLDER) {
        Some(name) => format!("docs{name}"),
        None if path == CHINESE_README => "README.md".to_owned(),
        None => path.to_owned(),
    }
}

#[cfg(test)]
pub mod tests {
    use super::{Page, Pair, Site};

    /// Two pairs: `a`, whose second heading is "Two", and `b`.
    pub fn site() -> Site {
        let pair = |name: &str, english: &str, chinese: &str| {
            let path = format!("docs/{name}.md");
            let pair = Pair {
                english: Page::new(&path, english),
                chinese: Page::new(&format!("docs/zh-CN/{name}.md"), chinese),
            };
            (path, pair)
        };
        let a = pair("a", "# One\n## Two words!\n", "# 一\n## 两个，字\n");
        let b = pair("b", "# B\n", "# 乙\n");
        Site([a, b].into())
    }

    #[test]
    fn the_same_place_has_the_same_words() {
        let site = site();
        let Pair { english, chinese } = &site.0["docs/a.md"];
        let same = [
            ("b.md", "b.md"),
            ("#two-words", "#两个字"),
            ("a.md#two-words", "a.md#两个字"),
            ("c.md#three", "../c.md#three"),
            ("../src/main.rs", "../../src/main.rs"),
            ("https://x.org/#a", "https://x.org/#a"),
        ];
        for (target, its_twin) in same {
            assert_eq!(site.place(english, target), site.place(chinese, its_twin));
        }
    }

    #[test]
    fn another_place_has_other_words() {
        let site = site();
        let Pair { english, chinese } = &site.0["docs/a.md"];
        let different = [
            ("b.md", "a.md"),
            ("b.md", "../b.md"),
            ("b.md", "b.md#乙"),
            ("#two-words", "#一"),
            ("#two-words", "#两个，字"),
            ("c.md#three", "../c.md#two"),
            ("c.md", "c.md"),
        ];
        for (target, other) in different {
            let (target, other) = (site.place(english, target), site.place(chinese, other));
            assert_ne!(target, other);
        }
    }
}
