//! The core does nothing while the flash is busy or has lost its power; everything else goes on.

use super::*;
use crate::soc::guest_memory::GuestMemory;

const FLASH_ACR: u32 = 0x4002_3C00;
const WORD: u32 = 0x0800_4000;
/// movw r2, #0x4000; movt r2, #0x0800; movs r0, #5; str r0, [r2]; isb; ldr r2, [r2]; str r2, [r7], #4
const STORE_AND_LOAD: [u16; 11] = [
    0xF244, 0x0200, 0xF6C0, 0x0200, 0x2005, 0x6010, 0xF3BF, 0x8F6F, 0x6812, 0xF847, 0x2B04,
];

struct NoMemory;

impl GuestMemory for NoMemory {
    fn read(&mut self, _: u32, _: &mut [u8]) -> bool {
        false
    }

    fn write(&mut self, _: u32, _: &[u8]) -> bool {
        false
    }
}

/// Sets PG and a width of 32 bits, as the image would.
fn ready_to_program(cpu: &mut Cpu) {
    cpu.with_soc(|soc, now| {
        for (offset, value) in [(0x04, 0x4567_0123), (0x04, 0xCDEF_89AB), (0x10, 0x201)] {
            soc.write(FLASH_ACR + offset, 4, value, now, &mut NoMemory)
                .expect("modelled registers");
        }
    });
}

/// Interrupts from SysTick every 5 µs at 16 MHz.
fn start_systick(cpu: &mut Cpu) {
    let systick = &mut cpu.state_mut().system.systick;
    systick.write_reload(79);
    systick.write_value(0);
    systick.write_ctrl(0b111, 0);
}

#[test]
fn a_store_to_flash_stops_the_core_for_16_us_and_interrupts_wait() {
    let thread = program(&[&trace(1), &STORE_AND_LOAD, &trace(2), &[STAY]]);
    let tick = program(&[&trace(9), &[RETURN]]);
    let mut cpu = board(&thread, &[(Exception::SYS_TICK, tick)]);
    ready_to_program(&mut cpu);
    start_systick(&mut cpu);
    run_until(&mut cpu, 15 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1]);
    assert_eq!(cpu.now() / US, 15, "time does not jump over the limit");
    run_until(&mut cpu, 30 * US).expect("no fault");
    // Three ticks were due meanwhile, of which one stays pending.
    assert_eq!(traced(&cpu)[..4], [1, 9, 5, 2]);
    assert!(!traced(&cpu)[4..].contains(&5));
    let loaded = with_soc(&mut cpu.engine, |soc, now, memory| {
        soc.load_data_flash(WORD, 4, now, memory)
    });
    assert_eq!(loaded, Ok(5));
    let stalled = cpu.soc().flash().history().stats().longest_stall;
    assert_eq!(stalled, 16 * US);
}

#[test]
fn a_store_to_the_image_itself_stops_the_run() {
    // STORE_AND_LOAD with the address of the vector table: movw r2, #0.
    let mut thread = STORE_AND_LOAD;
    thread[0] = 0xF240;
    let mut cpu = board(&thread, &[]);
    ready_to_program(&mut cpu);
    let halt = run_until(&mut cpu, 100 * US).expect_err("read-only memory");
    assert!(halt.what.starts_with("flash 0x08000000"), "{}", halt.what);
}

#[test]
fn without_power_nothing_runs_and_the_chip_boots_afterwards() {
    let thread = program(&[&trace(1), &[STAY]]);
    let mut cpu = board(&thread, &[]);
    run_until(&mut cpu, 20 * US).expect("no fault");
    cpu.state_mut().system.nvic.pend(Exception::PEND_SV);
    cpu.with_soc(|soc, now| soc.reset(ResetCause::PowerOn, now));
    cpu.power_off(50 * US);
    assert!(!cpu.is_powered());
    assert_eq!(cpu.run(40 * US), Ok(Pause::Limit));
    let spent = cpu.stats().busy_cycles;
    assert_eq!(cpu.run(200 * US), Ok(Pause::PowerReturns));
    assert_eq!((cpu.now() / US, cpu.stats().busy_cycles), (50, spent));
    cpu.power_up();
    assert!(cpu.is_powered());
    assert_eq!(cpu.pc(), CODE);
    assert_ne!(word(&cpu, TRACE), 1, "RAM forgets");
    assert!(!cpu.state().system.nvic.is_pending(Exception::PEND_SV));
    run_until(&mut cpu, 100 * US).expect("no fault");
    assert_eq!(traced(&cpu), [1]);
}
