use std::{cell::RefCell, env, path::PathBuf, rc::Rc};

use super::*;
use crate::{
    filters::{EMPTY, OURS},
    motion::{Motion, Wheels},
};

fn boot(program: &str) -> Program {
    let built = "../../target/robot-estimator-bench/thumbv7em-none-eabihf/release";
    let usual = || Path::new(env!("CARGO_MANIFEST_DIR")).join(built);
    let folder = env::var_os("ROBOT_FILTERS").map_or_else(usual, PathBuf::from);
    Program::boot(&folder.join(program)).expect("`cargo xtask test` builds it")
}

/// Counts with the engine's own hook before each instruction. The hook leaves out instructions of an IT block whose
/// condition fails, although the processor issues them and each takes a cycle. So an IT counts for all instructions
/// that it covers, and these do not count again.
#[derive(Default)]
struct Oracle {
    count: u32,
    covered_from: u64,
    covered_to: u64,
}

impl Oracle {
    fn sees(&mut self, engine: &Unicorn<'_, Counter>, address: u64, size: u32) {
        if (self.covered_from..self.covered_to).contains(&address) {
            return;
        }
        self.count += 1;
        let Some(mut covered) = (size == 2).then(|| it_length(halfword(engine, address))) else {
            return;
        };
        let mut end = address + 2;
        self.covered_from = end;
        self.count += covered;
        while covered > 0 {
            let wide = halfword(engine, end) >> 11 >= 0b11101;
            end += if wide { 4 } else { 2 };
            covered -= 1;
        }
        self.covered_to = end;
    }
}

fn halfword(engine: &Unicorn<'_, Counter>, address: u64) -> u16 {
    let mut bytes = [0; 2];
    engine.mem_read(address, &mut bytes).expect("there is code");
    u16::from_le_bytes(bytes)
}

/// Returns how many instructions an IT covers (ARMv7-M ARM A7.3.2), or 0 if this is no IT.
fn it_length(op: u16) -> u32 {
    if op >> 8 == 0xBF && op & 0xF != 0 {
        4 - (op & 0xF).trailing_zeros()
    } else {
        0
    }
}

#[test]
fn counted_instructions_equal_the_executed_ones() {
    for filter in [OURS, EMPTY] {
        let mut program = boot(filter.program);
        let oracle = Rc::new(RefCell::new(Oracle::default()));
        let seen = Rc::clone(&oracle);
        let count = move |engine: &mut Unicorn<'_, Counter>, address: u64, size: u32| {
            if engine.get_data().returns_to.is_some() {
                seen.borrow_mut().sees(engine, address, size);
            }
        };
        let installed = program.engine.add_code_hook(1, 0, count);
        installed.expect("the engine takes a hook");
        // Code translated during start-up does not have the hook.
        program.engine.ctl_flush_tb().expect("the engine forgets");
        for (_, _, input) in Motion::computed(Wheels::Turning).ticks().take(2_000) {
            oracle.take();
            let tick = program.tick(&input).expect("the program runs");
            assert!(tick.instructions > 0);
            assert_eq!(
                tick.instructions,
                oracle.borrow().count,
                "{}",
                filter.program
            );
        }
    }
}

/// The empty filter returns parts of its input, which must be what the host wrote.
#[test]
fn samples_arrive_as_they_were_sent() {
    let mut program = boot(EMPTY.program);
    let input = Input {
        now_us: 1_000,
        imu_ts_us: 1_000,
        mag_ts_us: 900,
        gyro_rps: [0.25, -3.0, 7.0],
        mag_ut: [19.5, -45.25, 3.0],
        ..Input::default()
    };
    let tick = program.tick(&input).expect("the program runs");
    assert_eq!(tick.q_wxyz, [0.25, 19.5, -45.25, 3.0]);
}

#[test]
fn a_file_that_is_no_program_is_refused() {
    let error = Program::boot(Path::new("/dev/null"))
        .err()
        .expect("an empty file");
    assert!(error.to_string().contains("ELF"), "{error:#}");
}
