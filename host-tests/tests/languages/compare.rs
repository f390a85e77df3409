//! What the two pages of a pair do not have in common.
//!
//! Both have the same sections, and each section has the same blocks in the same order. The words of a
//! block are free; its code, settings, figures and links are not.

use crate::{
    blocks::{Block, Kind},
    figures::figures,
    site::{Page, Pair, Site},
    spans::spans,
};

/// All differences, each with file, line, heading, and what differs.
pub fn differences(site: &Site, pair: &Pair) -> Vec<String> {
    let [english, chinese] = [&pair.english, &pair.chinese].map(without_switch);
    let [english, chinese] = [&english, &chinese].map(|blocks| sections(blocks));
    let mut found = no_switch(site, pair);
    for (english, chinese) in english.iter().zip(&chinese) {
        found.extend(section_differences(site, pair, english, chinese));
    }
    if english.len() != chinese.len() {
        let (path, here, there) = (&pair.chinese.path, chinese.len(), english.len());
        found.push(format!("{path}: {here} sections, in English {there}"));
    }
    found
}

fn section_differences(
    site: &Site,
    pair: &Pair,
    english: &[Block],
    chinese: &[Block],
) -> Vec<String> {
    let title = &chinese[0].text;
    let place = |block: &Block| format!("{}:{} “{title}”", pair.chinese.path, block.line);
    let (here, there) = (outline(chinese), outline(english));
    if here != there {
        let place = place(&chinese[0]);
        return vec![format!(
            "{place}: {here}; in English, “{}”: {there}",
            english[0].text
        )];
    }
    let blocks = english.iter().zip(chinese);
    let named = blocks.flat_map(|(english, chinese)| {
        let place = format!("{} (English: line {})", place(chinese), english.line);
        let differences = block_differences(site, pair, english, chinese);
        differences
            .into_iter()
            .map(move |what| format!("{place}: {what}"))
    });
    named.collect()
}

fn block_differences(site: &Site, pair: &Pair, english: &Block, chinese: &Block) -> Vec<String> {
    let here = said(site, &pair.chinese, chinese);
    let there = said(site, &pair.english, english);
    let missing = only_in(&there, &here).into_iter();
    let extra = only_in(&here, &there).into_iter();
    let missing = missing.map(|thing| format!("{thing} is only in English"));
    let extra = extra.map(|thing| format!("{thing} is only in Chinese"));
    missing
        .chain(extra)
        .chain(cells(english, chinese))
        .collect()
}

/// Each page must lead to the other before its first section.
fn no_switch(site: &Site, pair: &Pair) -> Vec<String> {
    let pages = [
        (&pair.english, &pair.chinese),
        (&pair.chinese, &pair.english),
    ];
    let switch = format!("{}, in the other language", pair.english.path);
    let leads = |page: &Page| {
        let top = page.blocks.iter().take(3).filter(|block| is_switch(block));
        let mut targets = top.flat_map(|block| spans(&block.text).targets);
        targets.any(|target| site.place(page, &target) == switch)
    };
    pages
        .into_iter()
        .filter(|(page, _)| !leads(page))
        .map(|(page, other)| format!("{}: no link to {} at its top", page.path, other.path))
        .collect()
}

/// The line that leads to the other language.
fn is_switch(block: &Block) -> bool {
    block.kind == Kind::Paragraph
        && block.text.contains("English")
        && block.text.contains("简体中文")
}

fn without_switch(page: &Page) -> Vec<Block> {
    let kept = page.blocks.iter().filter(|block| !is_switch(block));
    kept.cloned().collect()
}

/// Each heading with what follows it.
fn sections(blocks: &[Block]) -> Vec<&[Block]> {
    let same_section = |_: &Block, next: &Block| !matches!(next.kind, Kind::Heading(_));
    blocks.chunk_by(same_section).collect()
}

/// The blocks of a section in order, the same kind in a row counted: `Heading(2), 3 Row`.
fn outline(section: &[Block]) -> String {
    let kinds = section.chunk_by(|one, next| one.kind == next.kind);
    let counted = kinds.map(|same| match (same.len(), same[0].kind) {
        (1, kind) => format!("{kind:?}"),
        (count, kind) => format!("{count} {kind:?}"),
    });
    counted.collect::<Vec<_>>().join(", ")
}

/// What a block says in any language, in a fixed order.
fn said(site: &Site, page: &Page, block: &Block) -> Vec<String> {
    if block.kind == Kind::Code {
        return block.text.lines().flat_map(said_by_code).collect();
    }
    let spans = spans(&block.text);
    let figures = figures(&spans.words).into_iter();
    let code = spans.code.iter().map(|code| format!("`{code}`"));
    let places = spans.targets.iter().map(|target| site.place(page, target));
    let links = places.map(|place| format!("the link to {place}"));
    let mut said: Vec<String> = figures.chain(code).chain(links).collect();
    said.sort();
    said
}

/// A line of code as it is, and the figures of its comment, which is free otherwise.
fn said_by_code(line: &str) -> Vec<String> {
    let comment = line.find(" # ").or(line.starts_with("# ").then_some(0));
    let (code, comment) = line.split_at(comment.unwrap_or(line.len()));
    let code = format!("`{}`", code.trim_end());
    [code].into_iter().chain(figures(comment)).collect()
}

