//! Tells an event in plain language.

use robot_app::{
    black_box::{BlackBoxSample, CommandSource},
    domain::{BalanceStatus, CrashCause, DriveMode, EventKind, LateTasks, ResetCause},
    safety::{ArmingBlockers, SafetyFlags},
};

use super::{event::RecordedEvent, names::state_name};
use crate::link_recorder::Attitude;

/// Returns the paragraphs of a report: what stopped the robot and when, the values just before, and what came after.
pub fn paragraphs(event: &RecordedEvent) -> Vec<String> {
    let mut all = vec![
        format!("{} {}", first_sentence(event), reset_sentence(event)),
        values(event.just_before(), event),
        afterwards(event),
    ];
    all.iter_mut()
        .for_each(|text| *text = text.trim().to_owned());
    all.retain(|text| !text.is_empty());
    all
}

/// Says what happened, and when.
pub fn first_sentence(event: &RecordedEvent) -> String {
    let at = event.seconds();
    let causes = causes(event);
    match event.event.kind {
        EventKind::Stop | EventKind::None => {
            format!("The robot was stopped {at:.2} s after it had booted: {causes}.")
        }
        EventKind::PartialStop => format!(
            "A part of the robot was stopped {at:.2} s after it had booted, while it stayed armed: {causes}."
        ),
        EventKind::Reset => {
            let armed = match event.just_before().armed {
                true => "armed",
                false => "disarmed",
            };
            let cause = event.event.reset.map_or_else(String::new, reset_words);
            format!(
                "The chip was reset while the robot was {armed}: {cause}. The last sample is from {at:.2} s after the boot."
            )
        }
    }
}

/// Says whether a reset came right after a stop.
fn reset_sentence(event: &RecordedEvent) -> String {
    match event.event.reset {
        Some(reset) if event.event.kind != EventKind::Reset => format!(
            "The chip was reset within a second after that: {}.",
            reset_words(reset)
        ),
        _ => String::new(),
    }
}

fn reset_words((cause, crash): (ResetCause, CrashCause)) -> String {
    let cause = match cause {
        ResetCause::Unknown => "the cause is unknown",
        ResetCause::PowerOn => "the power came on",
        ResetCause::Pin => "the reset pin was pulled",
        ResetCause::BrownOut => "the supply voltage was too low",
        ResetCause::Software => "the program asked for it",
        ResetCause::IndependentWatchdog | ResetCause::WindowWatchdog => "the watchdog was not fed",
        ResetCause::LowPower => "low-power management",
    };
    match crash {
        CrashCause::Silent => format!("{cause}, and the program left no word"),
        crash => format!("{cause}, and the program's last word is: {}", crash.text()),
    }
}

fn causes(event: &RecordedEvent) -> String {
    let causes = event.causes();
    let blockers = event.event.blockers;
    let late = event.samples.iter().map(|sample| sample.late_tasks);
    let late: Vec<&str> = late.flat_map(late_names).collect();
    let mut words: Vec<String> = causes
        .iter_names()
        .map(|(_, flag)| flag)
        .filter(|flag| *flag != SafetyFlags::ESTIMATE_INVALID || causes == *flag)
        .map(|flag| flag_words(flag, &late))
        .collect();
    if words.is_empty() && blockers.contains(ArmingBlockers::REMOTE_NOT_FRESH) {
        words.push("the radio was lost".to_owned());
    }
    if words.is_empty() {
        words.extend(
            blockers
                .names()
                .map(|name| format!("what blocks arming appeared ({name})")),
        );
    }
    match words.is_empty() {
        true => "nothing recorded says why".to_owned(),
        false => words.join("; and "),
    }
}

fn late_names(late: LateTasks) -> Vec<&'static str> {
    let tasks = [
        (late.imu, "imu"),
        (late.mag, "mag"),
        (late.sbus, "sbus"),
        (late.logic, "logic"),
        (late.status, "status"),
        (late.params, "params"),
        (late.link_receive, "link receive"),
        (late.link_send, "link send"),
    ];
    let late = tasks.into_iter().filter(|(is_late, _)| *is_late);
    late.map(|(_, name)| name).collect()
}

