//! Exceptions and sleep, on hand-assembled programs that leave a trace in SRAM.

use super::*;
use crate::{soc::test_board::NoBoard, time::US};

mod debug;
mod fault_injection;
mod refused;
mod sleep;
mod standstill;

const TRACE: u32 = 0x2000_0000;
const CODE: u32 = 0x0800_0200;
const ROUTINE: u32 = 0x80;
const STACK_TOP: u32 = 0x2001_0000;

/// r7 = TRACE; r4 = NVIC_STIR; CPACR = full access to the FPU; dsb; isb
const START: [u16; 20] = [
    0xF240, 0x0700, 0xF2C2, 0x0700, // movw r7, #0; movt r7, #0x2000
    0xF64E, 0x7400, 0xF2CE, 0x0400, // movw r4, #0xEF00; movt r4, #0xE000
    0xF64E, 0x5088, 0xF2CE, 0x0000, // movw r0, #0xED88; movt r0, #0xE000
    0xF44F, 0x0170, 0x6001, 0xBF00, // mov r1, #0xF00000; str r1, [r0]; nop
    0xF3BF, 0x8F4F, 0xF3BF, 0x8F6F, // dsb; isb
];
const ISB: [u16; 2] = [0xF3BF, 0x8F6F];
const WFE: u16 = 0xBF20;
const WFI: u16 = 0xBF30;
const SEV: u16 = 0xBF40;
const CPSID_I: u16 = 0xB672;
const CPSIE_I: u16 = 0xB662;
const STAY: u16 = 0xE7FE; // b .
const RETURN: u16 = 0x4770; // bx lr
const TRACE_R0: [u16; 2] = [0xF847, 0x0B04]; // str r0, [r7], #4
const TRACE_R2: [u16; 2] = [0xF847, 0x2B04]; // str r2, [r7], #4
const TRACE_LR: [u16; 2] = [0xF847, 0xEB04]; // str lr, [r7], #4

/// movs r1, #value; str r1, [r7], #4
fn trace(value: u8) -> [u16; 3] {
    [0x2100 | u16::from(value), 0xF847, 0x1B04]
}

/// movs r0, #irq; str r0, [r4]; isb: software-triggered interrupt
fn pend(irq: u8) -> [u16; 4] {
    [0x2000 | u16::from(irq), 0x6020, ISB[0], ISB[1]]
}

fn program(parts: &[&[u16]]) -> Vec<u16> {
    parts.concat()
}

/// The chip with `thread` behind the reset vector (after `START`) and handlers by exception number.
fn board(thread: &[u16], handlers: &[(Exception, Vec<u16>)]) -> Cpu {
    let mut vectors = vec![0_u32; 98];
    vectors[0] = STACK_TOP;
    vectors[1] = CODE | 1;
    let mut segments = vec![segment(CODE, &program(&[&START, thread]))];
    for (start, (exception, code)) in (CODE + ROUTINE..).step_by(ROUTINE as usize).zip(handlers) {
        vectors[exception.index()] = start | 1;
        segments.push(segment(start, code));
    }
    let table = vectors.iter().flat_map(|v| v.to_le_bytes()).collect();
    segments.push(Segment {
        address: FLASH.base,
        data: table,
    });
    let mut cpu = Cpu::new(&segments, None, Soc::new(Box::new(NoBoard::default())))
        .expect("the engine starts");
    for (exception, _) in handlers {
        cpu.state_mut().system.nvic.set_enabled(*exception, true);
    }
    cpu
}

fn segment(address: u32, code: &[u16]) -> Segment {
    assert!(code.len() * 2 <= ROUTINE as usize);
    Segment {
        address,
        data: code.iter().flat_map(|h| h.to_le_bytes()).collect(),
    }
}

fn irq(number: u8) -> Exception {
    Exception::from_irq(number)
}

/// Raises the request line of an interrupt and lowers it again.
fn pulse(cpu: &mut Cpu, irq: u8) {
    cpu.with_soc(|soc, _| {
        soc.irq.set(irq, true);
        soc.irq.set(irq, false);
    });
}

fn set_priority(cpu: &mut Cpu, number: u8, priority: u8) {
    cpu.state_mut()
        .system
        .nvic
        .set_priority_register(irq(number), priority);
}

/// Runs until `until`, sleep included.
fn run_until(cpu: &mut Cpu, until: Ps) -> Result<(), Halt> {
    while cpu.run(until)? != Pause::Limit {}
    Ok(())
}

