//! Writes the status for people, the most urgent first.

mod words;

use std::fmt::{self, Display, Formatter};

use robot_app::tuning::{JOINTS, WHEELS};

use super::{Status, advice};
use crate::tuning::LiveReading;
use words::{REPORTS_ENABLED, duration, list, marks, number, rest, whole};

/// Pages that have their own words here. Any other page is listed with all its values.
const PUT_INTO_WORDS: [&str; 25] = [
    "version",
    "run",
    "boot",
    "arming",
    "safety",
    "latched",
    "power",
    "operator",
    "radio",
    "bring-up",
    "attitude",
    "imu",
    "sensors",
    "joint",
    "joint-health",
    "wheel",
    "can",
    "store",
    "motor-findings",
    "refused",
    "strangers",
    "link",
    "link-frames",
    "link-errors",
    "balance",
];
/// Pages that are left out here. `--json` has them.
const LEFT_OUT: [&str; 16] = [
    "seen",
    "radio-frames",
    "radio-line",
    "radio-errors",
    "channels",
    "raw-channels",
    "gyro",
    "mag",
    "rejects",
    "gyro-bias",
    "gyro-buffer",
    "wheel-motor",
    "accel",
    "can-frames",
    "tick",
    "link-tunnel",
];

/// Flags that leave wheels and joints without torque while the robot is armed.
const PC_STOPS: [&str; 2] = ["pc-lost", "pc-awaited"];

impl Display for Status {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.firmware(f)?;
        self.arming(f)?;
        self.balance(f)?;
        self.flags(f)?;
        self.radio(f)?;
        self.motors(f)?;
        self.sensors(f)?;
        self.buses(f)?;
        self.settings(f)?;
        self.others(f)
    }
}

impl Status {
    fn firmware(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(version) = self.page("version") {
            let part = |field| whole(version, field);
            let (major, minor, patch) = (part("major"), part("minor"), part("patch"));
            let joints = version.choice("joint-motors");
            write!(f, "firmware    {major}.{minor}.{patch}, joints {joints}")?;
        }
        if let Some(run) = self.page("run") {
            write!(f, ", up {}", duration(run.number("uptime-s")))?;
            match run.number("missed-ticks") {
                Some(missed) if missed > 0.0 => write!(f, ", {missed} TICKS MISSED")?,
                _ => {}
            }
        }
        if let Some(boot) = self.page("boot") {
            write!(f, "\nlast reset  {}", boot.choice("reset-cause"))?;
            let words = boot.choice("last-words");
            if words != "nothing was reported" {
                write!(f, ", before it: {words}")?;
            }
        }
        writeln!(f)
    }

    fn arming(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(arming) = self.page("arming") {
            writeln!(f, "state       {}", arming.choice("state"))?;
            if arming.has("debugger", "attached") {
                writeln!(
                    f,
                    "debugger    attached, or was since power-on: never attach or detach while armed"
                )?;
            }
            let blockers = arming.set("blockers");
            if !blockers.is_empty() {
                writeln!(f, "\nwhat keeps it from being armed:")?;
                list(f, &blockers, advice::for_blocker)?;
            }
        }
        if let Some(refused) = self.page("refused") {
            let why = refused.set("blockers");
            if !why.is_empty() {
                writeln!(f, "the last flip of enable was refused: {}", why.join(", "))?;
            }
            if refused.has("marks", "waiting") {
                writeln!(f, "it arms as soon as flash is written: enable is on")?;
            }
        }
        if let Some(bring_up) = self.page("bring-up") {
            let step = bring_up.choice("step");
            if step == "one-motor" {
                let (motor, trial) = (bring_up.choice("motor"), bring_up.choice("trial"));
                writeln!(f, "bring-up    one motor: {motor}, {trial}")?;
            } else if step != "off" {
                writeln!(f, "bring-up    {step}")?;
            }
        }
        Ok(())
    }

    fn balance(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Some(balance) = self.page("balance") else {
            return Ok(());
        };
        let (state, request) = (balance.choice("state"), balance.choice("request"));
        write!(
            f,
            "balance     {state}, {request}: {}",
            advice::for_request(&request)
        )?;
        if state != "sit" {
            let legs = [
                balance.number("left-leg-mm"),
                balance.number("right-leg-mm"),
            ];
            let leans = [
                balance.number("left-lean-rad"),
                balance.number("right-lean-rad"),
            ];
            let [left_mm, right_mm] = legs.map(|leg| number(leg, 0));
            let [left_rad, right_rad] = leans.map(|lean| number(lean, 3));
            write!(
                f,
                "\nlegs        left {left_mm} mm, right {right_mm} mm; lean {left_rad}, {right_rad} rad"
            )?;
            for mark in balance.set("marks") {
                write!(f, ", {}", mark.to_uppercase())?;
            }
        }
        writeln!(f)
    }

