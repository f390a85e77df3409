//! A Markdown page as a list of blocks: headings, table rows, list items, code and paragraphs.

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A heading with its level, which is 1 for the title.
    Heading(usize),
    Row,
    Item,
    Code,
    Paragraph,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    pub kind: Kind,
    /// The text without the mark of its kind, on one line unless it is code.
    pub text: String,
    /// Counted from 1.
    pub line: usize,
}

/// A region that begins with the first and ends with the second is written by a program: no block.
const GENERATED: (&str, &str) = ("<!-- matrix", "<!-- matrix ends");

pub fn blocks(page: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut lines = (1..).zip(page.lines());
    // Whether the next line may go on with the last block.
    let mut open = false;
    while let Some((line, text)) = lines.next() {
        let text = text.trim();
        if text.starts_with(GENERATED.0) {
            lines.find(|(_, text)| text.starts_with(GENERATED.1));
            open = false;
            continue;
        }
        let code = text.starts_with("```");
        let (kind, text) = if code {
            let inside: Vec<&str> = lines
                .by_ref()
                .map(|(_, line)| line)
                .take_while(|line| !line.trim().starts_with("```"))
                .collect();
            (Kind::Code, inside.join("\n"))
        } else if text.is_empty() || text.starts_with("|--") || text.starts_with("<!--") {
            open = false;
            continue;
        } else {
            let (kind, text) = kind(text);
            (kind, text.to_owned())
        };
        if let (Kind::Paragraph, true, Some(last)) = (kind, open, blocks.last_mut()) {
            last.text = format!("{} {text}", last.text);
            continue;
        }
        open = matches!(kind, Kind::Paragraph | Kind::Item);
        blocks.push(Block { kind, text, line });
    }
    blocks
}

fn kind(line: &str) -> (Kind, &str) {
    let hashes = line.bytes().take_while(|byte| *byte == b'#').count();
    if let (1.., Some(title)) = (hashes, line[hashes..].strip_prefix(' ')) {
        return (Kind::Heading(hashes), title);
    }
    if line.starts_with('|') {
        return (Kind::Row, line);
    }
    let number = line.trim_start_matches(|digit: char| digit.is_ascii_digit());
    let numbered = number.len() < line.len() && number.starts_with(". ");
    match line.strip_prefix("- ") {
        Some(item) => (Kind::Item, item),
        // The number stays: it is a figure like any other.
        None if numbered => (Kind::Item, line),
        None => (Kind::Paragraph, line),
    }
}

#[test]
fn a_page_is_cut_into_blocks() {
    let page = "# Title\n\nOne\nparagraph:\n- an item\n  of two lines\n- another\n\n1. first\n\n\
                | a | b |\n|---|---|\n| 1 | 2 |\n\n```sh\nrun  it\n\nnow\n```\nEnd.\n\
                <!-- matrix: by a program -->\n| x |\n<!-- matrix ends -->\n## Sub #2\n";
    let found: Vec<(Kind, String, usize)> = blocks(page)
        .into_iter()
        .map(|block| (block.kind, block.text, block.line))
        .collect();
    let expected = [
        (Kind::Heading(1), "Title", 1),
        (Kind::Paragraph, "One paragraph:", 3),
        (Kind::Item, "an item of two lines", 5),
        (Kind::Item, "another", 7),
        (Kind::Item, "1. first", 9),
        (Kind::Row, "| a | b |", 11),
        (Kind::Row, "| 1 | 2 |", 13),
        (Kind::Code, "run  it\n\nnow", 15),
        (Kind::Paragraph, "End.", 20),
        (Kind::Heading(2), "Sub #2", 24),
    ];
    let expected = expected.map(|(kind, text, line)| (kind, text.to_owned(), line));
    assert_eq!(found, expected);
}
