//! Notices request lines that wait for a stream that was never set up for them.

use super::{
    Dma,
    request_map::{LINES, RequestLine},
};
use crate::{
    soc::{board_errors::BoardErrors, dma_request::DmaRequests},
    time::{MS, Ps},
};

/// Drivers may raise a request shortly before they enable its stream. A longer wait is an error.
const TIMEOUT: Ps = MS;

#[derive(Clone, Copy, Debug, Default)]
struct Waiting {
    since: Option<Ps>,
    /// Whether a stream has served this line since reset. A stream that has ended legitimately leaves the line high.
    served_before: bool,
}

#[derive(Debug, Default)]
pub struct Unserved {
    lines: [Waiting; LINES.len()],
}

impl Unserved {
    pub fn note_served(&mut self, line: &RequestLine) {
        self.lines[line.request as usize] = Waiting {
            since: None,
            served_before: true,
        };
    }

    /// Checks the lines that are still high after every ready stream has been served.
    pub fn check(
        &mut self,
        requests: &DmaRequests,
        dma: [&Dma; 2],
        now: Ps,
        errors: &mut BoardErrors,
    ) {
        for (line, waiting) in LINES.iter().zip(&mut self.lines) {
            if !requests.get(line.request) {
                waiting.since = None;
            } else if !waiting.served_before {
                let since = *waiting.since.get_or_insert(now);
                if now - since >= TIMEOUT {
                    errors.report(now, message(line, dma));
                    waiting.since = Some(now);
                }
            }
        }
    }
}

fn message(line: &RequestLine, dma: [&Dma; 2]) -> String {
    let places: Vec<_> = line
        .slots
        .iter()
        .map(|slot| {
            let stream = dma[usize::from(slot.controller == 2)].stream(slot.stream);
            let state = if !stream.enabled() {
                "which is not enabled".to_owned()
            } else {
                format!("which is set to channel {}", stream.channel())
            };
            format!(
                "DMA{} stream {} channel {}, {state}",
                slot.controller, slot.stream, slot.channel
            )
        })
        .collect();
    format!("{} requests on {}", line.name, places.join("; or "))
}
