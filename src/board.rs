//! The RoboMaster Development Board C: clocks, pins, DMA streams and interrupts. No other file names them
//! (docs/hardware.md#board-devices, docs/hardware.md#dma).

use bxcan::{Rx0, Rx1};
use embassy_stm32::adc::AdcChannel;
use embassy_stm32::dma;
use embassy_stm32::gpio::{AfType, Flex, Level, Output, OutputType, Pull, Speed};
use embassy_stm32::i2c::{self, I2c};
use embassy_stm32::interrupt::{self, InterruptExt, Priority};
use embassy_stm32::mode::Async;
use embassy_stm32::spi::{self, Spi};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::low_level::CountingMode;
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwm};
use embassy_stm32::{Config, Peri, Peripherals, bind_interrupts, pac, peripherals, rcc};
use robot_app::input::RemoteFormat;

use crate::drivers::analog::{AnalogInputs, FactoryWords};
use crate::drivers::bmi088::Bmi088;
use crate::drivers::buzzer::Buzzer;
use crate::drivers::can::{self, Can1, Can2, CanPort, FifoInterrupt};
use crate::drivers::heater::Heater;
use crate::drivers::ist8310::Ist8310;
use crate::drivers::status_led::StatusLed;
use crate::executors::{ControlInterrupt, SensorInterrupt};
use serial::{LinkInterrupt, LinkPins, LinkUart, RadioInterrupt, RadioReceiver};

pub mod serial;

bind_interrupts!(struct Irqs {
    CAN1_RX0 => FifoInterrupt<Rx0<Can1>>;
    CAN1_RX1 => FifoInterrupt<Rx1<Can1>>;
    CAN2_RX0 => FifoInterrupt<Rx0<Can2>>;
    CAN2_RX1 => FifoInterrupt<Rx1<Can2>>;
    USART1 => LinkInterrupt;
    USART3 => RadioInterrupt;
    UART5 => ControlInterrupt;
    UART4 => SensorInterrupt;
    I2C3_EV => i2c::EventInterruptHandler<peripherals::I2C3>;
    I2C3_ER => i2c::ErrorInterruptHandler<peripherals::I2C3>;
    DMA1_STREAM1 => dma::InterruptHandler<peripherals::DMA1_CH1>;
    DMA1_STREAM2 => dma::InterruptHandler<peripherals::DMA1_CH2>;
    DMA1_STREAM4 => dma::InterruptHandler<peripherals::DMA1_CH4>;
    DMA2_STREAM2 => dma::InterruptHandler<peripherals::DMA2_CH2>;
    DMA2_STREAM3 => dma::InterruptHandler<peripherals::DMA2_CH3>;
    DMA2_STREAM5 => dma::InterruptHandler<peripherals::DMA2_CH5>;
    DMA2_STREAM7 => dma::InterruptHandler<peripherals::DMA2_CH7>;
});

/// Interrupt of the control executor, borrowed from an unused peripheral.
pub const CONTROL_EXECUTOR_IRQ: interrupt::Interrupt = interrupt::UART5;
/// Interrupt of the sensor executor, borrowed from an unused peripheral.
pub const SENSOR_EXECUTOR_IRQ: interrupt::Interrupt = interrupt::UART4;

/// Alternate function of the CAN pins.
const CAN_AF: u8 = 9;

/// The time driver releases the control tick, so nothing may delay it. CAN receive comes next, because each hardware FIFO
/// holds only three frames. Sensor transfers may wait for a control tick, but not for the sensor executor.
const PRIORITIES: [(interrupt::Interrupt, Priority); 11] = [
    (interrupt::TIM2, Priority::P0),
    (interrupt::CAN1_RX0, Priority::P1),
    (interrupt::CAN1_RX1, Priority::P1),
    (interrupt::CAN2_RX0, Priority::P1),
    (interrupt::CAN2_RX1, Priority::P1),
    (CONTROL_EXECUTOR_IRQ, Priority::P2),
    (interrupt::USART1, Priority::P3),
    (interrupt::USART3, Priority::P3),
    (interrupt::I2C3_EV, Priority::P3),
    (interrupt::I2C3_ER, Priority::P3),
    (SENSOR_EXECUTOR_IRQ, Priority::P4),
];

/// Everything on the board, ready for use.
pub struct Board {
    pub can1: CanPort,
    pub can2: CanPort,
    pub radio: RadioReceiver,
    pub link: LinkUart,
    pub imu: ImuBus,
    pub heater: Heater,
    pub mag: MagBus,
    pub led: StatusLed,
    pub buzzer: Buzzer,
    pub analog: AnalogInputs,
    pub iwdg: Peri<'static, peripherals::IWDG>,
    pub flash: Peri<'static, peripherals::FLASH>,
}

