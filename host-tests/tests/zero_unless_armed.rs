//! Whatever comes in: no torque unless every condition of design.md section 3 holds, never more than the limit, no
//! panic, no NaN in the estimate. The conditions are written here from the rules, from what goes into the tick alone.

use proptest::prelude::*;
use robot_app::{
    control::{ChassisController, ChassisControllerInput, ChassisControllerOutput},
    domain::{
        BusErrorState, BusHealth, BusId, CanFrame, ChassisCommand, HighLevelCommand, ImuState,
        MagState, OperatorState, RemoteDiagnostics, RemoteState, RemoteUpdate, StandardId,
        StateEstimate, SystemHealth, WheelCommand,
    },
    logic::LogicBus,
    tick::{ControlConfig, ControlInputs, ControlLoop},
};

/// C620 counts of the 8 A limit: 8000 · 16384 / 20000, rounded up.
const LIMIT_COUNTS: i32 = 6_554;
const REMOTE_TIMEOUT_US: u64 = 100_000;
const IMU_TIMEOUT_US: u64 = 25_000;
const COMMAND_TIMEOUT_US: u64 = 50_000;

/// A user's controller gone wrong: asks for whatever it is told.
struct Rogue(f32);

impl ChassisController for Rogue {
    fn step(&mut self, _: &ChassisControllerInput<'_>) -> ChassisControllerOutput {
        ChassisControllerOutput {
            cmd: ChassisCommand {
                wheels: [
                    WheelCommand { current_ma: self.0 },
                    WheelCommand {
                        current_ma: -self.0,
                    },
                ],
            },
            cmd_valid: true,
        }
    }
}

/// One stretch of ticks in which the same things are right or wrong.
#[derive(Clone, Debug)]
struct Phase {
    ticks: u16,
    enabled: bool,
    e_stop: bool,
    failsafe: bool,
    radio_sends: bool,
    quality: f32,
    sticks: (f32, f32),
    imu_sends: bool,
    accel: [f32; 3],
    gyro: [f32; 3],
    gyro_bias: [f32; 3],
    mag: [f32; 3],
    calibrated: bool,
    can1: BusErrorState,
    logic_sends: bool,
    imu_errors: u32,
    time_jump_us: u64,
    frame: (u16, Vec<u8>),
}

/// Mostly as it should be, with anything possible.
fn mostly<T: Clone + std::fmt::Debug + 'static>(
    usual: T,
    odd: impl Strategy<Value = T> + 'static,
) -> impl Strategy<Value = T> {
    prop_oneof![9 => Just(usual), 1 => odd]
}

fn phases() -> impl Strategy<Value = Vec<Phase>> {
    let switches = (
        any::<bool>(),
        mostly(false, Just(true)),
        mostly(false, Just(true)),
    );
    let radio = (
        mostly(true, Just(false)),
        mostly(1.0, any::<f32>()),
        mostly((0.0, 0.0), any::<(f32, f32)>()),
    );
    let imu = (
        mostly(true, Just(false)),
        mostly([0.0, 0.0, 9.81], any::<[f32; 3]>()),
        mostly([0.0; 3], any::<[f32; 3]>()),
        mostly([0.0; 3], any::<[f32; 3]>()),
        mostly([0.0, 20.0, -45.0], any::<[f32; 3]>()),
        mostly(true, Just(false)),
    );
    let rest = (
        mostly(BusErrorState::Active, Just(BusErrorState::BusOff)),
        mostly(true, Just(false)),
        mostly(0, any::<u32>()),
        mostly(0, any::<u64>()),
        (any::<u16>(), prop::collection::vec(any::<u8>(), 0..=8)),
    );
    let phase =
        (1u16..300, switches, radio, imu, rest).prop_map(|(ticks, switches, radio, imu, rest)| {
            Phase {
                ticks,
                enabled: switches.0,
                e_stop: switches.1,
                failsafe: switches.2,
                radio_sends: radio.0,
                quality: radio.1,
                sticks: radio.2,
                imu_sends: imu.0,
                accel: imu.1,
                gyro: imu.2,
                gyro_bias: imu.3,
                mag: imu.4,
                calibrated: imu.5,
                can1: rest.0,
                logic_sends: rest.1,
                imu_errors: rest.2,
                time_jump_us: rest.3,
                frame: rest.4,
            }
        });
    prop::collection::vec(phase, 1..12)
}

