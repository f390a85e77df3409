use robot_plant::{
    robots::JointMotor,
    time::{MS, SECOND},
    wire::CanFrame,
    world::{CanBusId, PcDrive, PcInput, PcJoints, Push, RemoteInput},
};

use super::*;
use crate::{
    expectation::Bound,
    machine::flash::FlashTimes,
    parameter_sectors::Record,
    scenario::{Event, FlashContents},
};

const HEAD: &str = "name = \"n\"\nseconds = 4.0\nplant = \"stand\"\n";

fn error_of(body: &str) -> String {
    Scenario::parse(&format!("{HEAD}{body}"), "s.toml")
        .expect_err("must be refused")
        .to_string()
}

#[test]
fn reads_an_example() {
    let text = r#"
        name = "remote loss stops the wheels"
        seconds = 4
        plant = "rolling"
        radio = "dbus"
        [[at]]
        t = 2.0
        remote = { vx = 0.0 }
        [[at]]
        t = 0.5
        remote = { enable = true, vx = 0.4 }
        [[expect]]
        signal = "can.m3508.0.current_ma"
        from = 2.15
        to = 4.0
        max_abs = 0
    "#;
    let s = Scenario::parse(text, "s.toml").unwrap();
    assert_eq!(s.length, 4 * SECOND);
    assert_eq!((s.plant, s.radio), (PlantKind::Rolling, RadioKind::Dbus));
    assert_eq!(s.events[0].at, 500 * MS, "sorted by time");
    assert_eq!(
        s.events[0].event,
        Event::Remote(RemoteInput {
            enable: Some(true),
            vx: Some(0.4),
            ..RemoteInput::default()
        })
    );
    assert_eq!(s.expectations[0].bounds, [Bound::MaxAbs(0.0)]);
    assert_eq!(s.expectations[0].window.start, 2_150 * MS);
}

#[test]
fn the_flash_starts_as_the_scenario_says() {
    let text = format!("{HEAD}[flash]\nimage = \"worn.bin\"\ntimes = \"max\"\nseed = 3\n");
    let read = Scenario::parse(&text, "scenarios/s.toml").unwrap();
    let wanted = FlashSetup {
        contents: FlashContents::Image("scenarios/worn.bin".into()),
        times: FlashTimes::Max,
        seed: Some(3),
    };
    assert_eq!(read.flash, wanted);
    let plain = Scenario::parse(HEAD, "s.toml").unwrap();
    assert_eq!(plain.flash, FlashSetup::default());
    assert_eq!(plain.flash.times, FlashTimes::Typical);
}

#[test]
fn the_robot_may_have_saved_settings_before() {
    let record = "[[flash.record]]\ngroup = 8\nvalues = [13, 24]\n";
    let read = Scenario::parse(&format!("{HEAD}{record}"), "s.toml").unwrap();
    let records = vec![Record::first(8, &[13.0, 24.0])];
    assert_eq!(read.flash.contents, FlashContents::Records(records));
    let both = error_of(&format!("[flash]\nimage = \"a.bin\"\n{record}"));
    assert!(both.contains("either an `image` or records"), "{both}");
    let many = [0; 29].map(|_| "0").join(", ");
    let long = error_of(&format!("[[flash.record]]\ngroup = 8\nvalues = [{many}]\n"));
    assert!(long.contains("group 8 has more than 28 values"), "{long}");
}

#[test]
fn the_board_may_sit_otherwise() {
    let text = format!("{HEAD}mounting = \"x-left-z-up\"\nmag_mounting = \"x-up-z-left\"\n");
    let read = Scenario::parse(&text, "s.toml").unwrap();
    assert_eq!(Ok(read.mounting.unwrap()), "x-left-z-up".parse());
    assert_eq!(Ok(read.mag_mounting), "x-up-z-left".parse());
    let wrong = error_of("mounting = \"upside-down\"\n");
    assert!(
        wrong.starts_with("s.toml:4: `upside-down` is no mounting"),
        "{wrong}"
    );
}

#[test]
fn errors_name_the_line() {
    assert!(error_of("bogus = 1\n").starts_with("s.toml:4: unknown field `bogus`"));
    let late = error_of("[[at]]\nt = 1\nremote = {}\n[[at]]\nt = 9\nremote = {}\n");
    assert!(late.starts_with("s.toml:7: `t` is 9 s"), "{late}");
    let typo = error_of("[[expect]]\nsignal = \"x\"\nfrom = 0\nto = 1\nmaxabs = 0\n");
    assert!(
        typo.starts_with("s.toml:8: unknown field `maxabs`"),
        "{typo}"
    );
}

