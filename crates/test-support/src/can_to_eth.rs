//! CAN frames beside the 13 bytes that a CAN-TO-ETH gateway makes of them.

/// Printed by `data/can_to_eth.c`.
const EXAMPLES: &str = include_str!("../data/can_to_eth.txt");

/// A CAN frame in 13 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CanToEth {
    /// 29 bits of identifier instead of 11.
    pub extended: bool,
    /// A remote frame, without data.
    pub remote: bool,
    /// The identifier.
    pub id: u32,
    /// Number of data bytes, of which a remote frame carries none.
    pub dlc: u8,
    /// The data, padded with zeros.
    pub data: [u8; 8],
    /// The frame as the gateway sends and takes it.
    pub bytes: [u8; 13],
}

impl CanToEth {
    /// Frames of every kind and length, written by C code of the gateway's document.
    pub fn examples() -> Vec<Self> {
        EXAMPLES.lines().map(example).collect()
    }
}

fn example(line: &str) -> CanToEth {
    let words: Vec<_> = line.split(' ').collect();
    let [kind, content, id, dlc, data, bytes] = words[..] else {
        panic!("{line}");
    };
    CanToEth {
        extended: kind == "extended",
        remote: content == "remote",
        id: u32::from_str_radix(id, 16).expect("an identifier"),
        dlc: dlc.parse().expect("a length"),
        data: digits(data.trim_matches('-')),
        bytes: digits(bytes),
    }
}

fn digits<const N: usize>(text: &str) -> [u8; N] {
    let mut bytes = [0; N];
    for (n, byte) in bytes.iter_mut().enumerate().take(text.len() / 2) {
        *byte = u8::from_str_radix(&text[2 * n..2 * n + 2], 16).expect("hexadecimal digits");
    }
    bytes
}

#[cfg(test)]
mod tests {
    use std::{path::Path, process::Command};

    use super::*;

    #[test]
    fn the_examples_are_what_the_c_code_prints() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let program = std::env::temp_dir().join(format!("can_to_eth-{}", std::process::id()));
        let mut compile = Command::new("cc");
        compile.arg(folder.join("data/can_to_eth.c"));
        match compile.arg("-o").arg(&program).output() {
            Err(_) => println!("skipped: no C compiler here"),
            Ok(compiled) => {
                assert!(compiled.status.success(), "{compiled:?}");
                let printed = Command::new(&program).output().expect("it starts").stdout;
                std::fs::remove_file(&program).expect("it is there");
                assert_eq!(String::from_utf8_lossy(&printed), EXAMPLES);
            }
        }
    }

    #[test]
    fn a_line_is_read_as_it_is_meant() {
        let read = example("extended data 18FF50E5 2 1122 8218FF50E51122000000000000");
        let expected = CanToEth {
            extended: true,
            remote: false,
            id: 0x18FF_50E5,
            dlc: 2,
            data: [0x11, 0x22, 0, 0, 0, 0, 0, 0],
            bytes: [0x82, 0x18, 0xFF, 0x50, 0xE5, 0x11, 0x22, 0, 0, 0, 0, 0, 0],
        };
        assert_eq!(read, expected);
    }
}
