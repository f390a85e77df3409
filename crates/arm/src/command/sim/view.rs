//! `--view`: a page that shows the arm in a browser of this computer.

use std::{
    io::{self, BufRead, BufReader, Read, Write},
    net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream},
    sync::{Arc, Weak},
    thread,
    time::Duration,
};

use robot_servo_model::{Port, SO101_JOINTS, So101, View};
use serde_json::{Value, json};

use super::screen;

const PAGE: &str = include_str!("view.html");
/// Longest line of a request that is read.
const LONGEST: u64 = 1024;
/// How long a browser may take.
const PATIENCE: Duration = Duration::from_secs(1);

/// Serves the page to this computer alone, as long as the port is there. Returns its address.
pub fn serve(port: &Arc<Port>) -> io::Result<SocketAddr> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
    let address = listener.local_addr()?;
    let port = Arc::downgrade(port);
    thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            // A browser that goes away in the middle asks again when it comes back.
            let _ = answer(stream, &port);
        }
    });
    Ok(address)
}

fn answer(mut stream: TcpStream, port: &Weak<Port>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut line = String::new();
    BufReader::new((&stream).take(LONGEST)).read_line(&mut line)?;
    let (status, kind, body) = match (line.split(' ').nth(1), port.upgrade()) {
        (Some("/"), Some(_)) => ("200 OK", "text/html; charset=utf-8", PAGE.to_owned()),
        (Some("/state"), Some(port)) => ("200 OK", "application/json", state(&port).to_string()),
        _ => (
            "404 Not Found",
            "text/plain",
            "there is / and /state".to_owned(),
        ),
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    )
}

fn state(port: &Port) -> Value {
    let mut bus = port.bus();
    let views = bus.view();
    let faults: Vec<String> = bus.faults().map(|(_, fault)| fault.to_string()).collect();
    drop(bus);
    let mut steps = [0.0; 6];
    for (known, view) in steps.iter_mut().zip(&views) {
        *known = view.shaft_steps;
    }
    let (pan_rad, points) = So101.pose(steps);
    let joints = SO101_JOINTS.iter().zip(&views);
    json!({
        "port": port.path().display().to_string(),
        "faults": faults,
        "pan_rad": pan_rad,
        "points": points,
        "joints": joints.map(|((name, _, _), view)| joint(name, view)).collect::<Vec<_>>(),
    })
}

fn joint(name: &str, view: &View) -> Value {
    json!({
        "name": name,
        "id": view.id,
        "position": view.position_steps,
        "goal": view.goal_steps,
        "load": view.duty,
        "current_a": view.current_a,
        "temperature_c": view.temperature_c,
        "supply_v": view.supply_v,
        "state": screen::state(view),
    })
}

#[cfg(test)]
mod tests {
    use robot_servo_model::{Bus, Version, so101_servos};

    use super::*;

    fn get(address: SocketAddr, path: &str) -> String {
        let mut stream = TcpStream::connect(address).expect("it listens");
        write!(stream, "GET {path} HTTP/1.1\r\nHost: it\r\n\r\n").expect("it reads");
        let mut text = String::new();
        stream.read_to_string(&mut text).expect("text");
        text
    }

    #[test]
    fn a_browser_finds_the_page_and_the_arms_state() {
        let bus = Bus::new(so101_servos(Version::Volts12), 1);
        let port = Arc::new(Port::open(bus).expect("a pseudo-terminal"));
        let address = serve(&port).expect("a free port");
        assert!(address.ip().is_loopback());
        assert!(get(address, "/").ends_with(PAGE));
        let answer = get(address, "/state");
        let (_, body) = answer.split_once("\r\n\r\n").expect("a head and a body");
        let state: Value = serde_json::from_str(body).expect("JSON");
        assert_eq!(state["joints"][5]["name"], "gripper");
        assert_eq!(state["joints"][0]["position"], 2048);
        assert_eq!(state["points"].as_array().map(Vec::len), Some(4));
        assert!(get(address, "/etc/passwd").starts_with("HTTP/1.1 404"));
        drop(port);
        assert!(get(address, "/state").starts_with("HTTP/1.1 404"));
    }
}
