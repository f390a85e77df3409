use super::*;
use crate::{
    domain::{
        FlashRequest, ImuState, LogicBus, MagState, ParamStatus, PcCommand, RemoteUpdate,
        StandardId, SystemHealth,
    },
    motor::layout::REPLY_PERIOD_TICKS,
    safety::WatchdogPeriod,
    tick::RobotLoop,
};

/// The firmware's loop on a level robot at rest that receives reports of its two wheels.
struct Bench {
    control: RobotLoop,
    remote: RemoteUpdate,
    mag: MagState,
    logic: LogicBus,
    pc: PcCommand,
    health: SystemHealth,
    params: ParamStatus,
    /// Speed of the wheels, forward positive.
    rpm: i16,
    now_us: u64,
}

impl Bench {
    fn new() -> Self {
        Self {
            control: RobotLoop::new(
                &ROBOT_LAYOUT,
                RobotConfig::default(),
                Box::leak(Box::default()),
            ),
            remote: RemoteUpdate::default(),
            mag: MagState::default(),
            logic: LogicBus::default(),
            pc: PcCommand::default(),
            health: SystemHealth::default(),
            params: ParamStatus::default(),
            rpm: 0,
            now_us: 1_000_000,
        }
    }

    fn hear(&mut self, bus: BusId, id: u16, payload: [u8; 8]) {
        let frame = CanFrame::new(StandardId::new(id).unwrap(), payload);
        self.control.on_can_frame(bus, &frame, self.now_us);
    }

    fn tick(&mut self) -> ControlOutputs<'_> {
        self.now_us += 1_000;
        for (id, rpm) in [(0x201, self.rpm), (0x202, -self.rpm)] {
            let [high, low] = rpm.to_be_bytes();
            let angle = (self.now_us / 1_000 % 256) as u8;
            self.hear(BusId::Can1, id, [0, angle, high, low, 0, 0, 30, 0]);
        }
        let sample_us = self.now_us / 5_000 * 5_000;
        let imu = ImuState {
            accel_mps2: [0.0, 0.0, 9.81],
            ts_us: sample_us,
            ..ImuState::default()
        };
        let inputs = ControlInputs {
            remote: &self.remote,
            imu: &imu,
            mag: &self.mag,
            logic: &self.logic,
            pc: &self.pc,
            health: &self.health,
            params: &self.params,
            flash_request: FlashRequest::None,
            watchdog: WatchdogPeriod::Short,
        };
        self.control.tick(&inputs, self.now_us)
    }

    fn run(&mut self, ticks: u32) -> ControlOutputs<'_> {
        for _ in 1..ticks {
            self.tick();
        }
        self.tick()
    }

    /// Replies of the tuning channel in its slot.
    fn replies(&mut self) -> std::vec::Vec<(BusId, [u8; 8])> {
        let mut replies = std::vec::Vec::new();
        for _ in 0..REPLY_PERIOD_TICKS {
            let frames = self.tick().frames.iter();
            let of_channel = frames.filter(|(_, frame)| frame.id().raw() == 0x7A2);
            replies.extend(of_channel.map(|(bus, frame)| (*bus, frame.full_payload().unwrap())));
        }
        replies
    }
}

/// Wheels of twice the radius, 120 mm; the rest as shipped (docs/tuning.md).
const TWICE_AS_LARGE: [u8; 8] = [0x10, 120, 0, 0xA4, 0x01, 0x80, 0x07, 0x02];

#[test]
fn new_settings_are_acknowledged_and_published() {
    let mut bench = Bench::new();
    assert_eq!(bench.run(8).diagnostics.tuning.revision, 0);
    bench.hear(BusId::Can2, 0x7A0, TWICE_AS_LARGE);
    let outputs = bench.tick();
    assert_eq!(outputs.config.wheel_odom.wheel_radius_m, 0.12);
    assert_eq!(outputs.diagnostics.tuning.revision, 1);
    assert_eq!(outputs.diagnostics.tuning.accepted, 1);
    let mut bench = Bench::new();
    bench.hear(BusId::Can2, 0x7A0, TWICE_AS_LARGE);
    assert_eq!(bench.replies(), [(BusId::Can2, TWICE_AS_LARGE)]);
    assert_eq!(bench.replies(), []);
}

#[test]
fn the_estimator_uses_new_wheel_geometry() {
    let speed_mps = |tuned: bool| {
        let mut bench = Bench::new();
        // The wheels must turn from the start: wheels that speed up under a robot at rest count as spinning.
        bench.rpm = 1_000;
        bench.run(500);
        if tuned {
            bench.hear(BusId::Can1, 0x7A0, TWICE_AS_LARGE);
        }
        let [east_mps, north_mps, _] = bench.run(3_000).estimate.vel_mps;
        east_mps.hypot(north_mps)
    };
    let (before, after) = (speed_mps(false), speed_mps(true));
    assert!((0.3..0.35).contains(&before), "{before} m/s");
    assert!((after / before - 2.0).abs() < 0.05, "{before}, {after} m/s");
}

#[test]
fn diagnostics_show_the_newest_value_of_each_producer() {
    let mut bench = Bench::new();
    for ts_us in 1..=3 {
        bench.remote.state.ts_us = ts_us;
        bench.remote.operator.ts_us = ts_us;
        bench.mag.ts_us = ts_us;
        bench.logic.ts_us = ts_us;
        bench.health.late_tasks.status = ts_us == 2;
        let late_tasks = bench.health.late_tasks;
        let seen = bench.tick().diagnostics;
        assert_eq!(seen.remote.ts_us, ts_us);
        assert_eq!(seen.operator.ts_us, ts_us);
        assert_eq!(seen.sensors.mag.ts_us, ts_us);
        assert_eq!(seen.logic.ts_us, ts_us);
        assert_eq!(seen.late_tasks, late_tasks);
        let (ts_us, now_us) = (seen.ts_us, bench.now_us);
        assert_eq!(ts_us, now_us);
    }
}

#[test]
fn slow_diagnostics_are_updated_every_tenth_tick() {
    let mut bench = Bench::new();
    while !bench.tick().diagnostics.tick.count.is_multiple_of(10) {}
    bench.health.battery_v = 25.0;
    bench.params.save_ok = 7;
    for ms in 1..=10 {
        let seen = bench.tick().diagnostics;
        let is_new = (seen.battery_v == 25.0, seen.params.save_ok == 7);
        assert_eq!(is_new, (ms == 10, ms == 10), "{ms} ms");
    }
}