#[test]
fn expectations_that_cannot_be_judged_are_refused() {
    for (body, part) in [
        (
            "[[expect]]\nsignal = \"x\"\nfrom = 0\nmin = 1\n",
            "`from` and `to`",
        ),
        (
            "[[expect]]\nsignal = \"x\"\nat = 1\n",
            "nothing is expected",
        ),
        (
            "[[expect]]\nsignal = \"x\"\nfrom = 2\nto = 1\nmin = 1\n",
            "swap",
        ),
        (
            "[[expect]]\nsignal = \"x\"\nat = 1\nmin = nan\n",
            "not finite",
        ),
        ("[[at]]\nt = 1\n", "does nothing"),
        ("[[at]]\nt = 1\nremote = { vx = 1.5 }\n", "stick"),
        (
            "[[at]]\nt = 1\nfault = \"no-such-fault\"\n",
            "--list-faults",
        ),
    ] {
        let error = error_of(body);
        assert!(error.contains(part), "{error} lacks {part}");
    }
}

#[test]
fn a_pc_sends_frames() {
    let frame = "[[at]]\nt = 1\ncan = { bus = 2, id = 0x7A0, data = [0x10, 200, 0, 0xB8, 0x0B] }\n";
    let s = Scenario::parse(&format!("{HEAD}{frame}"), "s.toml").unwrap();
    let frame = CanFrame {
        id: 0x7A0,
        extended: false,
        remote: false,
        dlc: 5,
        data: [0x10, 200, 0, 0xB8, 0x0B, 0, 0, 0],
    };
    assert_eq!(s.events[0].event, Event::Can(CanBusId::Can2, frame));
    for (can, part) in [
        ("{ bus = 3, id = 1, data = [] }", "1 and 2"),
        ("{ bus = 1, id = 0x800, data = [] }", "0x7FF"),
        (
            "{ bus = 1, id = 1, data = [0, 0, 0, 0, 0, 0, 0, 0, 0] }",
            "8 bytes",
        ),
        ("{ bus = 1, id = 1, data = [256] }", "256"),
    ] {
        let error = error_of(&format!("[[at]]\nt = 1\ncan = {can}\n"));
        assert!(error.contains(part), "{error} lacks {part}");
    }
}

#[test]
fn a_pc_steers_over_the_serial_link() {
    let pc =
        "[[at]]\nt = 1\npc = { wheels = [2, -3.5], kd = 0.5, joints = \"hold\", rate_hz = 200 }\n";
    let s = Scenario::parse(&format!("{HEAD}{pc}"), "s.toml").unwrap();
    let input = PcInput {
        on: Some(true),
        rate_hz: Some(200.0),
        wheels_rps: Some([2.0, -3.5]),
        wheel_kd: Some(0.5),
        joints: Some(PcJoints::Hold),
        ..PcInput::default()
    };
    assert_eq!(s.events[0].event, Event::Pc(input));
    let off = "[[at]]\nt = 1\npc = { on = false, joints = [0.1, 0, 0, -0.1] }\n";
    let s = Scenario::parse(&format!("{HEAD}{off}"), "s.toml").unwrap();
    let input = PcInput {
        on: Some(false),
        joints: Some(PcJoints::At([0.1, 0.0, 0.0, -0.1])),
        ..PcInput::default()
    };
    assert_eq!(s.events[0].event, Event::Pc(input));
    let drive = "[[at]]\nt = 1\npc = { drive = { vx = 0.5, jump = true } }\n";
    let s = Scenario::parse(&format!("{HEAD}{drive}"), "s.toml").unwrap();
    let input = PcInput {
        on: Some(true),
        drive: Some(PcDrive {
            vx: 0.5,
            jump: true,
            ..PcDrive::default()
        }),
        ..PcInput::default()
    };
    assert_eq!(s.events[0].event, Event::Pc(input));
    for (pc, part) in [
        ("{ drive = { vx = 1.5 } }", "`vx` is 1.5"),
        ("{ drive = { stand = true } }", "unknown field"),
        ("{ wheels = [201, 0] }", "-200 to 200"),
        ("{ kd = -1 }", "`kd` is -1"),
        ("{ joint_kp = nan }", "`joint_kp` is NaN"),
        ("{ joints = [0, 0, 0, 4] }", "-3.2 to 3.2"),
        ("{ joints = \"held\" }", "\"hold\", \"limp\""),
        ("{ rate_hz = 5000 }", "1,200 frames"),
        ("{ wheel = [1, 1] }", "unknown field"),
    ] {
        let error = error_of(&format!("[[at]]\nt = 1\npc = {pc}\n"));
        assert!(error.contains(part), "{error} lacks {part}");
    }
}

const FREE: &str = "name = \"n\"\nseconds = 4.0\nplant = \"free\"\n";

