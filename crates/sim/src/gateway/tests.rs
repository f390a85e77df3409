//! Both servers against sockets on this computer, and a port against an adapter.

use std::{
    io::{ErrorKind, Read, Write},
    net::{TcpStream, UdpSocket},
    thread,
};

use robot_plant::{
    can_adapter::{AdapterMode, CanAdapter},
    wire::CanFrame,
};
use robot_test_support::{CanToEth, Random};

use super::{
    frame::{self, LENGTH},
    gateway_port::GatewayPort,
    tcp::{CLIENTS, TcpServer},
    udp::UdpServer,
    *,
};
use crate::can_port::{CanDevice, CanPort, Protocol};

const ANY: &str = "127.0.0.1:0";

/// Repeats `step` until it says that all is there. What a socket of this computer has been given arrives soon.
fn until(mut step: impl FnMut() -> bool) {
    while !step() {
        thread::yield_now();
    }
}

fn can_frame(example: &CanToEth) -> CanFrame {
    CanFrame {
        id: example.id,
        extended: example.extended,
        remote: example.remote,
        dlc: example.dlc,
        data: example.data,
    }
}

fn bytes_of_all() -> Vec<u8> {
    let all = CanToEth::examples().into_iter();
    all.flat_map(|example| example.bytes).collect()
}

fn tcp() -> TcpServer {
    TcpServer::open(ANY.parse().unwrap()).unwrap()
}

fn connect(server: &TcpServer) -> TcpStream {
    let stream = TcpStream::connect(server.address().unwrap()).unwrap();
    stream.set_nodelay(true).unwrap();
    stream
}

/// Takes what arrives until there are so many bytes.
fn take(server: &mut TcpServer, bytes: usize) -> Vec<u8> {
    let mut taken = Vec::new();
    until(|| {
        server.receive(&mut |frame| taken.extend(frame));
        taken.len() >= bytes
    });
    taken
}

#[test]
fn frames_are_written_and_read_as_by_the_c_code() {
    for example in CanToEth::examples() {
        let frame = can_frame(&example);
        assert_eq!(frame::encode(&frame), example.bytes);
        assert_eq!(frame::decode(&example.bytes), Some(frame));
    }
}

