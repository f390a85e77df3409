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
    use super::{MaybeUninit, copy_blocks, words};
    use atomic_maybe_uninit::AtomicMaybeUninit;
    use core::{cell::UnsafeCell, sync::atomic::Ordering};

    pub struct Slot<T>(UnsafeCell<MaybeUninit<T>>);

    impl<T: Copy> Slot<T> {
        const WORDS: usize = words::<T>();

        pub const fn new(init: T) -> Self {
            Self(UnsafeCell::new(MaybeUninit::new(init)))
        }

        /// What ends up in `copy` may mix words of several values if the slot was written meanwhile.
        pub fn load(&self, copy: &mut MaybeUninit<T>) {
            let to = copy.as_mut_ptr().cast::<MaybeUninit<u32>>();
            // SAFETY: cell and copy both hold `WORDS` aligned words (`words::<T>` checks); `copy` is borrowed mutably,
            // and the cell is only ever reached word by word.
            let copied = unsafe { copy_blocks(self.0.get().cast(), to, Self::WORDS) };
            for index in copied..Self::WORDS {
                let word = self.word(index).load(Ordering::Relaxed);
                // SAFETY: `index < WORDS`, so the word lies inside `copy`.
                let place = unsafe { to.add(index) };
                // SAFETY: `place` lies inside `copy`, which is borrowed mutably, and `words` has
                // shown that `T` is aligned for it.
                unsafe { place.write(word) };
            }
        }

        /// Must not run twice at a time: `Snapshot` has one writer.
        pub fn store(&self, value: &T) {
            let from = core::ptr::from_ref(value).cast::<MaybeUninit<u32>>();
            // SAFETY: as in `load`, and `value` is borrowed.
            let copied = unsafe { copy_blocks(from, self.0.get().cast(), Self::WORDS) };
            for index in copied..Self::WORDS {
                // SAFETY: `index < WORDS`, so the word lies inside `value`.
                let place = unsafe { from.add(index) };
                // SAFETY: `place` lies inside `value`, `words` has shown that it is aligned, and a
                // `MaybeUninit` may be padding.
                let word = unsafe { place.read() };
                self.word(index).store(word, Ordering::Relaxed);
            }
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

/// Copies words in blocks of eight, four and two, and returns how many it has copied: all but the last of an odd number.
/// The copies are part of the control tick, and word by word they take three instructions each.
///
/// # Safety
/// `from` and `to` must be aligned and valid for `count` words. Nobody may access them meanwhile but word by word.
#[cfg(all(not(loom), target_arch = "arm"))]
#[inline(always)]
unsafe fn copy_blocks(
    mut from: *const MaybeUninit<u32>,
    mut to: *mut MaybeUninit<u32>,
    count: usize,
) -> usize {
    const BLOCK: usize = 8;
    // Each access is of one aligned word, so it is atomic like those of `AtomicMaybeUninit`, which are written in assembly
    // too (ARMv7-M ARM A3.5.3: LDM, STM, LDRD and STRD are sequences of atomic word accesses). An interrupt may restart an
    // instruction, which then copies words again.
    for _ in 0..count / BLOCK {
        // SAFETY: one block lies ahead of both pointers (contract).
        unsafe {
            core::arch::asm!(
                "ldm {from}!, {{r2, r3, r4, r5, r8, r10, r12, lr}}",
                "stm {to}!, {{r2, r3, r4, r5, r8, r10, r12, lr}}",
                from = inout(reg) from,
                to = inout(reg) to,
                out("r2") _,
                out("r3") _,
                out("r4") _,
                out("r5") _,
                out("r8") _,
                out("r10") _,
                out("r12") _,
                out("lr") _,
                options(nostack, preserves_flags),
            );
        }
    }
    if count % BLOCK >= 4 {
        // SAFETY: four words lie ahead of both pointers.
        unsafe {
            core::arch::asm!(
                "ldm {from}!, {{r2, r3, r4, r5}}",
                "stm {to}!, {{r2, r3, r4, r5}}",
                from = inout(reg) from,
                to = inout(reg) to,
                out("r2") _,
                out("r3") _,
                out("r4") _,
                out("r5") _,
                options(nostack, preserves_flags),
            );
        }
    }
    if count % 4 >= 2 {
        // SAFETY: two words lie ahead of both pointers.
        unsafe {
            core::arch::asm!(
                "ldrd {first}, {second}, [{from}]",
                "strd {first}, {second}, [{to}]",
                from = in(reg) from,
                to = in(reg) to,
                first = out(reg) _,
                second = out(reg) _,
                options(nostack, preserves_flags),
            );
        }
    }
    count / 2 * 2
}

/// Elsewhere words are copied one by one.
///
/// # Safety
/// None is needed: it touches nothing.
#[cfg(all(not(loom), not(target_arch = "arm")))]
unsafe fn copy_blocks(_: *const MaybeUninit<u32>, _: *mut MaybeUninit<u32>, _: usize) -> usize {
    0
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