#[test]
fn a_free_robot_has_a_start_a_ground_and_differences_from_its_file() {
    let keys = "robot = \"fivebar-rs00\"\nstart = { dropped = { height_m = 0.28 } }\n\
                terrain = { step = { at_m = 1.0, height_m = -0.15 } }\n\
                variation = { mass = 1.2, delay_ms = 2, imu_deg = [0, 1, 0] }\n\
                [[at]]\nt = 1\npush = { impulse_ns = [3, 0, 0] }\n";
    let s = Scenario::parse(&format!("{FREE}{keys}"), "s.toml").unwrap();
    assert_eq!(
        (s.plant, s.robot.name.as_str()),
        (PlantKind::Free, "fivebar-rs00")
    );
    assert_eq!(s.start, Start::Dropped { height_m: 0.28 });
    assert_eq!(s.variation.delay, 2 * MS);
    assert_eq!(
        (s.variation.body.mass_factor, s.variation.torque),
        (1.2, 1.0)
    );
    assert_eq!(
        s.events[0].event,
        Event::Push(Push::instant([3.0, 0.0, 0.0]))
    );
    let plain = Scenario::parse(FREE, "s.toml").unwrap();
    assert_eq!(
        (plain.start, plain.robot.name.as_str()),
        (Start::Sitting, "fivebar")
    );
}

#[test]
fn what_only_a_free_robot_has_is_refused_elsewhere_and_nonsense_everywhere() {
    for (head, body, part) in [
        (
            HEAD,
            "start = \"front\"\n",
            "s.toml:4: `start` belongs to `plant = \"free\"`",
        ),
        (HEAD, "terrain = \"flat\"\n", "s.toml:4: `terrain` belongs"),
        (
            HEAD,
            "[[at]]\nt = 1\npush = { impulse_ns = [1, 0, 0] }\n",
            "s.toml:4: `push` belongs",
        ),
        (
            FREE,
            "[[at]]\nt = 1\npush = { impulse_ns = [1e3, 0, 0] }\n",
            "100 N·s",
        ),
        (
            FREE,
            "start = \"asleep\"\n",
            "s.toml:4: unknown variant `asleep`",
        ),
        (
            FREE,
            "\nvariation = { mass = 9 }\n",
            "s.toml:5: `mass` of the variation is 9",
        ),
        (
            FREE,
            "start = { dropped = { height_m = -1 } }\n",
            "s.toml:4: `start` is out of range",
        ),
        (
            FREE,
            "terrain = { step = { at_m = 1, height_m = nan } }\n",
            "s.toml:4: `terrain` is out of range",
        ),
        (
            FREE,
            "terrain = { gap = { at_m = 1, width_m = -1, depth_m = 1 } }\n",
            "s.toml:4: `terrain` is out of range",
        ),
        (
            FREE,
            "terrain = { slippery = { start_m = 1, length_m = 1, grip = inf } }\n",
            "s.toml:4: `terrain` is out of range",
        ),
        (
            FREE,
            "terrain = { slope = { start_m = 1, angle_rad = 1.2, length_m = 1 } }\n",
            "slopes up to 1.05 rad",
        ),
        (FREE, "robot = \"no-such\"\n", "no-such.toml"),
        (
            FREE,
            "robot = \"fivebar\"\njoints = \"rs00\"\n",
            "leave `joints` out",
        ),
    ] {
        let error = Scenario::parse(&format!("{head}{body}"), "s.toml").expect_err("refused");
        let error = error.to_string();
        assert!(error.contains(part), "{error} lacks {part}");
    }
}

#[test]
fn flags_are_expected_by_name() {
    let body = "[[expect]]\nsignal = \"f\"\nat = 1\nhas_flag = \"lost\"\nlacks_flag = \"hot\"\n";
    let s = Scenario::parse(&format!("{HEAD}{body}"), "s.toml").unwrap();
    let flags = s.expectations[0].flags.iter();
    let flags: Vec<_> = flags.map(|f| (f.name.as_str(), f.set)).collect();
    assert_eq!(flags, [("lost", true), ("hot", false)]);
}

#[test]
fn the_robot_may_have_other_joints_and_a_cold_board() {
    let plain = Scenario::parse(HEAD, "s.toml").unwrap();
    assert_eq!(
        (plain.robot.joints.motor, plain.imu_temperature_c),
        (JointMotor::Dm4310, None)
    );
    let text = format!("{HEAD}joints = \"rs00\"\nimu_temperature_c = 22.0\n");
    let cold = Scenario::parse(&text, "s.toml").unwrap();
    assert_eq!(
        (cold.robot.joints.motor, cold.imu_temperature_c),
        (JointMotor::Rs00, Some(22.0))
    );
    assert!(error_of("imu_temperature_c = 200.0\n").contains("BMI088"));
}
