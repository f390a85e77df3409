//! A wrong line of `board.rs` must fail the run, and the message must name the error (register addresses: RM0090).

mod support;

#[path = "strictness/link.rs"]
mod link;

use robot_plant::time::SECOND;
use robot_sim::{machine::RegisterPatch, scenario::Scenario};

const QUIET: &str = "name = \"strictness\"\nseconds = 1.5\nplant = \"stand\"\n";

const BEEPING: &str = "
name = \"strictness\"
seconds = 1.0
plant = \"stand\"
[[at]]
t = 0.4
remote = { e_stop = true }
";

/// The board errors and suspicions of a run.
#[derive(Debug, Default, PartialEq)]
struct Reported {
    failing: Vec<String>,
    suspicious: Vec<String>,
}

/// Runs the image with these register bits overridden.
fn reported(patches: &[RegisterPatch]) -> Reported {
    reported_in(QUIET, patches)
}

/// The same in a scenario.
fn reported_in(scenario: &str, patches: &[RegisterPatch]) -> Reported {
    let mut job = support::job(Scenario::parse(scenario, "strictness").expect("it parses"));
    job.patches = patches.to_vec();
    let summary = job.run(&mut []).expect("the machine starts").summary;
    let errors = summary.board_errors.into_iter().map(|e| e.message);
    let doubts = summary.suspicions.into_iter().map(|e| e.message);
    let all = Reported {
        failing: errors.chain(summary.stopped).collect(),
        suspicious: doubts.collect(),
    };
    assert_eq!(summary.ok, all.failing.is_empty());
    all
}

