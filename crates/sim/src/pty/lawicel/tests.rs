//! Against the command list of the CAN232 and CANUSB manuals.

use super::*;

const CLOSED: AdapterMode = AdapterMode::Off;
const OPEN: AdapterMode = AdapterMode::Active;

fn say(lawicel: &mut Lawicel, mode: AdapterMode, text: &str) -> Vec<Request> {
    text.bytes().filter_map(|b| lawicel.feed(b, mode)).collect()
}

fn one(lawicel: &mut Lawicel, mode: AdapterMode, text: &str) -> Request {
    let requests = say(lawicel, mode, text);
    assert_eq!(requests.len(), 1, "{text:?}");
    requests[0]
}

const BELL: Request = Request::Answered("\x07");
const CR: Request = Request::Answered("\r");

#[test]
fn the_channel_opens_only_with_the_bit_rate_of_the_bus() {
    let mut lawicel = Lawicel::default();
    assert_eq!(one(&mut lawicel, CLOSED, "O\r"), BELL, "no rate set");
    assert_eq!(one(&mut lawicel, CLOSED, "S6\r"), CR);
    assert_eq!(one(&mut lawicel, CLOSED, "O\r"), BELL, "500 kbit/s");
    assert_eq!(one(&mut lawicel, CLOSED, "S8\r"), CR);
    assert_eq!(one(&mut lawicel, CLOSED, "O\r"), Request::Switch(OPEN));
    let listen = Request::Switch(AdapterMode::ListenOnly);
    assert_eq!(one(&mut lawicel, CLOSED, "L\r"), listen);
}

#[test]
fn bit_timing_registers_give_the_rates_of_the_manuals_table() {
    // BTR0/BTR1 of Lawicel's list for 16 MHz.
    assert_eq!(register_rate(0x00, 0x14), 1_000_000);
    assert_eq!(register_rate(0x00, 0x1C), 500_000);
    assert_eq!(register_rate(0x03, 0x1C), 125_000);
    assert_eq!(register_rate(0x31, 0x1C), 10_000);
    let mut lawicel = Lawicel::default();
    assert_eq!(one(&mut lawicel, CLOSED, "s0014\r"), CR);
    assert_eq!(one(&mut lawicel, CLOSED, "O\r"), Request::Switch(OPEN));
    assert_eq!(one(&mut lawicel, CLOSED, "s00\r"), BELL);
    assert_eq!(one(&mut lawicel, CLOSED, "s00xy\r"), BELL);
}

#[test]
fn settings_belong_to_the_closed_channel_and_frames_to_the_open_one() {
    let mut lawicel = Lawicel::default();
    for setting in ["S8\r", "Z1\r", "M00000000\r", "mFFFFFFFF\r"] {
        assert_eq!(one(&mut lawicel, OPEN, setting), BELL, "{setting:?} open");
        assert_eq!(one(&mut lawicel, CLOSED, setting), CR, "{setting:?} closed");
    }
    for used_open in [
        "t1000\r",
        "T000001000\r",
        "r1000\r",
        "R000001000\r",
        "F\r",
        "C\r",
    ] {
        assert_eq!(one(&mut lawicel, CLOSED, used_open), BELL, "{used_open:?}");
        assert_ne!(one(&mut lawicel, OPEN, used_open), BELL, "{used_open:?}");
    }
    assert_eq!(one(&mut lawicel, AdapterMode::ListenOnly, "t1000\r"), BELL);
}

#[test]
fn time_stamps_go_on_and_off() {
    let mut lawicel = Lawicel::default();
    say(&mut lawicel, CLOSED, "Z1\r");
    assert!(lawicel.time_stamps);
    assert_eq!(one(&mut lawicel, CLOSED, "Z2\r"), BELL);
    say(&mut lawicel, CLOSED, "Z0\r");
    assert!(!lawicel.time_stamps);
}

#[test]
fn version_and_serial_number_have_the_manuals_lengths() {
    for (question, letter) in [("V\r", 'V'), ("v\r", 'v'), ("N\r", 'N')] {
        let Request::Answered(reply) = one(&mut Lawicel::default(), OPEN, question) else {
            panic!("{question:?} asks nothing of the bus");
        };
        assert!(reply.starts_with(letter) && reply.ends_with('\r'));
        assert_eq!(reply.len(), 6);
    }
}

#[test]
fn noise_between_sessions_ends_with_the_next_carriage_return() {
    let mut lawicel = Lawicel::default();
    let noise = "x".repeat(1_000);
    assert_eq!(say(&mut lawicel, CLOSED, &noise), []);
    assert_eq!(say(&mut lawicel, CLOSED, "\r\rS8\r"), [BELL, BELL, CR]);
    let too_long = "T1FFFFFFF80011223344556677FF\r";
    assert_eq!(one(&mut lawicel, OPEN, too_long), BELL);
}

#[test]
fn replies_to_frames_and_flags() {
    let frame = frame_text::parse(b"t1000").expect("a frame");
    let extended = frame_text::parse(b"T000001000").expect("a frame");
    assert_eq!(sent_reply(&frame, true), "z\r");
    assert_eq!(sent_reply(&extended, true), "Z\r");
    assert_eq!(sent_reply(&frame, false), "\x07");
    assert_eq!(
        flags_reply(flags::RECEIVE_FULL | flags::TRANSMIT_FULL),
        "F03\r"
    );
}
