//! A number that tells two robots apart.

use crate::Robot;

/// FNV-1a, 64 bits.
const BASIS: u64 = 0xCBF2_9CE4_8422_2325;
const PRIME: u64 = 0x0000_0100_0000_01B3;

impl Robot {
    /// Returns a number that differs, but for chance, if the name or any figure differs. Comments and the order of the
    /// file's keys do not count.
    pub fn fingerprint(&self) -> u64 {
        of(format!("{self:?}").as_bytes())
    }
}

fn of(bytes: &[u8]) -> u64 {
    let mix = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(PRIME);
    bytes.iter().fold(BASIS, mix)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIVEBAR: &str = include_str!("../../../robots/fivebar.toml");

    fn parse(text: &str) -> Robot {
        Robot::parse(text, "robot.toml").expect("it parses")
    }

    /// Values of the authors' own list of test vectors.
    #[test]
    fn the_sum_has_the_published_values() {
        assert_eq!(of(b""), 0xCBF2_9CE4_8422_2325);
        assert_eq!(of(b"a"), 0xAF63_DC4C_8601_EC8C);
        assert_eq!(of(b"foobar"), 0x8594_4171_F739_67E8);
    }

    #[test]
    fn only_what_the_file_says_counts() {
        let robot = parse(FIVEBAR);
        let commented = parse(&format!("# A comment.\n{FIVEBAR}"));
        assert_eq!(commented.fingerprint(), robot.fingerprint());
        let mut heavier = robot.clone();
        heavier.wheels.motor_mass_kg += 1e-9;
        assert_ne!(heavier.fingerprint(), robot.fingerprint());
        let mut renamed = robot.clone();
        renamed.name = "ours".to_owned();
        assert_ne!(renamed.fingerprint(), robot.fingerprint());
    }
}