    fn flags(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Some(safety) = self.page("safety") else {
            return Ok(());
        };
        let flags = safety.set("flags");
        // These stop nothing by the verdict: commands count as zero.
        let of_pc = flags
            .iter()
            .filter(|flag| PC_STOPS.contains(&flag.as_str()));
        let without_torque = of_pc.cloned().collect::<Vec<_>>().join(", ");
        let stopped = match safety.choice("verdict").as_str() {
            "global-stop" => "everything".to_owned(),
            _ if !without_torque.is_empty() => {
                format!("wheels and joints, without torque ({without_torque})")
            }
            "run" => "nothing".to_owned(),
            _ => safety.set("stopped").join(", "),
        };
        writeln!(f, "\nstopped     {stopped}")?;
        if !flags.is_empty() {
            writeln!(f, "flags:")?;
            list(f, &flags, advice::for_flag)?;
        }
        let latched = self.page("latched").map(|page| page.set("flags"));
        if let Some(latched) = latched.filter(|latched| !latched.is_empty()) {
            writeln!(
                f,
                "these stay until cleared by enable off and e-stop thrown for a second: {}",
                latched.join(", ")
            )?;
        }
        Ok(())
    }

    fn radio(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Some(radio) = self.page("radio") else {
            return Ok(());
        };
        let age = match radio.number("age-ms") {
            Some(age) if age < 65_535.0 => format!("last frame {age} ms ago"),
            _ => "no frame yet, or none for a minute".to_owned(),
        };
        write!(
            f,
            "\nradio       {} Hz, {} % good, {age}",
            number(radio.number("rate-hz"), 0),
            number(radio.number("quality-percent"), 0)
        )?;
        if radio.has("marks", "failsafe") {
            write!(f, ", FAILSAFE")?;
        }
        if let Some(operator) = self.page("operator") {
            let mut switches = operator.set("switches");
            switches.push(format!("mode {}", operator.choice("mode")));
            write!(f, "\nswitches    {}", switches.join(", "))?;
        }
        if let Some(power) = self.page("power") {
            write!(f, "\nbattery     ")?;
            match power.number("battery-v") {
                Some(volts) => write!(f, "{volts:.2} V")?,
                None => write!(f, "not measured, or none")?,
            }
        }
        self.pc(f)?;
        writeln!(f)
    }

    /// One line about the PC link, and a second one if it loses anything.
    fn pc(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Some(link) = self.page("link") else {
            return Ok(());
        };
        match link.number("age-ms") {
            Some(age) if age < 65_535.0 => {
                let gap = whole(link, "longest-gap-ms");
                let rate = number(link.number("rate-hz"), 0);
                write!(
                    f,
                    "\nPC          {rate} Hz, last command {age} ms ago, longest gap {gap} ms"
                )?;
            }
            _ => write!(f, "\nPC          no command yet, or none for a minute")?,
        }
        if let Some(frames) = self.page("link-frames") {
            let (good, sent) = (whole(frames, "good"), whole(frames, "sent"));
            write!(f, "; {good} frames received, {sent} sent")?;
        }
        if let Some(errors) = self.page("link-errors") {
            let count = |field| whole(errors, field);
            let (crc, line) = (count("crc-errors"), count("line-errors"));
            let (resyncs, unconfirmed) = (count("resyncs"), count("unconfirmed"));
            if crc + line + resyncs > 0 {
                write!(
                    f,
                    "\nPC line     {crc} CRC errors, {line} line errors, {resyncs} resyncs, {unconfirmed} commands not used"
                )?;
            }
        }
        Ok(())
    }

