//! The robot's state and a setting by every way to a CAN bus.

use robot_plant::world::CanBusId;
use robot_sim::{parameter_sectors::Record, pc::PcAccess, scenario::FlashContents};
use robotctl::{settings, status::Status};

use crate::{job, tool::Tool};

fn read_all(bus: CanBusId, pc: PcAccess) {
    let mut tool = Tool::new(|client| {
        let status = Status::read(client)?.to_json();
        let radius = client.read(settings::find("wheel-geometry.radius-m")?)?;
        Ok((status, radius))
    })
    .on(bus);
    let mut job = job();
    // Sectors with a record need no erase, during which requests would be lost.
    let saved = Record::first(1, &[0.0625, 0.4375, 19.2, 1.0, -1.0]);
    job.scenario.flash.contents = FlashContents::Records(vec![saved]);
    job.pc = pc;
    let outcome = job.run(&mut [&mut tool]).expect("the machine starts");
    let (status, radius) = tool.result().expect("the robot answers");
    assert_eq!(status["arming"]["state"], "disarmed", "{status}");
    assert_eq!(radius, 0.0625);
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    let name = format!("{bus:?}").to_lowercase();
    let port = outcome.summary.can_ports[&name];
    assert_eq!((port.refused, port.malformed), (0, 0), "{port:?}");
}

fn gateway(address: &str) -> PcAccess {
    PcAccess {
        gateway: Some(address.parse().expect("an address")),
        ..PcAccess::default()
    }
}

#[test]
fn state_and_settings_are_read_through_an_slcan_adapter() {
    let pc = PcAccess {
        can_on_pty: vec![CanBusId::Can2],
        ..PcAccess::default()
    };
    read_all(CanBusId::Can2, pc);
}

#[test]
fn state_and_settings_are_read_through_a_gateway_over_tcp() {
    read_all(CanBusId::Can1, gateway("tcp:0"));
}

#[test]
fn state_and_settings_are_read_through_a_gateway_over_udp() {
    read_all(CanBusId::Can2, gateway("udp:0"));
}
