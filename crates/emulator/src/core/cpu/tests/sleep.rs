//! The effect of SCR on the kind and start of sleep.

use super::*;

/// movw r2, #0xED10; movt r2, #0xE000; movs r0, #value; str r0, [r2]: SCR
fn set_scr(value: u8) -> [u16; 6] {
    let value = 0x2000 | u16::from(value);
    [0xF64E, 0x5210, 0xF2CE, 0x0200, value, 0x6010]
}

#[test]
fn deep_sleep_stops_the_run_whatever_would_wake_it() {
    for sleep in [WFI, WFE] {
        let thread = program(&[&set_scr(1 << 2), &[sleep], &trace(1), &[STAY]]);
        let mut cpu = board(&thread, &[]);
        let halt = run_until(&mut cpu, 100 * US).expect_err("the clocks stop");
        assert!(halt.what.contains("SLEEPDEEP"), "{}", halt.what);
    }
}

#[test]
fn with_sleep_on_exit_the_interrupted_code_does_not_go_on() {
    let thread = program(&[&set_scr(1 << 1), &trace(1), &pend(5), &trace(2), &[STAY]]);
    let handler = program(&[&trace(9), &[RETURN]]);
    let mut cpu = board(&thread, &[(irq(5), handler)]);
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1, 9]);
    pulse(&mut cpu, 5);
    run_until(&mut cpu, 200 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1, 9, 9]);
}
