//! The rules of docs/safety.md, written from what goes into the tick alone: as far as they can
//! be told without knowing the estimator and the motors' set-up, so each is necessary, not sufficient.

use robot_app::{
    domain::{BusErrorState, DriveMode, StandSwitch, WheelTarget},
    tick::ControlInputs,
};

use crate::motors::Behaviour;

const REMOTE_TIMEOUT_US: u64 = 100_000;
const IMU_TIMEOUT_US: u64 = 25_000;
const MAX_TX_FAILURES: u32 = 20;
const COMMAND_TIMEOUT_US: u64 = 50_000;
const PC_TIMEOUT_US: u64 = 100_000;
/// A stop whose cause must last has come at the latest this long after its time: 20 ms of jumping clock and a tick.
const SLACK_US: u64 = 25_000;

/// What is allowed to leave the board in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Allowed {
    /// Wheel currents.
    pub wheels: bool,
    /// Enabling joints.
    pub joints: bool,
    /// Commands to enabled joints.
    pub commands: bool,
}

/// How long a condition has held while the clock ran regularly.
#[derive(Default)]
struct Lasting(u64);

impl Lasting {
    fn for_us(&mut self, so: bool, dt_us: u64) -> u64 {
        self.0 = if so { self.0 + dt_us } else { 0 };
        self.0
    }
}

#[derive(Default)]
pub struct Rules {
    /// The enable switch was off in a fresh frame, since boot or since the last stop.
    seen_off: bool,
    /// And then on.
    cycled: bool,
    /// Torque was on since then, so the next stop uses the switch up.
    pub driving: bool,
    last_us: u64,
    empty: Lasting,
    wheel_hot: Lasting,
    joint_hot: Lasting,
    joint_gone: Lasting,
    gesture: Lasting,
    battery_latched: bool,
    fault_latched: bool,
    /// The PC has asked the wheels to rest since mode PC was chosen, the robot was stopped or the PC was lost.
    pc_rested: bool,
    /// The stand switch was down in a frame.
    seen_down: bool,
}

impl Rules {
    /// `joint_fault`: a joint's last answer told of a fault. `bring_up`: a step of it was asked for, so that a held
    /// dead-man switch may take the place of a command.
    pub fn allow(
        &mut self,
        inputs: &ControlInputs<'_>,
        wheels: [Behaviour; 2],
        joints: [Behaviour; 4],
        joint_fault: bool,
        bring_up: bool,
        now_us: u64,
    ) -> Allowed {
        // A condition that must last does not count as lasting while the clock runs unevenly.
        let dt_us = now_us.saturating_sub(self.last_us);
        let operator = &inputs.remote.operator;
        let gesture = operator.disabled && operator.e_stop;
        self.gesture.for_us(gesture, dt_us.min(20_000));
        let dt_us = if dt_us == 1_000 { dt_us } else { 0 };
        self.last_us = now_us;
        let battery_ok = self.battery_ok(inputs, dt_us);
        let run = self.pilot_wants(inputs, battery_ok, now_us);
        let fresh_command = is_fresh(inputs.logic.ts_us, COMMAND_TIMEOUT_US, now_us)
            || bring_up && operator.dead_man;
        // Bring-up takes the place of the PC too.
        let pc_ok = self.pc_may_steer(inputs, run, now_us) || bring_up;
        let fresh_command = fresh_command && pc_ok;
        let hot = |motor: &Behaviour| matches!(motor, Behaviour::Hot(celsius) if *celsius > 90);
        let too_long = 500_000 + SLACK_US;
        let wheel_hot = self.wheel_hot.for_us(wheels.iter().any(hot), dt_us) > too_long;
        let joint_hot = self.joint_hot.for_us(joints.iter().any(hot), dt_us) > too_long;
        let gone = joints.contains(&Behaviour::Gone);
        let joint_gone = self.joint_gone.for_us(gone, dt_us) > 50_000 + SLACK_US;
        let fault_stands = self.fault_stands(joint_fault);
        let [can1_ok, can2_ok] = inputs.health.can.map(|bus| {
            bus.state != BusErrorState::BusOff && bus.tx_failures_in_row <= MAX_TX_FAILURES
        });
        let joints_run = run && can2_ok && !joint_hot && !joint_gone && !fault_stands;
        Allowed {
            wheels: run && fresh_command && can1_ok && !wheel_hot,
            joints: joints_run,
            commands: joints_run && fresh_command,
        }
    }

    /// Switches, link and sensors.
    fn pilot_wants(&mut self, inputs: &ControlInputs<'_>, battery_ok: bool, now_us: u64) -> bool {
        let link = &inputs.remote.diagnostics;
        let remote_fresh = is_fresh(link.good_ts_us, REMOTE_TIMEOUT_US, now_us);
        let operator = &inputs.remote.operator;
        let good_quality = link.quality >= 0.5;
        let stopped = !remote_fresh
            || !operator.enabled
            || operator.e_stop
            || link.failsafe
            || !good_quality
            || !inputs.health.imu_calibrated
            || inputs.health.late_tasks.any()
            || !is_fresh(inputs.imu.ts_us, IMU_TIMEOUT_US, now_us)
            || !battery_ok;
        if stopped && self.driving {
            self.seen_off = false;
            self.cycled = false;
            self.driving = false;
        }
        if remote_fresh {
            self.cycled = operator.enabled && self.seen_off;
            self.seen_off |= operator.disabled;
        }
        self.cycled && !stopped
    }

    /// In mode PC: whether its command is fresh and it has rested since the last interruption, or the pilot asks for
    /// standing, which needs no PC. Of the joints only the motors know where they are.
    fn pc_may_steer(&mut self, inputs: &ControlInputs<'_>, run: bool, now_us: u64) -> bool {
        let pc = inputs.pc;
        let in_mode = inputs.remote.operator.mode == DriveMode::Pc;
        let is_fresh = pc.ts_us <= now_us && is_fresh(pc.ts_us, PC_TIMEOUT_US, now_us);
        let rests = |wheel: &WheelTarget| wheel.speed_rps.abs() <= 0.05 || wheel.kd == 0.0;
        self.pc_rested &= in_mode && is_fresh && run;
        self.pc_rested |= in_mode && is_fresh && pc.wheels.iter().all(rests);
        let stand = inputs.remote.operator.stand;
        self.seen_down |= stand == StandSwitch::Down;
        let asks_to_stand = self.seen_down && stand == StandSwitch::Up;
        !in_mode || self.pc_rested || asks_to_stand
    }

    /// False from the end of a second below 19 V until a clearing gesture may have ended it.
    fn battery_ok(&mut self, inputs: &ControlInputs<'_>, dt_us: u64) -> bool {
        let volts = inputs.health.battery_v;
        let empty = volts.is_nan() || (6.0..19.0).contains(&volts);
        // Shorter than it must be: it may have been cleared.
        let cleared = self.gesture.0 > 900_000;
        if self.empty.for_us(empty, dt_us) > 1_000_000 + SLACK_US {
            self.battery_latched = true;
        } else if cleared {
            self.battery_latched = false;
        }
        !self.battery_latched
    }

    /// True from a joint's fault until a clearing gesture may have ended it.
    fn fault_stands(&mut self, joint_fault: bool) -> bool {
        if joint_fault {
            self.fault_latched = true;
        } else if self.gesture.0 > 900_000 {
            self.fault_latched = false;
        }
        self.fault_latched
    }
}

fn is_fresh(ts_us: u64, limit_us: u64, now_us: u64) -> bool {
    ts_us != 0 && now_us.saturating_sub(ts_us) <= limit_us
}
