//! The reasons for which an IMU sample is rejected.

/// Why an IMU sample was rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ImuSampleError {
    /// All bits of the accelerometer's answer are alike.
    AccelAbsent,
    /// The gyro's answer lacks its chip id.
    GyroAbsent,
    /// The accelerometer's sensor time stands still, the gyro has measured nothing new, or all counts have stayed the same
    /// for longer than noise allows.
    Frozen,
    /// The rate has jumped further than the gyro's low-pass allows, or the sensor is on probation after such a jump.
    Implausible,
    /// An axis has been at the end of its range for longer than an impact or a spin can take.
    Saturated,
}
