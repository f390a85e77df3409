use std::time::{Duration, Instant};

use robot_app::{
    bring_up::BringUpStep,
    diagnostics::DiagnosticsSnapshot,
    domain::{CanFrame, NO_CHANNEL, RemoteChannel},
    safety::ArmingState,
    tuning::TuningGate,
};

use super::*;
use crate::{
    can_link::{CanLink, CanLinkError},
    tuning::{
        Timeouts, TuningClient,
        testing::{Bus, Robot, client, robot},
    },
};

/// A FrSky transmitter: sticks in the middle, enable off (channel 4), mode manual (5), e-stop thrown (6), no more
/// channels.
const REST: Frame = [
    992, 992, 992, 992, 172, 172, 1811, 992, 0, 0, 0, 0, 0, 0, 0, 0,
];

fn with(changes: &[(usize, u16)]) -> Frame {
    let mut frame = REST;
    for &(index, count) in changes {
        frame[index] = count;
    }
    frame
}

fn still(frame: Frame) -> HeldPosition {
    HeldPosition::of(&[frame; 5]).unwrap()
}

fn find(control: Control, changes: &[(usize, u16)]) -> Result<Movement, MoveError> {
    Movement::find(control, &still(REST), &still(with(changes)), &[])
}

fn channel(index: u32, low: u32, centre: u32, high: u32, reversed: u32) -> RemoteChannel {
    RemoteChannel {
        index,
        low,
        centre,
        high,
        reversed,
    }
}

/// Returns frames in which the stick is held for five frames at each end of the channel.
fn round(index: usize, low: u16, high: u16) -> Vec<Frame> {
    let mut frames = vec![REST; 5];
    frames.extend([with(&[(index, low)]); 5]);
    frames.extend([with(&[(index, high)]); 5]);
    frames
}

/// In docs/driving.md drive forward, steering right, selector up, dead-man right, enable on, mode custom and e-stop
/// stop are +1.
#[test]
fn each_control_at_its_high_end_is_at_plus_one_for_the_robot() {
    for (control, index) in Control::STICKS.into_iter().zip([1, 0, 2, 3]) {
        for held in [1811, 172] {
            let moved = find(control, &[(index, held)]).unwrap();
            let stick = stick(&moved, &round(index, 172, 1811)).unwrap();
            let reversed = u32::from(held == 172);
            assert_eq!(stick, channel(index as u32, 172, 992, 1811, reversed));
            assert_eq!(stick.position(&with(&[(index, held)])), Some(1.0));
        }
    }
    let switch = |control, index, to| {
        let moved = find(control, &[(index, to)]).unwrap();
        MappedControl::switch(&moved).channel.unwrap()
    };
    let enable = switch(Control::Enable, 4, 1811);
    assert_eq!(enable, channel(4, 172, 991, 1811, 0));
    assert_eq!(enable.position(&REST), Some(-1.0));
    let mode = switch(Control::Mode, 5, 1811);
    assert_eq!(mode.position(&with(&[(5, 1811)])), Some(1.0));
    // Asked for, the e-stop goes to run, its low end.
    let e_stop = switch(Control::EStop, 6, 172);
    assert_eq!(e_stop, channel(6, 172, 991, 1811, 0));
    assert_eq!(e_stop.position(&REST), Some(1.0));
}

/// In docs/driving.md stand, jump, long legs and the right side down are +1. The stand switch rests at its end, the others
/// at their middle.
#[test]
fn a_standing_robot_s_controls_have_a_channel_and_a_direction() {
    for (control, index) in Control::BALANCE.into_iter().zip([9, 10, 11, 12]) {
        for (end, sense) in [(1811, 0), (172, 1)] {
            let from = match control {
                Control::Stand => 1983 - end,
                _ => 992,
            };
            let rest = still(with(&[(index, from)]));
            let held = still(with(&[(index, end)]));
            let moved = Movement::find(control, &rest, &held, &[]).unwrap();
            let settings = MappedControl::switch(&moved).settings();
            let name = control.name();
            let wanted = [("channel", index as f32), ("reversed", sense as f32)];
            let wanted = wanted.map(|(what, value)| (format!("radio.{name}-{what}"), value));
            assert_eq!(settings, wanted);
        }
        assert!(control.may_be_missing());
    }
}

