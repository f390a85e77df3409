//! The arm as text.

use std::{fmt::Write, path::Path, time::Duration};

use robot_servo_model::{Fault, FaultId, SO101_JOINTS, View, status};

/// Width of the picture of a joint's travel.
const TRAVEL: usize = 32;
/// Steps of a turn.
const TURN: i32 = 4096;
/// Clears the terminal and goes to its first line.
const CLEAR: &str = "\x1b[2J\x1b[H";
/// Remembers the place of the cursor and goes to the first line; and back.
const SAVE: &str = "\x1b7\x1b[H";
const RESTORE: &str = "\x1b8";
/// Clears the rest of a line.
const CLEAR_LINE: &str = "\x1b[K\n";

/// What a program that reads the output, or a user, wants first: the port and what to do with it.
pub fn heading(port: &Path, is_new: bool) -> String {
    let port = port.display();
    if is_new {
        format!(
            "{port}: new servos, the first plugged in alone. Next:\n  armctl set-id --port {port} --from 1 --to 1"
        )
    } else {
        format!("{port}: six servos. Next:\n  armctl scan --port {port}")
    }
}

/// What draws a picture: on a cleared screen with a prompt below it, or over the last one, so that what the user is typing stays.
pub fn drawn(picture: &str, is_first: bool) -> String {
    if is_first {
        format!("{CLEAR}{picture}> ")
    } else {
        format!("{SAVE}{}{RESTORE}", picture.replace('\n', CLEAR_LINE))
    }
}

/// What the picture shows beside the servos.
pub struct Around<'a> {
    /// Name of the port.
    pub port: &'a Path,
    /// Faults in force.
    pub faults: &'a [(FaultId, Fault)],
    /// How late the computer has been.
    pub stall: Duration,
    /// What was said last.
    pub said: &'a str,
}

/// The arm, and what goes wrong.
pub fn picture(views: &[View], around: &Around) -> String {
    let mut text = format!(
        "{}: STS3215, o is where it is, | its goal\n\n",
        around.port.display()
    );
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "  {:13} {:>3} {:>5} {:>5} 0{:^TRAVEL$}4095 {:>5} {:>4} {:>3} {:>5}  state",
        "joint", "id", "at", "goal", "", "load", "A", "°C", "V",
    );
    for ((joint, _, _), view) in SO101_JOINTS.iter().zip(views) {
        let _ = writeln!(
            text,
            "  {joint:13} {:>3} {:>5} {:>5} [{}]    {:>4.0}% {:>4.1} {:>3.0} {:>5.1}  {}",
            view.id,
            view.position_steps,
            view.goal_steps,
            travel(view),
            view.duty * 100.0,
            view.current_a,
            view.temperature_c,
            view.supply_v,
            state(view),
        );
    }
    let faults = around.faults.iter().map(|(_, fault)| fault.to_string());
    let faults: Vec<String> = faults.collect();
    let faults = if faults.is_empty() {
        "none".to_owned()
    } else {
        faults.join("  ")
    };
    let _ = write!(
        text,
        "\nfaults: {faults}\nthis computer let the port wait for up to {:.1} ms\n{}\n\nA fault starts or ends it, such as gone=3; quit ends all; more: armctl sim --help\n",
        around.stall.as_secs_f64() * 1e3,
        around.said,
    );
    text
}

fn travel(view: &View) -> String {
    let mut picture = vec![' '; TRAVEL];
    let cell = |steps: i32| {
        let steps = steps.clamp(0, TURN - 1);
        usize::try_from(steps).unwrap_or(0) * TRAVEL / TURN as usize
    };
    if view.has_torque {
        picture[cell(view.goal_steps)] = '|';
    }
    picture[cell(view.position_steps)] = 'o';
    picture.into_iter().collect()
}

/// What a servo does and what it complains of.
pub fn state(view: &View) -> String {
    if view.supply_v == 0.0 {
        return "no power".to_owned();
    }
    let mut words = vec![if view.has_torque { "holds" } else { "limp" }];
    for (bit, word) in [
        (status::VOLTAGE, "VOLTAGE"),
        (status::TEMPERATURE, "HOT"),
        (status::CURRENT, "CURRENT"),
        (status::OVERLOAD, "OVERLOAD"),
    ] {
        if view.status & bit != 0 {
            words.push(word);
        }
    }
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use robot_servo_model::{Bus, Version, so101_servos};

    use super::*;

    #[test]
    fn each_joint_has_a_line_with_its_state() {
        let mut bus = Bus::new(so101_servos(Version::Volts12), 1);
        bus.start(Fault::Gone { servo: 5 });
        bus.start(Fault::Supply { volts: 16.0 });
        bus.advance(2_000_000);
        let faults: Vec<_> = bus.faults().collect();
        let around = Around {
            port: Path::new("/dev/pts/9"),
            faults: &faults,
            stall: Duration::from_micros(1400),
            said: "",
        };
        let text = picture(&bus.view(), &around);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[3].contains("shoulder_pan    1  2048  2048"), "{text}");
        assert!(lines[3].ends_with("16.0  limp VOLTAGE"), "{text}");
        assert!(lines[8].ends_with("no power"), "{text}");
        assert!(text.contains("faults: gone=6  supply=16V"), "{text}");
        assert!(text.contains("up to 1.4 ms"), "{text}");
    }

    #[test]
    fn a_picture_over_the_last_leaves_the_cursor_where_it_is() {
        assert_eq!(drawn("a\nb\n", true), "\x1b[2J\x1b[Ha\nb\n> ");
        assert_eq!(drawn("a\nb\n", false), "\x1b7\x1b[Ha\x1b[K\nb\x1b[K\n\x1b8");
    }

    #[test]
    fn the_place_of_a_joint_is_that_of_its_position() {
        let mut view = Bus::new(so101_servos(Version::Volts12), 1).view()[0];
        for (steps, place) in [(0, 0), (2048, 16), (4095, 31), (-5, 0), (9000, 31)] {
            view.position_steps = steps;
            assert_eq!(travel(&view).find('o'), Some(place));
        }
    }
}
