//! Both kinds of gateway against sockets on this computer.

use std::{
    io::{Read, Write},
    net::{TcpListener, TcpStream, UdpSocket},
    thread,
};

use robot_app::domain::StandardId;
use robot_test_support::{CanToEth, Random};

use super::*;
use crate::can_link::CanDevice;

/// Longer than any computer takes for what is there already.
const LONG: Duration = Duration::from_secs(60);

fn can_frame(id: u16, payload: &[u8]) -> CanFrame {
    CanFrame::from_payload(StandardId::new(id).unwrap(), payload).unwrap()
}

fn open(text: &str) -> Box<dyn CanLink> {
    let device: CanDevice = text.parse().unwrap();
    device.open().unwrap()
}

fn receive(link: &mut dyn CanLink) -> CanFrame {
    let received = link.receive(Instant::now() + LONG).unwrap();
    received.expect("it has been sent")
}

/// A link over TCP, and the gateway's end of it.
fn tcp() -> (Box<dyn CanLink>, TcpStream) {
    let server = TcpListener::bind("127.0.0.1:0").unwrap();
    let link = open(&format!("tcp:{}", server.local_addr().unwrap()));
    (link, server.accept().unwrap().0)
}

/// A link over UDP, and the gateway's end of it.
fn udp() -> (Box<dyn CanLink>, UdpSocket) {
    let server = UdpSocket::bind("127.0.0.1:0").unwrap();
    let link = open(&format!("udp:{}", server.local_addr().unwrap()));
    let (length, client) = server.recv_from(&mut [0; 64]).unwrap();
    assert_eq!(length, 0, "the link makes itself known");
    server.connect(client).unwrap();
    (link, server)
}

/// The frames that this tool knows, in the bytes of the examples.
fn standard_data() -> Vec<(CanFrame, [u8; LENGTH])> {
    let all = CanToEth::examples().into_iter();
    all.filter(|e| !e.extended && !e.remote)
        .map(|e| {
            let payload = &e.data[..usize::from(e.dlc)];
            (can_frame(e.id as u16, payload), e.bytes)
        })
        .collect()
}

#[test]
fn frames_are_written_and_read_as_by_the_c_code() {
    let known = standard_data();
    assert_eq!(known.len(), 18);
    for (frame, bytes) in &known {
        assert_eq!(frame::encode(frame), *bytes);
        assert_eq!(frame::decode(bytes), Some(*frame));
    }
    let others = CanToEth::examples().into_iter();
    for other in others.filter(|e| e.extended || e.remote) {
        assert_eq!(frame::decode(&other.bytes), None, "{other:?}");
    }
}

#[test]
fn every_other_first_byte_and_identifier_is_no_frame() {
    let bytes = frame::encode(&can_frame(0x7A1, &[7; 8]));
    for kind in 0..=u8::MAX {
        let mut changed = bytes;
        changed[0] = kind;
        assert_eq!(frame::decode(&changed).is_some(), kind <= 8, "{kind:#x}");
    }
    for (place, value) in [(1, 0x80), (1, 1), (2, 1), (3, 8)] {
        let mut changed = bytes;
        changed[place] = value;
        assert_eq!(frame::decode(&changed), None, "{place}");
    }
}

#[test]
fn a_stream_may_be_cut_at_every_byte() {
    let known = standard_data();
    let stream: Vec<u8> = known.iter().flat_map(|(_, bytes)| *bytes).collect();
    let (mut link, mut gateway) = tcp();
    gateway.set_nodelay(true).unwrap();
    for cut in 1..stream.len() {
        gateway.write_all(&stream[..cut]).unwrap();
        let whole = cut / LENGTH;
        for (frame, _) in &known[..whole] {
            assert_eq!(receive(&mut *link), *frame);
        }
        gateway.write_all(&stream[cut..]).unwrap();
        for (frame, _) in &known[whole..] {
            assert_eq!(receive(&mut *link), *frame);
        }
    }
}

#[test]
fn what_is_sent_arrives_in_thirteen_bytes() {
    let (mut tcp, mut stream) = tcp();
    let (mut udp, socket) = udp();
    for (frame, bytes) in standard_data() {
        tcp.send(&frame).unwrap();
        let mut heard = [0; LENGTH];
        stream.read_exact(&mut heard).unwrap();
        assert_eq!(heard, bytes);
        udp.send(&frame).unwrap();
        let mut heard = [0; 64];
        let length = socket.recv(&mut heard).unwrap();
        assert_eq!(heard[..length], bytes);
    }
}

