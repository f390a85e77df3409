use super::*;
use crate::time::{SECOND, US};

const CHARACTER: Ps = 10 * SECOND / 460_800;

fn forward() -> PcInput {
    PcInput {
        on: Some(true),
        wheels_rps: Some([2.0, 3.0]),
        ..PcInput::default()
    }
}

/// Lets the PC act until `end`. Returns the characters on the line to the board.
fn run(pc: &mut Pc, end: Ps, faults: LinkFaults) -> Vec<UartChar> {
    let mut characters = Vec::new();
    while pc.next_due() <= end {
        let now = pc.next_due();
        pc.act(faults);
        take(pc, now, &mut characters);
    }
    take(pc, end, &mut characters);
    while pc.next_whole(end + MS).is_some() {}
    characters
}

fn take(pc: &mut Pc, now: Ps, characters: &mut Vec<UartChar>) {
    while let Some(event) = pc.next_on_the_line(now) {
        if let LineEvent::Character(character) = event {
            characters.push(character);
        }
    }
}

fn up_frame(joints_code: u16) -> [u8; UP_LEN] {
    let mut frame = [0; UP_LEN];
    frame[0] = codec::HEADER;
    for joint in 2..6 {
        frame[69 + 4 * joint..71 + 4 * joint].copy_from_slice(&joints_code.to_le_bytes());
    }
    frame[93] = codec::crc8(&frame[..93]);
    frame
}

fn tell(pc: &mut Pc, frame: &[u8], from: Ps, faults: LinkFaults) -> Option<Ps> {
    let characters = frame.iter().enumerate().map(|(n, byte)| UartChar {
        start: from + n as Ps * CHARACTER,
        byte: *byte,
        format: LINK_FORMAT,
    });
    characters.fold(None, |whole, character| {
        let heard = pc.arrives(character, faults);
        let end = character.start + CHARACTER;
        let is_whole = heard.is_some_and(|heard| pc.receive(heard, end));
        is_whole.then_some(end).or(whole)
    })
}

#[test]
fn frames_leave_at_the_rate_with_the_characters_one_after_another() {
    let mut pc = Pc::new(1);
    pc.set(forward(), MS);
    let characters = run(&mut pc, 100 * MS, LinkFaults::default());
    assert_eq!(characters.len(), 10 * DOWN_LEN);
    let starts: Vec<Ps> = characters.iter().map(|c| c.start).collect();
    assert_eq!((starts[0], starts[DOWN_LEN]), (MS, 11 * MS));
    assert_eq!(starts[37] - starts[0], 37 * CHARACTER);
    assert_eq!((pc.down_frames, pc.sent()), (10, 10));
    assert!((pc.asked.motors[1].target - 3.0).abs() < 0.004);
}

#[test]
fn every_frame_differs_unless_the_pc_is_frozen_or_does_not_count() {
    let mut pc = Pc::new(1);
    pc.set(forward(), 0);
    let frames = |characters: Vec<UartChar>| {
        let bytes: Vec<u8> = characters.iter().map(|c| c.byte).collect();
        let frames = bytes.chunks(DOWN_LEN).map(<[u8]>::to_vec);
        frames.collect::<std::collections::BTreeSet<_>>().len()
    };
    assert_eq!(frames(run(&mut pc, 95 * MS, LinkFaults::default())), 10);
    let frozen = LinkFaults {
        frozen: true,
        ..LinkFaults::default()
    };
    assert_eq!(frames(run(&mut pc, 195 * MS, frozen)), 1);
    let silent = PcInput {
        counts: Some(false),
        ..PcInput::default()
    };
    pc.set(silent, 195 * MS);
    assert_eq!(frames(run(&mut pc, 295 * MS, LinkFaults::default())), 1);
}

#[test]
fn joints_are_held_where_the_robot_says_they_are() {
    let mut pc = Pc::new(1);
    pc.set(PcInput::rest(), 0);
    run(&mut pc, 5 * MS, LinkFaults::default());
    assert_eq!(pc.asked.motors[2].kp, 0.0, "limp until the robot has told");
    // 49,151 of 65,535 is a quarter turn.
    let whole = tell(&mut pc, &up_frame(49_151), 6 * MS, LinkFaults::default());
    assert_eq!(whole, Some(6 * MS + 94 * CHARACTER));
    run(&mut pc, 15 * MS, LinkFaults::default());
    let held = pc.asked.motors[5];
    assert!((held.target - std::f64::consts::FRAC_PI_2).abs() < 1e-3);
    assert!((held.kp - 20.0).abs() < 0.01);
}