#[test]
fn a_switch_that_the_robot_would_not_see_thrown_is_named() {
    let found = |control, from: u16, to: u16| {
        let held = |count| still(with(&[(9, count)]));
        Movement::find(control, &held(from), &held(to), &[])
    };
    for (from, to) in [(581, 1402), (1402, 581)] {
        assert!(found(Control::Stand, from, to).is_ok());
    }
    assert!(found(Control::Jump, 1001, 1402).is_ok());
    assert!(found(Control::Jump, 982, 581).is_ok());
    for (control, from, to) in [
        (Control::Stand, 582, 1402),
        (Control::Stand, 581, 1401),
        (Control::Jump, 1001, 1401),
        (Control::Jump, 992, 582),
        (Control::Jump, 1402, 1811),
    ] {
        let short = found(control, from, to).unwrap_err().to_string();
        let why = format!("{}: channel 9 went from {from} to {to}", control.name());
        assert!(short.starts_with(&why), "{short}");
    }
}

#[test]
fn a_switch_with_the_opposite_direction_is_reversed() {
    let found = |control, from: u16, to: u16| {
        let rest = still(with(&[(9, from)]));
        let moved = Movement::find(control, &rest, &still(with(&[(9, to)])), &[]).unwrap();
        (
            moved.is_reversed(),
            MappedControl::switch(&moved).channel.unwrap(),
        )
    };
    // Futaba's ends.
    let (reversed, enable) = found(Control::Enable, 1696, 352);
    assert!(reversed);
    assert_eq!(enable, channel(9, 352, 1024, 1696, 1));
    assert_eq!(enable.position(&with(&[(9, 352)])), Some(1.0));
    let (reversed, e_stop) = found(Control::EStop, 352, 1696);
    assert!(reversed);
    assert_eq!(e_stop.position(&with(&[(9, 1696)])), Some(-1.0));
}

#[test]
fn an_ambiguous_movement_is_reported_with_advice() {
    let complaint = |control, changes: &[_]| find(control, changes).unwrap_err().to_string();
    let little = complaint(Control::Drive, &[(1, 1291)]);
    assert!(
        little
            .starts_with("drive: nothing moved (channel 1 by 299 counts at most, 300 are wanted)"),
        "{little}"
    );
    assert!(find(Control::Drive, &[(1, 1292)]).is_ok());
    let short = find(Control::Enable, &[(4, 571)]).unwrap_err();
    assert!(matches!(short, MoveError::Nothing { counts: 399, .. }));
    assert!(find(Control::Enable, &[(4, 572)]).is_ok());

    let both = complaint(Control::Drive, &[(1, 1811), (0, 842)]);
    assert!(
        both.starts_with("drive: channels 1 and 0 both moved"),
        "{both}"
    );
    assert!(find(Control::Drive, &[(1, 1811), (0, 843)]).is_ok());

    let drive = MappedControl::switch(&find(Control::Drive, &[(1, 1811)]).unwrap());
    let held = still(with(&[(1, 172)]));
    let again = Movement::find(Control::Steering, &still(REST), &held, &[drive]).unwrap_err();
    let again = again.to_string();
    assert!(
        again.starts_with("steering: channel 1 moved, which is drive already"),
        "{again}"
    );

    let wobbling = [1700, 1811, 1750, 1761, 1800].map(|count| with(&[(1, count)]));
    let wobbling = HeldPosition::of(&wobbling).unwrap();
    assert_eq!(wobbling.median[1], 1761);
    assert_eq!(
        Movement::find(Control::Drive, &still(REST), &wobbling, &[]),
        Err(MoveError::Unsteady {
            name: "drive",
            index: 1,
            counts: 111
        })
    );
}

#[test]
fn a_control_that_is_not_back_is_named() {
    let back = |changes: &[_]| still(REST).check_back(&still(with(changes)));
    assert_eq!(back(&[(0, 1100)]), Ok(()));
    let on = back(&[(4, 1811)]).unwrap_err();
    assert_eq!(on, MoveError::NotBack { index: 4 });
}

