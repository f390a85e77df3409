//! The tunnel of the PC link: queues of tuning-channel frames between the link tasks and the control task.

use core::future::poll_fn;
use core::sync::atomic::{AtomicU32, Ordering};
use core::task::Poll;

use embassy_sync::waitqueue::AtomicWaker;
use heapless::spsc::{Consumer, Producer, Queue};
use robot_app::domain::CanFrame;
use static_cell::StaticCell;

/// Places for requests, of which one stays unused. A client waits for each reply.
const REQUESTS: usize = 4;
/// Places for replies, of which one stays unused. Two may come in a tick, and a state frame holds the line for 2 ms.
const REPLIES: usize = 16;

static REPLY_WAKER: AtomicWaker = AtomicWaker::new();
/// Frames lost because a queue was full.
static DROPPED: AtomicU32 = AtomicU32::new(0);

/// The ends of both queues.
pub struct Tunnel {
    pub receive: TunnelRequests,
    pub send: TunnelReplies,
    pub control: ControlTunnel,
}

impl Tunnel {
    /// Makes the one tunnel.
    ///
    /// # Panics
    /// On a second call.
    pub fn init() -> Self {
        static REQUEST_QUEUE: StaticCell<Queue<CanFrame, REQUESTS>> = StaticCell::new();
        static REPLY_QUEUE: StaticCell<Queue<CanFrame, REPLIES>> = StaticCell::new();
        let (request_in, request_out) = REQUEST_QUEUE.init(Queue::new()).split();
        let (reply_in, reply_out) = REPLY_QUEUE.init(Queue::new()).split();
        Self {
            receive: TunnelRequests(request_in),
            send: TunnelReplies(reply_out),
            control: ControlTunnel {
                requests: request_out,
                replies: reply_in,
            },
        }
    }

    /// Frames lost since boot because a queue was full.
    pub fn dropped() -> u32 {
        DROPPED.load(Ordering::Relaxed)
    }
}

/// The link receive task's end.
pub struct TunnelRequests(Producer<'static, CanFrame>);

impl TunnelRequests {
    pub fn push(&mut self, request: CanFrame) {
        count_if_full(self.0.enqueue(request));
    }
}

/// The link send task's end.
pub struct TunnelReplies(Consumer<'static, CanFrame>);

impl TunnelReplies {
    /// Waits for the next reply.
    pub async fn next(&mut self) -> CanFrame {
        poll_fn(|cx| {
            REPLY_WAKER.register(cx.waker());
            match self.0.dequeue() {
                Some(reply) => Poll::Ready(reply),
                None => Poll::Pending,
            }
        })
        .await
    }
}

/// The control task's end.
pub struct ControlTunnel {
    requests: Consumer<'static, CanFrame>,
    replies: Producer<'static, CanFrame>,
}

impl ControlTunnel {
    /// Takes one request. The others wait for later ticks, so that no tick grows long.
    pub fn request(&mut self) -> Option<CanFrame> {
        self.requests.dequeue()
    }

    pub fn reply(&mut self, frames: &[CanFrame]) {
        if frames.is_empty() {
            return;
        }
        for frame in frames {
            count_if_full(self.replies.enqueue(*frame));
        }
        REPLY_WAKER.wake();
    }
}

fn count_if_full(result: Result<(), CanFrame>) {
    if result.is_err() {
        DROPPED.fetch_add(1, Ordering::Relaxed);
    }
}
