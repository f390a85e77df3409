//! The settings of a debug probe halt the core, and nothing else does.

use super::*;
use crate::core::system::debug_registers::{DEMCR_VC_CORERESET, DEMCR_VC_HARDERR};

const BKPT: u16 = 0xBE00;

/// Runs into a HardFault, whose handler leaves a 3.
fn faulting_board(thread: &[u16]) -> Cpu {
    let handler = program(&[&trace(3), &[STAY]]);
    board(thread, &[(Exception::HARD_FAULT, handler)])
}

/// The trace of the program, and whether there is a board error with `part` in it.
fn run_and_hear(cpu: &mut Cpu, part: &str) -> (Vec<u32>, bool) {
    let until = cpu.now() + 100 * US;
    run_until(cpu, until).expect("no fault of the model");
    let mut errors = cpu.soc().errors.list().iter();
    let is_reported = errors.any(|error| error.message.contains(part));
    (traced(cpu), is_reported)
}

#[test]
fn a_caught_hard_fault_halts_before_its_handler() {
    let mut cpu = faulting_board(&LOAD_FROM_NOWHERE);
    cpu.debug().attach(DEMCR_VC_HARDERR);
    assert_eq!(run_and_hear(&mut cpu, "HardFault"), (vec![], true));
}

#[test]
fn catches_do_nothing_while_debugging_is_off() {
    let mut cpu = faulting_board(&LOAD_FROM_NOWHERE);
    cpu.debug()
        .keep_catches_set(DEMCR_VC_HARDERR | DEMCR_VC_CORERESET);
    cpu.reset();
    assert_eq!(run_and_hear(&mut cpu, "debugger"), (vec![3], false));
}

#[test]
fn a_caught_reset_halts_until_the_power_goes() {
    let mut cpu = board(&program(&[&trace(1), &[STAY]]), &[]);
    cpu.debug().attach(DEMCR_VC_CORERESET);
    cpu.reset();
    assert_eq!(run_and_hear(&mut cpu, "reset vector"), (vec![], true));
    cpu.reset();
    assert_eq!(run_and_hear(&mut cpu, "reset vector"), (vec![], true));
    cpu.power_off(cpu.now());
    cpu.power_up();
    assert_eq!(run_and_hear(&mut cpu, "reset vector").0, [1]);
}

#[test]
fn a_breakpoint_instruction_is_a_hard_fault_or_waits_for_the_debugger() {
    let mut alone = faulting_board(&[BKPT]);
    assert_eq!(run_and_hear(&mut alone, "breakpoint"), (vec![3], false));
    let mut watched = faulting_board(&[BKPT]);
    watched.debug().attach(0);
    assert_eq!(run_and_hear(&mut watched, "breakpoint"), (vec![], true));
}

#[test]
fn a_hardware_breakpoint_halts_where_it_lies() {
    let mut cpu = faulting_board(&LOAD_FROM_NOWHERE);
    let handler = CODE + ROUTINE;
    cpu.debug().breakpoints.set(&[handler]);
    cpu.debug().attach(0);
    assert_eq!(run_and_hear(&mut cpu, "breakpoint"), (vec![], true));
}

#[test]
fn a_halt_passes_and_the_core_s_own_timer_stands_meanwhile() {
    let tick = program(&[&trace(9), &[RETURN]]);
    let mut cpu = board(&[WFE, 0xE7FD], &[(Exception::SYS_TICK, tick)]);
    let systick = &mut cpu.state_mut().system.systick;
    systick.write_reload(1_599);
    systick.write_value(0);
    systick.write_ctrl(0b111, 0);
    run_until(&mut cpu, 250 * US).expect("no fault");
    cpu.halt_for(1_000 * US);
    run_until(&mut cpu, 1_200 * US).expect("no fault");
    assert_eq!(traced(&cpu), [9; 2]);
    run_until(&mut cpu, 1_450 * US).expect("no fault");
    assert_eq!(traced(&cpu), [9; 4]);
}
