//! Devices on plain pins, driven through the chip's registers.

use robot_emulator::{
    soc::{bus::Soc, guest_memory::GuestMemory},
    time::{MS, Ps, US},
};
use robot_plant::world::{World, WorldConfig};

use super::CBoard;

mod link;
mod temperature;

const RCC: u32 = 0x4002_3800;
const AHB1ENR: u32 = RCC + 0x30;
const APB1ENR: u32 = RCC + 0x40;
const FLASH_ACR: u32 = 0x4002_3C00;
const GPIOA: u32 = 0x4002_0000;
const GPIOD: u32 = 0x4002_0C00;
const GPIOH: u32 = 0x4002_1C00;
const TIM4: u32 = 0x4000_0800;
const TIM5: u32 = 0x4000_0C00;
/// PWM mode 1 with preload, channel 1 or 3 of its register.
const PWM1: u32 = 0x68;

/// DMA is not used here.
struct NoMemory;

impl GuestMemory for NoMemory {
    fn read(&mut self, _addr: u32, _out: &mut [u8]) -> bool {
        false
    }

    fn write(&mut self, _addr: u32, _data: &[u8]) -> bool {
        false
    }
}

/// The board without a CPU: the test makes the accesses.
struct Bench {
    soc: Soc,
    now: Ps,
}

impl Bench {
    fn new() -> Self {
        let world = World::new(WorldConfig::default()).expect("a world without a recording");
        Self {
            soc: Soc::new(Box::new(CBoard::new(world))),
            now: 0,
        }
    }

    fn write(&mut self, addr: u32, value: u32) {
        self.soc
            .write(addr, 4, value, self.now, &mut NoMemory)
            .expect("a modelled register");
    }

    fn read(&mut self, addr: u32) -> u32 {
        self.soc
            .read(addr, 4, self.now, &mut NoMemory)
            .expect("a modelled register")
    }

    fn set_bits(&mut self, addr: u32, bits: u32) {
        let old = self.read(addr);
        self.write(addr, old | bits);
    }

    fn run_until(&mut self, at: Ps) {
        self.now = at;
        self.soc
            .run_due(at, &mut NoMemory)
            .expect("modelled registers");
    }

    /// HSE, PLL and prescalers: 168, 42 and 84 MHz.
    fn clock_up(&mut self) {
        self.set_bits(RCC, 1 << 16);
        self.run_until(self.now + 2 * MS);
        self.write(RCC + 0x04, 6 | 168 << 6 | 1 << 22 | 7 << 24);
        self.set_bits(RCC, 1 << 24);
        self.run_until(self.now + MS);
        self.write(FLASH_ACR, 5);
        self.write(RCC + 0x08, 0b10 | 0b101 << 10 | 0b100 << 13);
    }

    fn errors(&self) -> Vec<&str> {
        let errors = self.soc.errors.list().iter();
        errors.map(|e| e.message.as_str()).collect()
    }

    fn world(&mut self) -> &mut World {
        let board: &mut CBoard = self.soc.board_as().expect("a C board");
        &mut board.world
    }

    fn truth(&mut self, name: &str) -> f64 {
        self.world().signal(name).expect(name)
    }
}

fn board() -> Bench {
    let mut bench = Bench::new();
    bench.clock_up();
    bench.set_bits(AHB1ENR, 0x1FF);
    bench.set_bits(APB1ENR, 1 << 2 | 1 << 3);
    bench
}

#[test]
fn an_led_follows_its_port_pin() {
    let mut bench = board();
    // PH12 is red, active high.
    bench.write(GPIOH + 0x18, 1 << 12);
    assert_eq!(bench.truth("truth.led.r"), 0.0);
    let expected = "PH12 is an input, needs an output: the red LED stays off";
    assert_eq!(bench.errors(), [expected]);
    bench.write(GPIOH, 0b01 << 24);
    assert_eq!(bench.truth("truth.led.r"), 1.0);
    bench.write(GPIOH + 0x18, 1 << 28);
    assert_eq!(bench.truth("truth.led.r"), 0.0);
}

