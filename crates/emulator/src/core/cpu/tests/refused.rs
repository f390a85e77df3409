//! Operations that the processor refuses, although the engine would carry them out.

use super::*;

const UNALIGNED: u32 = 1 << 24;
const INVSTATE: u32 = 1 << 17;

/// Runs with handlers that leave their exception number. Returns these numbers and CFSR.
fn faults_of(thread: &[u16]) -> (Vec<u32>, u32) {
    let leave = |number| program(&[&trace(number), &[STAY]]);
    let handlers = [
        (Exception::HARD_FAULT, leave(3)),
        (Exception::BUS_FAULT, leave(5)),
        (Exception::USAGE_FAULT, leave(6)),
    ];
    let mut cpu = board(&program(&[thread, &trace(1), &[STAY]]), &handlers);
    run_until(&mut cpu, 200 * US).expect("a handler runs");
    (traced(&cpu), cpu.state().system.faults.cfsr)
}

#[test]
fn a_call_of_nothing_is_a_usage_fault() {
    // movs r0, #0; blx r0
    assert_eq!(faults_of(&[0x2000, 0x4780]), (vec![6], INVSTATE));
}

/// The address has the Thumb bit, so the vector table at address 0 runs as code until it ends.
#[test]
fn a_call_of_address_one_ends_in_a_fault() {
    // movs r0, #1; blx r0
    let (left, cfsr) = faults_of(&[0x2001, 0x4780]);
    assert_eq!(left.len(), 1);
    assert!(left != [1] && cfsr != 0, "{left:?}, {cfsr:#x}");
}

#[test]
fn words_in_pairs_and_lists_must_be_aligned() {
    // movw r2, #0x100 + offset; movt r2, #0x2000
    let base = |offset: u16| [0xF240, 0x1200 | offset, 0xF2C2, 0x0200];
    for access in [
        &[0xE9D2, 0x0100][..], // ldrd r0, r1, [r2]
        &[0xE9D2, 0x2300],     // ldrd r2, r3, [r2]
        &[0xE9C2, 0x0100],     // strd r0, r1, [r2]
        &[0xCA03],             // ldm r2!, {r0, r1}
        &[0xC203],             // stm r2!, {r0, r1}
        &[0xED92, 0x0A00],     // vldr s0, [r2]
    ] {
        for offset in [1, 2, 3] {
            let seen = faults_of(&[&base(offset), access].concat());
            assert_eq!(seen, (vec![6], UNALIGNED), "{access:04X?} at {offset}");
        }
        let seen = faults_of(&[&base(4), access].concat());
        assert_eq!(seen, (vec![1], 0), "{access:04X?}");
    }
    // ldr r0, [r2]; strh r0, [r2]: single accesses need not be aligned.
    let single = faults_of(&[&base(1)[..], &[0x6810, 0x8010]].concat());
    assert_eq!(single, (vec![1], 0));
}

#[test]
fn a_pointer_out_of_memory_must_be_aligned_too() {
    // movs r5, #1; str r7, [r7]; ldr r2, [r7]; add r2, r5; ldrd r0, r1, [r2]
    let with = |offset: u16| [0x2500 | offset, 0x603F, 0x683A, 0x442A, 0xE9D2, 0x0100];
    assert_eq!(
        faults_of(&[&with(1)[..], &ISB].concat()),
        (vec![6], UNALIGNED)
    );
    assert_eq!(faults_of(&[&with(4)[..], &ISB].concat()), (vec![1], 0));
}

/// movs r0, #1; msr control, r0; isb: thread mode without privilege.
const DROP_PRIVILEGE: [u16; 5] = [0x2001, 0xF380, 0x8814, 0xF3BF, 0x8F6F];

#[test]
fn unprivileged_code_does_not_reach_the_core_s_registers() {
    // movw r2, #0xED08; movt r2, #0xE000: VTOR; str r0, [r2] or ldr r0, [r2]
    for access in [0x6010, 0x6810] {
        let thread = [
            &DROP_PRIVILEGE[..],
            &[0xF64E, 0x5208, 0xF2CE, 0x0200, access],
        ]
        .concat();
        // PRECISERR and BFARVALID.
        assert_eq!(faults_of(&thread), (vec![5], 0x8200));
    }
}

#[test]
fn unprivileged_code_reaches_memory_and_handlers_have_privilege() {
    let thread = program(&[&DROP_PRIVILEGE, &[0xDF00], &trace(1), &[STAY]]); // svc #0
    // movw r2, #0xED08; movt r2, #0xE000; ldr r0, [r2]; str r0, [r7], #4
    let call = program(&[
        &[0xF64E, 0x5208, 0xF2CE, 0x0200, 0x6810],
        &TRACE_R0,
        &[RETURN],
    ]);
    let mut cpu = board(&thread, &[(Exception::SV_CALL, call)]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [0, 1]);
}
