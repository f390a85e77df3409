//! A robot at the other end of a pseudo-terminal: the codec of the firmware, and answers to reads.

use std::{
    io::{ErrorKind, Read, Write},
    sync::{Arc, Mutex, mpsc},
    thread,
    time::Duration,
};

use robot_app::{
    domain::{CanFrame, PcCommand},
    link::{Keys, MotorState, Received, RobotReceiver, Tunnelled, Uplink},
    tuning::{REPLY_ID, opcode},
};
use serialport::{SerialPort, TTYPort};

const STATE_PERIOD_S: f32 = 0.0024;

/// What the robot has of the world.
#[derive(Clone, Copy)]
pub struct World {
    pub keys: Keys,
    /// The robot goes on sending its state.
    pub is_connected: bool,
}

pub struct Robot {
    /// Name of the port.
    pub port: String,
    /// Commands in their order.
    pub commands: mpsc::Receiver<PcCommand>,
    pub world: Arc<Mutex<World>>,
}

impl Robot {
    pub fn new(keys: Keys) -> Self {
        // The other end is closed again, because it is locked for its first user.
        let (master, slave) = TTYPort::pair().expect("a pseudo-terminal");
        let port = slave.name().expect("it has a name");
        drop(slave);
        let world = Arc::new(Mutex::new(World {
            keys,
            is_connected: true,
        }));
        let (sender, commands) = mpsc::channel();
        let seen = world.clone();
        thread::spawn(move || live(master, &seen, &sender));
        Self {
            port,
            commands,
            world,
        }
    }

    pub fn press(&self, keys: Keys) {
        self.world.lock().expect("nobody panics").keys = keys;
    }
}

/// Sends states and takes commands until the test ends.
fn live(mut port: TTYPort, world: &Mutex<World>, commands: &mpsc::Sender<PcCommand>) {
    let mut receiver = RobotReceiver::new();
    port.set_timeout(Duration::from_millis(2))
        .expect("a time-out");
    for n in 1_u32.. {
        let World { keys, is_connected } = *world.lock().expect("nobody panics");
        let time_s = 10.0 + STATE_PERIOD_S * n as f32;
        let mut answers = Vec::new();
        if is_connected {
            answers.extend(state(time_s, keys).encode());
        }
        let mut bytes = [0; 1024];
        match port.read(&mut bytes) {
            Ok(count) => {
                receiver.feed(&bytes[..count], u64::from(n), |received| match received {
                    Received::Command(command) => {
                        let _ = commands.send(command);
                    }
                    Received::Tunnel(request) => answers.extend(answer(&request)),
                });
            }
            Err(error) if error.kind() == ErrorKind::TimedOut => {}
            // Nobody has the port open.
            Err(_) => thread::sleep(Duration::from_millis(2)),
        }
        // Nobody may be reading.
        let _ = port.write(&answers);
    }
}

fn state(time_s: f32, keys: Keys) -> Uplink {
    Uplink {
        time_s,
        battery_v: 24.0,
        accel_mps2: [0.0, 0.0, 9.8],
        q_xyzw: [0.0, 0.0, 0.0, 1.0],
        keys,
        motors: [MotorState {
            pos_rad: 0.25,
            vel_rps: 0.0,
        }; 6],
        ..Uplink::default()
    }
}

/// Every setting is 0.5, and live pages are all zeros: no blocker, no flag, verdict run.
fn answer(request: &CanFrame) -> Vec<u8> {
    let Some([command, first, second, ..]) = request.full_payload() else {
        return Vec::new();
    };
    let [a, b, c, d] = 0.5_f32.to_le_bytes();
    let data = match command {
        opcode::READ_PARAMETER => [command, first, second, 0, a, b, c, d],
        opcode::READ_LIVE => [command, first, 0, 0, 0, 0, 0, 0],
        _ => return Vec::new(),
    };
    let reply = Tunnelled::new(CanFrame::new(REPLY_ID, data)).expect("a tuning frame");
    reply.encode().to_vec()
}