#[test]
fn a_pc_that_drives_sends_shares_until_it_is_told_about_motors() {
    let mut pc = Pc::new(1);
    let drive = PcDrive {
        vx: -1.0,
        jump: true,
        ..PcDrive::default()
    };
    let input = PcInput {
        on: Some(true),
        drive: Some(drive),
        ..PcInput::default()
    };
    pc.set(input, 0);
    let bytes = |characters: Vec<UartChar>| -> Vec<u8> {
        characters.iter().map(|character| character.byte).collect()
    };
    let sent = bytes(run(&mut pc, 15 * MS, LinkFaults::default()));
    let [first, second] =
        [1, 2].map(|count| codec::drive_frame([-1.0, 0.0, 0.0, 0.0], true, count));
    assert_eq!(sent, [first, second].concat(), "no two frames are equal");
    assert_eq!(pc.down_frames, 0, "none of them is for motors");
    pc.set(forward(), 15 * MS);
    let sent = run(&mut pc, 25 * MS, LinkFaults::default());
    assert_eq!((sent.len(), pc.down_frames), (DOWN_LEN, 1));
}

#[test]
fn a_cut_ends_a_frame_in_the_middle() {
    let mut pc = Pc::new(1);
    pc.set(forward(), 0);
    pc.act(LinkFaults::default());
    let cut = LinkFaults {
        cut_down: true,
        cut_up: true,
        ..LinkFaults::default()
    };
    pc.set_faults(cut, 400 * US);
    let heard = run(&mut pc, 95 * MS, cut);
    assert!(heard.iter().all(|c| c.start <= 400 * US));
    assert_eq!(heard.len(), 19);
    assert_eq!(tell(&mut pc, &up_frame(0), 96 * MS, cut), None);
    assert_eq!(pc.down_frames, 0);
    pc.set_faults(LinkFaults::default(), 96 * MS);
    run(&mut pc, 115 * MS, LinkFaults::default());
    assert_eq!(pc.down_frames, 2, "the program never stopped");
}

#[test]
fn a_flood_fills_the_line_and_leaves_no_room_for_frames() {
    let mut pc = Pc::new(1);
    pc.set(forward(), 0);
    let flood = LinkFaults {
        flood: true,
        ..LinkFaults::default()
    };
    pc.set_faults(flood, 0);
    let characters = run(&mut pc, 50 * MS, flood);
    assert_eq!(characters.len() as u64, 50 * MS / CHARACTER + 1);
    let gaps = characters.windows(2).map(|w| w[1].start - w[0].start);
    assert!(gaps.into_iter().all(|gap| gap == CHARACTER));
    assert!(
        characters
            .iter()
            .map(|c| c.byte)
            .any(|byte| byte != characters[0].byte)
    );
    pc.set_faults(LinkFaults::default(), 50 * MS);
    run(&mut pc, 72 * MS, LinkFaults::default());
    assert_eq!(pc.down_frames, 2);
}

#[test]
fn noise_damages_about_half_of_the_frames_in_both_directions() {
    let mut pc = Pc::new(1);
    pc.set(forward(), 0);
    let noise = LinkFaults {
        noise: true,
        ..LinkFaults::default()
    };
    run(&mut pc, 4 * SECOND, noise);
    assert_eq!(pc.sent(), 401);
    assert!((120..280).contains(&pc.down_frames), "{}", pc.down_frames);
    for n in 0..400 {
        tell(&mut pc, &up_frame(n), Ps::from(n) * 3 * MS, noise);
    }
    let frames = pc.meter.frames();
    assert!((20..160).contains(&frames), "{frames}");
    let [crc_errors, discarded] = pc.up_errors();
    assert!(crc_errors > 100 && discarded > 1_000 && pc.unreadable > 10);
}

#[test]
fn extremes_are_both_ends_of_every_field_and_never_between() {
    let mut pc = Pc::new(1);
    pc.set(forward(), 0);
    let extremes = LinkFaults {
        extremes: true,
        ..LinkFaults::default()
    };
    let characters = run(&mut pc, SECOND, extremes);
    let bytes: Vec<u8> = characters.iter().map(|c| c.byte).collect();
    for frame in bytes.chunks_exact(DOWN_LEN) {
        assert!(frame[1..37].iter().all(|byte| [0, 0xFF].contains(byte)));
    }
    for place in 1..37 {
        let ends = |end| {
            bytes
                .chunks_exact(DOWN_LEN)
                .any(|frame| frame[place] == end)
        };
        assert!(ends(0) && ends(0xFF), "byte {place}");
    }
    assert!(pc.down_frames >= 100);
}

#[test]
fn a_line_held_low_carries_breaks_and_no_frames() {
    let mut pc = Pc::new(1);
    pc.set(forward(), 0);
    let low = LinkFaults {
        held_low: true,
        ..LinkFaults::default()
    };
    pc.set_faults(low, 0);
    while pc.next_due() <= 10 * MS {
        pc.act(low);
    }
    let held = LineEvent::Low {
        from: 0,
        until: 50 * MS,
    };
    assert_eq!(pc.next_on_the_line(10 * MS), Some(held));
    assert_eq!(pc.next_on_the_line(10 * MS), None);
}

#[test]
fn characters_of_another_rate_cannot_be_read() {
    let mut pc = Pc::new(1);
    let mut slow = LINK_FORMAT;
    slow.baud = 115_200;
    for byte in up_frame(0) {
        let start = 0;
        let character = UartChar {
            start,
            byte,
            format: slow,
        };
        assert_eq!(pc.arrives(character, LinkFaults::default()), None);
    }
    assert_eq!(pc.unreadable, 94);
}