#[test]
fn an_end_needs_several_frames() {
    let drive = find(Control::Drive, &[(1, 1811)]).unwrap();
    let mut frames = round(1, 180, 1805);
    frames.extend([with(&[(1, 0)]), with(&[(1, 2047)])]);
    frames.extend([with(&[(1, 3)]), with(&[(1, 2046)])]);
    let found = stick(&drive, &frames).unwrap();
    assert_eq!((found.low, found.centre, found.high), (180, 992, 1805));
}

#[test]
fn a_stick_that_was_not_moved_to_both_ends_is_named() {
    let drive = find(Control::Drive, &[(1, 1811)]).unwrap();
    let ends = |low, high| stick(&drive, &round(1, low, high));
    assert!(ends(172, 1751).is_ok());
    let missed = ends(172, 1750).unwrap_err().to_string();
    assert!(
        missed.starts_with("drive: channel 1 went from 172 over 992 to 1750, and was at 1811"),
        "{missed}"
    );
    // Half of 819 counts is 409.
    assert!(ends(583, 1811).is_ok());
    assert!(ends(584, 1811).is_err());
    let none = stick(&drive, &[]).unwrap_err();
    assert!(matches!(
        none,
        MoveError::Ends {
            low: 992,
            high: 992,
            ..
        }
    ));
    let weak = find(Control::Drive, &[(1, 1292)]).unwrap();
    assert!(stick(&weak, &round(1, 692, 1292)).is_ok());
    assert!(stick(&weak, &round(1, 693, 1292)).is_err());
}

/// A transmitter with another order: throttle first, the two sticks' channels swapped, no selector.
fn found() -> Vec<MappedControl> {
    let with = |control, channel| MappedControl { control, channel };
    vec![
        with(Control::Drive, Some(channel(0, 352, 1024, 1696, 1))),
        with(Control::Steering, Some(channel(1, 300, 1000, 1700, 0))),
        with(Control::Select, None),
        with(Control::DeadMan, Some(channel(2, 172, 992, 1811, 0))),
        with(Control::Stand, Some(channel(9, 172, 991, 1811, 1))),
        with(Control::Jump, Some(channel(7, 172, 991, 1811, 0))),
        with(Control::Height, Some(channel(8, 992, 1401, 1811, 0))),
        with(Control::Roll, None),
        with(Control::Mode, Some(channel(6, 172, 991, 1811, 0))),
        with(Control::Enable, Some(channel(5, 172, 991, 1811, 1))),
        with(Control::EStop, Some(channel(4, 172, 991, 1811, 0))),
    ]
}

#[test]
fn the_mapping_is_shown_and_written() {
    let (bus, mut client) = robot();
    let words: Vec<_> = found().iter().map(MappedControl::in_words).collect();
    assert_eq!(
        words[0],
        "drive: channel 0, 352 … 1024 … 1696; forward is the low count"
    );
    assert_eq!(words[2], "select: none");
    assert_eq!(
        words[4],
        "stand: channel 9, 172 … 1811; stand is the low count"
    );
    let differs = differing(&mut client, &found(), 4.0).unwrap();
    // drive 5, steering 4, select 1, dead-man 1, stand 2, jump, height and roll 1 each, mode 2, enable 3, e-stop 2.
    assert_eq!(differs.len(), 23);
    write(&mut client, &found()).unwrap();
    assert!(differing(&mut client, &found(), 5.0).unwrap().is_empty());
    let radio = bus.0.borrow().config.radio;
    assert_eq!(radio.drive, channel(0, 352, 1024, 1696, 1));
    assert_eq!(radio.steering, channel(1, 300, 1000, 1700, 0));
    assert_eq!(radio.select, channel(NO_CHANNEL, 172, 992, 1811, 0));
    assert_eq!(radio.enable, channel(5, 172, 991, 1811, 1));
    assert_eq!(radio.e_stop, channel(4, 172, 991, 1811, 0));
    assert_eq!((radio.stand.index, radio.stand.reversed), (9, 1));
    assert_eq!((radio.jump.index, radio.jump.reversed), (7, 0));
    assert_eq!(radio.height.index, 8);
    assert_eq!(radio.roll.index, NO_CHANNEL);
}

