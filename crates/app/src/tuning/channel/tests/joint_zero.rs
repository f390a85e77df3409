//! A joint's zero, set from where its motor is.

use super::*;

/// The motors of joints 0 (forward) and 2 (mirrored) are at 0.75 rad (0x3F400000). Set to 0 rad, the zeros are there.
/// Set to 0.5 rad (0x3F000000), the forward joint's zero is at 0.25 and the mirrored one's at 1.25.
#[test]
fn the_present_angle_of_a_joint_is_set_as_requested() {
    let mut bench = Bench {
        stationary: [
            Ok(0.75),
            Err(NotStationary::Unknown),
            Ok(0.75),
            Err(NotStationary::Moving),
        ],
        ..Bench::default()
    };
    let zero = |bench: &Bench, joint: usize| bench.config.joints[joint].zero_rad;
    for joint in [0, 2] {
        let request = [0x41, joint, 0, 0, 0, 0, 0, 0];
        assert_eq!(bench.write(&request), request);
        assert_eq!(zero(&bench, joint.into()), 0.75);
    }
    for joint in [0, 2] {
        let request = [0x41, joint, 0, 0, 0x00, 0x00, 0x00, 0x3F];
        assert_eq!(bench.write(&request), request);
        // The request is repeated, as after a lost reply.
        assert_eq!(bench.write(&request), request);
    }
    assert_eq!((zero(&bench, 0), zero(&bench, 2)), (0.25, 1.25));
    assert_eq!(bench.channel.status().revision, 4);
}

/// 13 rad (0x41500000) is beyond any joint, and NaN is 0x7FC00000. A motor at 12.5 rad set to −1 rad (0xBF800000)
/// would have its zero at 13.5.
#[test]
fn an_invalid_zero_is_refused() {
    let mut bench = Bench {
        stationary: [
            Ok(12.5),
            Err(NotStationary::Unknown),
            Ok(0.0),
            Err(NotStationary::Moving),
        ],
        ..Bench::default()
    };
    for (request, reason) in [
        ([0x41, 1, 0, 0, 0, 0, 0, 0], 9),
        ([0x41, 3, 0, 0, 0, 0, 0, 0], 10),
        ([0x41, 4, 0, 0, 0, 0, 0, 0], 3),
        ([0x41, 2, 0, 0, 0x00, 0x00, 0x50, 0x41], 4),
        ([0x41, 2, 0, 0, 0x00, 0x00, 0xC0, 0x7F], 6),
        ([0x41, 0, 0, 0, 0x00, 0x00, 0x80, 0xBF], 4),
        ([0x41, 2, 1, 0, 0, 0, 0, 0], 4),
    ] {
        assert_eq!(bench.write(&request), [0xEE, 0x41, reason, 0, 0, 0, 0, 0]);
        assert!(bench.unchanged());
    }
    let request = [0x41, 2, 0, 0, 0, 0, 0, 0];
    let armed = [0xEE, 0x41, 5, 0, 0, 0, 0, 0];
    assert_eq!(bench.reply(TuningGate::Shut, 0x7A0, &request), armed);
    assert!(bench.unchanged());
}
