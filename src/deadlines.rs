//! Every task checks in; the control tick feeds the watchdog only while all of them met their deadline.

use core::sync::atomic::{AtomicU32, Ordering};

use embassy_time::{Duration, Instant, Timer};

/// Tasks below the control tick.
#[derive(Clone, Copy, PartialEq, Eq, defmt::Format)]
pub enum Watched {
    Imu,
    Mag,
    Sbus,
    Logic,
    Status,
}

impl Watched {
    const ALL: [Self; 5] = [Self::Imu, Self::Mag, Self::Sbus, Self::Logic, Self::Status];

    fn last_check_in(self) -> &'static AtomicU32 {
        static IMU: AtomicU32 = AtomicU32::new(0);
        static MAG: AtomicU32 = AtomicU32::new(0);
        static SBUS: AtomicU32 = AtomicU32::new(0);
        static LOGIC: AtomicU32 = AtomicU32::new(0);
        static STATUS: AtomicU32 = AtomicU32::new(0);
        match self {
            Self::Imu => &IMU,
            Self::Mag => &MAG,
            Self::Sbus => &SBUS,
            Self::Logic => &LOGIC,
            Self::Status => &STATUS,
        }
    }

    /// The task is alive.
    pub fn check_in(self) {
        self.last_check_in().store(now_us(), Ordering::Relaxed);
    }
}

/// Every watched task runs at least each 10 ms. With the watchdog's longest period this gives a reset within 60 ms.
const DEADLINE_US: u32 = 25_000;

/// Gives every task a first deadline, counted from now.
pub fn start() {
    for task in Watched::ALL {
        task.check_in();
    }
}

/// A task that missed its deadline, if there is one.
pub fn missed() -> Option<Watched> {
    let now_us = now_us();
    Watched::ALL.into_iter().find(|task| {
        let age_us = now_us.wrapping_sub(task.last_check_in().load(Ordering::Relaxed));
        // A check-in may come between the two reads, so that its time lies just ahead of `now_us`.
        (DEADLINE_US..u32::MAX / 2).contains(&age_us)
    })
}

/// Sleeps in steps short enough for the deadline.
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

/// The low half of the microsecond clock: deadlines are far shorter than its 71 minutes.
fn now_us() -> u32 {
    Instant::now().as_micros() as u32
}