/// A robot that receives a transmitter at rest, and takes settings only while it reads its enable switch as off.
struct AtRest(Bus, Frame);

impl CanLink for AtRest {
    fn send(&mut self, frame: &CanFrame) -> Result<(), CanLinkError> {
        {
            let robot = &mut *self.0.0.borrow_mut();
            let enable = robot.config.radio.enable.position(&self.1);
            robot.gate = match enable {
                Some(position) if position > 0.5 => TuningGate::Shut,
                _ => TuningGate::Open,
            };
        }
        self.0.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<CanFrame>, CanLinkError> {
        self.0.receive(until)
    }
}

/// Enable is on channel 5 and off at 1811. With the old direction it would be on, and the robot would take no settings.
#[test]
fn a_reversed_enable_switch_does_not_lock_its_own_settings_out() {
    let (bus, _) = robot();
    bus.0.borrow_mut().config.radio.enable.index = NO_CHANNEL;
    let rest = [
        1024, 1000, 992, 992, 1811, 1811, 172, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    ];
    let timeouts = Timeouts {
        each_try: Duration::ZERO,
        tries: 3,
    };
    let mut client = TuningClient::new(Box::new(AtRest(bus.clone(), rest)), timeouts);
    write(&mut client, &found()).unwrap();
    let enable = bus.0.borrow().config.radio.enable;
    assert_eq!(enable, channel(5, 172, 991, 1811, 1));
    assert_eq!(enable.position(&rest), Some(-1.0));
}

#[test]
fn a_robot_with_half_a_mapping_has_no_enable_switch() {
    let (bus, mut client) = robot();
    let mut wrong = found();
    wrong[0].channel = Some(channel(0, 352, 353, 1696, 0));
    let error = write(&mut client, &wrong).unwrap_err();
    assert!(error.to_string().contains("cannot be armed"), "{error}");
    let index = |robot: &Robot| robot.config.radio.enable.index;
    assert_eq!(index(&bus.0.borrow()), NO_CHANNEL);
    write(&mut client, &found()).unwrap();
    assert_eq!(index(&bus.0.borrow()), 5);
}

/// Returns the error for a robot in bring-up's read-only step that receives a frame of these channels, after `change`.
fn watched(raw: Frame, change: fn(&mut DiagnosticsSnapshot)) -> Result<Frame, WatchError> {
    let mut client = client(|diagnostics| {
        diagnostics.bring_up.step = BringUpStep::ReadOnly;
        diagnostics.remote_diag.age_us = 9_000;
        diagnostics.remote_diag.failsafe = false;
        diagnostics.remote_raw = raw;
        change(diagnostics);
    });
    Watch::new(&mut client).frame()
}

#[test]
fn all_channels_are_read_in_their_order() {
    let raw: Frame = std::array::from_fn(|index| 100 * index as u16 + 7);
    assert_eq!(watched(raw, |_| ()).unwrap(), raw);
}

#[test]
fn only_a_robot_that_receives_and_cannot_be_armed_is_watched() {
    let refused = |change: fn(&mut DiagnosticsSnapshot)| watched(REST, change).unwrap_err();
    assert!(matches!(
        refused(|robot| robot.arming.state = ArmingState::Armed),
        WatchError::Armed
    ));
    for step in [
        BringUpStep::Off,
        BringUpStep::ZeroTorque,
        BringUpStep::OneMotor,
    ] {
        let mut client = client(|diagnostics| diagnostics.bring_up.step = step);
        let error = Watch::new(&mut client).frame().unwrap_err();
        assert!(matches!(error, WatchError::NotReadOnly), "{step:?}");
    }
    assert!(matches!(
        refused(|robot| robot.remote_diag.age_us = 101_000),
        WatchError::NotHeard
    ));
    assert!(matches!(
        refused(|robot| robot.remote_diag.failsafe = true),
        WatchError::NotHeard
    ));
    // DBUS: four sticks and the wheel.
    let dbus = |robot: &mut DiagnosticsSnapshot| {
        robot.remote_raw = [0; 16];
        robot.remote_raw[..5].fill(1024);
    };
    assert!(matches!(refused(dbus), WatchError::Dbus));
}
