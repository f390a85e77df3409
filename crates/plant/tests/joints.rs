//! The leg joints through CAN2 alone: their frames, and what the world says of them. The frames are those of
//! docs/hardware.md#mit-frames, docs/hardware.md#dm4310-frames and docs/hardware.md#test-vectors.

use robot_plant::{
    robots::{self, JointMotor},
    time::{MS, Ps, US},
    wire::CanFrame,
    world::{CanBusId, World, WorldConfig},
};

const BUS: CanBusId = CanBusId::Can2;

struct Bench {
    world: World,
    now: Ps,
    events: Vec<(Ps, String, f64)>,
}

fn service(tail: u8) -> [u8; 8] {
    let mut data = [0xFF; 8];
    data[7] = tail;
    data
}

impl Bench {
    fn new(joints: JointMotor) -> Self {
        let config = WorldConfig {
            robot: robots::with_joints(joints),
            ..WorldConfig::default()
        };
        let mut world = World::new(config).expect("no file is read");
        world.advance(0);
        Self {
            world,
            now: 0,
            events: Vec::new(),
        }
    }

    fn send(&mut self, id: u32, data: [u8; 8]) {
        let frame = CanFrame::with_data(id, data);
        for node in 0..self.world.can_nodes(BUS) {
            if self.world.can_hears(BUS, node) {
                self.world.can_received(BUS, node, &frame, self.now);
            }
        }
    }

    /// Goes from event to event, as the emulator does, and delivers every reply on an idle bus at once.
    fn run_until(&mut self, end: Ps) -> Vec<CanFrame> {
        let mut replies = Vec::new();
        while self.now < end {
            let next = self.world.next_event();
            assert!(next > self.now, "time stands still");
            self.now = next.min(end);
            self.world.advance(self.now);
            for node in 0..self.world.can_nodes(BUS) {
                if let Some(frame) = self.world.can_pending(BUS, node, self.now) {
                    self.world.can_sent(BUS, node, self.now);
                    replies.push(frame);
                }
            }
        }
        let mut events = Vec::new();
        self.world.drain_wire_events(&mut events);
        let names = self.world.signal_names();
        let events = events
            .iter()
            .map(|event| (event.at, names[event.signal].clone(), event.value));
        self.events.extend(events);
        replies
    }

    fn wait(&mut self, time: Ps) -> Vec<CanFrame> {
        self.run_until(self.now + time)
    }

    fn signal(&self, name: &str) -> f64 {
        self.world.signal(name).expect(name)
    }

    fn fault(&mut self, name: &str, active: bool) {
        self.world.set_fault(name, active).expect("listed");
    }

    fn values_of(&self, name: &str) -> Vec<f64> {
        let of = self.events.iter().filter(|(_, signal, _)| signal == name);
        of.map(|(_, _, value)| *value).collect()
    }
}

#[test]
fn four_dm4310_answer_under_their_own_identifiers() {
    let mut bench = Bench::new(JointMotor::Dm4310);
    for id in 1..=4 {
        bench.send(id, service(0xFD));
        let replies = bench.wait(MS);
        assert_eq!(replies.len(), 1);
        assert_eq!(replies[0].id, 0x10 + id);
        assert_eq!(replies[0].data[0], id as u8);
    }
    assert_eq!(bench.wait(10 * MS), [], "nothing by themselves");
}

#[test]
fn four_rs00_answer_under_the_hosts_they_are_set_to() {
    let mut bench = Bench::new(JointMotor::Rs00);
    for id in 1..=4 {
        bench.send(id, service(0xFC));
        let replies = bench.wait(MS);
        assert_eq!(replies.len(), 1);
        assert_eq!((replies[0].id, replies[0].data[0]), (0xF0 + id, id as u8));
    }
    assert_eq!(bench.signal("can.joint.3.enabled"), 1.0);
}