/// SPI1 and the pins of the BMI088.
pub struct ImuBus {
    spi: Peri<'static, peripherals::SPI1>,
    sck: Peri<'static, peripherals::PB3>,
    mosi: Peri<'static, peripherals::PA7>,
    miso: Peri<'static, peripherals::PB4>,
    tx_dma: Peri<'static, peripherals::DMA2_CH3>,
    rx_dma: Peri<'static, peripherals::DMA2_CH2>,
    accel_select: Peri<'static, peripherals::PA4>,
    gyro_select: Peri<'static, peripherals::PB0>,
}

/// I2C3 and the pins of the IST8310.
pub struct MagBus {
    i2c: Peri<'static, peripherals::I2C3>,
    scl: Peri<'static, peripherals::PA8>,
    sda: Peri<'static, peripherals::PC9>,
    tx_dma: Peri<'static, peripherals::DMA1_CH4>,
    rx_dma: Peri<'static, peripherals::DMA1_CH2>,
    reset: Peri<'static, peripherals::PG6>,
}

impl Board {
    /// Starts CAN, the radio receiver, the PC link, heater, buzzer and analogue inputs. `p` exists once, so this runs once.
    pub fn start(p: Peripherals, remote_format: RemoteFormat) -> Self {
        enable_flash_caches();
        watch_supply();
        for (irq, priority) in PRIORITIES {
            irq.set_priority(priority);
        }
        let (can1, can2) = start_can(CanPins {
            can1: p.CAN1,
            can2: p.CAN2,
            rx1: p.PD0,
            tx1: p.PD1,
            rx2: p.PB5,
            tx2: p.PB6,
        });
        Self {
            can1,
            can2,
            radio: serial::start_radio(p.PC11, p.DMA1_CH1, remote_format),
            link: serial::start_link(LinkPins {
                rx: p.PB7,
                tx: p.PA9,
                rx_dma: p.DMA2_CH5,
                tx_dma: p.DMA2_CH7,
            }),
            imu: ImuBus {
                spi: p.SPI1,
                sck: p.PB3,
                mosi: p.PA7,
                miso: p.PB4,
                tx_dma: p.DMA2_CH3,
                rx_dma: p.DMA2_CH2,
                accel_select: p.PA4,
                gyro_select: p.PB0,
            },
            heater: start_heater(p.TIM10, p.PF6),
            mag: MagBus {
                i2c: p.I2C3,
                scl: p.PA8,
                sda: p.PC9,
                tx_dma: p.DMA1_CH4,
                rx_dma: p.DMA1_CH2,
                reset: p.PG6,
            },
            led: StatusLed {
                red: Output::new(p.PH12, Level::Low, Speed::Low),
                green: Output::new(p.PH11, Level::Low, Speed::Low),
                blue: Output::new(p.PH10, Level::Low, Speed::Low),
            },
            buzzer: start_buzzer(p.TIM4, p.PD14),
            analog: AnalogInputs::new(
                (p.ADC3, pac::ADC3),
                p.PF10.degrade_adc(),
                (p.ADC1, pac::ADC1),
                &factory_words(),
            ),
            iwdg: p.IWDG,
            flash: p.FLASH,
        }
    }
}

impl ImuBus {
    /// Resets SPI1 and gives it to a driver: mode 3 at PCLK2/16 = 5.25 MHz (the sensor's limit is 10 MHz).
    pub fn open(&mut self) -> Bmi088<'_> {
        let mut config = spi::Config::default();
        config.mode = spi::MODE_3;
        config.frequency = Hertz(5_250_000);
        let spi = Spi::new(
            self.spi.reborrow(),
            self.sck.reborrow(),
            self.mosi.reborrow(),
            self.miso.reborrow(),
            self.tx_dma.reborrow(),
            self.rx_dma.reborrow(),
            Irqs,
            config,
        );
        Bmi088::new(
            spi,
            Output::new(self.accel_select.reborrow(), Level::High, Speed::High),
            Output::new(self.gyro_select.reborrow(), Level::High, Speed::High),
        )
    }
}

impl MagBus {
    /// Resets I2C3, which also ends a transfer that hangs, and gives it to a driver.
    pub fn open(&mut self) -> Ist8310<'_> {
        let mut config = i2c::Config::default();
        config.frequency = Hertz(400_000);
        let i2c: I2c<'_, Async, i2c::Master> = I2c::new(
            self.i2c.reborrow(),
            self.scl.reborrow(),
            self.sda.reborrow(),
            self.tx_dma.reborrow(),
            self.rx_dma.reborrow(),
            Irqs,
            config,
        );
        Ist8310::new(
            i2c,
            pac::I2C3,
            Output::new(self.reset.reborrow(), Level::High, Speed::Low),
        )
    }
}

