//! The newest value of a message, handed from one writer to any number of readers on one core.
//!
//! Two slots and two counters. The writer announces a publication (`begun`), fills the slot that
//! holds the *older* value, and then makes it the newest (`published`). A reader copies the slot
//! that `published` names and keeps the copy unless a *second* publication began meanwhile, because
//! only that one reuses the slot it was reading.
//!
//! What this gives on a single core with any preemption:
//!
//! - A reader that interrupts the writer, even in the middle of a publication, copies once and
//!   returns: the slot it reads is not the one being filled, and the writer cannot run before it is
//!   done. The same holds for a reader at the writer's priority.
//! - A reader that the writer interrupts copies again only if two publications began within one
//!   copy. A copy takes microseconds and the fastest writer here publishes once a millisecond, so
//!   this needs the reader to be suspended for a whole period of the writer; each further repeat
//!   needs the same once more.
//! - The value returned was the newest one at the moment `latest` read `published`, and a reader
//!   never sees an older value after a newer one.
//!
//! Slots are copied word by word with relaxed atomics, ordered by one release fence in the writer
//! and one acquire fence in the reader (the pattern of Boehm, "Can seqlocks get along with
//! programming language memory models?", MSPC 2012), so no access is a data race.
//! The words are `MaybeUninit`, because the padding of `T` has no value, and a copy becomes a `T`
//! only after the counters have shown that it is whole.
//!
//! The counters wrap after 2^32 publications: a reader would have to be suspended for exactly a
//! multiple of that (seven weeks at 1 kHz) to be misled.
#![cfg_attr(not(any(test, loom)), no_std)]
#![deny(
    missing_docs,
    clippy::undocumented_unsafe_blocks,
    clippy::multiple_unsafe_ops_per_block
)]

mod slot;

use slot::Slot;

use core::mem::MaybeUninit;
#[cfg(not(loom))]
use core::{
    hint::spin_loop,
    sync::atomic::{AtomicBool, AtomicU32, Ordering, fence},
};
#[cfg(loom)]
use loom::{
    hint::spin_loop,
    sync::atomic::{AtomicBool, AtomicU32, Ordering, fence},
};

