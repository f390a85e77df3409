//! The estimator keeps its limits on a motion that needs no recording: rest, slow and fast turning, a magnet.

mod programs;

use object::{Object, ObjectSymbol};
use robot_bench::{
    filters::{EMPTY, OURS},
    measure::{self, Costs, Detail, Spread},
    motion::{Motion, Wheels},
    program::Program,
    report::{EXTRAPOLATION_MEAN, UPDATE_MAX, UPDATE_MEAN},
};

/// The estimator may grow no further. A tenth of its size handles impacts, and wheels that spin while the robot rests;
/// a twentieth leads the velocity of a body on moving legs to its axle.
/// `cargo xtask bench` shows how far this is from the size wanted.
const FLASH_BYTES: f64 = 23.25 * 1024.0;

fn costs(wheels: Wheels) -> Costs {
    let motion = Motion::computed(wheels);
    let run = measure::run(OURS, &programs::folder(), &motion, Detail::Totals, || ());
    run.expect("the estimator runs").costs
}

fn spread(ticks: &[u32]) -> Spread {
    Spread::of(ticks).expect("there were ticks")
}

#[test]
fn updates_and_extrapolations_keep_their_instruction_limits() {
    for wheels in [Wheels::Silent, Wheels::Turning] {
        let costs = costs(wheels);
        let update = spread(&costs.update_with_mag);
        let between = spread(&costs.extrapolation);
        println!("{wheels:?}: update {update:?}, between {between:?}");
        assert!(update.mean <= UPDATE_MEAN, "{wheels:?}: {update:?}");
        assert!(
            f64::from(update.max) <= UPDATE_MAX,
            "{wheels:?}: {update:?}"
        );
        assert!(
            between.mean <= EXTRAPOLATION_MEAN,
            "{wheels:?}: {between:?}"
        );
    }
}

#[test]
fn the_estimator_keeps_its_flash_limit() {
    let flash = |filter: robot_bench::filters::Filter| {
        let program = Program::boot(&filter.elf(&programs::folder())).expect("the program boots");
        program.flash_bytes as f64
    };
    let own = flash(OURS) - flash(EMPTY);
    assert!(own <= FLASH_BYTES, "{own} bytes");
}

/// The names are from the ARM run-time ABI, such as `__aeabi_dadd`, and from compiler-rt, such as `__adddf3` and
/// `__extendsfdf2`.
#[test]
fn the_estimator_computes_nothing_in_double_precision() {
    let elf = std::fs::read(OURS.elf(&programs::folder())).expect("the program is there");
    let file = object::File::parse(&*elf).expect("it is an ELF file");
    let names: Vec<_> = file
        .symbols()
        .filter_map(|symbol| symbol.name().ok())
        .collect();
    assert!(names.contains(&"main"), "the program has symbols");
    let double = |name: &&str| {
        name.starts_with("__aeabi_d") || name.ends_with("df3") || name.ends_with("df2")
    };
    let found: Vec<_> = names.into_iter().filter(double).collect();
    assert!(found.is_empty(), "{found:?}");
}