fn flag_words(flag: SafetyFlags, late: &[&str]) -> String {
    let words = match flag {
        SafetyFlags::REMOTE_LOST => "the radio was lost, no frame came over the air in time",
        SafetyFlags::REMOTE_FAILSAFE => "the receiver reported that it had lost the transmitter",
        SafetyFlags::REMOTE_QUALITY => "too many radio frames were lost",
        SafetyFlags::E_STOP => "the e-stop was thrown",
        SafetyFlags::ESTIMATE_INVALID => "the attitude could not be trusted",
        SafetyFlags::IMU_STALE => "no sample of the IMU came in time",
        SafetyFlags::IMU_ERRORS => "the IMU had too many errors",
        SafetyFlags::MAG_ERRORS => "the magnetometer had too many errors",
        SafetyFlags::CAN1_FAULT => "CAN1 was bus-off",
        SafetyFlags::CAN2_FAULT => "CAN2 was bus-off",
        SafetyFlags::CAN1_CONGESTED => "frames could not be sent on CAN1",
        SafetyFlags::CAN2_CONGESTED => "frames could not be sent on CAN2",
        SafetyFlags::COMMAND_STALE => "the logic task gave no fresh command",
        SafetyFlags::TASK_LATE => match late.first() {
            Some(task) => return format!("the task {task} missed its deadline"),
            None => "a task missed its deadline",
        },
        SafetyFlags::TILT => "it fell over",
        SafetyFlags::WHEEL_HOT => "a wheel motor was too hot",
        SafetyFlags::JOINT_HOT => "a joint motor was too hot",
        SafetyFlags::BATTERY_EMPTY => "the battery was empty",
        SafetyFlags::JOINT_FAULT => "a joint motor reported a fault",
        SafetyFlags::JOINT_SILENT => "a joint motor fell silent",
        SafetyFlags::WHEEL_FROZEN => "a wheel motor repeated an old report",
        SafetyFlags::JOINT_FROZEN => "a joint motor repeated an old report",
        SafetyFlags::JOINT_NOT_READY => "a joint motor could not be set up",
        SafetyFlags::STICKS_AWAITED => "a stop that was too short to be recorded",
        SafetyFlags::PC_LOST => "the PC was lost: no fresh command came over the link",
        SafetyFlags::PC_AWAITED => {
            "the PC had to begin from rest again, after a short gap in its commands or because a motor had come back"
        }
        _ => "a condition that this robotctl does not know",
    };
    let name = flag.names().next();
    name.map_or_else(|| words.to_owned(), |name| format!("{words} ({name})"))
}

/// Says what the robot did in one sample.
fn values(sample: &BlackBoxSample, event: &RecordedEvent) -> String {
    let before_ms = -1e3 * event.after_s(sample);
    let mode = match sample.mode {
        DriveMode::Manual => "manual",
        DriveMode::Pc => "PC",
        DriveMode::Custom => "custom",
    };
    let command = match sample.source {
        CommandSource::Nobody => "nobody commanded it".to_owned(),
        CommandSource::Drive => format!(
            "the command was drive {:+.0} %, turn {:+.0} %",
            100.0 * sample.drive,
            100.0 * sample.turn
        ),
        CommandSource::Direct => "its own logic commanded the motors".to_owned(),
        CommandSource::Pc => format!(
            "the PC commanded it (last command {} ms old)",
            sample.command_age_ms
        ),
        CommandSource::BringUp => "bring-up commanded it".to_owned(),
    };
    let attitude = Attitude::of_wxyz(sample.q_wxyz);
    let [left, right] = sample.wheel_rps;
    let [sent_left, sent_right] = sample.sent_ma.map(|ma| ma / 1e3);
    let [measured_left, measured_right] = sample.measured_ma.map(|ma| ma / 1e3);
    let battery = match sample.battery_v {
        0.0 => "battery not measured".to_owned(),
        volts => format!("battery {volts:.1} V"),
    };
    let radio = match sample.radio_age_ms {
        u8::MAX => "no radio frame for a quarter of a second or more".to_owned(),
        age => format!("last radio frame {age} ms old"),
    };
    format!(
        "Just before ({before_ms:.0} ms), it was {armed} in mode {mode}, and {command}. Roll {roll:+.1}°, pitch \
         {pitch:+.1}°; wheels {left:+.1} and {right:+.1} rad/s, currents sent {sent_left:+.2} and {sent_right:+.2} A, \
         measured {measured_left:+.2} and {measured_right:+.2} A; {battery}; {radio}.{balance}",
        armed = if sample.armed { "armed" } else { "disarmed" },
        roll = attitude.roll_deg,
        pitch = attitude.pitch_deg,
        balance = sample
            .balance
            .as_ref()
            .map_or_else(String::new, |it| balance_words(&it.status)),
    )
}

/// Says nothing of a robot that sits.
fn balance_words(balance: &BalanceStatus) -> String {
    if balance.sits() {
        return String::new();
    }
    let [left_m, right_m] = balance.leg_m;
    let [left, right] = balance.lean_rad.map(f32::to_degrees);
    let [left_n, right_n] = balance.contact_n;
    let marks = [
        (balance.airborne, ", airborne"),
        (balance.slipping, ", slipping"),
    ];
    let marks = marks.map(|(is_so, words)| if is_so { words } else { "" });
    format!(
        " Balance: {}{}; legs {left_m:.2} and {right_m:.2} m, leaning {left:+.0}° and {right:+.0}°, wheels on the ground with \
         {left_n:.0} and {right_n:.0} N.",
        state_name(balance.state),
        marks.concat(),
    )
}

fn afterwards(event: &RecordedEvent) -> String {
    let later = event.changes();
    let later: Vec<String> = later
        .iter()
        .filter(|(at, _, raised)| *raised && *at > 0.0)
        .map(|(at, name, _)| format!("{name} after {at:.2} s"))
        .collect();
    match later.is_empty() {
        true => String::new(),
        false => format!("Flags raised afterwards: {}.", later.join(", ")),
    }
}