/// A double-buffered message of type `T`: one [`Writer`], readers at any priority.
///
/// `T` must be aligned to at least four bytes (checked when it is built): slots are copied in
/// 32-bit words. Every message that carries a `ts_us` is.
///
/// ```
/// use robot_snapshot::Snapshot;
///
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Speed {
///     ts_us: u64,
///     mps: f32,
/// }
///
/// static SPEED: Snapshot<Speed> = Snapshot::new(Speed { ts_us: 0, mps: 0.0 });
///
/// // There is one writer for the life of the snapshot.
/// let mut writer = SPEED.writer().expect("nobody asked before");
/// assert!(SPEED.writer().is_none());
///
/// // A follower copies a value only once.
/// let mut follower = SPEED.follower();
/// writer.publish(&Speed { ts_us: 1_000, mps: 0.4 });
/// assert_eq!(follower.changed().map(|speed| speed.mps), Some(0.4));
/// assert_eq!(follower.changed(), None);
/// assert_eq!(SPEED.latest().ts_us, 1_000);
/// ```
pub struct Snapshot<T> {
    slots: [Slot<T>; 2],
    /// Number of the publication being written or written last; its slot is `begun % 2`.
    begun: AtomicU32,
    /// Number of the newest complete publication; its slot is `published % 2`.
    published: AtomicU32,
    writer_taken: AtomicBool,
}

// SAFETY: shared access goes through atomics alone, and only copies of `T` cross between contexts,
// which `T: Send` allows.
unsafe impl<T: Copy + Send> Sync for Snapshot<T> {}

impl<T: Copy> Snapshot<T> {
    /// A snapshot that reads as `init` until the first publication.
    #[cfg(not(loom))]
    #[inline(never)]
    pub const fn new(init: T) -> Self {
        Self {
            slots: [Slot::new(init), Slot::new(init)],
            begun: AtomicU32::new(0),
            published: AtomicU32::new(0),
            writer_taken: AtomicBool::new(false),
        }
    }

    /// As above; loom's atomics cannot be built in a constant.
    #[cfg(loom)]
    pub fn new(init: T) -> Self {
        Self {
            slots: [Slot::new(init), Slot::new(init)],
            begun: AtomicU32::new(0),
            published: AtomicU32::new(0),
            writer_taken: AtomicBool::new(false),
        }
    }

    /// The writing end, or `None` if it was handed out before: there is one for the life of the
    /// snapshot, so that two writers cannot exist.
    pub fn writer(&self) -> Option<Writer<'_, T>> {
        let taken_before = self.writer_taken.swap(true, Ordering::Relaxed);
        (!taken_before).then_some(Writer {
            snapshot: self,
            last: 0,
        })
    }

    /// A copy of the newest published value. Never waits for the writer; the module text says when
    /// a copy is repeated.
    pub fn latest(&self) -> T {
        let mut copy = MaybeUninit::uninit();
        self.read(&mut copy);
        // SAFETY: `read` leaves a whole value.
        unsafe { copy.assume_init() }
    }

    /// A reader that keeps its copy.
    pub fn follower(&self) -> Follower<'_, T> {
        let mut copy = MaybeUninit::uninit();
        let seen = self.read(&mut copy);
        Follower {
            snapshot: self,
            seen,
            copy,
        }
    }

    /// Fills `copy` with the newest value and gives the number of its publication.
    fn read(&self, copy: &mut MaybeUninit<T>) -> u32 {
        loop {
            let newest = self.published.load(Ordering::Acquire);
            self.slot(newest).load(copy);
            // Pairs with the writer's release fence: whoever saw a word of a later publication
            // also sees that it began.
            fence(Ordering::Acquire);
            let begun = self.begun.load(Ordering::Relaxed);
            if begun.wrapping_sub(newest) <= 1 {
                // Publication `newest` was complete when its number was read, and the next one to
                // use its slot, `newest + 2`, had not begun when the copy ended: every word comes
                // from one value.
                return newest;
            }
            spin_loop();
        }
    }

    fn slot(&self, publication: u32) -> &Slot<T> {
        let [even, odd] = &self.slots;
        if publication.is_multiple_of(2) {
            even
        } else {
            odd
        }
    }
}

/// A reader with a copy of its own. It suits a reader that runs more often than the writer.
pub struct Follower<'a, T> {
    snapshot: &'a Snapshot<T>,
    /// Number of the publication that `copy` is of.
    seen: u32,
    /// A complete value, except while `follow` fills it.
    copy: MaybeUninit<T>,
}

impl<T: Copy> Follower<'_, T> {
    /// The newest published value, as [`Snapshot::latest`]; copies it only if it is new.
    pub fn latest(&mut self) -> &T {
        self.follow();
        self.last()
    }

    /// The newest value if it was published since the last call, otherwise `None`.
    pub fn changed(&mut self) -> Option<&T> {
        self.follow().then_some(self.last())
    }

    /// The value of the last call of [`latest`](Self::latest) or [`changed`](Self::changed).
    pub fn last(&self) -> &T {
        // SAFETY: whole since the follower was made (see the field).
        unsafe { self.copy.assume_init_ref() }
    }

    fn follow(&mut self) -> bool {
        let is_new = self.snapshot.published.load(Ordering::Acquire) != self.seen;
        if is_new {
            self.seen = self.snapshot.read(&mut self.copy);
        }
        is_new
    }
}

/// The one writing end of a [`Snapshot`].
pub struct Writer<'a, T> {
    snapshot: &'a Snapshot<T>,
    /// Number of the last publication of this writer.
    last: u32,
}

impl<T: Copy> Writer<'_, T> {
    /// Makes `value` the newest value. The time this takes does not depend on the readers.
    pub fn publish(&mut self, value: &T) {
        let number = self.last.wrapping_add(1);
        self.snapshot.begun.store(number, Ordering::Relaxed);
        // A reader that sees any word stored below also sees `begun`.
        fence(Ordering::Release);
        self.snapshot.slot(number).store(value);
        self.snapshot.published.store(number, Ordering::Release);
        self.last = number;
    }
}

#[cfg(all(test, not(loom)))]
mod tests;
