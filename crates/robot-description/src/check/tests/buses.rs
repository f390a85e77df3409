//! Identifiers and load of the buses.

use super::{Case, assert_refused};

const REFUSED: &[Case] = &[
    Case {
        changes: &[("joints.period_ticks", "3")],
        says: &[
            "joints.period_ticks: 3; allowed: 1, 2, 4 or 8. Enter 2: each motor gets a command every 2 ms.",
        ],
    },
    Case {
        changes: &[("joints.phases", "[0, 0, 1, 2]")],
        says: &[
            "joints.phases: [0, 0, 1, 2]; allowed: 0 to 1, less than period_ticks. Enter 0, 0, 1, 1 with a period of 2.",
        ],
    },
    Case {
        changes: &[("wheels.escs", "[1, 1]")],
        says: &[
            "wheels.escs: 1, 1; allowed: two different numbers, 1 to 4. Press SET on a C620: the number of blinks is its number. Its command frame is that of 1 to 4.",
        ],
    },
    Case {
        changes: &[("wheels.escs", "[1, 5]")],
        says: &[
            "wheels.escs: 1, 5; allowed: two different numbers, 1 to 4. Press SET on a C620: the number of blinks is its number. Its command frame is that of 1 to 4.",
        ],
    },
    Case {
        changes: &[("joints.ids", "[1, 2, 3, 16]")],
        says: &[
            "joints.ids: [1, 2, 3, 16]; allowed: 1 to 15 for a DM4310. Give each motor a number and a reply of its own, such as 1 to 4 with 0x11 to 0x14.",
        ],
    },
    Case {
        changes: &[("joints.replies", "[0x11, 0x12, 0x13, 0x914]")],
        says: &[
            "joints.replies: 0x11, 0x12, 0x13, 0x914; allowed: 0 to 0x7FF for a DM4310. Give each motor a number and a reply of its own, such as 1 to 4 with 0x11 to 0x14.",
        ],
    },
    Case {
        changes: &[("joints.replies", "[0x101, 0x12, 0x13, 0x14]")],
        says: &[
            "joints.replies: left front replies with 0x101, the identifier of its commands; allowed: another identifier. Give each motor a number and a reply of its own, such as 1 to 4 with 0x11 to 0x14.",
        ],
    },
    Case {
        changes: &[("joints.replies", "[0x7A0, 0x12, 0x13, 0x14]")],
        says: &[
            "joints.replies: left front uses 0x7A0, which the tuning channel or the registers use; allowed: an identifier below 0x7A0. Give each motor a number and a reply of its own, such as 1 to 4 with 0x11 to 0x14.",
        ],
    },
    Case {
        changes: &[("joints.bus", "\"can1\"")],
        says: &[
            "joints.ids: left front uses 0x201, as a wheel's speed controller does; allowed: no identifier from 0x1FF to 0x208 on the wheels' bus. Put the joints on the other bus, or give them numbers from 9.",
            "joints.replies: left front has number 1 and would take 0x201 for a command to itself; allowed: no other frame on the bus whose low byte is a DM4310's number. Give each motor a number and a reply of its own, such as 1 to 4 with 0x11 to 0x14.",
            "joints.period_ticks: CAN1 would be loaded to 111 %; allowed: 80 % of 1 Mb/s. Command the joints less often, or put them on the other bus than the wheels.",
            "joints.phases: 3 frames for motors start on CAN1 in one tick; allowed: 2, so that one mailbox stays free. Spread the phases.",
        ],
    },
    Case {
        changes: &[("joints.ids", "[1, 1, 3, 4]")],
        says: &[
            "joints.ids: left front and left rear both use 0x1; allowed: each identifier once. Give each motor a number and a reply of its own, such as 1 to 4 with 0x11 to 0x14.",
        ],
    },
    Case {
        changes: &[("joints.replies", "[0x11, 0x11, 0x13, 0x14]")],
        says: &[
            "joints.replies: left front and left rear both use 0x11; allowed: each identifier once. Give each motor a number and a reply of its own, such as 1 to 4 with 0x11 to 0x14.",
        ],
    },
    Case {
        changes: &[("joints.replies", "[0x302, 0x12, 0x13, 0x14]")],
        says: &[
            "joints.replies: left rear has number 2 and would take 0x302 for a command to itself; allowed: no other frame on the bus whose low byte is a DM4310's number. Give each motor a number and a reply of its own, such as 1 to 4 with 0x11 to 0x14.",
        ],
    },
    Case {
        changes: &[
            ("joints.period_ticks", "1"),
            ("joints.phases", "[0, 0, 0, 0]"),
        ],
        says: &[
            "joints.period_ticks: CAN2 would be loaded to 125 %; allowed: 80 % of 1 Mb/s. Command the joints less often, or put them on the other bus than the wheels.",
            "joints.phases: 4 frames for motors start on CAN2 in one tick; allowed: 2, so that one mailbox stays free. Spread the phases.",
        ],
    },
    Case {
        changes: &[("joints.phases", "[0, 0, 0, 1]")],
        says: &[
            "joints.phases: 3 frames for motors start on CAN2 in one tick; allowed: 2, so that one mailbox stays free. Spread the phases.",
        ],
    },
];

#[test]
fn files_are_refused() {
    assert_refused(REFUSED);
}
