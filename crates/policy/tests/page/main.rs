//! What docs/bring-your-own-policy.md shows is what the program prints.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

const PAGE: &str = "docs/bring-your-own-policy.md";
/// Alone in a line it stands for any number of lines.
const LEFT_OUT: &str = "…";

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Commands, and what the page shows right behind them.
#[derive(Debug, Default)]
struct Example {
    commands: Vec<String>,
    shown: Vec<String>,
}

/// Blocks of commands with a block of text right behind. An empty line between them says that a robot took part.
fn examples(page: &str) -> Vec<Example> {
    let mut examples = Vec::new();
    let mut lines = page.lines().peekable();
    while let Some(line) = lines.next() {
        if line != "```sh" {
            continue;
        }
        let block = |line: &&str| *line != "```";
        let commands = lines.by_ref().take_while(block).map(str::to_owned);
        let commands = commands.collect();
        if lines.next_if_eq(&"```text").is_some() {
            let shown = lines.by_ref().take_while(block).map(str::to_owned);
            let shown = shown.collect();
            examples.push(Example { commands, shown });
        }
    }
    examples
}

/// What the commands print, errors last.
fn printed(commands: &[String]) -> Vec<String> {
    let mut text = String::new();
    for command in commands {
        let words = command.split_whitespace().skip(1);
        let output = Command::new(env!("CARGO_BIN_EXE_policy"))
            .args(words)
            .current_dir(repository())
            .output()
            .expect("it starts");
        text += &String::from_utf8_lossy(&output.stdout);
        text += &String::from_utf8_lossy(&output.stderr);
    }
    text.lines().map(str::to_owned).collect()
}

/// Times differ from one computer to the next.
fn without_figures(lines: &[String]) -> Vec<String> {
    let keeps = |letter: &char| !letter.is_ascii_digit();
    let strip = |line: &String| line.chars().filter(keeps).collect();
    lines.iter().map(strip).collect()
}

/// Whether the lines are those that are shown.
fn fits(shown: &[String], printed: &[String]) -> bool {
    match shown.split_first() {
        None => printed.is_empty(),
        Some((first, rest)) if first == LEFT_OUT => {
            (0..=printed.len()).any(|from| fits(rest, &printed[from..]))
        }
        Some((first, rest)) => {
            let next = printed.split_first();
            next.is_some_and(|(line, others)| line == first && fits(rest, others))
        }
    }
}

#[test]
fn the_page_shows_what_is_printed() {
    let page = fs::read_to_string(repository().join(PAGE)).expect("the page");
    let examples = examples(&page);
    assert!(examples.len() >= 12, "{examples:?}");
    for Example { commands, shown } in &examples {
        assert!(
            commands.iter().all(|it| it.starts_with("policy ")),
            "{commands:?}"
        );
        let printed = printed(commands);
        let is_timed = commands.iter().any(|it| it.starts_with("policy bench"));
        let fits = if is_timed {
            fits(&without_figures(shown), &without_figures(&printed))
        } else {
            fits(shown, &printed)
        };
        assert!(fits, "{PAGE}: {commands:?} prints\n{}", printed.join("\n"));
    }
}

#[test]
fn a_line_that_is_not_shown_is_noticed() {
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let printed = lines("a\nb\nc");
    assert!(fits(&lines("a\n…\nc"), &printed) && fits(&lines("…"), &printed));
    assert!(!fits(&lines("a\nc"), &printed) && !fits(&lines("a\n…\nb"), &printed));
}
