//! Shows what all joints do.

use std::{
    io::{IsTerminal, stdout},
    time::Duration,
};

use anyhow::Result;
use robot_arm::controller::{JointState, States};
use serde_json::json;

use super::{
    connection::{Arm, warn},
    output::{say, write},
    stop::Stop,
};

#[derive(clap::Args)]
#[command(after_help = "The torque stays as it is. Ctrl-C ends.

Examples:
  armctl monitor --port /dev/ttyACM0 --arm left_arm.json
  armctl monitor --port /dev/ttyACM0 --json --seconds 10 > states.jsonl")]
pub struct Monitor {
    #[command(flatten)]
    arm: Arm,
    /// Print one line of JSON for each reading
    #[arg(long)]
    json: bool,
    /// End after so many seconds
    #[arg(long, value_name = "S")]
    seconds: Option<f64>,
    /// Readings a second
    #[arg(long, value_name = "HZ", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=500))]
    rate: u32,
}

impl Monitor {
    pub fn run(self) -> Result<()> {
        let stop = Stop::catch()?;
        let mut arm = self.arm.open()?;
        let period = Duration::from_secs(1) / self.rate;
        let started = arm.bus().now();
        let mut next = started;
        while !stop.is_caught() {
            let states = arm.read_states()?;
            let elapsed_s = (arm.bus().now() - started).as_secs_f64();
            if self.json {
                say!("{}", json_line(elapsed_s, &states))?;
            } else {
                if stdout().is_terminal() {
                    write(format_args!("\x1b[2J\x1b[H"))?;
                }
                table(&states)?;
                warn(&mut arm)?;
            }
            if self.seconds.is_some_and(|end| elapsed_s >= end) {
                break;
            }
            next += period;
            arm.bus().wait_until(next)?;
        }
        Ok(())
    }
}

fn json_line(time_s: f64, states: &States) -> String {
    let joint = |state: &JointState| {
        json!({
            "position_steps": state.position_steps,
            "speed_steps_s": state.speed_steps_s,
            "load_permille": state.load_permille,
            "voltage_v": f64::from(state.voltage_dv) / 10.0,
            "temperature_c": state.temperature_c,
            "current_ma": state.current_ma,
            "alarms": state.alarms.to_string(),
        })
    };
    let joints = states
        .joints
        .iter()
        .map(|(name, state)| (name.clone(), joint(state)));
    let joints: serde_json::Map<String, serde_json::Value> = joints.collect();
    let errors: Vec<String> = states.errors.iter().map(ToString::to_string).collect();
    json!({ "time_s": time_s, "joints": joints, "errors": errors }).to_string()
}

fn table(states: &States) -> Result<()> {
    say!("joint             position   speed    load   current  voltage  temperature  alarms")?;
    for (name, state) in &states.joints {
        say!(
            "{name:<16} {:6} st {:5} st/s {:5.1} % {:6} mA {:6.1} V {:9} °C  {}",
            state.position_steps,
            state.speed_steps_s,
            f64::from(state.load_permille) / 10.0,
            state.current_ma,
            f64::from(state.voltage_dv) / 10.0,
            state.temperature_c,
            state.alarms
        )?;
    }
    for error in &states.errors {
        say!("{error}")?;
    }
    Ok(())
}