/// Every 2 ms, p = 0.5 rad of the motor, kp 20, kd 1. Joint angle +0.5 on the left and −0.5 on the right; a link weighs
/// sin 0.5 = 0.48 N·m there, which gives way by 0.02 rad, and friction may hold it 0.01 rad off.
#[test]
fn held_poses_are_mirrored_on_the_right() {
    let mut bench = Bench::new(JointMotor::Dm4310);
    for id in [1, 3] {
        bench.send(id, service(0xFC));
        bench.wait(MS);
    }
    let half = [0x85, 0x1E, 0x7F, 0xF0, 0xA3, 0x33, 0x37, 0xFF];
    for _ in 0..500 {
        bench.send(1, half);
        bench.send(3, half);
        bench.wait(2 * MS);
    }
    for (joint, sign) in [(0, 1.0), (2, -1.0)] {
        let pos_rad = bench.signal(&format!("truth.joint.{joint}.pos_rad"));
        assert!((sign * pos_rad - 0.48).abs() < 0.02, "{joint}: {pos_rad}");
        let said_rad = bench.signal(&format!("can.joint.{joint}.pos_rad"));
        assert!((said_rad - sign * pos_rad).abs() < 1e-3, "{said_rad}");
        let torque_nm = bench.signal(&format!("truth.joint.{joint}.torque_nm"));
        assert!((sign * torque_nm - 0.47).abs() < 0.2, "{torque_nm}");
        let asked_nm = bench.signal(&format!("can.joint.{joint}.torque_nm"));
        assert!((asked_nm - sign * torque_nm).abs() < 0.01, "{asked_nm}");
    }
    assert_eq!(bench.signal("truth.joint.1.pos_rad"), 0.0);
    assert!(bench.signal("truth.joint.0.temperature_c") > 30.0);
    // Let go, the leg swings down and stays where friction holds it.
    bench.send(1, service(0xFD));
    bench.wait(2_000 * MS);
    let down_rad = bench.signal("truth.joint.0.pos_rad");
    assert!(down_rad.abs() < 0.151, "{down_rad}");
}

#[test]
fn enabling_torque_and_stopping_are_events_at_their_instants() {
    let mut bench = Bench::new(JointMotor::Dm4310);
    bench.wait(5 * MS);
    bench.send(2, service(0xFC));
    bench.wait(MS);
    // t = 0x800: 2.4e-3 N·m.
    bench.send(2, [0x7F, 0xFF, 0x7F, 0xF0, 0, 0, 0x08, 0x00]);
    bench.wait(MS);
    bench.send(2, service(0xFD));
    bench.wait(MS);
    assert_eq!(bench.values_of("can.joint.1.enabled"), [1.0, 0.0]);
    assert_eq!(bench.values_of("can.joint.1.stop_frames"), [1.0]);
    let torque = bench.values_of("can.joint.1.torque_nm");
    assert_eq!(torque.len(), 2);
    assert!((torque[0] - 2.442e-3).abs() < 1e-6);
    assert_eq!(torque[1], 0.0);
    let first = bench
        .events
        .iter()
        .find(|(_, name, _)| name.contains("enabled"));
    assert_eq!(first.map(|(at, _, _)| *at), Some(5 * MS));
    // The first reply speaks of −1.9e-4 rad, the code of zero, 150 µs after the frame.
    let said = bench
        .events
        .iter()
        .find(|(_, name, _)| name == "can.joint.1.pos_rad");
    let (at, _, value) = said.expect("a reply");
    assert_eq!(*at, 5 * MS + 150 * US);
    assert!((value + 1.907e-4).abs() < 1e-6);
}

#[test]
fn a_timeout_or_a_fault_disables_without_a_frame_and_is_an_event() {
    let mut bench = Bench::new(JointMotor::Dm4310);
    // TIMEOUT 2000 · 50 µs on the fourth motor.
    bench.send(0x7FF, [4, 0, 0x55, 9, 0xD0, 0x07, 0, 0]);
    bench.wait(200 * MS);
    bench.send(4, service(0xFC));
    let enabled_at = bench.now;
    bench.wait(200 * MS);
    assert_eq!(bench.values_of("can.joint.3.enabled"), [1.0, 0.0]);
    let (at, _, _) = bench
        .events
        .iter()
        .rfind(|(_, name, _)| name == "can.joint.3.enabled")
        .expect("told");
    let after = at - enabled_at;
    assert!((100 * MS..=100 * MS + 500 * US).contains(&after), "{after}");
    bench.send(1, service(0xFC));
    bench.wait(MS);
    bench.fault("motor-2-fault", true);
    bench.wait(MS);
    assert_eq!(bench.values_of("can.joint.0.enabled"), [1.0, 0.0]);
}

#[test]
fn motors_2_to_5_are_the_joints() {
    let mut bench = Bench::new(JointMotor::Dm4310);
    for (motor, id) in (2..6).zip(1..) {
        let joint = id as usize - 1;
        bench.fault(&format!("motor-{motor}-gone"), true);
        assert!(!bench.world.can_present(BUS, joint));
        bench.send(id, service(0xFD));
        assert_eq!(bench.wait(MS), []);
        bench.fault(&format!("motor-{motor}-gone"), false);
        bench.fault(&format!("motor-{motor}-hot"), true);
        let name = format!("truth.joint.{joint}.temperature_c");
        assert_eq!(bench.signal(&name), 120.0);
        bench.send(id, service(0xFD));
        assert_eq!(bench.wait(MS)[0].data[7], 120);
    }
}