#[test]
fn reserved_bits_lengths_and_identifiers_out_of_range_are_no_frame() {
    let of = |kind: u8, id: u32| {
        let mut bytes = [0xA5; LENGTH];
        bytes[0] = kind;
        bytes[1..5].copy_from_slice(&id.to_be_bytes());
        frame::decode(&bytes)
    };
    let known = (0..=u8::MAX).filter(|kind| of(*kind, 0x123).is_some());
    let expected = [0x00, 0x40, 0x80, 0xC0].map(|kind| kind..=kind + 8);
    assert!(known.eq(expected.into_iter().flatten()));
    for (kind, highest) in [(0x08, 0x7FF), (0x88, 0x1FFF_FFFF)] {
        assert!(of(kind, highest).is_some() && of(kind, highest + 1).is_none());
    }
    // What follows the data does not count, nor does anything after a remote frame's identifier.
    assert_eq!(of(0x01, 1).unwrap().data, [0xA5, 0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(of(0x48, 1).unwrap().data, [0; 8]);
}

#[test]
fn a_stream_may_be_cut_at_every_byte() {
    let all = bytes_of_all();
    let mut server = tcp();
    let mut client = connect(&server);
    for cut in 1..all.len() {
        client.write_all(&all[..cut]).unwrap();
        let mut taken = take(&mut server, cut / LENGTH * LENGTH);
        client.write_all(&all[cut..]).unwrap();
        let left = all.len() - taken.len();
        taken.extend(take(&mut server, left));
        assert_eq!(taken, all, "{cut}");
    }
}

#[test]
fn clients_do_not_mix_their_bytes_and_all_hear_the_bus() {
    let all = bytes_of_all();
    let mut server = tcp();
    let mut clients = [connect(&server), connect(&server)];
    let (first, second) = (&all[..LENGTH], &all[LENGTH..2 * LENGTH]);
    clients[0].write_all(&first[..6]).unwrap();
    clients[1].write_all(second).unwrap();
    assert_eq!(take(&mut server, LENGTH), second);
    clients[0].write_all(&first[6..]).unwrap();
    assert_eq!(take(&mut server, LENGTH), first);
    assert_eq!(server.send(&all), (2 * all.len() as u64 / 13, 0));
    for client in &mut clients {
        let mut heard = vec![0; all.len()];
        client.read_exact(&mut heard).unwrap();
        assert_eq!(heard, all);
    }
}

#[test]
fn a_client_too_many_is_turned_away_until_one_leaves() {
    let frame = &bytes_of_all()[..LENGTH];
    let mut server = tcp();
    let mut clients: Vec<_> = (0..CLIENTS).map(|_| connect(&server)).collect();
    for client in &mut clients {
        client.write_all(frame).unwrap();
    }
    take(&mut server, CLIENTS * LENGTH);
    let mut late = connect(&server);
    until(|| {
        server.receive(&mut |_| {});
        late.set_nonblocking(true).unwrap();
        match late.read(&mut [0; 1]) {
            Ok(0) => true,
            Ok(_) => panic!("nobody says anything"),
            Err(e) => e.kind() != ErrorKind::WouldBlock,
        }
    });
    clients.pop();
    until(|| {
        server.receive(&mut |_| {});
        server.send(frame).0 == CLIENTS as u64 - 1
    });
    connect(&server).write_all(frame).unwrap();
    assert_eq!(take(&mut server, LENGTH), frame);
}

#[test]
fn a_client_that_does_not_read_loses_whole_frames_and_stops_nobody() {
    let all = bytes_of_all();
    let mut server = tcp();
    let (mut idle, mut reader) = (connect(&server), connect(&server));
    for client in [&mut idle, &mut reader] {
        client.write_all(&all[..LENGTH]).unwrap();
    }
    take(&mut server, 2 * LENGTH);
    let mut heard = vec![0; all.len()];
    let mut queued = 0;
    let lost = loop {
        let (taken, lost) = server.send(&all);
        queued += taken;
        // One of the two reads.
        queued -= all.len() as u64 / 13;
        reader.read_exact(&mut heard).unwrap();
        assert_eq!(heard, all);
        if lost > 0 {
            break lost;
        }
    };
    assert!(lost < all.len() as u64 / 13 && lost + queued > 5_000);
    // All that was taken for it is whole.
    let reading = thread::spawn(move || {
        let mut heard = vec![0; queued as usize * LENGTH];
        idle.read_exact(&mut heard).unwrap();
        heard
    });
    until(|| {
        server.send(&[]);
        reading.is_finished()
    });
    let heard = reading.join().unwrap();
    assert!(heard.chunks(all.len()).all(|part| all.starts_with(part)));
}

#[test]
fn datagrams_carry_several_frames_and_the_last_sender_is_answered() {
    let all = bytes_of_all();
    let mut server = UdpServer::open(ANY.parse().unwrap()).unwrap();
    let [first, second] = [(); 2].map(|()| UdpSocket::bind(ANY).unwrap());
    let at = server.address().unwrap();
    assert_eq!(server.send(&all), (0, 0), "nobody is known");
    let mut taken: Vec<u8> = Vec::new();
    let mut cut = 0;
    let mut hear = |client: &UdpSocket, bytes: &[u8], whole: usize| {
        client.send_to(bytes, at).unwrap();
        taken.clear();
        until(|| {
            cut += server.receive(&mut |frame| taken.extend(frame));
            taken.len() >= whole * LENGTH
        });
        assert_eq!(taken, all[..whole * LENGTH]);
        let frames = all.repeat(3);
        assert_eq!(server.send(&frames), (frames.len() as u64 / 13, 0));
        let mut heard = Vec::new();
        while heard.len() < frames.len() {
            let mut datagram = [0; 2_048];
            let (length, _) = client.recv_from(&mut datagram).unwrap();
            assert!(length % LENGTH == 0 && length <= 1_400, "{length}");
            heard.extend_from_slice(&datagram[..length]);
        }
        assert_eq!(heard, frames);
    };
    hear(&first, &all[..LENGTH], 1);
    hear(&second, &all[..3 * LENGTH + 5], 3);
    hear(&first, &all[..2 * LENGTH], 2);
    assert_eq!(cut, 1, "one datagram did not end with a whole frame");
}

/// 10 MB of noise and of frames with a wrong bit. The document's rules, applied one by one, say what is a frame.
#[test]
fn ten_million_random_bytes_do_nothing_but_count() {
    const BYTES: usize = 10_000_000 / LENGTH * LENGTH;
    let mut random = Random::new(31);
    let mut noise: Vec<u8> = (0..BYTES).map(|_| random.byte()).collect();
    for (n, example) in CanToEth::examples().iter().cycle().take(50_000).enumerate() {
        let place = n * 15 * LENGTH;
        noise[place..place + LENGTH].copy_from_slice(&example.bytes);
        noise[place + random.below(LENGTH)] ^= 1 << random.below(8);
    }
    let frames = noise.chunks(LENGTH);
    let malformed = frames.filter(|bytes| is_malformed(bytes)).count() as u64;
    assert!(malformed > 700_000, "{malformed}");

    let mut port = GatewayPort::open(CanBusId::Can1, Protocol::Tcp, ANY.parse().unwrap()).unwrap();
    let CanDevice::Gateway(_, at) = port.device() else {
        panic!("it is a gateway");
    };
    let mut adapter = CanAdapter::default();
    adapter.set_mode(AdapterMode::Active);
    let sender = thread::spawn(move || TcpStream::connect(at).unwrap().write_all(&noise).unwrap());
    let whole = (BYTES / LENGTH) as u64;
    let mut taken = 0;
    until(|| {
        port.receive(&mut adapter);
        let stats = port.stats();
        // The bus is stopped: the adapter takes as many as it has room for.
        taken = stats.malformed + stats.refused;
        taken + 256 >= whole
    });
    sender.join().unwrap();
    assert_eq!(port.stats().malformed, malformed);
    assert_eq!(taken + 256, whole);
}

fn is_malformed(bytes: &[u8]) -> bool {
    let has_reserved_bits = bytes[0] & 0x30 != 0;
    let is_extended = bytes[0] & 0x80 != 0;
    let id = bytes[1..5]
        .iter()
        .fold(0, |id, byte| id << 8 | u64::from(*byte));
    let highest = if is_extended { 1 << 29 } else { 1 << 11 };
    has_reserved_bits || bytes[0] & 0x0F > 8 || id >= highest
}
