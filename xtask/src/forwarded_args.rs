//! Options that are passed on to the program behind a command, which parses them.

use std::ffi::OsString;

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
}