/// The expectations of the default drive's first seconds that fail with these register bits overridden, where the board
/// itself reports nothing.
fn drive_fails(patch: RegisterPatch) -> Vec<String> {
    let path = robot_test_support::repository().join("scenarios/drive.toml");
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

/// Asserts that one message contains all of `parts`.
fn must_name(messages: &[String], parts: &[&str]) {
    let telling = |message: &String| parts.iter().all(|part| message.contains(part));
    assert!(
        messages.iter().any(telling),
        "no message names {parts:?}: {messages:#?}"
    );
}

/// Asserts that the run fails and that one message contains all of `parts`.
fn must_report(patch: RegisterPatch, parts: &[&str]) {
    must_name(&reported(&[patch]).failing, parts);
}

/// Asserts that the run does not fail and that one suspicion contains all of `parts`.
fn assert_suspicious(patch: RegisterPatch, parts: &[&str]) {
    let all = reported(&[patch]);
    assert_eq!(all.failing, Vec::<String>::new());
    must_name(&all.suspicious, parts);
}

/// The same for several patches in one run: address, mask, value and the parts of its message.
fn must_report_all(wrong: &[(u32, u32, u32, &[&str])]) {
    let patches: Vec<_> = wrong.iter().map(|w| patch(w.0, w.1, w.2)).collect();
    let failing = reported(&patches).failing;
    wrong.iter().for_each(|w| must_name(&failing, w.3));
}

fn patch(address: u32, mask: u32, value: u32) -> RegisterPatch {
    RegisterPatch {
        address,
        mask,
        value,
    }
}

#[test]
fn the_shipped_image_causes_no_board_error() {
    assert_eq!(reported(&[]), Reported::default());
}

/// PB3 on AF6 (SPI3) instead of AF5 (SPI1): GPIOB_AFRL bits 15:12.
#[test]
fn wrong_alternate_function_of_the_imu_clock() {
    let patch = RegisterPatch {
        address: 0x4002_0420,
        mask: 0xF000,
        value: 0x6000,
    };
    must_report(patch, &["SPI1_SCK: PB3 is AF6, needs AF5"]);
}

/// USART3_RX sits on DMA1 stream 1 channel 4; channel 5 is TIM2's there: DMA1_S1CR bits 27:25.
#[test]
fn wrong_dma_channel_of_the_radio() {
    let patch = RegisterPatch {
        address: 0x4002_6028,
        mask: 7 << 25,
        value: 5 << 25,
    };
    must_report(patch, &["USART3_RX", "DMA1 stream 1", "set to channel 5"]);
}

/// Prescaler 6 instead of 3 halves the bit rate: CAN1_BTR bits 9:0.
#[test]
fn wrong_can_bit_timing() {
    let patch = RegisterPatch {
        address: 0x4000_641C,
        mask: 0x3FF,
        value: 5,
    };
    must_report(patch, &["CAN1: 500000 bit/s on a 1000000 bit/s bus"]);
}

/// N = 100 instead of 168 gives 100 MHz: APB1 runs at 25 MHz. RCC_PLLCFGR bits 14:6.
#[test]
fn wrong_pll_multiplier() {
    let patch = RegisterPatch {
        address: 0x4002_3804,
        mask: 0x1FF << 6,
        value: 100 << 6,
    };
    must_report(patch, &["pclk1 runs at 25 MHz"]);
}

/// 8N1 instead of 8E2: USART3_CR1 bits M (12) and PCE (10) cleared.
#[test]
fn radio_without_parity() {
    let patch = RegisterPatch {
        address: 0x4000_480C,
        mask: 1 << 12 | 1 << 10,
        value: 0,
    };
    must_report(patch, &["USART3", "8E2", "8N2"]);
}

/// Odd parity where the receiver sends even: USART3_CR1 bit PS (9).
#[test]
fn radio_with_the_wrong_parity() {
    let patch = RegisterPatch {
        address: 0x4000_480C,
        mask: 1 << 9,
        value: 1 << 9,
    };
    must_report(patch, &["USART3", "8E2", "8O2"]);
}

/// PLLP = 4 instead of 2 halves every clock: RCC_PLLCFGR bits 17:16.
#[test]
fn wrong_pll_divider() {
    let patch = RegisterPatch {
        address: 0x4002_3804,
        mask: 3 << 16,
        value: 1 << 16,
    };
    must_report(patch, &["pclk1 runs at 21 MHz"]);
}

/// APB1 at 84 MHz, its limit is 42 MHz: RCC_CFGR bits 12:10.
#[test]
fn wrong_apb1_prescaler() {
    let patch = RegisterPatch {
        address: 0x4002_3808,
        mask: 7 << 10,
        value: 0b100 << 10,
    };
    must_report(patch, &["PCLK1 is 84000000 Hz"]);
}

/// Port B without its clock: RCC_AHB1ENR bit 1.
#[test]
fn unclocked_port() {
    let patch = RegisterPatch {
        address: 0x4002_3830,
        mask: 1 << 1,
        value: 0,
    };
    must_report(patch, &["GPIOB", "AHB1ENR.GPIOBEN is 0"]);
}

/// PCLK2/4 = 21 MHz, the BMI088 takes 10 MHz: SPI1_CR1 bits 5:3.
#[test]
fn imu_clock_above_its_limit() {
    let patch = RegisterPatch {
        address: 0x4001_3000,
        mask: 7 << 3,
        value: 1 << 3,
    };
    must_report(patch, &["BMI088: SCK at 21000000 Hz"]);
}

/// PCLK2/8 = 10.5 MHz, as DJI's own programs have it.
#[test]
fn imu_clock_just_above_its_limit() {
    let patch = RegisterPatch {
        address: 0x4001_3000,
        mask: 7 << 3,
        value: 2 << 3,
    };
    assert_suspicious(patch, &["BMI088: SCK at 10500000 Hz"]);
}

/// 42 MHz / (3 × 30) = 467 kHz, fast mode ends at 400 kHz: I2C3_CCR bits 11:0.
#[test]
fn magnetometer_clock_above_its_limit() {
    let patch = RegisterPatch {
        address: 0x4000_5C1C,
        mask: 0xFFF,
        value: 30,
    };
    must_report(patch, &["I2C3: SCL at 466666 Hz"]);
}

/// A push-pull SDA: GPIOC_OTYPER bit 9.
#[test]
fn push_pull_i2c_line() {
    let patch = RegisterPatch {
        address: 0x4002_0804,
        mask: 1 << 9,
        value: 0,
    };
    must_report(patch, &["I2C3_SDA: PC9 is push-pull, needs open-drain"]);
}

/// TIM2, the time base, at 84 MHz / 83: every tick is 1.2 % short. TIM2_PSC.
#[test]
fn a_time_base_a_little_off_fails_the_default_drive() {
    let patch = RegisterPatch {
        address: 0x4000_0028,
        mask: 0xFFFF,
        value: 82,
    };
    must_name(&drive_fails(patch), &["emu.tick_period_us", "988.0"]);
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

/// GPIOx_OTYPER has one bit for each pin; 1 is open-drain.
const OTYPER: [(char, u32); 6] = [
    ('A', 0x4002_0004),
    ('B', 0x4002_0404),
    ('D', 0x4002_0C04),
    ('F', 0x4002_1404),
    ('G', 0x4002_1804),
    ('H', 0x4002_1C04),
];

fn open_drain(port: char, pin: u32) -> (u32, u32, u32) {
    let (_, address) = OTYPER.into_iter().find(|o| o.0 == port).expect("a port");
    (address, 1 << pin, 1 << pin)
}

fn must_report_open_drains(pins: &[(char, u32, &[&str])]) {
    let wrong: Vec<_> = pins
        .iter()
        .map(|&(port, pin, parts)| {
            let (address, mask, value) = open_drain(port, pin);
            (address, mask, value, parts)
        })
        .collect();
    must_report_all(&wrong);
}

/// The clock idles high in mode 3, for which the HAL switches its pull-up on.
#[test]
fn open_drain_outputs_without_a_pull_up_never_rise() {
    let never = "open-drain without a pull-up and never rises";
    must_report_open_drains(&[
        ('B', 3, &["SPI1_SCK: PB3", "rises too slowly by a resistor"]),
        ('D', 1, &["CAN1_TX: PD1", never]),
        ('B', 6, &["CAN2_TX: PB6", never]),
    ]);
    must_report_open_drains(&[
        ('A', 7, &["SPI1_MOSI: PA7", never]),
        (
            'A',
            4,
            &[
                "PA4 is open-drain",
                "accelerometer's chip select never rises",
            ],
        ),
        (
            'B',
            0,
            &["PB0 is open-drain", "gyro's chip select never rises"],
        ),
    ]);
}

#[test]
fn open_drain_outputs_open_no_mosfet() {
    must_report_open_drains(&[
        ('F', 6, &["PF6 is open-drain", "heater stays off"]),
        ('H', 11, &["PH11 is open-drain", "green LED stays off"]),
        ('H', 12, &["PH12 is open-drain", "red LED stays off"]),
    ]);
}

/// PD14 drives the buzzer, which sounds when the e-stop is thrown.
#[test]
fn an_open_drain_buzzer_is_mute() {
    let (address, mask, value) = open_drain('D', 14);
    let mut job = support::job(Scenario::parse(BEEPING, "strictness").expect("it parses"));
    job.patches = vec![patch(address, mask, value)];
    let summary = job.run(&mut []).expect("the machine starts").summary;
    let errors: Vec<_> = summary
        .board_errors
        .into_iter()
        .map(|e| e.message)
        .collect();
    must_name(&errors, &["PD14 is open-drain", "buzzer stays off"]);
}

/// PG6 resets the magnetometer. No source says whether the magnetometer has a pull-up of its own.
#[test]
fn an_open_drain_reset_of_the_magnetometer_is_suspicious() {
    let (address, mask, value) = open_drain('G', 6);
    assert_suspicious(patch(address, mask, value), &["PG6 is open-drain"]);
}

/// GPIOF_AFRL bits 27:24: TIM10 is AF3 on PF6.
#[test]
fn wrong_alternate_function_of_the_heater() {
    let patch = patch(0x4002_1420, 0xF << 24, 2 << 24);
    must_report(patch, &["TIM10_CH1: PF6 is AF2, needs AF3: the heater"]);
}

/// GPIOC_MODER bits 23:22: PC11 drives against the radio's inverter.
#[test]
fn an_output_where_the_radio_comes_in() {
    let patch = patch(0x4002_0800, 3 << 22, 1 << 22);
    must_report(patch, &["PC11 is an output, and so is"]);
}

/// GPIOB_OSPEEDR bits 7:6: the slowest stage is made for 4 MHz, the clock has 5.25 MHz.
#[test]
fn a_slow_output_stage_on_the_imu_clock() {
    assert_suspicious(
        patch(0x4002_0408, 3 << 6, 0),
        &["SPI1_SCK: PB3 switches 5250000 Hz"],
    );
}

/// CANx_BTR, TS2 in bits 22:20, TS1 in 19:16, SJW in 25:24; 14 quanta a bit.
#[test]
fn can_bits_sampled_where_no_other_device_does() {
    let early = 5 << 20 | 6 << 16;
    let late = 11 << 16;
    must_report_all(&[
        (0x4000_641C, 0x7F << 16, early, &["CAN1: samples at 57.1 %"]),
        (0x4000_681C, 0x7F << 16, late, &["CAN2: samples at 92.8 %"]),
    ]);
    // 9 + 4.
    assert_suspicious(
        patch(0x4000_641C, 0x7F << 16, 3 << 20 | 8 << 16),
        &["CAN1: samples at 71.4 %"],
    );
}

#[test]
fn a_can_jump_width_past_the_end_of_the_bit() {
    let patch = patch(0x4000_641C, 3 << 24, 3 << 24);
    must_report(patch, &["CAN1: SJW of 4 quanta, with 3 after the sample"]);
}

/// GPIOH_MODER bits 23:22 and GPIOG_MODER bits 13:12: pins that are inputs and drive nothing.
#[test]
fn pins_that_were_never_made_outputs() {
    let led = (0x4002_1C00, 3 << 22, 0);
    let reset = (0x4002_1800, 3 << 12, 0);
    let found = reported(&[led, reset].map(|p| patch(p.0, p.1, p.2)));
    must_name(
        &found.failing,
        &["PH11 is an input, needs an output: the green LED"],
    );
    must_name(&found.suspicious, &["PG6 floats"]);
}

/// FLASH_ACR bits 8 to 10. Nothing fails, but the times of the run are not those of the board.
#[test]
fn flash_without_prefetch_and_caches() {
    let found = reported(&[patch(0x4002_3C00, 7 << 8, 0)]);
    assert_eq!(found.failing, Vec::<String>::new());
    for what in ["prefetch", "instruction cache", "data cache"] {
        must_name(&found.suspicious, &["FLASH:", what, "off at 5 wait states"]);
    }
}

/// ADC3_SMPR2 bits 26:24: 3 cycles at 21 MHz, too short for the divider of 20 kOhm.
#[test]
fn a_battery_sampled_too_shortly() {
    let patch = patch(0x4001_2210, 7 << 24, 0);
    assert_suspicious(
        patch,
        &["ADC3: a source of 19820 ohms is sampled for 142 ns"],
    );
}

/// TIM10_CCER bit 1: the heater is on while it should be off.
#[test]
fn an_inverted_heater_fails_the_default_drive() {
    let patch = patch(0x4001_4420, 1 << 1, 1 << 1);
    must_name(&drive_fails(patch), &["truth.imu.heater_duty"]);
}

/// NVIC_IPR of UART5, whose interrupt runs the control tick: below the sensors' 4.
#[test]
fn a_control_tick_below_the_sensors_fails_the_default_drive() {
    let patch = patch(0xE000_E435, 0xFF, 0x50);
    must_name(&drive_fails(patch), &["diag.tick.max_jitter_us"]);
}
