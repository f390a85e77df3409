//! The same messages as in the log, live, for Foxglove: a server of its WebSocket protocol
//! (<https://github.com/foxglove/ws-protocol>).

mod client;

use std::{
    io,
    net::{SocketAddr, TcpListener},
    sync::{
        Arc, Mutex, PoisonError,
        mpsc::{SyncSender, TrySendError, sync_channel},
    },
    thread,
    time::{SystemTime, UNIX_EPOCH},
};

use serde_json::json;

use crate::{
    PolicyDescription,
    messages::{Entry, Messages},
};

/// Messages that wait for a viewer; more are dropped, as the run waits for nobody.
const WAITING: usize = 512;

/// A port that cannot be opened for viewers.
#[derive(Debug, thiserror::Error)]
#[error(
    "cannot listen at {address}: does another program, and is this an address of this computer?"
)]
pub struct LiveError {
    address: SocketAddr,
    source: io::Error,
}

/// A message on its way to a viewer.
#[derive(Debug)]
struct Outgoing {
    /// Place of its topic.
    topic: usize,
    /// Time in ns since 1970.
    time_ns: u64,
    json: Vec<u8>,
}

type Viewers = Arc<Mutex<Vec<SyncSender<Arc<Outgoing>>>>>;

/// Sends messages to each viewer that is connected. It never waits for one.
pub struct Live {
    address: SocketAddr,
    messages: Messages,
    viewers: Viewers,
}

impl Live {
    /// Listens at an address, such as 127.0.0.1:8765.
    ///
    /// # Errors
    /// The port is taken, or the address is not this computer's.
    pub fn listen(address: SocketAddr, policy: &PolicyDescription) -> Result<Self, LiveError> {
        let failed = |source| LiveError { address, source };
        let listener = TcpListener::bind(address).map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        let messages = Messages::new(policy);
        let greetings = greetings(policy, &messages);
        let viewers = Viewers::default();
        let joined = viewers.clone();
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let (sender, receiver) = sync_channel(WAITING);
                let greetings = greetings.clone();
                lock(&joined).push(sender);
                // Whoever leaves or speaks something else is forgotten with its thread.
                thread::spawn(move || client::serve(stream, &greetings, &receiver));
            }
        });
        Ok(Self {
            address,
            messages,
            viewers,
        })
    }

    /// Returns where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Sends a cycle.
    pub fn add(&self, entry: &Entry<'_>) {
        let mut viewers = lock(&self.viewers);
        if viewers.is_empty() {
            return;
        }
        let since_1970 = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        let time_ns = u64::try_from(since_1970.as_nanos()).unwrap_or(u64::MAX);
        for (topic, message) in self.messages.of(entry) {
            let json = message.to_string().into_bytes();
            let outgoing = Arc::new(Outgoing {
                topic,
                time_ns,
                json,
            });
            viewers.retain(|viewer| {
                let sent = viewer.try_send(outgoing.clone());
                !matches!(sent, Err(TrySendError::Disconnected(_)))
            });
        }
    }
}

fn lock(viewers: &Viewers) -> std::sync::MutexGuard<'_, Vec<SyncSender<Arc<Outgoing>>>> {
    viewers.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What a viewer is told first. The number of a channel is its topic's place.
fn greetings(policy: &PolicyDescription, messages: &Messages) -> [String; 2] {
    let channels = messages.topics().iter().enumerate().map(|(id, topic)| {
        json!({
            "id": id,
            "topic": topic.name,
            "encoding": "json",
            "schemaName": topic.schema_name,
            "schema": topic.schema.to_string(),
            "schemaEncoding": "jsonschema",
        })
    });
    let channels: Vec<_> = channels.collect();
    let info = json!({
        "op": "serverInfo",
        "name": format!("policy {}", policy.name),
        "capabilities": [],
    });
    let advertise = json!({ "op": "advertise", "channels": channels });
    [info.to_string(), advertise.to_string()]
}

#[cfg(test)]
mod tests;