    fn motors(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f)?;
        for (part, name) in WHEELS.iter().enumerate() {
            let Some(wheel) = self.part("wheel", part) else {
                continue;
            };
            write!(f, "wheel {name:<12} ")?;
            match (wheel.number("rotor-rpm"), wheel.number("age-ms")) {
                (Some(rpm), Some(age)) => {
                    let temperature = number(wheel.number("temperature-c"), 0);
                    write!(f, "rotor {rpm} rpm, {temperature} degC, heard {age} ms ago")?;
                }
                _ => write!(f, "NEVER HEARD")?,
            }
            if self.is_found("wheels-doubtful", name) {
                write!(f, ", TWO MOTORS WITH ITS NUMBER, or a broken angle sensor")?;
            }
            marks(f, wheel)?;
        }
        for (part, name) in JOINTS.iter().enumerate() {
            let Some(joint) = self.part("joint", part) else {
                continue;
            };
            let state = joint.choice("state");
            write!(f, "joint {name:<12} {state}")?;
            if let Some(angle) = joint.number("angle-rad") {
                write!(f, ", {angle:+.3} rad")?;
            }
            if let Some(health) = self.part("joint-health", part) {
                if let Some(temperature) = health.number("temperature-c") {
                    write!(f, ", {temperature} degC")?;
                }
                match health.number("fault-code") {
                    Some(code) if code > 0.0 => write!(f, ", fault code 0x{:X}", code as u32)?,
                    _ => {}
                }
            }
            if self.is_found("joints-out-of-limits", name) {
                write!(f, ", OUT OF ITS LIMITS")?;
            }
            if joint.has("marks", REPORTS_ENABLED)
                && !matches!(state.as_str(), "enabled" | "enabling")
            {
                write!(f, ", BUT REPORTS THAT IT IS ENABLED")?;
            }
            marks(f, joint)?;
        }
        Ok(())
    }

    fn is_found(&self, finding: &str, motor: &str) -> bool {
        let findings = self.page("motor-findings");
        findings.is_some_and(|findings| findings.has(finding, motor))
    }

    fn sensors(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Some(imu) = self.page("imu") else {
            return Ok(());
        };
        write!(
            f,
            "\nIMU         {} degC, heater {} ({} %), gyro calibration {}",
            number(imu.number("temperature-c"), 1),
            imu.choice("heater"),
            number(imu.number("heater-percent"), 0),
            imu.choice("calibration")
        )?;
        if let Some(sensors) = self.page("sensors") {
            for sensor in ["imu", "mag"] {
                if !sensors.has("ready", sensor) {
                    write!(f, ", {sensor} NOT READY")?;
                }
            }
            let errors = |field| whole(sensors, field);
            let (imu, mag) = (errors("imu-errors"), errors("mag-errors"));
            write!(f, "\nerrors      IMU {imu}, magnetometer {mag}")?;
        }
        if let Some(attitude) = self.page("attitude") {
            let angle = |field| number(attitude.number(field), 1);
            write!(
                f,
                "\nattitude    roll {}, pitch {}, yaw {} deg",
                angle("roll-deg"),
                angle("pitch-deg"),
                angle("yaw-deg")
            )?;
            if !imu.has("marks", "attitude-valid") {
                write!(f, " (not valid)")?;
            }
        }
        writeln!(f)
    }

    fn buses(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (part, name) in ["CAN1", "CAN2"].iter().enumerate() {
            if let Some(can) = self.part("can", part) {
                let state = can.choice("state");
                let count = |field| whole(can, field);
                let (offs, back) = (count("bus-offs"), count("taken-back"));
                let lost = count("lost");
                writeln!(
                    f,
                    "{name}        {state}, {offs} times off, {back} frames not sent, {lost} lost"
                )?;
            }
            if let Some(strangers) = self.part("strangers", part) {
                stranger(f, strangers)?;
            }
        }
        Ok(())
    }

    fn settings(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(store) = &self.store {
            writeln!(f, "settings    {}", store.state_in_words())?;
        }
        let findings = self.findings.as_ref();
        let strange = self
            .page("store")
            .map(|page| whole(page, "strange-sectors"));
        if let Some(warnings) = findings.and_then(|found| found.warnings()) {
            writeln!(f, "{warnings}")?;
        }
        match strange {
            Some(count) if count > 0 => writeln!(f, "{}", strange_sectors(count)),
            _ => Ok(()),
        }
    }

    /// Lists the pages that are in the firmware's table and have no words here.
    fn others(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let known = |name: &str| PUT_INTO_WORDS.contains(&name) || LEFT_OUT.contains(&name);
        let others = self.pages.iter();
        for reading in others.filter(|reading| !known(reading.page.name)) {
            write!(f, "{}:", reading.title())?;
            rest(f, reading)?;
            writeln!(f)?;
        }
        Ok(())
    }
}

/// Names the identifiers that were received instead, because a motor that does not answer may have another one.
fn stranger(f: &mut Formatter<'_>, strangers: &LiveReading) -> fmt::Result {
    let (last, esc) = (whole(strangers, "last-id"), whole(strangers, "esc-id"));
    if last != 0 {
        write!(f, "  heard and meant for nobody: 0x{last:03X}")?;
        if esc != 0 {
            write!(f, "; 0x{esc:03X} is a C620 with number {}", esc - 0x200)?;
        }
        writeln!(f)?;
    }
    Ok(())
}

/// Describes sectors that were never part of a store.
pub fn strange_sectors(count: u32) -> String {
    format!(
        "{count} flash sectors for settings hold something else, such as an older firmware; they are erased when their turn \
         comes, and nothing of this robot is lost unless it had settings saved"
    )
}

#[cfg(test)]
mod tests {
    use robot_app::tuning::LIVE_PAGES;

    use super::*;

    #[test]
    fn pages_that_are_named_here_exist() {
        for name in PUT_INTO_WORDS.iter().chain(&LEFT_OUT) {
            assert!(LIVE_PAGES.iter().any(|page| page.name == *name), "{name}");
        }
    }
}
