//! The sensor tasks without a chip. The wires of the simulated world lead to the app's own drivers' tables and
//! pipelines.

use robot_app::{
    domain::{HeaterConfig, ImuCalibration, ImuState, MagCalibration, MagState, MountingConfig},
    sensing::{
        ImuPipeline, ImuSampleError, MagPipeline, MagSampleError,
        bmi088::{self, ACCEL_READ, BUFFER_READ, GYRO_READ, GyroBuffer},
        ist8310,
    },
};
use robot_plant::{
    time::{Ps, US},
    world::{SpiSelect, World},
};

const SCK_HZ: u32 = 5_250_000;
const SPI_MODE: u8 = 3;
const SCL_HZ: u32 = 400_000;

/// The pipelines behind IMU and magnetometer.
#[derive(Clone)]
pub struct Sensors {
    imu: ImuPipeline,
    mag: MagPipeline,
    mag_started_at: Option<Ps>,
}

impl Default for Sensors {
    fn default() -> Self {
        Self::new()
    }
}

impl Sensors {
    /// Pipelines without calibration.
    pub fn new() -> Self {
        Self {
            imu: ImuPipeline::new(ImuCalibration::default(), HeaterConfig::default()),
            mag: MagPipeline::new(MagCalibration::default()),
            mag_started_at: None,
        }
    }

    /// Sets how the board and its magnetometer sit in the robot.
    pub fn set_mounting(&mut self, mounting: &MountingConfig) {
        self.imu.set_mounting(mounting.board);
        self.mag.set_mounting(mounting);
    }

    /// True once the offset of the gyro is known.
    pub fn imu_calibrated(&self) -> bool {
        self.imu.calibrated()
    }

    /// Brings up both from `start` on, and returns the time at which that is done.
    ///
    /// # Panics
    /// A register does not hold what the datasheet says.
    pub fn bring_up(&self, world: &mut World, start: Ps) -> Ps {
        let imu_up = bring_up_imu(world, start);
        bring_up_mag(world, imu_up)
    }

    /// Reads one IMU sample.
    ///
    /// # Errors
    /// The sample is not one of a working sensor.
    pub fn read_imu(&mut self, world: &mut World, now: Ps) -> Result<ImuState, ImuSampleError> {
        let (mut accel, mut gyro, mut buffer) = (ACCEL_READ, GYRO_READ, BUFFER_READ);
        spi(world, SpiSelect::Gyro, &mut gyro, now);
        let frames = match bmi088::gyro_buffer(&gyro) {
            GyroBuffer::Frames { bytes } => {
                spi(world, SpiSelect::Gyro, &mut buffer[..bytes], now);
                &buffer[1..bytes]
            }
            GyroBuffer::Stale => {
                reset_buffer(world, now);
                &[]
            }
        };
        spi(world, SpiSelect::Accel, &mut accel, now);
        let state = self.imu.process(&accel, &gyro, frames, now / US);
        if self.imu.take_buffer_reset() {
            reset_buffer(world, now);
        }
        state
    }

    /// Starts a measurement of the magnetometer.
    pub fn start_mag(&mut self, world: &mut World, now: Ps) {
        i2c_write(world, &ist8310::START_SINGLE_SHOT, now);
        self.mag_started_at = Some(now);
    }

    /// Takes the result of the running measurement, once it is complete.
    ///
    /// # Errors
    /// The answer holds no sample.
    pub fn fetch_mag(
        &mut self,
        world: &mut World,
        now: Ps,
    ) -> Result<Option<MagState>, MagSampleError> {
        let due = |started: &mut Ps| now - *started >= u64::from(ist8310::MEASUREMENT_US) * US;
        let Some(started) = self.mag_started_at.take_if(due) else {
            return Ok(None);
        };
        let mut answer = [0; ist8310::READ_LEN];
        if !i2c_read(world, ist8310::READ_FROM, &mut answer, now) {
            return Err(MagSampleError::NotReady);
        }
        self.mag.process(&answer, started / US).map(Some)
    }
}

fn spi(world: &mut World, device: SpiSelect, bytes: &mut [u8], now: Ps) {
    world.spi_select(device, true, now);
    for byte in bytes {
        *byte = world.spi_transfer(*byte, SCK_HZ, SPI_MODE, now);
    }
    world.spi_select(device, false, now);
}

fn after_us(world: &mut World, now: Ps, us: u32) -> Ps {
    let then = now + u64::from(us) * US;
    world.advance(then);
    then
}

fn reset_buffer(world: &mut World, now: Ps) {
    for mut bytes in bmi088::BUFFER_RESET {
        spi(world, SpiSelect::Gyro, &mut bytes, now);
    }
}

fn bring_up_imu(world: &mut World, start: Ps) -> Ps {
    let select = |target| match target {
        bmi088::SpiTarget::Accel => SpiSelect::Accel,
        bmi088::SpiTarget::Gyro => SpiSelect::Gyro,
    };
    let mut now = start;
    for step in bmi088::INIT {
        match *step {
            bmi088::InitStep::DummyRead { target, register } => {
                let (mut bytes, len) = bmi088::read_command(target, register);
                spi(world, select(target), &mut bytes[..len], now);
            }
            bmi088::InitStep::Write {
                target,
                register,
                value,
            } => {
                let mut bytes = bmi088::write_command(register, value);
                spi(world, select(target), &mut bytes, now);
            }
            bmi088::InitStep::Check {
                target,
                register,
                expected,
                failure,
            } => {
                let (mut bytes, len) = bmi088::read_command(target, register);
                spi(world, select(target), &mut bytes[..len], now);
                assert_eq!(bytes[len - 1], expected, "{failure:?}");
            }
            bmi088::InitStep::Wait { us } => now = after_us(world, now, us),
        }
    }
    now
}

/// False where the device does not acknowledge.
fn i2c_write(world: &mut World, bytes: &[u8], now: Ps) -> bool {
    let mut acknowledged = world.i2c_address(ist8310::ADDRESS, false, SCL_HZ, now);
    for byte in bytes {
        acknowledged = acknowledged && world.i2c_write(*byte, now);
    }
    world.i2c_stop(now);
    acknowledged
}

fn i2c_read(world: &mut World, register: u8, bytes: &mut [u8], now: Ps) -> bool {
    let acknowledged = i2c_write(world, &[register], now)
        && world.i2c_address(ist8310::ADDRESS, true, SCL_HZ, now);
    for byte in bytes {
        *byte = world.i2c_read(true, now);
    }
    world.i2c_stop(now);
    acknowledged
}

fn bring_up_mag(world: &mut World, start: Ps) -> Ps {
    let mut now = start;
    for step in ist8310::INIT {
        match *step {
            ist8310::InitStep::ResetPin { high } => world.set_mag_reset_pin(high, now),
            ist8310::InitStep::Write { register, value } => {
                assert!(i2c_write(world, &[register, value], now));
            }
            ist8310::InitStep::Check {
                register,
                expected,
                failure,
            } => {
                let mut value = [0];
                assert!(i2c_read(world, register, &mut value, now));
                assert_eq!(value[0], expected, "{failure:?}");
            }
            ist8310::InitStep::Wait { us } => now = after_us(world, now, us),
        }
    }
    now
}
