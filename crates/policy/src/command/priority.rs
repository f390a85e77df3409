//! Real time, where the system allows it.

/// Priority among SCHED_FIFO's 1 to 99: above all that is not real time, below what the kernel itself needs.
#[cfg(target_os = "linux")]
const PRIORITY: u8 = 50;

/// Asks for SCHED_FIFO for this thread. Returns what came of it.
#[cfg(target_os = "linux")]
pub fn raise() -> String {
    use thread_priority::{
        RealtimeThreadSchedulePolicy, ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy,
        set_thread_priority_and_policy, thread_native_id,
    };
    let priority = ThreadPriorityValue::try_from(PRIORITY).map(ThreadPriority::Crossplatform);
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let set = priority.is_ok_and(|priority| {
        set_thread_priority_and_policy(thread_native_id(), priority, policy).is_ok()
    });
    if set {
        format!("real time: SCHED_FIFO, priority {PRIORITY}")
    } else {
        "real time: not allowed here, so other programs may delay the loop; `sudo setcap cap_sys_nice+ep $(which policy)` \
         allows it"
            .to_owned()
    }
}

/// Says that there is no real time.
#[cfg(not(target_os = "linux"))]
pub fn raise() -> String {
    "real time: on Linux only, so other programs may delay the loop".to_owned()
}