#[test]
fn an_led_is_dimmed_by_its_timer() {
    let mut bench = board();
    // PH10 is blue, TIM5_CH1 on AF2: 250 of 1000 steps.
    bench.write(GPIOH, 0b10 << 20);
    bench.write(GPIOH + 0x24, 2 << 8);
    bench.write(TIM5 + 0x2C, 999);
    bench.write(TIM5 + 0x18, PWM1);
    bench.write(TIM5 + 0x34, 250);
    bench.write(TIM5 + 0x20, 1);
    bench.write(TIM5 + 0x14, 1);
    bench.write(TIM5, 1);
    assert_eq!(bench.truth("truth.led.b"), 0.25);
    assert_eq!(bench.errors(), Vec::<&str>::new());
    // On another alternate function the timer does not reach the pin.
    bench.write(GPIOH + 0x24, 3 << 8);
    assert_eq!(bench.truth("truth.led.b"), 0.0);
    let expected = "TIM5_CH1: PH10 is AF3, needs AF2: the blue LED stays off";
    assert_eq!(bench.errors(), [expected]);
}

#[test]
fn an_open_drain_stage_opens_no_mosfet_and_releases_no_chip_select() {
    let mut bench = board();
    bench.write(GPIOH + 0x04, 1 << 12);
    bench.write(GPIOH, 0b01 << 24);
    bench.write(GPIOH + 0x18, 1 << 12);
    assert_eq!(bench.truth("truth.led.r"), 0.0);
    // PA4, the accelerometer's chip select; then with the chip's pull-up.
    bench.write(GPIOA + 0x04, 1 << 4);
    bench.write(GPIOA + 0x18, 1 << 4);
    bench.write(GPIOA, 0b01 << 8 | 0xA800_0000);
    let expected = [
        "PH12 is open-drain, needs push-pull: the red LED stays off",
        "PA4 is open-drain, needs push-pull: the accelerometer's chip select never rises",
    ];
    assert_eq!(bench.errors(), expected);
    bench.write(GPIOA + 0x0C, 0b01 << 8 | 0x6400_0000);
    let doubts = bench.soc.errors.suspicions().iter();
    let expected =
        "PA4 is open-drain: the accelerometer's chip select rises by the chip's 40 kOhm only";
    assert_eq!(doubts.map(|e| &e.message).collect::<Vec<_>>(), [expected]);
}

/// RM0090 18.3.9: with OCxPE the new value is taken at the next update event.
#[test]
fn a_new_duty_reaches_the_pin_with_the_next_period() {
    let mut bench = board();
    bench.write(GPIOH, 0b10 << 20);
    bench.write(GPIOH + 0x24, 2 << 8);
    // 84 MHz / 84 / 1000: a period of 1 ms.
    bench.write(TIM5 + 0x28, 83);
    bench.write(TIM5 + 0x2C, 999);
    bench.write(TIM5 + 0x18, PWM1);
    bench.write(TIM5 + 0x20, 1);
    bench.write(TIM5 + 0x14, 1);
    bench.write(TIM5, 1);
    let start = bench.now;
    bench.run_until(start + 300 * US);
    bench.write(TIM5 + 0x34, 250);
    bench.run_until(start + 990 * US);
    assert_eq!(bench.truth("truth.led.b"), 0.0);
    bench.run_until(start + 1_010 * US);
    assert_eq!(bench.truth("truth.led.b"), 0.25);
}

#[test]
fn the_buzzer_sounds_at_the_timers_rate() {
    let mut bench = board();
    // PD14, TIM4_CH3 on AF2: 84 MHz / 84 / 250 = 4 kHz.
    bench.write(GPIOD, 0b10 << 28);
    bench.write(GPIOD + 0x24, 2 << 24);
    bench.write(TIM4 + 0x28, 83);
    bench.write(TIM4 + 0x2C, 249);
    bench.write(TIM4 + 0x1C, PWM1);
    bench.write(TIM4 + 0x3C, 125);
    bench.write(TIM4 + 0x20, 1 << 8);
    bench.write(TIM4 + 0x14, 1);
    bench.write(TIM4, 1);
    assert_eq!(bench.truth("truth.buzzer.hz"), 4000.0);
}
