//! Deadlines of the tasks. Every task checks in; while one is late, the control tick stops the robot and does not feed the
//! watchdog.

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_time::{Duration, Instant, Timer};
use robot_app::domain::LateTasks;

/// The tasks below the control tick, which it watches.
#[derive(Clone, Copy)]
pub enum Watched {
    Imu,
    Mag,
    Sbus,
    Logic,
    Status,
    Params,
    LinkReceive,
    LinkSend,
}

impl Watched {
    const ALL: [Self; 8] = [
        Self::Imu,
        Self::Mag,
        Self::Sbus,
        Self::Logic,
        Self::Status,
        Self::Params,
        Self::LinkReceive,
        Self::LinkSend,
    ];

    fn last_check_in(self) -> &'static AtomicU32 {
        let [
            imu,
            mag,
            sbus,
            logic,
            status,
            params,
            link_receive,
            link_send,
        ] = &LAST_CHECK_INS;
        match self {
            Self::Imu => imu,
            Self::Mag => mag,
            Self::Sbus => sbus,
            Self::Logic => logic,
            Self::Status => status,
            Self::Params => params,
            Self::LinkReceive => link_receive,
            Self::LinkSend => link_send,
        }
    }

    /// Notes that the task is alive.
    pub fn check_in(self) {
        self.last_check_in().store(now_us(), Ordering::Relaxed);
    }

    fn is_late(self, now_us: u32) -> bool {
        is_past(self.last_check_in(), now_us)
    }
}

/// Times of the last check-ins, one after the other, because each control tick reads them all.
static LAST_CHECK_INS: [AtomicU32; 8] = [const { AtomicU32::new(0) }; 8];

fn is_past(last_check_in: &AtomicU32, now_us: u32) -> bool {
    let age_us = now_us.wrapping_sub(last_check_in.load(Ordering::Relaxed));
    // A check-in may come after `now_us` was read, so that its time lies just ahead.
    (DEADLINE_US..u32::MAX / 2).contains(&age_us)
}

/// Longest time between two check-ins. Every watched task runs at least once in 10 ms. With the short period of
/// `drivers/watchdog.rs`, which is in force while the robot is armed, a late task leads to a reset within 60 ms.
const DEADLINE_US: u32 = 25_000;

/// Starts all deadlines from now, at boot and after a stall.
#[inline(never)]
pub fn start() {
    for task in Watched::ALL {
        task.check_in();
    }
}

/// Whether any task missed its deadline.
pub fn any_late(now_us: u64) -> bool {
    let now_us = now_us as u32;
    LAST_CHECK_INS.iter().any(|last| is_past(last, now_us))
}

/// The tasks that missed their deadline.
#[cold]
#[inline(never)]
pub fn late_tasks(now_us: u64) -> LateTasks {
    let now_us = now_us as u32;
    LateTasks {
        imu: Watched::Imu.is_late(now_us),
        mag: Watched::Mag.is_late(now_us),
        sbus: Watched::Sbus.is_late(now_us),
        logic: Watched::Logic.is_late(now_us),
        status: Watched::Status.is_late(now_us),
        params: Watched::Params.is_late(now_us),
        link_receive: Watched::LinkReceive.is_late(now_us),
        link_send: Watched::LinkSend.is_late(now_us),
    }
}

/// Sleeps in steps, with a check-in at least every 10 ms.
pub async fn sleep_checking_in(task: Watched, duration: Duration) {
    const STEP: Duration = Duration::from_millis(10);
    let mut left = duration;
    while left > STEP {
        Timer::after(STEP).await;
        task.check_in();
        left = left.checked_sub(STEP).unwrap_or(Duration::MIN);
    }
    Timer::after(left).await;
    task.check_in();
}

/// The low half of the clock in µs. It wraps after 71 minutes, far longer than a deadline.
fn now_us() -> u32 {
    Instant::now().as_micros() as u32
}