fn traced(cpu: &Cpu) -> Vec<u32> {
    (TRACE..cpu.register(RegisterARM::R7))
        .step_by(4)
        .map(|at| word(cpu, at))
        .collect()
}

fn word(cpu: &Cpu, at: u32) -> u32 {
    let mut bytes = [0; 4];
    assert!(cpu.read_memory(at, &mut bytes));
    u32::from_le_bytes(bytes)
}

#[test]
fn a_higher_priority_interrupts_a_handler_and_a_lower_one_waits() {
    let thread = program(&[&pend(5), &trace(5), &[STAY]]);
    let middle = program(&[
        &trace(1),
        &pend(6),
        &trace(3),
        &pend(7),
        &trace(4),
        &[RETURN],
    ]);
    let high = program(&[&trace(2), &[RETURN]]);
    let low = program(&[&trace(9), &[RETURN]]);
    let mut cpu = board(&thread, &[(irq(5), middle), (irq(6), high), (irq(7), low)]);
    for (number, priority) in [(5, 0x40), (6, 0x20), (7, 0x60)] {
        set_priority(&mut cpu, number, priority);
    }
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1, 2, 3, 4, 9, 5]);
}

/// The load is executed in the first round only; the instructions after it are executed in each round.
#[test]
fn code_behind_a_conditional_load_from_a_register_is_never_skipped() {
    let before = [
        0x2300, 0x3301, // movs r3, #0; again: adds r3, #1
        0xF243, 0x0100, 0x2B01, 0xF2C4,
        0x0100, // movw r1, #0x3000; cmp r3, #1; movt r1, #0x4000
        0xBF04, 0x6888, 0xEA5F,
        0x72C0, // itt eq; ldreq r0, [r1, #8] (IWDG_RLR: odd); lslseq r2, r0, #31
        0xD004, // beq end
    ];
    let after = [0x2B03, 0xD1EF, STAY]; // cmp r3, #3; bne again; end: b .
    let mut cpu = board(&program(&[&before, &trace(7), &after]), &[]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [7, 7, 7]);
}

/// The first access to a page of RAM fills the engine's table of pages. The access is done in the first round only.
#[test]
fn code_behind_the_first_access_to_a_page_is_never_skipped() {
    const LDREQ: u16 = 0x6808; // r0, [r1]
    const STREQ: u16 = 0x6008; // r0, [r1]
    for access in [LDREQ, STREQ] {
        let before = [
            0x2300, 0x2000, 0x3301, // movs r3, #0; movs r0, #0; again: adds r3, #1
            0xF244, 0x0100, 0x2B01, 0xF2C2,
            0x0100, // movw r1, #0x4000; cmp r3, #1; movt r1, #0x2000
            0xBF04, access, 0xEA7F, 0x0200, // itt eq; …; mvnseq r2, r0
            0xD004, // beq end
        ];
        let after = [0x2B03, 0xD1EF, STAY]; // cmp r3, #3; bne again; end: b .
        let mut cpu = board(&program(&[&before, &trace(7), &after]), &[]);
        run_until(&mut cpu, 100 * US).expect("no fault");
        assert_eq!(traced(&cpu), [7, 7, 7], "0x{access:X}");
    }
}

#[test]
fn a_waiting_handler_follows_without_unstacking() {
    // r2 is in the frame, so only a return to thread mode would restore it between the handlers.
    let thread = program(&[
        &[0x2211, CPSID_I],
        &pend(5),
        &pend(6),
        &[CPSIE_I],
        &TRACE_R2,
        &[STAY],
    ]);
    let first = program(&[&TRACE_R2, &[0x2255, RETURN]]); // movs r2, #0x55
    let second = program(&[&TRACE_R2, &[RETURN]]);
    let mut cpu = board(&thread, &[(irq(5), first), (irq(6), second)]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [0x11, 0x55, 0x11]);
}

#[test]
fn primask_holds_an_interrupt_back_until_it_is_cleared() {
    let thread = program(&[
        &[CPSID_I],
        &pend(5),
        &trace(1),
        &[CPSIE_I],
        &trace(2),
        &[STAY],
    ]);
    let handler = program(&[&trace(9), &[RETURN]]);
    let mut cpu = board(&thread, &[(irq(5), handler)]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1, 9, 2]);
}

