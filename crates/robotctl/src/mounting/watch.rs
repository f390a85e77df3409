//! Reads what the robot's sensors show, along their own axes.

use nalgebra::{Rotation3, Vector3};
use robot_app::domain::Orientation;

use super::FieldSample;
use crate::{
    settings,
    tuning::{LiveReading, TuningClient, TuningError, live_page},
};

/// Number of readings in a pose.
const READINGS: usize = 40;
/// A robot that is held in the hands trembles by less than this.
const STILL_MPS2: f64 = 1.0;

#[derive(Debug, thiserror::Error)]
pub enum WatchError {
    #[error(transparent)]
    Tuning(#[from] TuningError),
    #[error("this firmware shows no live values: it is too old")]
    TooOld,
    #[error("the robot knows no {0}: is the sensor up? `robotctl tune status` and the log say")]
    NotMeasured(&'static str),
    #[error("the robot moved ({0:.1} m/s²): hold it still and try again")]
    Moved(f64),
    #[error("the robot's attitude is not valid; keep it still until it is calibrated")]
    NoAttitude,
}

/// Reads a robot's sensors. Its settings say how they sit, and turn its values back to the sensors' own axes.
pub struct Watch<'c> {
    client: &'c mut TuningClient,
    board: Orientation,
    mag: Option<Orientation>,
}

impl<'c> Watch<'c> {
    pub fn new(client: &'c mut TuningClient) -> Result<Self, WatchError> {
        let setting = |client: &mut TuningClient, name| -> Result<_, WatchError> {
            let named = settings::find(name).map_err(|_| WatchError::TooOld)?;
            Ok(Orientation::from_number(client.read(named)? as u32))
        };
        let board = setting(client, "mounting.board")?.ok_or(WatchError::TooOld)?;
        let mag = setting(client, "mounting.mag")?;
        Ok(Self { client, board, mag })
    }

    /// Returns how the board sits, as the settings say.
    pub fn board(&self) -> Orientation {
        self.board
    }

    /// Returns how the magnetometer sits on the board, as the settings say.
    pub fn mag(&self) -> Option<Orientation> {
        self.mag
    }

    /// Returns the mean specific force on a robot at rest, along the IMU's axes, in m/s².
    pub fn still_force(&mut self) -> Result<Vector3<f64>, WatchError> {
        let mut forces = Vec::with_capacity(READINGS);
        for _ in 0..READINGS {
            let accel = self.page("accel")?;
            forces.push(vector(&accel, ["x-mps2", "y-mps2", "z-mps2"])?);
        }
        let mean = forces.iter().sum::<Vector3<f64>>() / READINGS as f64;
        let moved = forces.iter().map(|force| (force - mean).norm());
        let moved = moved.fold(0.0, f64::max);
        if moved > STILL_MPS2 {
            return Err(WatchError::Moved(moved));
        }
        Ok(turned_back(self.board, mean))
    }

    /// Reads one sample of a robot that is being turned.
    pub fn field(&mut self) -> Result<FieldSample, WatchError> {
        let attitude = vector(
            &self.page("attitude")?,
            ["roll-deg", "pitch-deg", "yaw-deg"],
        )?;
        let [roll, pitch, yaw] = attitude.map(f64::to_radians).into();
        let shown_ut = vector(&self.page("mag")?, ["x-ut", "y-ut", "z-ut"])?;
        let on_the_board_ut = turned_back(self.board, shown_ut);
        Ok(FieldSample {
            attitude: Rotation3::from_euler_angles(roll, pitch, yaw).into_inner(),
            field_ut: turned_back(self.mag.unwrap_or_default(), on_the_board_ut),
        })
    }

    /// Fails unless the robot's attitude is valid.
    pub fn check_attitude(&mut self) -> Result<(), WatchError> {
        if self.page("safety")?.has("flags", "estimate-invalid") {
            return Err(WatchError::NoAttitude);
        }
        Ok(())
    }

    fn page(&mut self, name: &'static str) -> Result<LiveReading, WatchError> {
        let reading = self.client.live(live_page(name), 0)?;
        reading.ok_or(WatchError::TooOld)
    }
}

fn vector(reading: &LiveReading, fields: [&'static str; 3]) -> Result<Vector3<f64>, WatchError> {
    let mut vector = Vector3::zeros();
    for (part, field) in vector.iter_mut().zip(fields) {
        let number = reading.number(field);
        *part = number.ok_or(WatchError::NotMeasured(reading.page.name))?;
    }
    Ok(vector)
}

fn turned_back(orientation: Orientation, robot: Vector3<f64>) -> Vector3<f64> {
    let sensor = orientation.rotate_back(robot.map(|part| part as f32).into());
    Vector3::from(sensor).map(f64::from)
}
