//! IST8310 transfers on I2C3, by the tables of `robot_app::sensing::ist8310`.

use embassy_stm32::gpio::Output;
use embassy_stm32::i2c::{Error, I2c, Master};
use embassy_stm32::mode::Async;
use embassy_stm32::pac;
use embassy_time::{Duration, Timer, with_timeout};
use robot_app::sensing::ist8310::{
    ADDRESS, INIT, InitCheck, InitStep, MEASUREMENT_US, READ_FROM, READ_LEN, START_SINGLE_SHOT,
};

use crate::deadlines::{Watched, sleep_checking_in};

/// The longest transfer takes 0.25 ms on the wire.
const TRANSFER_TIMEOUT: Duration = Duration::from_millis(2);
/// A STOP takes one bit of 2.5 µs, after the byte under way of 23 µs.
const STOP_TIME: Duration = Duration::from_micros(50);

/// Why the sensor could not be brought up or read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum Ist8310Error {
    /// The bus hangs: a line is held low or a transfer stopped half way.
    Timeout,
    Bus(Error),
    /// A register of the bring-up does not hold what it should.
    Check(InitCheck),
}

/// The magnetometer, its bus and its reset pin.
pub struct Ist8310<'d> {
    i2c: I2c<'d, Async, Master>,
    registers: pac::i2c::I2c,
    reset: Output<'d>,
}

impl<'d> Ist8310<'d> {
    /// `registers` are those of `i2c`.
    pub fn new(i2c: I2c<'d, Async, Master>, registers: pac::i2c::I2c, reset: Output<'d>) -> Self {
        Self {
            i2c,
            registers,
            reset,
        }
    }

    /// Runs the bring-up sequence, which takes about 100 ms. It starts with a reset by pin, which also frees a bus that the
    /// sensor holds.
    pub async fn bring_up(&mut self) -> Result<(), Ist8310Error> {
        for &step in INIT {
            match step {
                InitStep::ResetPin { high } => self.reset.set_level(high.into()),
                InitStep::Write { register, value } => self.write([register, value]).await?,
                InitStep::Check {
                    register,
                    expected,
                    failure,
                } => {
                    if self.read::<1>(register).await? != [expected] {
                        return Err(Ist8310Error::Check(failure));
                    }
                }
                InitStep::Wait { us } => {
                    sleep_checking_in(Watched::Mag, Duration::from_micros(u64::from(us))).await;
                }
            }
        }
        Ok(())
    }

    /// Starts one measurement, waits for it and reads the answer.
    pub async fn measure(&mut self) -> Result<[u8; READ_LEN], Ist8310Error> {
        self.write(START_SINGLE_SHOT).await?;
        sleep_checking_in(
            Watched::Mag,
            Duration::from_micros(u64::from(MEASUREMENT_US)),
        )
        .await;
        self.read(READ_FROM).await
    }

    async fn write(&mut self, bytes: [u8; 2]) -> Result<(), Ist8310Error> {
        self.last_transfer_out().await?;
        within_time(self.i2c.write(ADDRESS, &bytes)).await
    }

    async fn read<const N: usize>(&mut self, register: u8) -> Result<[u8; N], Ist8310Error> {
        self.last_transfer_out().await?;
        let mut answer = [0; N];
        // A variable, not a constant: DMA1 must not fetch the register number from flash.
        let register = [register];
        within_time(self.i2c.write_read(ADDRESS, &register, &mut answer)).await?;
        Ok(answer)
    }

    /// Waits until the STOP of the last transfer has been sent. The HAL returns when it has requested the STOP, and a START
    /// that is requested before the STOP is out hangs the bus (RM0090 27.6.1 forbids it; stm32f4xx-hal, pull request 737,
    /// shows it).
    async fn last_transfer_out(&self) -> Result<(), Ist8310Error> {
        let pending = || {
            let cr1 = self.registers.cr1().read();
            cr1.start() || cr1.stop()
        };
        if pending() {
            Timer::after(STOP_TIME).await;
        }
        if pending() {
            return Err(Ist8310Error::Timeout);
        }
        Ok(())
    }
}

async fn within_time(
    transfer: impl Future<Output = Result<(), Error>>,
) -> Result<(), Ist8310Error> {
    match with_timeout(TRANSFER_TIMEOUT, transfer).await {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(Ist8310Error::Bus(error)),
        Err(_) => Err(Ist8310Error::Timeout),
    }
}
