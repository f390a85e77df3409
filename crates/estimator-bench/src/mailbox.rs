//! The words that host and board exchange, in one static.

use core::sync::atomic::AtomicU32;
#[cfg(feature = "board")]
use core::sync::atomic::Ordering::Relaxed;

/// Number of words of an [`Input`].
pub const INPUT_WORDS: usize = 15;
/// Number of words of the attitude: w, x, y, z.
pub const OUTPUT_WORDS: usize = 4;
/// End of the static's name in the program.
pub const SYMBOL: &str = "mailbox::MAILBOX";
/// Part of the name of the function whose instructions count.
pub const COUNTED: &str = "board::counted";

/// One tick of 1 ms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Input {
    pub now_us: u32,
    /// End of the interval over which the IMU's samples are means. A new value marks a new sample; 0 means none yet.
    pub imu_ts_us: u32,
    /// End of the magnetometer's interval in the same way; 0 means that there is no magnetometer.
    pub mag_ts_us: u32,
    pub gyro_rps: [f32; 3],
    pub accel_mps2: [f32; 3],
    pub mag_ut: [f32; 3],
    /// Rotor speeds of both wheels.
    pub wheel_rpm: [i16; 2],
    /// Time since the wheels last reported; `u32::MAX` means never.
    pub wheel_age_us: u32,
}

impl Input {
    pub const fn to_words(&self) -> [u32; INPUT_WORDS] {
        let [gx, gy, gz] = self.gyro_rps;
        let [ax, ay, az] = self.accel_mps2;
        let [mx, my, mz] = self.mag_ut;
        let [left, right] = self.wheel_rpm;
        [
            self.now_us,
            self.imu_ts_us,
            self.mag_ts_us,
            gx.to_bits(),
            gy.to_bits(),
            gz.to_bits(),
            ax.to_bits(),
            ay.to_bits(),
            az.to_bits(),
            mx.to_bits(),
            my.to_bits(),
            mz.to_bits(),
            left as u16 as u32,
            right as u16 as u32,
            self.wheel_age_us,
        ]
    }

    pub const fn from_words(words: [u32; INPUT_WORDS]) -> Self {
        let [
            now,
            imu,
            mag,
            gx,
            gy,
            gz,
            ax,
            ay,
            az,
            mx,
            my,
            mz,
            left,
            right,
            age,
        ] = words;
        const fn vector(x: u32, y: u32, z: u32) -> [f32; 3] {
            [f32::from_bits(x), f32::from_bits(y), f32::from_bits(z)]
        }
        Self {
            now_us: now,
            imu_ts_us: imu,
            mag_ts_us: mag,
            gyro_rps: vector(gx, gy, gz),
            accel_mps2: vector(ax, ay, az),
            mag_ut: vector(mx, my, mz),
            wheel_rpm: [left as u16 as i16, right as u16 as i16],
            wheel_age_us: age,
        }
    }
}

/// The host writes `input` and the board writes `output`. The words follow one another in memory.
#[repr(C)]
pub struct Mailbox {
    input: [AtomicU32; INPUT_WORDS],
    output: [AtomicU32; OUTPUT_WORDS],
}

/// The host finds it through the program's symbols.
#[cfg(feature = "board")]
pub static MAILBOX: Mailbox = Mailbox {
    input: [const { AtomicU32::new(0) }; INPUT_WORDS],
    output: [const { AtomicU32::new(0) }; OUTPUT_WORDS],
};

#[cfg(feature = "board")]
impl Mailbox {
    pub fn input(&self) -> Input {
        Input::from_words(self.input.each_ref().map(|word| word.load(Relaxed)))
    }

    pub fn answer(&self, q_wxyz: [f32; OUTPUT_WORDS]) {
        for (word, part) in self.output.iter().zip(q_wxyz) {
            word.store(part.to_bits(), Relaxed);
        }
    }
}