#[test]
fn floating_point_registers_survive_a_handler_that_uses_them() {
    let thread = program(&[
        &[0xEEB7, 0x0A00], // vmov.f32 s0, #1.0
        &pend(5),
        &[0xEE10, 0x0A10], // vmov r0, s0
        &TRACE_R0,
        &[STAY],
    ]);
    let handler = program(&[&[0xEEB0, 0x0A00], &TRACE_LR, &[RETURN]]); // vmov.f32 s0, #2.0
    let mut cpu = board(&thread, &[(irq(5), handler)]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    // EXC_RETURN for an extended frame on the main stack; 1.0.
    assert_eq!(traced(&cpu), [0xFFFF_FFE9, 0x3F80_0000]);
}

#[test]
fn without_floating_point_the_frame_is_short() {
    let thread = program(&[&pend(5), &[STAY]]);
    let handler = program(&[&TRACE_LR, &[STAY]]);
    let mut cpu = board(&thread, &[(irq(5), handler)]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [0xFFFF_FFF9]);
    assert_eq!(cpu.register(RegisterARM::MSP), STACK_TOP - 8 * 4);
}

#[test]
fn wfe_passes_once_after_sev_then_sleeps_until_an_interrupt() {
    let thread = program(&[&[SEV, WFE], &trace(1), &[WFE], &trace(2), &[STAY]]);
    let handler = program(&[&trace(9), &[RETURN]]);
    let mut cpu = board(&thread, &[(irq(5), handler)]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1]);
    assert!(cpu.stats().idle_cycles > cpu.stats().busy_cycles);
    pulse(&mut cpu, 5);
    run_until(&mut cpu, 200 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1, 9, 2]);
}

#[test]
fn an_exception_leaves_an_event_behind() {
    let thread = program(&[&pend(5), &[WFE], &trace(1), &[WFE], &trace(2), &[STAY]]);
    let mut cpu = board(&thread, &[(irq(5), vec![RETURN])]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1]);
}

#[test]
fn wfi_wakes_for_a_masked_interrupt_without_taking_it() {
    let thread = program(&[&[CPSID_I, WFI], &trace(1), &[CPSIE_I], &trace(2), &[STAY]]);
    let handler = program(&[&trace(9), &[RETURN]]);
    let mut cpu = board(&thread, &[(irq(5), handler)]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert!(traced(&cpu).is_empty());
    pulse(&mut cpu, 5);
    run_until(&mut cpu, 200 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1, 9, 2]);
}

#[test]
fn a_line_that_stays_high_calls_its_handler_again() {
    let handler = program(&[&trace(9), &[RETURN]]);
    let mut cpu = board(&[STAY], &[(irq(5), handler)]);
    run_until(&mut cpu, 5 * US).expect("the start sequence");
    cpu.with_soc(|soc, _| soc.irq.set(5, true));
    run_until(&mut cpu, 20 * US).expect("no fault");
    let calls = traced(&cpu).len();
    assert!(calls > 2);
    cpu.with_soc(|soc, _| soc.irq.set(5, false));
    run_until(&mut cpu, 40 * US).expect("no fault");
    let after = traced(&cpu).len();
    run_until(&mut cpu, 60 * US).expect("no fault");
    assert!(after <= calls + 1);
    assert_eq!(traced(&cpu).len(), after);
}

/// mov r2, #0x60000000; ldr r0, [r2]: nothing is mapped there.
const LOAD_FROM_NOWHERE: [u16; 3] = [0xF04F, 0x42C0, 0x6810];
/// ldr r0, [sp, #24]: the stacked PC.
const LOAD_STACKED_PC: u16 = 0x9806;

#[test]
fn a_load_from_nowhere_is_a_forced_hard_fault_with_its_address() {
    let handler = program(&[&[LOAD_STACKED_PC], &TRACE_R0, &[STAY]]);
    let mut cpu = board(&LOAD_FROM_NOWHERE, &[(Exception::HARD_FAULT, handler)]);
    run_until(&mut cpu, 100 * US).expect("the handler runs");
    assert_eq!(traced(&cpu), [CODE + 2 * START.len() as u32 + 4]);
    let faults = &cpu.state().system.faults;
    // PRECISERR and BFARVALID; FORCED.
    assert_eq!(
        (faults.cfsr, faults.hfsr, faults.bfar),
        (0x8200, 0x4000_0000, 0x6000_0000)
    );
}

#[test]
fn an_enabled_bus_fault_takes_it_itself() {
    let handler = program(&[&trace(7), &[STAY]]);
    let mut cpu = board(&LOAD_FROM_NOWHERE, &[(Exception::BUS_FAULT, handler)]);
    run_until(&mut cpu, 100 * US).expect("the handler runs");
    assert_eq!(traced(&cpu), [7]);
    assert_eq!(cpu.state().system.faults.hfsr, 0);
}

