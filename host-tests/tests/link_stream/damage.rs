//! One damaged frame in a row of good ones: every kind of damage, at every byte.

use std::fmt;

use robot_app::link::{Downlink, Heard, PcReceiver, Received, RobotReceiver};
use robot_test_support::Random;

use super::{
    specification::{Direction, search},
    streams::{byte_or_header, long_frame},
};

/// Frames in the row. The one with this index is damaged.
const FRAMES: usize = 7;
const DAMAGED: usize = 2;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Damage {
    Flipped { bit: u8 },
    Burst { bits: u8 },
    Dropped,
    Inserted { byte: u8 },
    Cut,
}

impl Damage {
    fn all() -> impl Iterator<Item = Self> {
        let flips = (0..8).map(|bit| Self::Flipped { bit });
        let bursts = [0x81, 0xFF, 0x3C].map(|bits| Self::Burst { bits });
        let inserted = [0x00, 0x55, 0xFD, 0xFE].map(|byte| Self::Inserted { byte });
        let others = [Self::Dropped, Self::Cut];
        flips.chain(bursts).chain(inserted).chain(others)
    }

    fn apply(self, frame: &mut Vec<u8>, at: usize) {
        match self {
            Self::Flipped { bit } => frame[at] ^= 1 << bit,
            Self::Burst { bits } => frame[at] ^= bits,
            Self::Dropped => {
                frame.remove(at);
            }
            Self::Inserted { byte } => frame.insert(at, byte),
            Self::Cut => frame.truncate(at),
        }
    }

    /// A CRC with 8 bits detects it with certainty, and not only in 255 of 256 cases.
    fn is_always_detected(self) -> bool {
        matches!(self, Self::Flipped { .. } | Self::Burst { .. })
    }
}

/// A row with one damaged frame.
struct Row {
    frames: Vec<Vec<u8>>,
    stream: Vec<u8>,
    damage: Damage,
    at: usize,
}

impl Row {
    fn all(direction: Direction, seeds: u64) -> impl Iterator<Item = Self> {
        let places = move |damage| (0..direction.long_frame()).map(move |at| (damage, at));
        let one_seed = move |seed| {
            let mut random = Random::new(seed);
            let frames: Vec<_> = (0..FRAMES)
                .map(|_| long_frame(&mut random, direction))
                .collect();
            Damage::all()
                .flat_map(places)
                .map(move |(damage, at)| Self::new(frames.clone(), damage, at))
        };
        (0..seeds).flat_map(one_seed)
    }

    fn new(frames: Vec<Vec<u8>>, damage: Damage, at: usize) -> Self {
        let mut sent = frames.clone();
        damage.apply(&mut sent[DAMAGED], at);
        let stream = sent.concat();
        Self {
            frames,
            stream,
            damage,
            at,
        }
    }

    /// Bytes from here to the end are good frames from this index on.
    fn start_of(&self, index: usize) -> usize {
        self.stream.len() - (FRAMES - index) * self.frames[0].len()
    }

    /// The damaged frame passes for a good one, which happens in one of 256 cases. It may take the first byte of the
    /// next frame with it.
    fn passes_by_chance(&self, direction: Direction) -> bool {
        let found = search(&self.stream, direction).frames;
        found.iter().any(|place| {
            let bytes = &self.stream[place.start..][..place.len];
            place.contiguous && self.frames.iter().all(|frame| frame != bytes)
        })
    }
}

impl fmt::Debug for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} at {}: {:02x?}", self.damage, self.at, self.stream)
    }
}

/// What the robot's receiver gives out, encoded again, with the number of bytes read at that moment.
fn commands_of(stream: &[u8]) -> Vec<(Vec<u8>, usize)> {
    let mut receiver = RobotReceiver::new();
    let mut commands = Vec::new();
    for (index, byte) in stream.iter().enumerate() {
        receiver.feed(&[*byte], 1_000_000, |received| {
            if let Received::Command(command) = received {
                let downlink = Downlink {
                    wheels: command.wheels,
                    joints: command.joints,
                };
                commands.push((downlink.encode().to_vec(), index + 1));
            }
        });
    }
    commands
}

/// The frame after the damage is found. Its command is not given out, as it has nothing sound before it; all later
/// ones are, each with its last byte.
#[test]
fn the_robot_obeys_again_with_the_second_frame_after_any_damage() {
    let (mut rows, mut by_chance) = (0, 0);
    for row in Row::all(Direction::ToRobot, 12) {
        rows += 1;
        let commands = commands_of(&row.stream);
        let passes = row.passes_by_chance(Direction::ToRobot);
        let first_given = if passes { DAMAGED + 3 } else { DAMAGED + 2 };
        for index in first_given..FRAMES {
            let expected = (row.frames[index].clone(), row.start_of(index) + 38);
            assert!(commands.contains(&expected), "{row:?}: {index}");
        }
        let all_true = commands.iter().all(|(bytes, _)| row.frames.contains(bytes));
        assert!(all_true || passes, "{row:?}");
        assert!(!passes || !row.damage.is_always_detected(), "{row:?}");
        by_chance += u32::from(passes);
    }
    assert_eq!(rows, 12 * 38 * 17);
    assert!(by_chance < rows / 200, "{by_chance} of {rows}");
}

/// A state frame has no consequences that could not wait for the next one, so the PC uses every frame.
#[test]
fn a_pc_hears_the_first_frame_after_any_damage() {
    let mut by_chance = 0;
    let mut rows = 0;
    for row in Row::all(Direction::ToPc, 3) {
        rows += 1;
        let passes = row.passes_by_chance(Direction::ToPc);
        by_chance += u32::from(passes);
        let mut receiver = PcReceiver::new();
        let mut states = Vec::new();
        for (index, byte) in row.stream.iter().enumerate() {
            receiver.feed(&[*byte], |heard| {
                if let Heard::Uplink(_) = heard {
                    states.push(index + 1);
                }
            });
        }
        let first_heard = if passes { DAMAGED + 2 } else { DAMAGED + 1 };
        for index in first_heard..FRAMES {
            let end = row.start_of(index) + 94;
            assert!(states.contains(&end), "{row:?}: {index}");
        }
    }
    assert!(by_chance < rows / 200, "{by_chance} of {rows}");
}

/// Garbage of any length before and after, without anything that looks like a frame by chance on its own.
#[test]
fn a_frame_in_garbage_is_always_found() {
    for seed in 0..3_000 {
        let mut random = Random::new(seed);
        let frame = long_frame(&mut random, Direction::ToRobot);
        let headers_among = 1 + random.below(50);
        let mut garbage = |most: usize| -> Vec<u8> {
            let count = random.below(most);
            (0..count)
                .map(|_| byte_or_header(&mut random, headers_among))
                .collect()
        };
        // The very first frame of a stream counts as contiguous, even a false one.
        let before = [&[0][..], &garbage(200)].concat();
        let mut after = garbage(200);
        // Long enough to end every wait for a false frame.
        after.extend([0; 38]);
        let stream = [&before[..], &frame, &after].concat();
        let mut receiver = RobotReceiver::new();
        let good_after = |receiver: &mut RobotReceiver, bytes: &[u8]| {
            receiver.feed(bytes, 1_000_000, |_| {});
            receiver.health(1_000_000).good
        };
        let end = before.len() + 38;
        good_after(&mut receiver, &stream[..end - 1]);
        let found = good_after(&mut receiver, &stream[end - 1..end]) > 0;
        let places = search(&stream, Direction::ToRobot).frames;
        let starts_there = places.iter().any(|place| place.start == before.len());
        assert!(starts_there && found, "seed {seed}");
    }
}
