//! Options that are passed on to the program behind a command, which parses them.

use std::{borrow::Cow, ffi::OsString};

use clap::Parser;

/// Everything after the command's name, including `--help`.
#[derive(Parser)]
#[command(disable_help_flag = true)]
pub struct ForwardedArgs {
    /// A scenario file or options. The command's own `--help` lists them.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    pub words: Vec<OsString>,
}

impl ForwardedArgs {
    /// True if one of `options` is among them, alone or as `--option=value`.
    pub fn has(&self, options: &[&str]) -> bool {
        self.words.iter().any(|word| {
            let word = word.to_string_lossy();
            let name = word.split_once('=').map_or(&*word, |(name, _)| name);
            options.contains(&name)
        })
    }

    /// What follows `option`, in the same word behind `=` or in the next one.
    pub fn value_of(&self, option: &str) -> Option<String> {
        let mut words = self.words.iter().map(|word| word.to_string_lossy());
        while let Some(word) = words.next() {
            match word.split_once('=') {
                Some((name, value)) if name == option => return Some(value.to_owned()),
                None if word == option => return words.next().map(Cow::into_owned),
                _ => {}
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(words: &[&str]) -> ForwardedArgs {
        ForwardedArgs::try_parse_from(words).expect("every word is passed on")
    }

    #[test]
    fn all_arguments_are_passed_on() {
        let words = [
            "sim",
            "scenarios/drive.toml",
            "--seconds",
            "3",
            "--realtime",
        ];
        assert_eq!(parsed(&words).words, words[1..]);
    }

    #[test]
    fn an_option_with_a_value_is_found() {
        let has_elf = |words: &[&str]| parsed(words).has(&["--elf", "--help"]);
        assert!(has_elf(&["sim", "--elf", "a.elf"]));
        assert!(has_elf(&["sim", "--elf=a.elf"]));
        assert!(has_elf(&["sim", "--help"]));
        assert!(!has_elf(&["sim", "--elfin"]));
        assert!(!has_elf(&["sim", "--seed", "1"]));
    }

    #[test]
    fn the_value_of_an_option_is_found() {
        let robot = |words: &[&str]| parsed(words).value_of("--robot");
        assert_eq!(robot(&["sim", "--robot", "ours"]).as_deref(), Some("ours"));
        assert_eq!(
            robot(&["sim", "a.toml", "--robot=ours.toml"]).as_deref(),
            Some("ours.toml")
        );
        assert_eq!(robot(&["sim", "--robot"]), None);
        assert_eq!(robot(&["sim", "--robots", "ours"]), None);
    }
}
