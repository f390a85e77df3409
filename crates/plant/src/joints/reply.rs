//! The frame that a motor sends in reply to each frame it receives.

use super::mit_frame::Feedback;
use crate::{
    time::{Ps, US},
    wire::CanFrame,
};

/// Time from the end of a command until the reply is ready. An assumption: no source gives it.
const REPLY_TIME: Ps = 150 * US;

#[derive(Clone, Copy, Debug)]
struct Reply {
    ready_at: Ps,
    frame: CanFrame,
    fed_back: Option<Feedback>,
}

/// The reply that waits for the bus. The next one replaces it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ReplyBox {
    waiting: Option<Reply>,
    last_feedback: Option<([u8; 8], Feedback)>,
    on_the_wire: Feedback,
}

impl ReplyBox {
    /// Queues a feedback; `frozen` repeats the last one instead.
    pub(super) fn feedback(
        &mut self,
        id: u32,
        data: [u8; 8],
        fed_back: Feedback,
        frozen: bool,
        now: Ps,
    ) {
        let (data, fed_back) = match self.last_feedback {
            Some(last) if frozen => last,
            _ => (data, fed_back),
        };
        self.last_feedback = Some((data, fed_back));
        self.put(id, data, Some(fed_back), now + REPLY_TIME);
    }

    /// Queues a reply without feedback.
    pub(super) fn other(&mut self, id: u32, data: [u8; 8], received: Ps) {
        self.put(id, data, None, received + REPLY_TIME);
    }

    fn put(&mut self, id: u32, data: [u8; 8], fed_back: Option<Feedback>, ready_at: Ps) {
        let frame = CanFrame::with_data(id, data);
        self.waiting = Some(Reply {
            ready_at,
            frame,
            fed_back,
        });
    }

    /// Time at which the waiting reply is ready for the bus.
    pub(super) fn ready_at(&self) -> Option<Ps> {
        self.waiting.map(|reply| reply.ready_at)
    }

    pub(super) fn pending(&self, now: Ps) -> Option<CanFrame> {
        self.waiting
            .filter(|reply| reply.ready_at <= now)
            .map(|reply| reply.frame)
    }

    pub(super) fn sent(&mut self) {
        if let Some(fed_back) = self.waiting.take().and_then(|reply| reply.fed_back) {
            self.on_the_wire = fed_back;
        }
    }

    pub(super) fn drop_waiting(&mut self) {
        self.waiting = None;
    }

    /// The last feedback that was sent.
    pub(super) fn on_the_wire(&self) -> Feedback {
        self.on_the_wire
    }
}
