//! One wrong line of `board.rs`, and the run must fail and say what is wrong (register addresses: RM0090).

mod support;

use robot_emulator::{machine::RegisterPatch, sim::scenario::Scenario};
use robot_plant::time::SECOND;

const QUIET: &str = "name = \"strictness\"\nseconds = 1.5\nplant = \"stand\"\n";

/// What a run complains of.
#[derive(Debug, Default, PartialEq)]
struct Complaints {
    failing: Vec<String>,
    suspicious: Vec<String>,
}

/// All that a run with these register bits overridden complains of.
fn complaints(patches: &[RegisterPatch]) -> Complaints {
    let mut job = support::job(Scenario::parse(QUIET, "strictness").expect("it parses"));
    job.patches = patches.to_vec();
    let summary = job.run(&mut []).expect("the machine starts").summary;
    let errors = summary.board_errors.into_iter().map(|e| e.message);
    let doubts = summary.suspicions.into_iter().map(|e| e.message);
    let all = Complaints {
        failing: errors.chain(summary.stopped).collect(),
        suspicious: doubts.collect(),
    };
    assert_eq!(summary.ok, all.failing.is_empty());
    all
}

/// What the first seconds of the default drive miss with these register bits overridden; the board itself sees nothing.
fn drive_fails(patch: RegisterPatch) -> Vec<String> {
    let path = support::repository().join("scenarios/drive.toml");
    let mut drive = Scenario::read(&path).expect("the default drive");
    drive.length = 2 * SECOND;
    drive.expectations.retain(|e| e.window.start < 2 * SECOND);
    for expectation in &mut drive.expectations {
        expectation.window.end = expectation.window.end.min(2 * SECOND);
    }
    let mut job = support::job(drive);
    job.patches = vec![patch];
    let summary = job.run(&mut []).expect("the machine starts").summary;
    let failed = summary.failed_expectations.into_iter();
    failed.map(|f| format!("{}: {}", f.signal, f.why)).collect()
}

/// One message has all of `parts` in it.
fn must_name(messages: &[String], parts: &[&str]) {
    let telling = |message: &String| parts.iter().all(|part| message.contains(part));
    assert!(
        messages.iter().any(telling),
        "no complaint names {parts:?}: {messages:#?}"
    );
}

/// The run fails, and one complaint has all of `parts` in it.
fn must_complain(patch: RegisterPatch, parts: &[&str]) {
    must_name(&complaints(&[patch]).failing, parts);
}

/// The run does not fail, and one complaint has all of `parts` in it.
fn must_doubt(patch: RegisterPatch, parts: &[&str]) {
    let all = complaints(&[patch]);
    assert_eq!(all.failing, Vec::<String>::new());
    must_name(&all.suspicious, parts);
}

#[test]
fn the_image_as_shipped_gives_no_complaint() {
    assert_eq!(complaints(&[]), Complaints::default());
}

/// PB3 on AF6 (SPI3) instead of AF5 (SPI1): GPIOB_AFRL bits 15:12.
#[test]
fn wrong_alternate_function_of_the_imu_clock() {
    let patch = RegisterPatch {
        address: 0x4002_0420,
        mask: 0xF000,
        value: 0x6000,
    };
    must_complain(patch, &["SPI1_SCK: PB3 is AF6, needs AF5"]);
}

/// USART3_RX sits on DMA1 stream 1 channel 4; channel 5 is TIM2's there: DMA1_S1CR bits 27:25.
#[test]
fn wrong_dma_channel_of_the_radio() {
    let patch = RegisterPatch {
        address: 0x4002_6028,
        mask: 7 << 25,
        value: 5 << 25,
    };
    must_complain(patch, &["USART3_RX", "DMA1 stream 1", "set to channel 5"]);
}

/// Prescaler 6 instead of 3 halves the bit rate: CAN1_BTR bits 9:0.
#[test]
fn wrong_can_bit_timing() {
    let patch = RegisterPatch {
        address: 0x4000_641C,
        mask: 0x3FF,
        value: 5,
    };
    must_complain(patch, &["CAN1: 500000 bit/s on a 1000000 bit/s bus"]);
}

