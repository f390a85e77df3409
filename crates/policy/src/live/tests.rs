use std::net::TcpStream;

use serde_json::Value;
use tungstenite::{ClientRequestBuilder, Message, WebSocket, client};

use super::*;
use crate::{machine::Phase, messages::OBSERVATION_TOPIC, observation::Commands, runner::testing};

fn connect(live: &Live, protocol: &str) -> Result<WebSocket<TcpStream>, String> {
    let stream = TcpStream::connect(live.address()).expect("it listens");
    let uri = format!("ws://{}/", live.address())
        .parse()
        .expect("an address");
    let request = ClientRequestBuilder::new(uri).with_sub_protocol(protocol);
    client(request, stream)
        .map(|(socket, _)| socket)
        .map_err(|error| error.to_string())
}

fn live() -> Live {
    let address = SocketAddr::from(([127, 0, 0, 1], 0));
    Live::listen(address, &testing::policy()).expect("a free port")
}

fn json(message: &Message) -> Value {
    serde_json::from_str(message.to_text().expect("text")).expect("JSON")
}

#[test]
fn a_viewer_gets_the_topic_that_it_subscribes_to() {
    let live = live();
    let mut socket = connect(&live, "foxglove.websocket.v1").expect("it agrees");
    let info = json(&socket.read().expect("a greeting"));
    assert_eq!(
        (&info["op"], &info["name"]),
        (&"serverInfo".into(), &"policy fivebar/flat".into())
    );
    let advertised = json(&socket.read().expect("the topics"));
    let channels = advertised["channels"].as_array().expect("channels");
    let wanted = channels
        .iter()
        .find(|it| it["topic"] == OBSERVATION_TOPIC)
        .expect("the topic");
    assert_eq!(
        (&wanted["encoding"], &wanted["schemaEncoding"]),
        (&"json".into(), &"jsonschema".into())
    );
    let subscribe = serde_json::json!({
        "op": "subscribe",
        "subscriptions": [{ "id": 7, "channelId": wanted["id"] }],
    });
    socket
        .send(Message::text(subscribe.to_string()))
        .expect("it listens");
    socket
        .get_ref()
        .set_read_timeout(Some(std::time::Duration::from_millis(20)))
        .expect("a time-out");

    let mut bench = testing::Bench::new([0.25; 6]);
    bench.until(Phase::Policy);
    let data = loop {
        bench.cycle();
        live.add(&Entry {
            time_s: bench.time_s,
            runner: &bench.runner,
            commands: Commands::default(),
            late_s: 0.0,
            state: &bench.state,
        });
        if let Ok(message) = socket.read() {
            break message.into_data();
        }
    };
    assert_eq!((data[0], &data[1..5]), (1, &[7, 0, 0, 0][..]));
    let observation: Value = serde_json::from_slice(&data[13..]).expect("JSON");
    assert!(observation["gravity_vec"]["z"].as_f64().expect("a number") < -0.99);
}

#[test]
fn another_protocol_is_refused() {
    let live = live();
    let error = connect(&live, "chat").unwrap_err();
    assert!(error.contains("400"), "{error}");
}
