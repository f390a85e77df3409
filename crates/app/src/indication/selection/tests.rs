use super::*;
use crate::domain::StandPermit;

/// Armed, or disarmed with the enable switch off, without any fault.
struct Situation {
    arming: ArmingStatus,
    safety: SafetyStatus,
    calibration: CalibrationStatus,
    bring_up: BringUpStep,
    params: ParamStatus,
}

impl Situation {
    fn new(state: ArmingState) -> Self {
        let blockers = match state {
            ArmingState::Armed => ArmingBlockers::NONE,
            ArmingState::Disarmed => ArmingBlockers::ENABLE_OFF,
        };
        Self {
            arming: ArmingStatus {
                state,
                blockers,
                ..ArmingStatus::default()
            },
            safety: SafetyStatus {
                global_stop: false,
                wheels_stop: false,
                joints_stop: false,
                bus_stop: [false; 2],
                ..SafetyStatus::default()
            },
            calibration: CalibrationStatus {
                state: CalibrationState::Done,
                ..CalibrationStatus::default()
            },
            bring_up: BringUpStep::Off,
            params: ParamStatus::default(),
        }
    }

    fn shows(&self) -> Indication {
        Indication::select(&IndicationInputs {
            arming: &self.arming,
            safety: &self.safety,
            calibration: &self.calibration,
            bring_up: self.bring_up,
            params: &self.params,
        })
    }
}

fn armed(change: impl FnOnce(&mut Situation)) -> Indication {
    let mut situation = Situation::new(ArmingState::Armed);
    change(&mut situation);
    situation.shows()
}

fn disarmed(change: impl FnOnce(&mut Situation)) -> Indication {
    let mut situation = Situation::new(ArmingState::Disarmed);
    change(&mut situation);
    situation.shows()
}

/// A global stop, which also disarms.
fn stopped(flags: SafetyFlags, latched: SafetyFlags) -> Indication {
    disarmed(|s| {
        s.safety.flags = flags;
        s.safety.latched = latched;
        s.safety.global_stop = true;
    })
}

#[test]
fn stops_come_first_in_order_of_urgency() {
    let none = SafetyFlags::NONE;
    let e_stop = SafetyFlags::E_STOP;
    let empty = SafetyFlags::BATTERY_EMPTY;
    let tilt = SafetyFlags::TILT;
    let lost = SafetyFlags::REMOTE_LOST;
    let stale = SafetyFlags::IMU_STALE;
    let all = e_stop.union(empty).union(tilt).union(stale);
    assert_eq!(stopped(all, empty.union(tilt)), Indication::EStop);
    let no_e_stop = empty.union(tilt).union(lost).union(stale);
    assert_eq!(stopped(no_e_stop, empty), Indication::BatteryEmpty);
    let fallen = tilt.union(lost).union(stale);
    assert_eq!(stopped(fallen, tilt), Indication::LatchedStop);
    assert_eq!(stopped(lost.union(stale), none), Indication::RadioLost);
    for radio in [SafetyFlags::REMOTE_FAILSAFE, SafetyFlags::REMOTE_QUALITY] {
        assert_eq!(stopped(radio, none), Indication::RadioLost);
    }
    assert_eq!(stopped(e_stop.union(lost), none), Indication::RadioLost);
    assert_eq!(stopped(stale, none), Indication::Fault);
    assert_eq!(stopped(SafetyFlags::TASK_LATE, none), Indication::Fault);
}

/// While the robot is armed its wheels may still turn, and nobody must take it for stopped and come near.
#[test]
fn a_latched_stop_of_the_joints_is_shown_only_when_disarmed() {
    let faulty = |s: &mut Situation| {
        s.safety.joints_stop = true;
        s.safety.flags = SafetyFlags::JOINT_FAULT;
        s.safety.latched = SafetyFlags::JOINT_FAULT;
    };
    assert_eq!(armed(faulty), Indication::ArmedInPart);
    assert_eq!(disarmed(faulty), Indication::LatchedStop);
}

#[test]
fn an_armed_robot_shows_what_is_degraded() {
    assert_eq!(armed(|_| ()), Indication::Armed);
    assert_eq!(
        armed(|s| s.bring_up = BringUpStep::OneMotor),
        Indication::BringUpArmed
    );
    assert_eq!(
        armed(|s| s.safety.flags = SafetyFlags::BATTERY_LOW),
        Indication::ArmedBatteryLow
    );
    let in_part: [fn(&mut Situation); 4] = [
        |s| s.safety.wheels_stop = true,
        |s| s.safety.joints_stop = true,
        |s| s.safety.bus_stop = [true, false],
        |s| s.safety.bus_stop = [false, true],
    ];
    for stop in in_part {
        assert_eq!(armed(stop), Indication::ArmedInPart);
    }
}

