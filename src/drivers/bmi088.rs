//! BMI088 transfers on SPI1, by the tables of `robot_app::sensing::bmi088`.

use embassy_stm32::gpio::Output;
use embassy_stm32::mode::Async;
use embassy_stm32::spi::Spi;
use embassy_stm32::spi::mode::Master;
use embassy_time::{Duration, with_timeout};
use robot_app::sensing::bmi088::{
    ACCEL_READ, BUFFER_READ, BUFFER_RESET, GYRO_READ, GyroBuffer, INIT, InitCheck, InitStep,
    SpiTarget, gyro_buffer, read_command, write_command,
};

use crate::deadlines::{Watched, sleep_checking_in};

/// The longest transfer takes 75 µs on the wire.
const TRANSFER_TIMEOUT: Duration = Duration::from_millis(1);

/// A die needs 2 µs after a register write, in cycles at 168 MHz. A timer would take longer to set up.
const WRITE_PAUSE_CYCLES: u32 = 2 * 168;

/// Why the sensor could not be brought up or read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum Bmi088Error {
    /// The DMA transfer did not finish.
    Timeout,
    Spi,
    /// A register of the bring-up does not hold what it should.
    Check(InitCheck),
}

/// Both dies behind one SPI bus.
pub struct Bmi088<'d> {
    spi: Spi<'d, Async, Master>,
    accel_select: Output<'d>,
    gyro_select: Output<'d>,
}

/// One sample as it came off the wire.
pub struct Bmi088Answers {
    pub accel: [u8; ACCEL_READ.len()],
    pub gyro: [u8; GYRO_READ.len()],
    buffer: [u8; BUFFER_READ.len()],
    buffer_bytes: usize,
}

impl Bmi088Answers {
    /// The bytes of the gyro's buffer, without the echo of the address.
    pub fn gyro_frames(&self) -> &[u8] {
        self.buffer.get(1..self.buffer_bytes).unwrap_or_default()
    }
}

impl<'d> Bmi088<'d> {
    /// Both chip selects must be high.
    pub fn new(
        spi: Spi<'d, Async, Master>,
        accel_select: Output<'d>,
        gyro_select: Output<'d>,
    ) -> Self {
        Self {
            spi,
            accel_select,
            gyro_select,
        }
    }

    /// Runs the bring-up sequence, which takes about 130 ms.
    pub async fn bring_up(&mut self) -> Result<(), Bmi088Error> {
        for &step in INIT {
            match step {
                InitStep::DummyRead { target, register } => {
                    self.read_register(target, register).await?;
                }
                InitStep::Write {
                    target,
                    register,
                    value,
                } => {
                    let mut bytes = write_command(register, value);
                    self.exchange(target, &mut bytes).await?;
                }
                InitStep::Check {
                    target,
                    register,
                    expected,
                    failure,
                } => {
                    if self.read_register(target, register).await? != Some(expected) {
                        return Err(Bmi088Error::Check(failure));
                    }
                }
                InitStep::Wait { us } => {
                    sleep_checking_in(Watched::Imu, Duration::from_micros(u64::from(us))).await;
                }
            }
        }
        Ok(())
    }

    /// Reads one sample of both dies, and all samples of the gyro since the last call.
    pub async fn read_sample(&mut self) -> Result<Bmi088Answers, Bmi088Error> {
        let mut answers = Bmi088Answers {
            accel: ACCEL_READ,
            gyro: GYRO_READ,
            buffer: BUFFER_READ,
            buffer_bytes: 0,
        };
        self.exchange(SpiTarget::Gyro, &mut answers.gyro).await?;
        match gyro_buffer(&answers.gyro) {
            GyroBuffer::Frames { bytes } => {
                answers.buffer_bytes = bytes;
                if let Some(buffer) = answers.buffer.get_mut(..bytes) {
                    self.exchange(SpiTarget::Gyro, buffer).await?;
                }
            }
            GyroBuffer::Stale => self.reset_gyro_buffer().await?,
        }
        self.exchange(SpiTarget::Accel, &mut answers.accel).await?;
        Ok(answers)
    }

    /// Empties the buffer of the gyro, which goes on measuring.
    pub async fn reset_gyro_buffer(&mut self) -> Result<(), Bmi088Error> {
        for mut bytes in BUFFER_RESET {
            self.exchange(SpiTarget::Gyro, &mut bytes).await?;
            cortex_m::asm::delay(WRITE_PAUSE_CYCLES);
        }
        Ok(())
    }

    async fn read_register(
        &mut self,
        target: SpiTarget,
        register: u8,
    ) -> Result<Option<u8>, Bmi088Error> {
        let (mut bytes, len) = read_command(target, register);
        let Some(bytes) = bytes.get_mut(..len) else {
            return Ok(None);
        };
        self.exchange(target, bytes).await?;
        Ok(bytes.last().copied())
    }

    /// Sends `bytes` and replaces them by the answer. They must lie in SRAM: DMA cannot reach CCM.
    async fn exchange(&mut self, target: SpiTarget, bytes: &mut [u8]) -> Result<(), Bmi088Error> {
        let select = match target {
            SpiTarget::Accel => &mut self.accel_select,
            SpiTarget::Gyro => &mut self.gyro_select,
        };
        select.set_low();
        let result = with_timeout(TRANSFER_TIMEOUT, self.spi.transfer_in_place(bytes)).await;
        select.set_high();
        match result {
            Ok(Ok(())) => Ok(()),
            Ok(Err(_)) => Err(Bmi088Error::Spi),
            Err(_) => Err(Bmi088Error::Timeout),
        }
    }
}
