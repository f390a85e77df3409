//! The tables `[[at]]`, which say what happens at which time.

use robot_plant::{
    time,
    wire::CanFrame,
    world::{CanBusId, Push, RemoteInput},
};
use serde::Deserialize;

use super::{
    Problem, instant,
    pc::{Pc, read_pc},
};
use crate::{
    faults,
    scenario::{Event, TimedEvent},
    signals::nearest,
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct At {
    t: f64,
    remote: Option<Remote>,
    pc: Option<Pc>,
    can: Option<Can>,
    push: Option<Shove>,
    fault: Option<String>,
    end_fault: Option<String>,
    duration: Option<f64>,
}

/// A frame that the PC's adapter sends.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Can {
    /// Number of the CAN bus, 1 or 2.
    bus: u8,
    id: u32,
    data: Vec<u8>,
}

/// A push against the free robot.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Shove {
    impulse_ns: [f64; 3],
    at_m: Option<[f64; 3]>,
    ms: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Remote {
    enable: Option<bool>,
    e_stop: Option<bool>,
    vx: Option<f64>,
    wz: Option<f64>,
    mode: Option<u8>,
    left_x: Option<f64>,
    left_y: Option<f64>,
    stand: Option<bool>,
    height: Option<f64>,
    roll: Option<f64>,
    jump: Option<bool>,
}

/// Adds the events of `at`. Only a `free` robot can be pushed.
pub(super) fn read_at(
    at: &At,
    seconds: f64,
    free: bool,
    events: &mut Vec<TimedEvent>,
) -> Result<(), Problem> {
    let start = instant("t", at.t, seconds)?;
    let acts = at.remote.is_some() || at.pc.is_some() || at.can.is_some() || at.push.is_some();
    if !acts && at.fault.is_none() && at.end_fault.is_none() {
        return Err(Problem::EmptyAt);
    }
    if let Some(remote) = &at.remote {
        events.push(TimedEvent {
            at: start,
            event: Event::Remote(read_remote(remote)?),
        });
    }
    if let Some(pc) = &at.pc {
        events.push(TimedEvent {
            at: start,
            event: Event::Pc(read_pc(pc)?),
        });
    }
    if let Some(can) = &at.can {
        let (bus, frame) = read_can(can)?;
        events.push(TimedEvent {
            at: start,
            event: Event::Can(bus, frame),
        });
    }
    if let Some(shove) = &at.push {
        if !free {
            return Err(Problem::NotFree("push"));
        }
        events.push(TimedEvent {
            at: start,
            event: Event::Push(read_push(shove)?),
        });
    }
    if let Some(name) = &at.fault {
        events.push(TimedEvent {
            at: start,
            event: Event::StartFault(known_fault(name)?),
        });
    }
    if let Some(name) = &at.end_fault {
        events.push(TimedEvent {
            at: start,
            event: Event::EndFault(known_fault(name)?),
        });
    }
    match (&at.fault, at.duration) {
        (Some(name), Some(duration)) if duration > 0.0 => events.push(TimedEvent {
            at: instant("t + duration", at.t + duration, seconds)?,
            event: Event::EndFault(name.clone()),
        }),
        (_, None) => {}
        (None, Some(_)) => return Err(Problem::DurationWithoutFault),
        (_, Some(duration)) => {
            return Err(Problem::BadDuration(duration));
        }
    }
    Ok(())
}

fn read_remote(remote: &Remote) -> Result<RemoteInput, Problem> {
    for (name, value) in [
        ("vx", remote.vx),
        ("wz", remote.wz),
        ("left_x", remote.left_x),
        ("left_y", remote.left_y),
        ("height", remote.height),
        ("roll", remote.roll),
    ] {
        if value.is_some_and(|v| !(-1.0..=1.0).contains(&v)) {
            return Err(Problem::Stick(name));
        }
    }
    if remote.mode.is_some_and(|m| m > 2) {
        return Err(Problem::Mode);
    }
    Ok(RemoteInput {
        enable: remote.enable,
        e_stop: remote.e_stop,
        vx: remote.vx,
        wz: remote.wz,
        mode: remote.mode,
        left_x: remote.left_x,
        left_y: remote.left_y,
        stand: remote.stand,
        height: remote.height,
        roll: remote.roll,
        jump: remote.jump,
    })
}

fn read_can(can: &Can) -> Result<(CanBusId, CanFrame), Problem> {
    let bus = match can.bus {
        1 => CanBusId::Can1,
        2 => CanBusId::Can2,
        other => return Err(Problem::Bus(other)),
    };
    if can.id > 0x7FF {
        return Err(Problem::Identifier(can.id));
    }
    let mut data = [0; 8];
    let Some(bytes) = data.get_mut(..can.data.len()) else {
        return Err(Problem::LongData);
    };
    bytes.copy_from_slice(&can.data);
    let frame = CanFrame {
        id: can.id,
        extended: false,
        remote: false,
        dlc: can.data.len() as u8,
        data,
    };
    Ok((bus, frame))
}

fn read_push(shove: &Shove) -> Result<Push, Problem> {
    let weak = |values: [f64; 3], most: f64| values.iter().all(|v| v.abs() <= most);
    let ms = shove.ms.unwrap_or(10.0);
    let sound = weak(shove.impulse_ns, 100.0)
        && shove.at_m.is_none_or(|at_m| weak(at_m, 1.0))
        && (1.0..=1_000.0).contains(&ms);
    if !sound {
        return Err(Problem::Push);
    }
    Ok(Push {
        impulse_ns: shove.impulse_ns,
        at_m: shove.at_m,
        lasts: time::from_seconds(ms * 1e-3),
    })
}

fn known_fault(name: &str) -> Result<String, Problem> {
    if faults::all().any(|f| f.name == name) {
        return Ok(name.to_owned());
    }
    let hint = nearest(name, faults::all().map(|f| f.name))
        .map_or(String::new(), |n| format!(" did you mean `{n}`?"));
    Err(Problem::UnknownFault {
        name: name.to_owned(),
        hint,
    })
}