#[test]
fn a_disarmed_robot_shows_what_it_waits_for() {
    assert_eq!(disarmed(|_| ()), Indication::Ready);
    assert_eq!(
        disarmed(|s| s.bring_up = BringUpStep::ReadOnly),
        Indication::BringUp
    );
    assert_eq!(
        disarmed(|s| s.safety.flags = SafetyFlags::BATTERY_LOW),
        Indication::BatteryLow
    );
    let calibrating = |state| {
        disarmed(|s| {
            s.arming.blockers = ArmingBlockers::CALIBRATION_PENDING;
            s.calibration.state = state;
        })
    };
    assert_eq!(
        calibrating(CalibrationState::WaitingForTemperature),
        Indication::WarmingUp
    );
    assert_eq!(
        calibrating(CalibrationState::WaitingForStillness),
        Indication::HoldStill
    );
    assert_eq!(
        calibrating(CalibrationState::Measuring),
        Indication::Calibrating
    );
    let blocked = |blocker| disarmed(|s| s.arming.blockers = blocker);
    assert_eq!(
        blocked(ArmingBlockers::JOINTS_NOT_READY),
        Indication::NotReady
    );
    for motors in [
        ArmingBlockers::WHEEL_NEVER_HEARD,
        ArmingBlockers::WHEEL_DOUBTFUL,
        ArmingBlockers::JOINT_OUT_OF_LIMITS,
    ] {
        assert_eq!(blocked(motors), Indication::NotReady);
    }
    assert_eq!(disarmed(|s| s.arming.waiting = true), Indication::Waiting);
    // The attitude settles after an erase, which is a stop.
    let settling = disarmed(|s| {
        s.arming.waiting = true;
        s.safety.flags = SafetyFlags::ESTIMATE_INVALID;
        s.safety.global_stop = true;
    });
    assert_eq!(settling, Indication::Waiting);
    assert_eq!(
        disarmed(|s| s.safety.joints_stop = true),
        Indication::NotReady
    );
    for refused in [
        ArmingBlockers::ENABLE_NOT_CYCLED,
        ArmingBlockers::STICKS_NOT_CENTRED,
    ] {
        assert_eq!(blocked(refused), Indication::Refused);
    }
}

#[test]
fn unsaved_settings_are_shown_when_nothing_else_is_wrong() {
    let failing = |s: &mut Situation| {
        s.params.unsaved = 1;
        s.params.state = ParamState::BackingOff;
    };
    assert_eq!(disarmed(failing), Indication::NotSaved);
    assert_eq!(armed(failing), Indication::Armed);
    let refused = disarmed(|s| {
        failing(s);
        s.arming.blockers = ArmingBlockers::STICKS_NOT_CENTRED;
    });
    assert_eq!(refused, Indication::Refused);
    // A save in progress, and an erase that failed while everything is saved, are not shown.
    let waiting = disarmed(|s| s.params.unsaved = 1);
    assert_eq!(waiting, Indication::Ready);
    let no_spare = disarmed(|s| s.params.state = ParamState::BackingOff);
    assert_eq!(no_spare, Indication::Ready);
}

#[test]
fn refused_settings_are_shown_before_the_pilot_tries_to_arm() {
    let refused = disarmed(|s| s.arming.blockers = ArmingBlockers::SETTINGS_REFUSED);
    assert_eq!(refused, Indication::NotReady);
}

#[test]
fn a_debugger_with_vector_catch_is_shown_before_the_pilot_tries_to_arm() {
    let unset = disarmed(|s| s.arming.blockers = ArmingBlockers::JOINT_TIMEOUT_UNSET);
    assert_eq!(unset, Indication::NotReady);
    let caught = disarmed(|s| s.arming.blockers = ArmingBlockers::DEBUGGER_CATCHES);
    assert_eq!(caught, Indication::NotReady);
}

#[test]
fn a_robot_that_stands_by_itself_is_shown() {
    for (stand, expected) in [
        (StandPermit::Ready, Indication::Armed),
        (StandPermit::Requested, Indication::Armed),
        (StandPermit::StandingUp, Indication::Standing),
        (StandPermit::Standing, Indication::Standing),
    ] {
        assert_eq!(armed(|s| s.safety.stand = stand), expected);
    }
    let part = armed(|s| {
        s.safety.stand = StandPermit::Standing;
        s.safety.wheels_stop = true;
    });
    assert_eq!(part, Indication::ArmedInPart);
}