#[test]
fn a_fault_inside_hard_fault_locks_up() {
    let mut cpu = board(
        &LOAD_FROM_NOWHERE,
        &[(Exception::HARD_FAULT, LOAD_FROM_NOWHERE.to_vec())],
    );
    let halt = run_until(&mut cpu, 100 * US).expect_err("the core locks up");
    assert!(halt.what.contains("lock-up"), "{}", halt.what);
}

#[test]
fn the_stack_running_off_the_bottom_of_ccm_faults_at_once() {
    let thread = program(&[
        &[0xF240, 0x0010, 0xF2C1, 0x0000], // movw r0, #0x10; movt r0, #0x1000
        &[0xF380, 0x8808],                 // msr msp, r0
        &[0xB4FF],                         // push {r0-r7}
    ]);
    let mut cpu = board(
        &thread,
        &[(Exception::HARD_FAULT, program(&[&trace(3), &[STAY]]))],
    );
    run_until(&mut cpu, 100 * US).expect("the handler runs, although its frame is lost");
    assert_eq!(traced(&cpu), [3]);
    // PRECISERR with BFARVALID for the push, STKERR for the frame.
    assert_eq!(cpu.state().system.faults.cfsr, 0x9200);
}

#[test]
fn undefined_instruction_and_supervisor_call_take_their_exceptions() {
    let thread = program(&[&[0xDF00], &trace(1), &[0xDE00]]); // svc #0; …; udf #0
    let call = program(&[&trace(11), &[RETURN]]);
    let usage = program(&[&trace(6), &[STAY]]);
    let mut cpu = board(
        &thread,
        &[(Exception::SV_CALL, call), (Exception::USAGE_FAULT, usage)],
    );
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [11, 1, 6]);
    assert_eq!(cpu.state().system.faults.cfsr, 1 << 16);
}

#[test]
fn floating_point_with_the_fpu_off_is_a_usage_fault() {
    let mut cpu = board(&[STAY], &[(Exception::USAGE_FAULT, vec![STAY])]);
    // In place of START, which opens the FPU: vmov.f32 s0, #1.0; b .
    let fp_first = segment(CODE, &[0xEEB7, 0x0A00, STAY]);
    cpu.engine
        .mem_write(CODE.into(), &fp_first.data)
        .expect("flash is mapped");
    run_until(&mut cpu, 100 * US).expect("the handler runs");
    assert_eq!(cpu.state().system.faults.cfsr, 1 << 19);
}

#[test]
fn systick_interrupts_at_its_period() {
    let mut cpu = board(
        &[WFE, 0xE7FD],
        &[(Exception::SYS_TICK, program(&[&trace(1), &[RETURN]]))],
    );
    // 16 MHz after reset: 1,600 cycles are 100 µs.
    let systick = &mut cpu.state_mut().system.systick;
    systick.write_reload(1_599);
    systick.write_value(0);
    systick.write_ctrl(0b111, 0);
    run_until(&mut cpu, 1_050 * US).expect("no fault");
    assert_eq!(traced(&cpu).len(), 10);
}

#[test]
fn a_register_the_model_lacks_stops_the_run_with_its_name() {
    let thread = [0xF04F, 0x4260, 0x6810]; // mov r2, #0xE0000000; ldr r0, [r2]: ITM stimulus port 0
    let mut cpu = board(&thread, &[]);
    let halt = run_until(&mut cpu, 100 * US).expect_err("the ITM is not modelled");
    assert_eq!(halt.what, "ITM 0xE0000000: read is not modelled");
}

#[test]
fn a_system_reset_request_starts_the_program_again() {
    let thread = program(&[
        &trace(1),
        &[0xF64E, 0x520C, 0xF2CE, 0x0200], // movw r2, #0xED0C; movt r2, #0xE000: AIRCR
        &[0x2004, 0xF2C0, 0x50FA, 0x6010], // movs r0, #4; movt r0, #0x5FA; str r0, [r2]
        &[STAY],
    ]);
    let mut cpu = board(&thread, &[]);
    assert_eq!(cpu.run(100 * US), Ok(Pause::Reset(ResetCause::Software)));
    assert_eq!(traced(&cpu), [1]);
    cpu.reset();
    assert_eq!(cpu.pc(), CODE);
    assert_eq!(cpu.register(RegisterARM::MSP), STACK_TOP);
    assert!(!cpu.state().system.fpu_on());
}
