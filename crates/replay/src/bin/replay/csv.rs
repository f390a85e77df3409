//! The 1 kHz attitude as text.

use std::{
    fs::File,
    io::{self, BufWriter, Write},
    path::Path,
};

use robot_replay::Run;

/// Writes the columns `t,qw,qx,qy,qz`: time in the recording in s, and unit quaternion from sensor to ENU earth.
pub fn write(run: &Run, path: &Path) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    rows(run, &mut file)?;
    file.flush()
}

fn rows(run: &Run, to: &mut impl Write) -> io::Result<()> {
    writeln!(to, "t,qw,qx,qy,qz")?;
    for tick in &run.ticks {
        let t_s = tick.t_us as f64 * 1e-6;
        let [w, x, y, z] = tick.q_wxyz;
        writeln!(to, "{t_s:.3},{w:.9e},{x:.9e},{y:.9e},{z:.9e}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use robot_replay::{Mode, Tick};

    use super::*;

    #[test]
    fn each_tick_is_a_row_in_full_single_precision() {
        let tick = Tick {
            t_us: 12_345_000,
            q_wxyz: [0.6, 0.0, -0.8, 1.234_567_891e-5],
            gyro_bias_rps: [0.0; 3],
            valid: true,
        };
        let run = Run {
            mode: Mode::NineAxis,
            ticks: vec![tick],
        };
        let mut text = Vec::new();
        rows(&run, &mut text).unwrap();
        let expected =
            "t,qw,qx,qy,qz\n12.345,6.000000000e-1,0.000000000e0,-8.000000000e-1,1.234567891e-5\n";
        assert_eq!(String::from_utf8(text).unwrap(), expected);
    }
}
