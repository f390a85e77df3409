//! What tools read from an image to know the robot that it is for.

use super::RobotProfile;

/// Length of the name's field. A longer name is cut.
const NAME_BYTES: usize = 24;

/// Fingerprint and name of a robot, in bytes that need no debug information to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct RobotIdentity {
    /// Little endian; see `Robot::fingerprint` of robot-description.
    fingerprint: [u8; 8],
    /// UTF-8, padded with zeros.
    name: [u8; NAME_BYTES],
}

impl RobotIdentity {
    /// That of a robot.
    pub const fn of(robot: &RobotProfile) -> Self {
        let mut name = [0; NAME_BYTES];
        let (mut from, mut to) = (robot.name.as_bytes(), name.as_mut_slice());
        while let ([byte, more @ ..], [place, places @ ..]) = (from, to) {
            *place = *byte;
            (from, to) = (more, places);
        }
        Self {
            fingerprint: robot.fingerprint.to_le_bytes(),
            name,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::robots;

    #[test]
    fn the_name_ends_in_zeros() {
        let identity = RobotIdentity::of(&robots::FIVEBAR);
        assert_eq!(&identity.name[..9], b"fivebar\0\0");
        assert_eq!(
            u64::from_le_bytes(identity.fingerprint),
            robots::FIVEBAR.fingerprint
        );
    }
}
