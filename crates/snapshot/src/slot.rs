//! Storage for one value, written and copied in 32-bit words while another context may look.

use core::mem::MaybeUninit;

#[cfg(not(loom))]
pub use target::Slot;

#[cfg(loom)]
pub use model::Slot;

/// Words in a `T`; refuses a `T` that is not made of whole words.
const fn words<T>() -> usize {
    assert!(
        align_of::<T>().is_multiple_of(4),
        "a message must be aligned to four bytes: give it its ts_us or repr(align(4))"
    );
    size_of::<T>() / 4
}

#[cfg(not(loom))]
mod target {
    use super::{MaybeUninit, words};
    use atomic_maybe_uninit::AtomicMaybeUninit;
    use core::{cell::UnsafeCell, sync::atomic::Ordering};

    pub struct Slot<T>(UnsafeCell<MaybeUninit<T>>);

    /// Calls `f` with 0, 1, … `count − 1`. Eight calls a round: the copies are part of the control
    /// tick, and a compiler that is asked for small code leaves one.
    #[inline(always)]
    fn for_each_index(count: usize, f: impl Fn(usize)) {
        let mut start = 0;
        while start + 8 <= count {
            f(start);
            f(start + 1);
            f(start + 2);
            f(start + 3);
            f(start + 4);
            f(start + 5);
            f(start + 6);
            f(start + 7);
            start += 8;
        }
        while start < count {
            f(start);
            start += 1;
        }
    }

    impl<T: Copy> Slot<T> {
        const WORDS: usize = words::<T>();

        pub const fn new(init: T) -> Self {
            Self(UnsafeCell::new(MaybeUninit::new(init)))
        }

        /// What ends up in `copy` may mix words of several values if the slot was written meanwhile.
        pub fn load(&self, copy: &mut MaybeUninit<T>) {
            let to = copy.as_mut_ptr().cast::<MaybeUninit<u32>>();
            for_each_index(Self::WORDS, |index| {
                let word = self.word(index).load(Ordering::Relaxed);
                // SAFETY: `index < WORDS`, so the word lies inside `copy`.
                let place = unsafe { to.add(index) };
                // SAFETY: `place` lies inside `copy`, which is borrowed mutably, and `words` has
                // shown that `T` is aligned for it.
                unsafe { place.write(word) };
            });
        }

        /// Must not run twice at a time: `Snapshot` has one writer.
        pub fn store(&self, value: &T) {
            let from = core::ptr::from_ref(value).cast::<MaybeUninit<u32>>();
            for_each_index(Self::WORDS, |index| {
                // SAFETY: `index < WORDS`, so the word lies inside `value`.
                let place = unsafe { from.add(index) };
                // SAFETY: `place` lies inside `value`, `words` has shown that it is aligned, and a
                // `MaybeUninit` may be padding.
                let word = unsafe { place.read() };
                self.word(index).store(word, Ordering::Relaxed);
            });
        }

        /// The caller keeps `index` below `WORDS`.
        fn word(&self, index: usize) -> &AtomicMaybeUninit<u32> {
            debug_assert!(index < Self::WORDS);
            let words = self.0.get().cast::<MaybeUninit<u32>>();
            // SAFETY: both callers count up to `WORDS`, so the word lies inside the cell.
            let word = unsafe { words.add(index) };
            // SAFETY: `word` is aligned (`words::<T>` checks), lives as long as `self` and is only
            // ever reached through these atomics.
            unsafe { AtomicMaybeUninit::from_ptr(word) }
        }
    }
}

/// The same storage out of loom's atomics, so that the model checker sees every word.
/// Loom has no `MaybeUninit` atomics, so a modelled `T` must have no padding.
#[cfg(loom)]
mod model {
    use super::{MaybeUninit, words};
    use core::marker::PhantomData;
    use loom::sync::atomic::{AtomicU32, Ordering};

    pub struct Slot<T> {
        words: Vec<AtomicU32>,
        value: PhantomData<T>,
    }

    impl<T: Copy> Slot<T> {
        pub fn new(init: T) -> Self {
            let words = Self::split(&init).map(AtomicU32::new).collect();
            Self {
                words,
                value: PhantomData,
            }
        }

        pub fn load(&self, copy: &mut MaybeUninit<T>) {
            let to = copy.as_mut_ptr().cast::<u32>();
            for (index, word) in self.words.iter().enumerate() {
                // SAFETY: there are as many words as `T` has.
                let place = unsafe { to.add(index) };
                // SAFETY: `place` lies inside `copy`, and `words` has checked its alignment.
                unsafe { place.write(word.load(Ordering::Relaxed)) };
            }
        }

        pub fn store(&self, value: &T) {
            for (word, new) in self.words.iter().zip(Self::split(value)) {
                word.store(new, Ordering::Relaxed);
            }
        }

        fn split(value: &T) -> impl Iterator<Item = u32> {
            let from = core::ptr::from_ref(value).cast::<u32>();
            (0..words::<T>()).map(move |index| {
                // SAFETY: there are as many words as `T` has, so this one lies inside `value`.
                let place = unsafe { from.add(index) };
                // SAFETY: `place` is aligned (`words` checks), and a modelled `T` has no padding.
                unsafe { place.read() }
            })
        }
    }
}
