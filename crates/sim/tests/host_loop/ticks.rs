//! Tick by tick.

use robot_app::{
    control::UserController,
    diagnostics::DiagnosticsSnapshot,
    domain::{BalanceState, FlashRequest, PcCommand},
    motor::layout::ROBOT_LAYOUT,
    safety::WatchdogPeriod,
    tick::{ControlInputs, ControlLoop},
};

use crate::image::{self, Inputs, Tick};

/// What the host's tick gives for the inputs of the image's.
struct Host {
    control: ControlLoop<UserController>,
    report: DiagnosticsSnapshot,
}

impl Host {
    fn tick(&mut self, inputs: &Inputs) {
        if let Some(stall_us) = inputs.stall_us {
            self.control.after_stall(stall_us, inputs.now_us);
        }
        for (bus, frame, at_us) in &inputs.frames {
            self.control.on_can_frame(*bus, frame, *at_us, &self.report);
        }
        let inputs_now = ControlInputs {
            remote: &inputs.remote,
            imu: &inputs.imu,
            mag: &inputs.mag,
            logic: &inputs.logic,
            pc: &PcCommand::default(),
            health: &inputs.health,
            params: &inputs.params,
            flash_request: FlashRequest::None,
            watchdog: WatchdogPeriod::Short,
        };
        self.control
            .tick(&inputs_now, inputs.now_us, &mut self.report);
    }
}

/// Names and values of what a tick decides, as the image calls them.
fn outputs(report: &DiagnosticsSnapshot) -> Vec<(String, f64)> {
    let mut all = Vec::new();
    let mut note = |name: String, value: f64| all.push((name, value));
    let lists: [(&str, &[f32]); 8] = [
        ("estimate.q_wxyz", &report.estimate.q_wxyz),
        ("estimate.rpy_rad", &report.estimate.rpy_rad),
        ("estimate.vel_mps", &report.estimate.vel_mps),
        ("estimate.pos_m", &report.estimate.pos_m),
        ("estimate.gyro_bias_rps", &report.estimate.gyro_bias_rps),
        ("balance.leg_m", &report.balance.leg_m),
        ("balance.lean_rad", &report.balance.lean_rad),
        ("balance.contact_n", &report.balance.contact_n),
    ];
    for (name, values) in lists {
        for (n, value) in values.iter().enumerate() {
            note(format!("{name}.{n}"), f64::from(*value));
        }
    }
    for (n, wheel) in report.command.wheels.iter().enumerate() {
        note(
            format!("command.wheels.{n}.current_ma"),
            wheel.current_ma.into(),
        );
    }
    for (n, joint) in report.command.joints.iter().enumerate() {
        let mut of_joint =
            |field: &str, value: f64| note(format!("command.joints.{n}.{field}"), value);
        of_joint("mode", f64::from(joint.mode as u32));
        of_joint("pos_rad", joint.pos_rad.into());
        of_joint("vel_rps", joint.vel_rps.into());
        of_joint("kp", joint.kp.into());
        of_joint("kd", joint.kd.into());
        of_joint("tau_nm", joint.tau_nm.into());
    }
    note(
        "arming.state".to_owned(),
        f64::from(report.arming.state as u8),
    );
    note("safety.flags".to_owned(), report.safety.flags.bits() as f64);
    note(
        "balance.state".to_owned(),
        f64::from(report.balance.state as u8),
    );
    note(
        "balance.phase".to_owned(),
        f64::from(report.balance.phase as u8),
    );
    note(
        "balance.airborne".to_owned(),
        f64::from(u8::from(report.balance.airborne)),
    );
    all
}

/// Names of what a tick decides.
pub fn output_names() -> Vec<String> {
    let report = DiagnosticsSnapshot::default();
    outputs(&report).into_iter().map(|(name, _)| name).collect()
}

fn assert_same(tick: &Tick, host: &DiagnosticsSnapshot) {
    for ((name, here), there) in outputs(host).iter().zip(&tick.outputs) {
        assert!(
            here.to_bits() == there.to_bits(),
            "{} µs: {name} is {here} on the host, {there} in the image",
            tick.inputs.now_us
        );
    }
}

/// From boot, while the robot sits, stands up, drives and is pushed. The image reports the state of its balance controller.
#[test]
fn a_tick_of_the_image_is_that_of_the_host_bit_for_bit() {
    let mut host = Host {
        control: ControlLoop::with_layout(
            &ROBOT_LAYOUT,
            ROBOT_LAYOUT.default_config(),
            UserController::default(),
        ),
        report: DiagnosticsSnapshot::default(),
    };
    let mut balanced = 0;
    for tick in &image::run(&output_names()).ticks {
        host.tick(&tick.inputs);
        assert_same(tick, &host.report);
        balanced += u32::from(host.report.balance.state == BalanceState::Balance);
    }
    println!("{balanced} ticks of a balancing robot");
    assert!(balanced > 4_000);
}