/// What `one` has more often than `other`; lines of code keep their order in the report.
fn only_in<'a>(one: &'a [String], other: &[String]) -> Vec<&'a String> {
    let mut other: Vec<&String> = other.iter().collect();
    let mut rest = Vec::new();
    for thing in one {
        match other.iter().position(|there| *there == thing) {
            Some(position) => drop(other.swap_remove(position)),
            None => rest.push(thing),
        }
    }
    rest
}

/// Cells of a row without a Chinese letter that differ from the English cell, such as a unit.
fn cells(english: &Block, chinese: &Block) -> Vec<String> {
    if english.kind != Kind::Row {
        return Vec::new();
    }
    let [english, chinese] = [english, chinese].map(|block| spans(&block.text).words);
    let [english, chinese]: [Vec<&str>; 2] = [&english, &chinese]
        .map(|words| words.trim_matches('|').split('|').map(str::trim).collect());
    if english.len() != chinese.len() {
        return vec![format!(
            "{} cells, in English {}",
            chinese.len(),
            english.len()
        )];
    }
    let cells = english.iter().zip(chinese);
    cells
        .filter(|(english, chinese)| !is_chinese(chinese) && *english != chinese)
        .map(|(english, chinese)| format!("the cell “{chinese}” is “{english}” in English"))
        .collect()
}

/// Chinese letters and punctuation begin there.
fn is_chinese(text: &str) -> bool {
    text.contains(|letter| letter >= '\u{2e80}')
}

#[cfg(test)]
mod tests {
    use super::differences;
    use crate::site::{Page, Pair, Site};

    const ENGLISH: &str = "# Title\n\nEnglish · [简体中文](zh-CN/page.md)\n\n\
        At most 1,200 mA for 0.5 s ([more](#rest), [other](other.md)): set `heater.kp`.\n\n\
        ## Rest\n\n| name | unit |\n|---|---|\n| `kp` | 1/K |\n\n```sh\nrobotctl status  # why, in 2 s\n```\n";
    const CHINESE: &str = "# 标题\n\n[English](../page.md) · 简体中文\n\n\
        设 `heater.kp`：0.5 s 内最多 1200 mA（见[其余](#其余)、[别处](../other.md)）。\n\n\
        ## 其余\n\n| 名字 | 单位 |\n|---|---|\n| `kp` | 1/K |\n\n```sh\nrobotctl status  # 2 s 内说出原因\n```\n";

    fn found(english: &str, chinese: &str) -> Vec<String> {
        let pair = Pair {
            english: Page::new("docs/page.md", english),
            chinese: Page::new("docs/zh-CN/page.md", chinese),
        };
        let site = Site([("docs/page.md".to_owned(), pair)].into());
        differences(&site, &site.0["docs/page.md"])
    }

    #[test]
    fn words_and_their_order_are_free() {
        assert_eq!(found(ENGLISH, CHINESE), Vec::<String>::new());
    }

    /// What is changed in the Chinese page, and what the report says of it.
    const CHANGES: [(&str, &str, &str); 11] = [
        ("0.5 s", "0.6 s", "0.5 s is only in English"),
        ("1200 mA", "1200 A", "1200 A is only in Chinese"),
        ("heater.kp", "heater.ki", "`heater.kp` is only in English"),
        (
            "robotctl status",
            "robotctl state",
            "`robotctl status` is only in English",
        ),
        ("# 2 s", "# 3 s", "3 s is only in Chinese"),
        (
            "(#其余)",
            "(#标题)",
            "the link to docs/page.md, heading 1 is only in English",
        ),
        (
            "(#其余)",
            "(#他处)",
            "docs/zh-CN/page.md#他处, which is no heading there is only in Chinese",
        ),
        (
            "../other.md",
            "other.md",
            "the link to docs/zh-CN/other.md is only in Chinese",
        ),
        ("| 1/K |", "| K |", "the cell “K” is “1/K” in English"),
        ("| 1/K |", "| 1/K | |", "3 cells, in English 2"),
        (
            "(../page.md)",
            "(../other.md)",
            "docs/zh-CN/page.md: no link to docs/page.md at its top",
        ),
    ];

    #[test]
    fn each_change_is_reported() {
        for (from, to, report) in CHANGES {
            let changed = CHINESE.replacen(from, to, 1);
            assert_ne!(changed, CHINESE, "{from}");
            let found = found(ENGLISH, &changed);
            let reported = found.iter().any(|line| line.contains(report));
            assert!(reported, "{to}: {found:?}");
        }
    }

    #[test]
    fn the_report_names_file_line_and_heading() {
        let found = found(
            ENGLISH,
            &CHINESE.replace("| `kp` | 1/K |", "| `ki` | 1/K |"),
        );
        let place = "docs/zh-CN/page.md:11 “其余” (English: line 11)";
        let expected = ["`kp` is only in English", "`ki` is only in Chinese"];
        assert_eq!(found, expected.map(|what| format!("{place}: {what}")));
    }

    #[test]
    fn sections_and_blocks_are_counted() {
        let fewer = found(ENGLISH, &CHINESE.replace("| `kp` | 1/K |\n", ""));
        let expected = "docs/zh-CN/page.md:7 “其余”: Heading(2), Row, Code; \
                        in English, “Rest”: Heading(2), 2 Row, Code";
        assert_eq!(fewer, [expected]);
        let more = found(ENGLISH, &format!("{CHINESE}\n## 再者\n"));
        assert_eq!(more, ["docs/zh-CN/page.md: 3 sections, in English 2"]);
        let deeper = found(ENGLISH, &CHINESE.replace("## 其余", "### 其余"));
        assert!(deeper[0].contains("Heading(3)"), "{deeper:?}");
    }
}