/// N = 100 instead of 168 gives 100 MHz: APB1 runs at 25 MHz. RCC_PLLCFGR bits 14:6.
#[test]
fn wrong_pll_multiplier() {
    let patch = RegisterPatch {
        address: 0x4002_3804,
        mask: 0x1FF << 6,
        value: 100 << 6,
    };
    must_complain(patch, &["pclk1 runs at 25 MHz"]);
}

/// 8N1 instead of 8E2: USART3_CR1 bits M (12) and PCE (10) cleared.
#[test]
fn radio_without_parity() {
    let patch = RegisterPatch {
        address: 0x4000_480C,
        mask: 1 << 12 | 1 << 10,
        value: 0,
    };
    must_complain(patch, &["USART3", "8E2", "8N2"]);
}

/// Odd parity where the receiver sends even: USART3_CR1 bit PS (9).
#[test]
fn radio_with_the_wrong_parity() {
    let patch = RegisterPatch {
        address: 0x4000_480C,
        mask: 1 << 9,
        value: 1 << 9,
    };
    must_complain(patch, &["USART3", "8E2", "8O2"]);
}

/// PLLP = 4 instead of 2 halves every clock: RCC_PLLCFGR bits 17:16.
#[test]
fn wrong_pll_divider() {
    let patch = RegisterPatch {
        address: 0x4002_3804,
        mask: 3 << 16,
        value: 1 << 16,
    };
    must_complain(patch, &["pclk1 runs at 21 MHz"]);
}

/// APB1 at 84 MHz, its limit is 42 MHz: RCC_CFGR bits 12:10.
#[test]
fn wrong_apb1_prescaler() {
    let patch = RegisterPatch {
        address: 0x4002_3808,
        mask: 7 << 10,
        value: 0b100 << 10,
    };
    must_complain(patch, &["PCLK1 is 84000000 Hz"]);
}

/// Port B without its clock: RCC_AHB1ENR bit 1.
#[test]
fn unclocked_port() {
    let patch = RegisterPatch {
        address: 0x4002_3830,
        mask: 1 << 1,
        value: 0,
    };
    must_complain(patch, &["GPIOB", "AHB1ENR.GPIOBEN is 0"]);
}

/// PCLK2/4 = 21 MHz, the BMI088 takes 10 MHz: SPI1_CR1 bits 5:3.
#[test]
fn imu_clock_above_its_limit() {
    let patch = RegisterPatch {
        address: 0x4001_3000,
        mask: 7 << 3,
        value: 1 << 3,
    };
    must_complain(patch, &["BMI088: SCK at 21000000 Hz"]);
}

/// PCLK2/8 = 10.5 MHz, as DJI's own programs have it.
#[test]
fn imu_clock_just_above_its_limit() {
    let patch = RegisterPatch {
        address: 0x4001_3000,
        mask: 7 << 3,
        value: 2 << 3,
    };
    must_doubt(patch, &["BMI088: SCK at 10500000 Hz"]);
}

/// 42 MHz / (3 × 30) = 467 kHz, fast mode ends at 400 kHz: I2C3_CCR bits 11:0.
#[test]
fn magnetometer_clock_above_its_limit() {
    let patch = RegisterPatch {
        address: 0x4000_5C1C,
        mask: 0xFFF,
        value: 30,
    };
    must_complain(patch, &["I2C3: SCL at 466666 Hz"]);
}

/// A push-pull SDA: GPIOC_OTYPER bit 9.
#[test]
fn push_pull_i2c_line() {
    let patch = RegisterPatch {
        address: 0x4002_0804,
        mask: 1 << 9,
        value: 0,
    };
    must_complain(patch, &["I2C3_SDA: PC9 is push-pull, needs open-drain"]);
}

/// TIM2, the time base, at 84 MHz / 83: every tick is 1.2 % short. TIM2_PSC.
#[test]
fn a_time_base_a_little_off_fails_the_default_drive() {
    let patch = RegisterPatch {
        address: 0x4000_0028,
        mask: 0xFFFF,
        value: 82,
    };
    must_name(&drive_fails(patch), &["emu.tick_period_us", "988.095"]);
}

/// The magnetometer's transfers without DMA never end: I2C3_CR2 bit DMAEN (11).
#[test]
fn a_magnetometer_that_never_gets_ready_fails_the_default_drive() {
    let patch = RegisterPatch {
        address: 0x4000_5C04,
        mask: 1 << 11,
        value: 0,
    };
    must_name(&drive_fails(patch), &["diag.mag_health.ready"]);
}
