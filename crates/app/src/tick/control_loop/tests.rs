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

/// Wheels of twice the radius, 150 mm; the rest as shipped (docs/tuning.md).
const TWICE_AS_LARGE: [u8; 8] = [0x10, 150, 0, 0xA4, 0x01, 0x80, 0x07, 0x02];

#[test]
fn new_settings_are_acknowledged_and_published() {
    let mut bench = Bench::new();
    assert_eq!(bench.run(8).diagnostics.tuning.revision, 0);
    bench.hear(BusId::Can2, 0x7A0, TWICE_AS_LARGE);
    let outputs = bench.tick();
    assert_eq!(outputs.config.wheel_odom.wheel_radius_m, 0.15);
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
    assert!((0.375..0.435).contains(&before), "{before} m/s");
    assert!((after / before - 2.0).abs() < 0.05, "{before}, {after} m/s");
}

#[test]
fn diagnostics_show_the_newest_value_of_each_producer() {
    let mut bench = Bench::new();
    for ts_us in 1..=3 {
        bench.remote.state.ts_us = ts_us;
        bench.mag.ts_us = ts_us;
        bench.logic.ts_us = ts_us;
        bench.health.late_tasks.status = ts_us == 2;
        let late_tasks = bench.health.late_tasks;
        let seen = bench.tick().diagnostics;
        assert_eq!(seen.remote.ts_us, ts_us);
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
    bench.remote.operator.ts_us = 9;
    for ms in 1..=10 {
        let seen = bench.tick().diagnostics;
        assert_eq!(seen.operator.ts_us == 9, ms == 10, "{ms} ms");
        let is_new = (seen.battery_v == 25.0, seen.params.save_ok == 7);
        assert_eq!(is_new, (ms == 10, ms == 10), "{ms} ms");
    }
}

/// `11` asks for the wheel geometry as shipped: 75 mm, 420 mm, 19.20, right wheel reversed (docs/tuning.md).
#[test]
fn a_request_over_the_pc_link_is_answered_there() {
    let mut bench = Bench::new();
    bench.run(8);
    let id = |raw| StandardId::new(raw).unwrap();
    let read = CanFrame::from_payload(id(0x7A1), &[0x11]).unwrap();
    let strange = CanFrame::from_payload(id(0x201), &[0x11]).unwrap();
    for frame in [strange, read, read] {
        bench.control.on_link_frame(&frame, bench.now_us);
    }
    bench.hear(BusId::Can1, 0x7A1, [0x11, 0, 0, 0, 0, 0, 0, 0]);
    let expected = [0x11, 75, 0, 0xA4, 0x01, 0x80, 0x07, 0x02];
    let (mut on_link, mut on_bus) = (std::vec::Vec::new(), std::vec::Vec::new());
    for _ in 0..2 * REPLY_PERIOD_TICKS {
        let outputs = bench.tick();
        on_link.extend(
            outputs
                .link_frames
                .iter()
                .map(|frame| frame.payload().to_vec()),
        );
        let replies = outputs
            .frames
            .iter()
            .filter(|(_, frame)| frame.id() == id(0x7A2));
        on_bus.extend(replies.map(|(bus, _)| *bus));
    }
    // The second request of the slot is dropped, and the bus has a slot of its own.
    assert_eq!(on_link, [expected]);
    assert_eq!(on_bus, [BusId::Can1]);
    let status = bench.tick().diagnostics.tuning;
    assert_eq!((status.accepted, status.dropped), (2, 1));
}

/// `42` starts a recording of 1 s.
#[test]
fn samples_that_the_pc_link_asked_for_go_there() {
    let mut bench = Bench::new();
    bench.run(8);
    let id = StandardId::new(0x7A0).unwrap();
    let start = CanFrame::new(id, [0x42, 1, 0, 0, 0, 0, 0, 0]);
    bench.control.on_link_frame(&start, bench.now_us);
    let (mut accel, mut on_bus) = (0, 0);
    for _ in 0..1_100 {
        let outputs = bench.tick();
        let of_recording = |frame: &CanFrame| (0x7A3..=0x7A5).contains(&frame.id().raw());
        accel += outputs
            .link_frames
            .iter()
            .filter(|frame| frame.id().raw() == 0x7A3)
            .count();
        on_bus += outputs
            .frames
            .iter()
            .filter(|(_, frame)| of_recording(frame))
            .count();
        assert!(outputs.link_frames.len() <= 1);
    }
    assert_eq!(on_bus, 0);
    assert!((195..=201).contains(&accel), "{accel} samples of 200 Hz");
}

/// The link's own state may be two reports old.
#[test]
fn the_report_has_the_age_of_the_command_that_the_tick_used() {
    let mut bench = Bench::new();
    bench.run(10);
    let age_us = |bench: &mut Bench| {
        let report = bench.tick().diagnostics;
        (report.tick.count % 10, report.ts_us, report.pc_age_us)
    };
    assert_eq!(age_us(&mut bench).2, u32::MAX);
    bench.health.link.last_us = 1_000_000;
    for _ in 0..20 {
        bench.pc.ts_us = bench.now_us - 3_000;
        if let (0, ts_us, age_us) = age_us(&mut bench) {
            assert_eq!(ts_us - u64::from(age_us), bench.pc.ts_us);
            assert_eq!(age_us, 4_000);
        }
    }
}

#[test]
fn telemetry_shows_every_second_tick() {
    let mut bench = Bench::new();
    bench.rpm = 500;
    let mut times = std::vec::Vec::new();
    for _ in 0..600 {
        let outputs = bench.tick();
        let seen = outputs.diagnostics;
        if let Some(brief) = outputs.telemetry {
            times.push(brief.ts_us);
            assert_eq!(brief.ts_us, seen.ts_us);
            assert_eq!(brief.q_wxyz, seen.estimate.q_wxyz);
            assert_eq!(brief.flags, seen.safety.flags);
            assert_eq!(brief.wheel_rpm, [500, -500]);
        }
    }
    assert_eq!(times.len(), 300);
    assert!(times.windows(2).all(|pair| pair[1] - pair[0] == 2_000));
    bench.run(2);
    let [first, second] = [
        bench.tick().telemetry.copied(),
        bench.tick().telemetry.copied(),
    ];
    let brief = first.or(second).unwrap();
    // The bench's rotors turn by one count a tick, and by −255 at the end of 256 of them.
    let ticks = (brief.ts_us - 1_001_000) / 1_000;
    let counts = (ticks as i64 + 1_001_000 / 1_000 % 256) % 256 - 1_001 % 256;
    assert_eq!(brief.wheel_counts, [counts; 2]);
}