/// The rules, as far as they can be told from the inputs without knowing the estimator.
#[derive(Default)]
struct Rules {
    /// The enable switch was off in a fresh frame, since boot or since the last stop.
    seen_off: bool,
    /// And then on.
    cycled: bool,
    /// Torque was on since then, so the next stop uses the switch up.
    driving: bool,
}

impl Rules {
    /// True if torque may leave now.
    fn allow(&mut self, inputs: &ControlInputs<'_>, now_us: u64) -> bool {
        let fresh = |ts_us: u64, limit_us| ts_us != 0 && now_us.saturating_sub(ts_us) <= limit_us;
        let remote_fresh = fresh(inputs.remote.diagnostics.good_ts_us, REMOTE_TIMEOUT_US);
        let operator = &inputs.remote.operator;
        let stopped = !remote_fresh
            || !operator.enabled
            || operator.e_stop
            || inputs.remote.diagnostics.failsafe
            || inputs.remote.diagnostics.quality < 0.5
            || !inputs.health.imu_calibrated
            || !fresh(inputs.imu.ts_us, IMU_TIMEOUT_US);
        if stopped && self.driving {
            *self = Self::default();
        }
        if remote_fresh {
            self.cycled = operator.enabled && self.seen_off;
            self.seen_off |= operator.disabled;
        }
        self.cycled
            && !stopped
            && inputs.health.can[0].state != BusErrorState::BusOff
            && fresh(inputs.logic.ts_us, COMMAND_TIMEOUT_US)
    }
}

fn sent_counts(frames: &[(BusId, CanFrame)]) -> [i32; 4] {
    let [(BusId::Can1, frame)] = frames else {
        panic!("one command frame a tick, on CAN1");
    };
    assert_eq!(frame.id().raw(), 0x200);
    let data = frame.full_payload().expect("eight bytes");
    std::array::from_fn(|slot| i16::from_be_bytes([data[2 * slot], data[2 * slot + 1]]).into())
}

/// Whatever the sensors said, what comes out is a rotation and finite numbers.
fn assert_sound(estimate: &StateEstimate) {
    let squared: f32 = estimate.q_wxyz.iter().map(|part| part * part).sum();
    assert!((squared - 1.0).abs() < 1e-4, "{estimate:?}");
    let vectors = [
        estimate.rpy_rad,
        estimate.vel_mps,
        estimate.pos_m,
        estimate.gyro_bias_rps,
    ];
    assert!(vectors.iter().flatten().all(|part| part.is_finite()));
}

/// Runs the phases and says for how many ticks torque was on.
fn run(phases: &[Phase], demand_ma: f32) -> usize {
    let mut control = ControlLoop::new(ControlConfig::default(), Rogue(demand_ma));
    let mut rules = Rules::default();
    let mut now_us = 1_000_000u64;
    let (mut remote, mut imu, mut logic) = (
        RemoteUpdate::default(),
        ImuState::default(),
        LogicBus::default(),
    );
    let mut driven = 0;
    for phase in phases {
        now_us = now_us.saturating_add(phase.time_jump_us);
        for tick in 0..phase.ticks {
            now_us = now_us.saturating_add(1_000);
            if phase.radio_sends && tick % 7 == 0 {
                remote = remote_update(phase, now_us);
            }
            if phase.imu_sends && tick % 5 == 0 {
                imu = ImuState {
                    accel_mps2: phase.accel,
                    gyro_dps: phase.gyro,
                    gyro_bias_dps: phase.gyro_bias,
                    ts_us: now_us,
                    ..ImuState::default()
                };
            }
            if phase.logic_sends && tick % 10 == 0 {
                logic = LogicBus {
                    hl_cmd: HighLevelCommand {
                        vx: phase.sticks.0,
                        wz: phase.sticks.1,
                    },
                    hl_valid: true,
                    ts_us: now_us,
                    ..LogicBus::default()
                };
            }
            let can1 = BusHealth {
                state: phase.can1,
                ..BusHealth::default()
            };
            let mut health = SystemHealth {
                can: [can1, BusHealth::default()],
                imu_calibrated: phase.calibrated,
                ..SystemHealth::default()
            };
            health.imu.errors = phase.imu_errors;
            let id = StandardId::new(phase.frame.0 & 0x7FF).expect("11 bits");
            let frame = CanFrame::from_payload(id, &phase.frame.1).expect("at most eight bytes");
            control.on_can_frame(BusId::Can1, &frame, now_us);
            let inputs = ControlInputs {
                remote: &remote,
                imu: &imu,
                mag: &MagState {
                    mag_ut: phase.mag,
                    ts_us: now_us - now_us % 20_000,
                },
                logic: &logic,
                health: &health,
            };
            let allowed = rules.allow(&inputs, now_us);
            let outputs = control.tick(&inputs, now_us);
            let counts = sent_counts(outputs.frames);
            let zero = counts == [0; 4];
            assert!(allowed || zero, "torque {counts:?} at {now_us} µs");
            assert!(counts.iter().all(|count| count.abs() <= LIMIT_COUNTS));
            assert_eq!(counts[2..], [0, 0]);
            assert_sound(outputs.estimate);
            rules.driving |= !zero;
            driven += usize::from(!zero);
        }
    }
    driven
}

