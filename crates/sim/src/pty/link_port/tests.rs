//! A program on the PC's end of the line, and the world at the board's.

use std::{
    fs::{File, OpenOptions},
    io::{Read, Write},
    os::unix::fs::OpenOptionsExt,
    thread,
    time::Duration,
};

use robot_app::link::{Downlink, Uplink};
use robot_plant::{
    serial_adapter::LINK_FORMAT,
    time::{MS, Ps, US},
    wire::{LineEvent, UartChar},
    world::{World, WorldConfig},
};
use rustix::fs::OFlags;

use super::LinkPort;

fn world() -> World {
    World::new(WorldConfig::default()).expect("a world without a recording")
}

fn program(port: &LinkPort) -> File {
    OpenOptions::new()
        .read(true)
        .write(true)
        .custom_flags((OFlags::NOCTTY | OFlags::NONBLOCK).bits().cast_signed())
        .open(port.path())
        .expect("the device is there")
}

fn board_sends(world: &mut World, byte: u8, now: Ps) {
    let character = UartChar {
        start: now - LINK_FORMAT.char_time(),
        byte,
        format: LINK_FORMAT,
    };
    world.link_sent(character, now);
}

/// What the board finds on its line by `now`.
fn arrived(world: &mut World, now: Ps) -> Vec<(u8, Ps)> {
    let events = std::iter::from_fn(|| world.link_event(now));
    let characters = events.filter_map(|event| match event {
        LineEvent::Character(character) => Some((character.byte, character.start)),
        LineEvent::Low { .. } => None,
    });
    characters.collect()
}

#[test]
fn bytes_of_a_program_reach_the_line_one_character_after_the_other() {
    let (mut world, mut port) = (world(), LinkPort::open(false).expect("a pseudo-terminal"));
    assert_eq!(world.link_rx_pin(), None);
    let mut program = program(&port);
    // Nothing may be echoed or converted: newline, carriage return, end of file, interrupt, XOFF, 0xFF.
    let bytes = [0x0A, 0x0D, 0x04, 0x03, 0x13, 0xFF, 0x00];
    program.write_all(&bytes).expect("it is short");
    port.serve(&mut world, MS).expect("the line works");
    assert_eq!(world.link_rx_pin(), Some(true));
    let heard = arrived(&mut world, 2 * MS);
    assert_eq!(heard.iter().map(|h| h.0).collect::<Vec<_>>(), bytes);
    let gaps = heard.windows(2).map(|two| two[1].1 - two[0].1);
    assert!(gaps.into_iter().all(|gap| gap == LINK_FORMAT.char_time()));
    port.serve(&mut world, 2 * MS).expect("the line works");
    assert_eq!(port.stats().from_pc, 7);
    let mut echo = [0; 8];
    assert!(program.read(&mut echo).is_err(), "no echo");
}

#[test]
fn a_program_reads_what_the_board_sends_while_it_has_the_device_open() {
    let (mut world, mut port) = (world(), LinkPort::open(false).expect("a pseudo-terminal"));
    port.serve(&mut world, MS).expect("the line works");
    board_sends(&mut world, 1, 2 * MS);
    port.serve(&mut world, 3 * MS).expect("nobody has it open");
    let mut first = program(&port);
    for (n, byte) in [0x0D, 0x11, 0xFF].into_iter().enumerate() {
        board_sends(&mut world, byte, 3 * MS + (n as Ps + 1) * 30 * US);
    }
    port.serve(&mut world, 4 * MS).expect("the line works");
    let mut got = [0; 8];
    let count = first.read(&mut got).expect("bytes are there");
    assert_eq!(got[..count], [0x0D, 0x11, 0xFF]);
    drop(first);
    board_sends(&mut world, 2, 5 * MS);
    port.serve(&mut world, 6 * MS).expect("closed again");
    let mut second = program(&port);
    board_sends(&mut world, 3, 7 * MS);
    port.serve(&mut world, 8 * MS).expect("open again");
    let count = second.read(&mut got).expect("bytes are there");
    assert_eq!(got[..count], [3]);
    assert_eq!((port.stats().to_pc, port.stats().dropped), (4, 0));
}

#[test]
fn a_program_that_does_not_read_loses_bytes_and_they_are_counted() {
    let (mut world, mut port) = (world(), LinkPort::open(false).expect("a pseudo-terminal"));
    port.serve(&mut world, MS).expect("the line works");
    let _silent = program(&port);
    let mut sent = 0;
    for ms in 2..4_000 {
        for n in 0..46 {
            board_sends(&mut world, n, ms * MS + Ps::from(n) * 21 * US);
            sent += 1;
        }
        port.serve(&mut world, (ms + 1) * MS)
            .expect("it never waits");
    }
    let stats = port.stats();
    assert!(stats.dropped > 0, "{stats:?}");
    assert_eq!(
        stats.to_pc + stats.dropped + port.waiting.len() as u64,
        sent
    );
}

/// The board sends a state by `now`, and the line is served.
fn state(world: &mut World, port: &mut LinkPort, now: Ps) {
    for byte in Uplink::default().encode() {
        board_sends(world, byte, now);
    }
    port.serve(world, now).expect("the line works");
}

#[test]
fn a_board_in_lockstep_waits_for_the_answer_to_each_state() {
    let (mut world, mut port) = (world(), LinkPort::open(true).expect("a pseudo-terminal"));
    let mut program = program(&port);
    state(&mut world, &mut port, MS);
    let command = Downlink::default().encode();
    program.write_all(&command).expect("it is short");
    port.serve(&mut world, 2 * MS).expect("the line works");
    assert_eq!(arrived(&mut world, 3 * MS).len(), command.len());
    let late = thread::spawn(move || {
        thread::sleep(Duration::from_millis(50));
        program.write_all(&command).expect("it is short");
        program
    });
    state(&mut world, &mut port, 4 * MS);
    assert_eq!(
        arrived(&mut world, 5 * MS).len(),
        command.len(),
        "the answer to the state of 4 ms is there at 4 ms"
    );
    drop(late.join().expect("it writes"));
    state(&mut world, &mut port, 6 * MS);
    state(&mut world, &mut port, 8 * MS);
}
