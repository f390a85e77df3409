//! One viewer.

use std::{
    collections::BTreeMap,
    io::ErrorKind,
    net::TcpStream,
    sync::{Arc, mpsc::Receiver, mpsc::RecvTimeoutError},
    time::Duration,
};

use serde::Deserialize;
use tungstenite::{
    Error, Message, WebSocket, accept_hdr,
    handshake::server::{ErrorResponse, Request, Response},
    http::{HeaderValue, StatusCode},
};

use super::Outgoing;

/// Both have the messages that are used here.
const PROTOCOLS: [&str; 2] = ["foxglove.websocket.v1", "foxglove.sdk.v1"];
const PROTOCOL_HEADER: &str = "sec-websocket-protocol";
/// A viewer's wishes are read so often.
const LOOK: Duration = Duration::from_millis(5);
/// A viewer that takes nothing for so long is gone.
const STUCK: Duration = Duration::from_secs(5);
const MESSAGE_DATA: u8 = 1;

/// What a viewer asks for. Everything else needs a capability that this server does not announce.
#[derive(Deserialize)]
#[serde(tag = "op", rename_all = "camelCase")]
enum Wish {
    Subscribe {
        subscriptions: Vec<Subscription>,
    },
    #[serde(rename_all = "camelCase")]
    Unsubscribe {
        subscription_ids: Vec<u32>,
    },
    #[serde(other)]
    Unknown,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Subscription {
    id: u32,
    channel_id: usize,
}

/// Serves a viewer until it leaves or the run ends.
pub(super) fn serve(stream: TcpStream, greetings: &[String], messages: &Receiver<Arc<Outgoing>>) {
    // Blocking until here: a viewer that stops in the middle of its greeting has only this thread.
    let Ok(mut socket) = accept_hdr(stream, agree) else {
        return;
    };
    // The viewer has left, or the run has ended: both end this thread.
    let _ = converse(&mut socket, greetings, messages);
    let _ = socket.close(None);
}

/// Agrees on the protocol.
#[expect(clippy::result_large_err, reason = "the signature is tungstenite's")]
fn agree(request: &Request, mut response: Response) -> Result<Response, ErrorResponse> {
    let offered = request.headers().get_all(PROTOCOL_HEADER).iter();
    let offered = offered
        .filter_map(|it| it.to_str().ok())
        .flat_map(|it| it.split(','));
    let offered: Vec<&str> = offered.map(str::trim).collect();
    let Some(chosen) = PROTOCOLS.into_iter().find(|it| offered.contains(it)) else {
        let mut refusal = ErrorResponse::new(Some("this is for Foxglove".to_owned()));
        *refusal.status_mut() = StatusCode::BAD_REQUEST;
        return Err(refusal);
    };
    response
        .headers_mut()
        .insert(PROTOCOL_HEADER, HeaderValue::from_static(chosen));
    Ok(response)
}

fn converse(
    socket: &mut WebSocket<TcpStream>,
    greetings: &[String],
    messages: &Receiver<Arc<Outgoing>>,
) -> Result<(), Error> {
    socket
        .get_ref()
        .set_read_timeout(Some(Duration::from_millis(1)))?;
    socket.get_ref().set_write_timeout(Some(STUCK))?;
    for greeting in greetings {
        socket.send(Message::text(greeting.clone()))?;
    }
    let mut channels = BTreeMap::new();
    loop {
        listen(socket, &mut channels)?;
        match messages.recv_timeout(LOOK) {
            Ok(message) => {
                send(socket, &channels, &message)?;
                while let Ok(message) = messages.try_recv() {
                    send(socket, &channels, &message)?;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
    }
}

/// Sends a message once for each subscription to its channel.
fn send(
    socket: &mut WebSocket<TcpStream>,
    channels: &BTreeMap<u32, usize>,
    message: &Outgoing,
) -> Result<(), Error> {
    let subscribed = channels
        .iter()
        .filter(|(_, channel)| **channel == message.topic);
    for (subscription, _) in subscribed {
        let mut data = vec![MESSAGE_DATA];
        data.extend(subscription.to_le_bytes());
        data.extend(message.time_ns.to_le_bytes());
        data.extend(&message.json);
        socket.send(Message::binary(data))?;
    }
    Ok(())
}

/// Takes the viewer's wishes, if there are any.
fn listen(
    socket: &mut WebSocket<TcpStream>,
    channels: &mut BTreeMap<u32, usize>,
) -> Result<(), Error> {
    loop {
        let message = match socket.read() {
            Ok(message) => message,
            Err(Error::Io(error))
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
            {
                return Ok(());
            }
            Err(error) => return Err(error),
        };
        let Ok(text) = message.to_text() else {
            continue;
        };
        match serde_json::from_str(text) {
            Ok(Wish::Subscribe { subscriptions }) => {
                channels.extend(subscriptions.into_iter().map(|it| (it.id, it.channel_id)));
            }
            Ok(Wish::Unsubscribe { subscription_ids }) => {
                channels.retain(|id, _| !subscription_ids.contains(id));
            }
            Ok(Wish::Unknown) | Err(_) => {}
        }
    }
}