fn remote_update(phase: &Phase, now_us: u64) -> RemoteUpdate {
    RemoteUpdate {
        state: RemoteState {
            vx: phase.sticks.0,
            wz: phase.sticks.1,
            ts_us: now_us,
            ..RemoteState::default()
        },
        operator: OperatorState {
            enabled: phase.enabled,
            disabled: !phase.enabled,
            e_stop: phase.e_stop,
            mode: 0,
            ts_us: now_us,
        },
        diagnostics: RemoteDiagnostics {
            quality: phase.quality,
            frames: 1,
            failsafe: phase.failsafe,
            frame_ts_us: now_us,
            good_ts_us: now_us,
            ..RemoteDiagnostics::default()
        },
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nothing_moves_the_robot_against_the_rules(
        phases in phases(),
        demand_ma in prop_oneof![Just(5_000.0), any::<f32>()],
    ) {
        run(&phases, demand_ma);
    }
}

fn good(ticks: u16, enabled: bool) -> Phase {
    Phase {
        ticks,
        enabled,
        e_stop: false,
        failsafe: false,
        radio_sends: true,
        quality: 1.0,
        sticks: (0.0, 0.0),
        imu_sends: true,
        accel: [0.0, 0.0, 9.81],
        gyro: [0.0; 3],
        gyro_bias: [0.0; 3],
        mag: [0.0, 20.0, -45.0],
        calibrated: true,
        can1: BusErrorState::Active,
        logic_sends: true,
        imu_errors: 0,
        time_jump_us: 0,
        frame: (0x201, vec![0; 8]),
    }
}

/// Without this the property above could hold because nothing ever arms.
#[test]
fn with_everything_in_order_the_rogue_drives_at_its_limit() {
    let driven = run(&[good(1_000, false), good(500, true)], f32::INFINITY);
    assert_eq!(driven, 500);
}

#[test]
fn a_controller_that_asks_for_nan_gets_zero() {
    let driven = run(&[good(1_000, false), good(500, true)], f32::NAN);
    assert_eq!(driven, 0);
}

/// Each of these ends the drive, and the robot does not start again when it is over.
#[test]
fn every_cause_disarms_until_the_switch_moves() {
    type Cause = fn(&mut Phase);
    let causes: [(&str, Cause); 9] = [
        ("switch", |phase| phase.enabled = false),
        ("e-stop", |phase| phase.e_stop = true),
        ("failsafe", |phase| phase.failsafe = true),
        ("quality", |phase| phase.quality = 0.4),
        ("silence", |phase| phase.radio_sends = false),
        ("imu", |phase| phase.imu_sends = false),
        ("imu errors", |phase| phase.imu_errors = 100),
        ("nan", |phase| phase.gyro = [f32::NAN; 3]),
        ("overflow", |phase| phase.accel = [f32::MAX; 3]),
    ];
    for (name, cause) in causes {
        let mut bad = good(200, true);
        cause(&mut bad);
        let mut after = good(4_000, true);
        after.imu_errors = bad.imu_errors;
        let drive = [good(1_000, false), good(100, true)];
        let before = run(&drive, 5_000.0);
        assert_eq!(before, 100);
        let with_cause = [drive.to_vec(), vec![bad]].concat();
        let driven = run(&with_cause, 5_000.0);
        assert!(driven <= 210, "{name}: {driven} ticks");
        if name != "switch" {
            let and_after = [with_cause, vec![after]].concat();
            assert_eq!(run(&and_after, 5_000.0), driven, "{name}");
        }
    }
}
