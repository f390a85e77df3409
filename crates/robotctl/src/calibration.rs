//! Finds sensor corrections from recorded samples. The firmware applies them (`robot_app::sensing`).

pub mod accel;
mod least_squares;
pub mod mag;
mod parameters;

#[cfg(test)]
mod tests {
    use super::{accel::AccelCorrection, mag::MagCorrection};
    use crate::{parameter_file::ParameterFile, settings};

    #[test]
    fn every_name_a_calibration_writes_is_one_the_robot_knows() {
        let mut file = ParameterFile::default();
        AccelCorrection::NONE.write(&mut file);
        MagCorrection::none().write(&mut file);
        assert_eq!(file.iter().len(), 15);
        for (name, _) in file.iter() {
            settings::find(name).unwrap();
        }
    }
}
