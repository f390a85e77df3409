//! An event as JSON, for scripts.

use robot_app::domain::EventKind;
use serde_json::{Value, json};

use super::{event::RecordedEvent, story};

/// Returns what happened, without the samples.
pub fn summary(event: &RecordedEvent) -> Value {
    let head = &event.event;
    let kind = match head.kind {
        EventKind::None => "none",
        EventKind::Stop => "stop",
        EventKind::PartialStop => "partial-stop",
        EventKind::Reset => "reset",
    };
    let reset = head
        .reset
        .map(|(cause, crash)| json!({ "cause": format!("{cause:?}"), "last_words": crash.text() }));
    json!({
        "number": head.number,
        "kind": kind,
        "time_s": event.seconds(),
        "causes": event.causes().names().collect::<Vec<_>>(),
        "flags": head.flags.names().collect::<Vec<_>>(),
        "blockers": head.blockers.names().collect::<Vec<_>>(),
        "reset": reset,
        "samples": event.samples.len(),
        "story": story::paragraphs(event).join(" "),
    })
}