#[test]
fn wheels_get_hot_and_change_their_numbers() {
    let mut bench = Bench::new(JointMotor::Dm4310);
    bench.fault("motor-0-hot", true);
    bench.fault("motor-1-wrong-id", true);
    bench.world.advance(5 * MS);
    let frames: Vec<CanFrame> = (0..2)
        .filter_map(|node| bench.world.can_pending(CanBusId::Can1, node, 5 * MS))
        .collect();
    assert_eq!((frames[0].id, frames[0].data[6]), (0x201, 120));
    assert_eq!((frames[1].id, frames[1].data[6]), (0x206, 30));
    let command = CanFrame::with_data(0x200, [0x10, 0, 0x10, 0, 0, 0, 0, 0]);
    for node in 0..2 {
        bench
            .world
            .can_received(CanBusId::Can1, node, &command, 5 * MS);
    }
    assert_eq!(bench.signal("can.m3508.0.current_ma"), 5_000.0);
    assert_eq!(bench.signal("can.m3508.1.current_ma"), 0.0);
}

#[test]
fn the_adapter_records_replies_of_the_tuning_channel() {
    use robot_plant::can_adapter::AdapterMode;
    let mut bench = Bench::new(JointMotor::Dm4310);
    let reply = [0x21, 3, 1, 0, 0, 0, 0x80, 0x3F];
    bench.send(0x7A2, reply);
    assert_eq!(bench.signal("can.tuning.replies"), 0.0, "nobody listens");
    assert!(bench.signal("can.tuning.reply.0").is_nan());
    bench.world.can_adapter(BUS).set_mode(AdapterMode::Active);
    bench.send(0x7A2, reply);
    bench.send(0x7A1, [0; 8]);
    assert_eq!(bench.signal("can.tuning.replies"), 1.0);
    for (index, byte) in reply.iter().enumerate() {
        let name = format!("can.tuning.reply.{index}");
        assert_eq!(bench.signal(&name), f64::from(*byte));
    }
}

/// Frames of every kind with random payloads, floats at their worst, and faults in between.
#[test]
fn no_frame_makes_a_joint_stronger_than_its_motor_or_its_numbers_infinite() {
    for (kind, peak_nm) in [(JointMotor::Dm4310, 7.0), (JointMotor::Rs00, 14.0)] {
        let mut bench = Bench::new(kind);
        // A generator of its own: the numbers of Knuth's MMIX.
        let mut state = 1_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            state >> 16
        };
        let floats = [
            0.0,
            1.0,
            -2.0,
            f32::MAX,
            f32::MIN,
            f32::MIN_POSITIVE,
            f32::NAN,
            f32::INFINITY,
        ];
        let mut most_nm: f64 = 0.0;
        for _ in 0..1_000 {
            let id = 1 + random() as u32 % 4;
            let first = floats[random() as usize % floats.len()].to_le_bytes();
            let second = floats[random() as usize % floats.len()].to_le_bytes();
            let two_floats = [first, second].concat().try_into().expect("eight bytes");
            match random() % 8 {
                0 => bench.send(id, service([0xFB, 0xFC, 0xFD, 0xFE][random() as usize % 4])),
                1 | 2 => bench.send(id, service(0xFC)),
                3 => bench.send(id, random().to_be_bytes()),
                4 => bench.send(0x100 + id, two_floats),
                5 => bench.send(0x200 + id, two_floats),
                6 => {
                    let register = [9, 0x15, 0x16, 0x17][random() as usize % 4];
                    let [a, b, c, d] = first;
                    bench.send(0x7FF, [id as u8, 0, 0x55, register, a, b, c, d]);
                }
                _ => {
                    let [mode, tail] = [random() as u8 % 4, 0xFC];
                    let service = [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, mode, tail];
                    bench.send(id, service);
                    bench.send(0x7FF, [id as u8, 0, 0x55, 10, mode, 0, 0, 0]);
                }
            }
            bench.wait((1 + random() % 40) * MS);
            for joint in 0..4 {
                let torque_nm = bench.signal(&format!("truth.joint.{joint}.torque_nm"));
                let speed_rps = bench.signal(&format!("truth.joint.{joint}.vel_rps"));
                let asked_nm = bench.signal(&format!("can.joint.{joint}.torque_nm"));
                assert!(torque_nm.abs() <= peak_nm && asked_nm.is_finite());
                assert!(speed_rps.abs() < 60.0, "{speed_rps}");
                most_nm = most_nm.max(torque_nm.abs());
            }
        }
        assert_eq!(most_nm, peak_nm, "{kind:?}");
    }
}

#[test]
fn a_frame_beyond_the_model_is_reported() {
    let mut bench = Bench::new(JointMotor::Dm4310);
    bench.send(0x7FF, [1, 0, 0x33, 0x50, 0, 0, 0, 0]);
    let complaints = bench.world.take_complaints();
    assert!(complaints[0].text.contains("0x50"), "{complaints:?}");
}
