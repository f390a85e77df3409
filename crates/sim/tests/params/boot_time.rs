//! Duration of a boot with every possible contents of the store.

use robot_plant::time::{MS, Ps, SECOND, US};

use crate::{
    at_rest_only::before_a_rotation,
    cells::run_all,
    flash_image::Image,
    robot::Robot,
    settings::{GROUPS, Make, image},
};

/// docs/safety.md#reaction-times: "zero torque ≤ 20 ms after reset".
const ZERO_TORQUE: Ps = 20 * MS;

struct Store {
    what: &'static str,
    flash: Image,
}

struct Boot {
    /// First zero current and first disable frame, of the last motor that got one.
    safe: Ps,
    first_tick: Ps,
    boot_us: f64,
}

fn stores() -> Vec<Store> {
    let mut noise = 1_u32;
    let mut byte = move || {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (noise >> 24) as u8
    };
    let full = before_a_rotation(Make::Dm4310);
    let damaged = (0..3).fold(Image::blank(), |image, sector| {
        image.garbage(sector, &mut byte)
    });
    let full_and_damaged = full.clone().garbage(1, &mut byte);
    let store = |what, flash| Store { what, flash };
    vec![
        store("empty, clean", Image::blank().clean(0).clean(1).clean(2)),
        store("a new chip", Image::blank()),
        store("a record a group", image(Make::Dm4310, GROUPS)),
        store("full", full),
        store("full, its clean sector damaged", full_and_damaged),
        store("garbage in all three sectors", damaged),
    ]
}

fn boot(store: &Store) -> Boot {
    let mut robot = Robot::with_flash(Make::Dm4310, &store.flash);
    robot
        .wait(SECOND, |robot| robot.diag("ts_us").is_some())
        .expect("it boots");
    let names = robot
        .machine
        .with_world(|world| world.signal_names().to_vec());
    let zero_frames = (0..2).map(|wheel| format!("can.m3508.{wheel}.current_ma"));
    let stop_frames = (0..4).map(|joint| format!("can.joint.{joint}.stop_frames"));
    let first = |name: String| {
        let mut of_signal = robot
            .events
            .iter()
            .filter(|event| names[event.signal] == name);
        of_signal.next().map_or(Ps::MAX, |event| event.at)
    };
    let safe = zero_frames.chain(stop_frames).map(first).max();
    let first_tick = robot.now();
    robot.run_for(20 * MS);
    let steps = robot.machine.flash_steps().len();
    assert_eq!(steps, 0, "{}: motors may still turn", store.what);
    Boot {
        safe: safe.expect("there are motors"),
        first_tick,
        boot_us: robot.diag("params.boot_us").expect("it runs"),
    }
}

#[test]
fn motors_are_safe_before_the_store_is_read() {
    let stores = stores();
    let boots = run_all(&stores, boot);
    println!("store                            all motors safe   store read   runs after");
    for (store, boot) in stores.iter().zip(&boots) {
        println!(
            "{:<32} {:>12.2} ms {:>9.2} ms {:>9.0} ms",
            store.what,
            boot.safe as f64 / MS as f64,
            boot.boot_us / 1_000.0,
            boot.first_tick as f64 / MS as f64
        );
    }
    for (store, boot) in stores.iter().zip(&boots) {
        let what = store.what;
        assert!(boot.safe <= ZERO_TORQUE, "{what}: {} us", boot.safe / US);
        let reading_us = boot.boot_us;
        assert!(
            (10.0..20_000.0).contains(&reading_us),
            "{what}: {reading_us} us"
        );
    }
}