#[test]
fn several_frames_of_a_datagram_are_read_and_a_rest_is_not() {
    let (mut link, gateway) = udp();
    let (heard, last) = (can_frame(0x201, &[1, 2]), can_frame(0x202, &[]));
    let extended = CanToEth::examples().into_iter().find(|e| e.extended);
    let whole = [
        frame::encode(&heard),
        extended.unwrap().bytes,
        frame::encode(&last),
    ];
    gateway
        .send(&[whole.as_flattened(), &[8, 0, 0]].concat())
        .unwrap();
    gateway.send(&frame::encode(&heard)).unwrap();
    assert_eq!(receive(&mut *link), heard);
    assert_eq!(receive(&mut *link), last);
    assert_eq!(receive(&mut *link), heard);
}

#[test]
fn ten_million_random_bytes_are_read_to_their_end() {
    const BYTES: usize = 10_000_000 / LENGTH * LENGTH;
    let mut random = Random::new(13);
    let mut noise: Vec<u8> = (0..BYTES).map(|_| random.byte()).collect();
    // Mutated frames as well: one bit of each is wrong.
    for (n, (_, bytes)) in standard_data().iter().cycle().take(50_000).enumerate() {
        let place = n * 15 * LENGTH;
        noise[place..place + LENGTH].copy_from_slice(bytes);
        noise[place + random.below(LENGTH)] ^= 1 << random.below(8);
    }
    noise.extend(frame::encode(&can_frame(0x7FF, b"the end!")));
    let (frames, _) = noise.as_chunks();
    let expected: Vec<_> = frames.iter().filter_map(plain_decode).collect();
    assert!(expected.len() > 10_000, "{}", expected.len());
    let (mut link, mut gateway) = tcp();
    let sender = thread::spawn(move || gateway.write_all(&noise).unwrap());
    for (id, payload) in expected {
        let frame = receive(&mut *link);
        assert_eq!((frame.id().raw(), frame.payload()), (id, &payload[..]));
    }
    sender.join().unwrap();
}

/// The document's rules, one by one.
fn plain_decode(bytes: &[u8; LENGTH]) -> Option<(u16, Vec<u8>)> {
    let is_extended_or_remote = bytes[0] & 0xC0 != 0;
    let has_reserved_bits = bytes[0] & 0x30 != 0;
    let dlc = usize::from(bytes[0] & 0x0F);
    let id = u32::from_be_bytes([bytes[1], bytes[2], bytes[3], bytes[4]]);
    if is_extended_or_remote || has_reserved_bits || dlc > 8 || id > 0x7FF {
        return None;
    }
    Some((id as u16, bytes[5..5 + dlc].to_vec()))
}

/// Port 1 belongs to a service that nobody offers.
#[test]
fn a_port_on_which_nobody_listens_is_named_with_its_cure() {
    let device: CanDevice = "tcp:127.0.0.1:1".parse().unwrap();
    let error = device.open().err().expect("nobody listens").to_string();
    for part in ["tcp:127.0.0.1:1:", "TCP server, not UDP", "20001 for CAN1"] {
        assert!(error.contains(part), "{error}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_datagram_that_nobody_takes_is_named_with_its_cure() {
    let mut link = open("udp:127.0.0.1:1");
    let error = link.receive(Instant::now() + LONG).unwrap_err().to_string();
    assert!(error.contains("UDP, not TCP server"), "{error}");
}

#[test]
fn a_gateway_that_hangs_up_is_named_with_its_cure() {
    let (mut link, gateway) = tcp();
    drop(gateway);
    let error = link.receive(Instant::now() + LONG).unwrap_err().to_string();
    assert!(error.contains("closed the connection"), "{error}");
}

#[test]
fn a_silent_gateway_gives_no_frame_and_advice() {
    let ((mut tcp, _stream), (mut udp, _socket)) = (tcp(), udp());
    for link in [&mut tcp, &mut udp] {
        let soon = Instant::now() + Duration::from_millis(5);
        assert_eq!(link.receive(soon).unwrap(), None);
        assert!(link.why_silent().contains("1 Mbit/s"));
    }
    assert!(udp.why_silent().contains("not to TCP server"));
}
