//! A handler calls a function every 100 µs, and a fault is injected into the function.

use super::*;

const FUNCTION: u32 = CODE + 2 * ROUTINE;

/// SysTick calls the function, which leaves a 1; HardFault leaves a 9.
fn calling_board() -> Cpu {
    let handler = vec![0xB500, 0xF000, 0xF83D, 0xBD00]; // push {lr}; bl FUNCTION; pop {pc}
    let function = program(&[&trace(1), &[RETURN]]);
    let hard_fault = program(&[&trace(9), &[STAY]]);
    let mut cpu = board(
        &[WFE, 0xE7FD],
        &[
            (Exception::SYS_TICK, handler),
            // Behind a vector that is never taken.
            (Exception::PEND_SV, function),
            (Exception::HARD_FAULT, hard_fault),
        ],
    );
    let systick = &mut cpu.state_mut().system.systick;
    systick.write_reload(1_599);
    systick.write_value(0);
    systick.write_ctrl(0b111, 0);
    run_until(&mut cpu, 350 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1, 1, 1]);
    cpu
}

fn effect(effect: Effect) -> Injection {
    Injection {
        entry: FUNCTION,
        effect,
    }
}

/// The times 400, 500 and 600 µs fall into the hang. The first call continues at its end, and one more was pending.
#[test]
fn a_function_that_hangs_does_its_work_when_the_injection_ends() {
    let mut cpu = calling_board();
    cpu.inject(effect(Effect::Hang));
    run_until(&mut cpu, 650 * US).expect("no fault");
    assert_eq!(traced(&cpu).len(), 3);
    let struck = cpu.struck_at().expect("it struck");
    assert!((400 * US..402 * US).contains(&struck));
    cpu.end_injection(effect(Effect::Hang));
    run_until(&mut cpu, 1_050 * US).expect("no fault");
    assert_eq!(traced(&cpu).len(), 3 + 2 + 4);
}

#[test]
fn calls_that_return_at_once_are_lost() {
    let mut cpu = calling_board();
    cpu.inject(effect(Effect::ReturnAtOnce));
    run_until(&mut cpu, 650 * US).expect("no fault");
    cpu.end_injection(effect(Effect::ReturnAtOnce));
    run_until(&mut cpu, 1_050 * US).expect("no fault");
    assert_eq!(traced(&cpu).len(), 10 - 3);
}

#[test]
fn an_undefined_instruction_and_a_jump_to_nowhere_are_hard_faults() {
    for what in [Effect::Undefined, Effect::GoTo(0x0900_0000)] {
        let mut cpu = calling_board();
        cpu.inject(effect(what));
        run_until(&mut cpu, 650 * US).expect("the handler runs");
        assert_eq!(traced(&cpu), [1, 1, 1, 9], "{what:?}");
    }
}

#[test]
fn a_reset_ends_every_injection() {
    let mut cpu = calling_board();
    cpu.inject(effect(Effect::Undefined));
    cpu.reset();
    assert!(cpu.state().injector.is_idle());
}
