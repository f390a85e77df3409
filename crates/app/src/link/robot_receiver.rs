//! The robot's end of the line: bytes → commands of the PC.

use super::{
    BAUD, DOWNLINK_LEN, DRIVE_HEADER, Downlink, DriveFrame, HEADER, TUNNEL_HEADER, Tunnelled,
    scanner::{Found, Frame, Scanner, Shape},
    tunnel::TUNNEL_SHAPE,
};
use crate::domain::{CanFrame, LinkHealth, PcCommand, PcKind};

/// A frame of which nothing more comes for this long is given up.
const SILENCE_US: u64 = 20_000;
/// Time of a byte on the line, with start and stop bit.
const BYTE_NS: u32 = 1_000_000_000 / (BAUD / 10);

static COMMAND_SHAPE: Shape = Shape::new(DOWNLINK_LEN);

/// What a frame from the PC brings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Received {
    /// Targets for the motors or the controller.
    Command(PcCommand),
    /// A request on the tuning channel.
    Tunnel(CanFrame),
}

/// Decodes what the PC sends.
///
/// A frame that follows on damaged bytes is counted as good, but not used: 8 bits of CRC alone would let about one false
/// command a second through on a line full of noise. The next frame in an unbroken row is used again.
///
/// ```
/// use robot_app::link::{Downlink, Received, RobotReceiver};
///
/// let mut receiver = RobotReceiver::new();
/// let mut commands = Vec::new();
/// receiver.feed(&Downlink::default().encode(), 2_000, |received| {
///     if let Received::Command(command) = received {
///         commands.push(command);
///     }
/// });
/// assert_eq!(commands.len(), 1);
/// assert_eq!(commands[0].ts_us, 2_000);
/// assert_eq!(commands[0].wheels[0].kd, 0.0);
/// ```
#[derive(Clone, Debug)]
pub struct RobotReceiver {
    scanner: Scanner,
    health: LinkHealth,
    newest: PcCommand,
    last_byte_us: u64,
}

/// Which frames are used.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Trust {
    /// Those in an unbroken row.
    InARow,
    None,
}

/// A frame as it is on the line.
#[derive(Clone, Copy, Debug)]
enum FromPc {
    Command(Downlink),
    Drive(DriveFrame),
    Tunnel(Tunnelled),
}

impl Frame for FromPc {
    fn shape(header: u8) -> Option<&'static Shape> {
        match header {
            HEADER => Some(&COMMAND_SHAPE),
            TUNNEL_HEADER | DRIVE_HEADER => Some(&TUNNEL_SHAPE),
            _ => None,
        }
    }

    fn read(bytes: &[u8]) -> Option<Self> {
        if let Ok(frame) = bytes.try_into() {
            return Downlink::decode(frame).map(Self::Command);
        }
        let frame = bytes.try_into().ok()?;
        let tunnelled = Tunnelled::decode(frame).map(Self::Tunnel);
        tunnelled.or_else(|| DriveFrame::decode(frame).map(Self::Drive))
    }
}

impl Default for RobotReceiver {
    fn default() -> Self {
        Self::new()
    }
}

impl RobotReceiver {
    /// A receiver that has seen no byte yet.
    pub fn new() -> Self {
        Self {
            scanner: Scanner::new(),
            health: LinkHealth::default(),
            newest: PcCommand::default(),
            last_byte_us: 0,
        }
    }

    /// Takes the bytes that arrived up to `ts_us`, the time of the last one, in chunks of any length. `sink` gets what
    /// each frame brings. After 20 ms of silence it wants a call without bytes, which gives up a frame that was cut.
    pub fn feed(&mut self, bytes: &[u8], ts_us: u64, sink: impl FnMut(Received)) {
        self.scan(bytes, ts_us, Trust::InARow, sink);
    }

    /// Takes bytes of which the UART flagged or lost some, with `errors` errors. Nothing that is even in part among them
    /// is used, nor is the first frame after them, unless it follows directly on one.
    pub fn feed_damaged(&mut self, bytes: &[u8], errors: u32, ts_us: u64) {
        self.health.line_errors = self.health.line_errors.wrapping_add(errors);
        self.scanner.mark_gap();
        self.scan(bytes, ts_us, Trust::None, |_| ());
        if self.scanner.held() > 0 {
            self.scanner.mark_gap();
        }
    }

    fn scan(&mut self, bytes: &[u8], ts_us: u64, trust: Trust, mut sink: impl FnMut(Received)) {
        let Self {
            scanner,
            health,
            newest,
            last_byte_us,
        } = self;
        let mut accept = |found: Found<FromPc>, ts_us: u64| match found.frame {
            _ if !found.contiguous || trust == Trust::None => {
                health.unconfirmed = health.unconfirmed.wrapping_add(1);
            }
            FromPc::Tunnel(tunnelled) => {
                health.tunnelled = health.tunnelled.wrapping_add(1);
                sink(Received::Tunnel(tunnelled.can_frame()));
            }
            FromPc::Command(Downlink { wheels, joints }) => {
                let targets = PcCommand {
                    wheels,
                    joints,
                    ..PcCommand::default()
                };
                health.count_command(ts_us);
                sink(Received::Command(renew(newest, targets, ts_us)));
            }
            FromPc::Drive(DriveFrame(drive)) => {
                let targets = PcCommand {
                    kind: PcKind::Drive,
                    drive,
                    ..PcCommand::default()
                };
                health.count_command(ts_us);
                sink(Received::Command(renew(newest, targets, ts_us)));
            }
        };
        let first_us = ts_us.saturating_sub(line_time_us(bytes.len().saturating_sub(1)));
        if scanner.held() > 0 && first_us.saturating_sub(*last_byte_us) >= SILENCE_US {
            scanner.flush(&mut |found| accept(found, *last_byte_us));
        }
        scanner.feed(bytes, &mut |found, following| {
            accept(found, ts_us.saturating_sub(line_time_us(following)));
        });
        if !bytes.is_empty() {
            *last_byte_us = ts_us;
        }
    }

    /// State of the link at `now_us`. The fields `sent` and `tunnel_dropped` are 0: the sender knows them.
    pub fn health(&self, now_us: u64) -> LinkHealth {
        let counters = self.scanner.counters();
        LinkHealth {
            good: counters.good,
            crc_errors: counters.crc_errors,
            resyncs: counters.resyncs,
            discarded_bytes: counters.discarded_bytes,
            ..self.health.at(now_us)
        }
    }
}

/// Time of `bytes` on the line.
fn line_time_us(bytes: usize) -> u64 {
    u64::from((bytes as u32).saturating_mul(BYTE_NS) / 1_000)
}

/// Replaces the newest command by one with these targets, and returns it.
fn renew(newest: &mut PcCommand, targets: PcCommand, ts_us: u64) -> PcCommand {
    let same = newest.ts_us != 0
        && newest.kind == targets.kind
        && newest.drive == targets.drive
        && newest.wheels == targets.wheels
        && newest.joints == targets.joints;
    *newest = PcCommand {
        ts_us,
        changed_us: if same { newest.changed_us } else { ts_us },
        ..targets
    };
    *newest
}