/// 168 MHz from the 12 MHz crystal; APB1 42 MHz, APB2 84 MHz.
pub fn clocks() -> Config {
    use embassy_stm32::rcc::{
        AHBPrescaler, APBPrescaler, Hse, HseMode, Pll, PllMul, PllPDiv, PllPreDiv, PllQDiv,
        PllSource, Sysclk,
    };
    let mut config = Config::default();
    config.rcc.hse = Some(Hse {
        freq: Hertz(12_000_000),
        mode: HseMode::Oscillator,
    });
    config.rcc.pll_src = PllSource::HSE;
    config.rcc.pll = Some(Pll {
        prediv: PllPreDiv::DIV6,
        mul: PllMul::MUL168,
        divp: Some(PllPDiv::DIV2),
        divq: Some(PllQDiv::DIV7),
        divr: None,
    });
    config.rcc.sys = Sysclk::PLL1_P;
    config.rcc.ahb_pre = AHBPrescaler::DIV1;
    config.rcc.apb1_pre = APBPrescaler::DIV4;
    config.rcc.apb2_pre = APBPrescaler::DIV2;
    config.dma_interrupt_priority = Priority::P3;
    config
}

/// Turns on the flash caches, which the HAL leaves off. Without them, code runs several times slower at five wait states.
fn enable_flash_caches() {
    pac::FLASH.acr().modify(|w| {
        w.set_icen(true);
        w.set_dcen(true);
        w.set_prften(true);
    });
}

/// Sets the supply detector to 2.9 V, its highest level (RM0090 5.4.1). `drivers/param_flash.rs` asks it before it writes.
fn watch_supply() {
    pac::PWR.cr1().modify(|w| {
        w.set_pls(7);
        w.set_pvde(true);
    });
}

/// Counts that the maker measured at 3.3 V: of the internal reference and of the temperature sensor.
fn factory_words() -> FactoryWords {
    const VREFIN_CAL: *const u16 = 0x1FFF_7A2A as *const u16;
    const TS_CAL: *const [u16; 2] = 0x1FFF_7A2C as *const [u16; 2];
    FactoryWords {
        // SAFETY: a half-word of the chip's own read-only memory (STM32F405/407 datasheet, internal reference voltage
        // calibration values), aligned and always there.
        reference: unsafe { VREFIN_CAL.read_volatile() },
        // SAFETY: two half-words beside it (temperature sensor calibration values).
        temperature: unsafe { TS_CAL.read_volatile() },
    }
}

/// PWM of the heater at 1 kHz, which its temperature cannot follow.
fn start_heater(
    timer: Peri<'static, peripherals::TIM10>,
    pin: Peri<'static, peripherals::PF6>,
) -> Heater {
    Heater::new(SimplePwm::new(
        timer,
        Some(PwmPin::new(pin, OutputType::PushPull)),
        None,
        None,
        None,
        Hertz(1_000),
        CountingMode::EdgeAlignedUp,
    ))
}

/// PWM of the buzzer at 4 kHz, its rated pitch.
fn start_buzzer(
    timer: Peri<'static, peripherals::TIM4>,
    pin: Peri<'static, peripherals::PD14>,
) -> Buzzer {
    Buzzer::new(SimplePwm::new(
        timer,
        None,
        None,
        Some(PwmPin::new(pin, OutputType::PushPull)),
        None,
        Hertz(4_000),
        CountingMode::EdgeAlignedUp,
    ))
}

/// Takes the heater's pin from its timer and drives it low. For the fault handlers.
pub fn force_heater_off() {
    if pac::RCC.ahb1enr().read().gpiofen() {
        pac::GPIOF.bsrr().write(|w| w.set_br(6, true));
        pac::GPIOF
            .moder()
            .modify(|w| w.set_moder(6, pac::gpio::vals::Moder::OUTPUT));
    }
}

struct CanPins {
    can1: Peri<'static, peripherals::CAN1>,
    can2: Peri<'static, peripherals::CAN2>,
    rx1: Peri<'static, peripherals::PD0>,
    tx1: Peri<'static, peripherals::PD1>,
    rx2: Peri<'static, peripherals::PB5>,
    tx2: Peri<'static, peripherals::PB6>,
}

fn start_can(pins: CanPins) -> (CanPort, CanPort) {
    rcc::enable_and_reset::<peripherals::CAN1>();
    rcc::enable_and_reset::<peripherals::CAN2>();
    for rx in [Flex::new(pins.rx1), Flex::new(pins.rx2)] {
        lend(rx, CAN_AF, AfType::input(Pull::Up));
    }
    for tx in [Flex::new(pins.tx1), Flex::new(pins.tx2)] {
        lend(
            tx,
            CAN_AF,
            AfType::output(OutputType::PushPull, Speed::VeryHigh),
        );
    }
    let ports = can::start(Can1::new(pins.can1), Can2::new(pins.can2));
    for irq in [
        interrupt::CAN1_RX0,
        interrupt::CAN1_RX1,
        interrupt::CAN2_RX0,
        interrupt::CAN2_RX1,
    ] {
        // SAFETY: no critical section or lock relies on this interrupt being masked, and `can::start` installed what
        // its handler needs.
        unsafe { irq.enable() };
    }
    ports
}

/// Connects a pin to a peripheral for good. Dropping the handle would disconnect it, so it is forgotten.
fn lend(mut pin: Flex<'static>, alternate_function: u8, kind: AfType) {
    pin.set_as_af_unchecked(alternate_function, kind);
    core::mem::forget(pin);
}
