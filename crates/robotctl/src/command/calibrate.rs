//! `robotctl calibrate`: computes a parameter file and a page with plots from recordings.

use std::path::PathBuf;

use anyhow::{Context, Result};
use robotctl::{
    calibration::{
        accel::{self, AccelCorrection, AccelFit, Face},
        mag::{self, MagCorrection, MagFit},
    },
    parameter_file::ParameterFile,
    recording::{self, Sample},
    report,
};

use super::output::say;

#[derive(clap::Subcommand)]
pub enum Sensor {
    /// Use recordings of the robot held still on each of its six sides (columns `t,ax,ay,az` in s and m/s²)
    Accel(Files),
    /// Use recordings of the robot turned through all attitudes (columns `t,mx,my,mz` in s and µT)
    Mag {
        #[command(flatten)]
        files: Files,
        /// Strength of the local earth's field in µT; without this option the measured strength stays
        #[arg(long)]
        field_ut: Option<f64>,
    },
}

#[derive(clap::Args)]
pub struct Files {
    /// Tables (CSV) or recordings (`run.mcap`) of one robot
    #[arg(required = true)]
    recordings: Vec<PathBuf>,
    /// Parameters that corrected the recorded samples; without this option, none did
    #[arg(long)]
    active: Option<PathBuf>,
    /// Parameter file to write; other values in it stay
    #[arg(long, default_value = "calibration.toml")]
    out: PathBuf,
    /// Page with plots [default: beside the parameter file]
    #[arg(long)]
    report: Option<PathBuf>,
}

impl Sensor {
    pub fn run(self) -> Result<()> {
        match self {
            Self::Accel(files) => accel(&files),
            Self::Mag { files, field_ut } => mag(&files, field_ut),
        }
    }
}

impl Files {
    fn load(&self, sensor: recording::Sensor) -> Result<Vec<Vec<Sample>>> {
        let loaded = self.recordings.iter().map(|path| {
            let note = |text: &str| eprintln!("note: {}: {text}", path.display());
            recording::load_noting(path, sensor, note)
        });
        Ok(loaded.collect::<Result<_, _>>()?)
    }

    fn active_parameters(&self) -> Result<ParameterFile> {
        match &self.active {
            Some(path) => Ok(ParameterFile::load(path)?),
            None => Ok(ParameterFile::default()),
        }
    }

    fn write(&self, name: &str, page: &str, values: impl FnOnce(&mut ParameterFile)) -> Result<()> {
        let mut file = ParameterFile::load_or_new(&self.out)?;
        values(&mut file);
        file.save(&self.out)?;
        let beside = || self.out.with_file_name(format!("calibration-{name}.html"));
        let report = self.report.clone().unwrap_or_else(beside);
        std::fs::write(&report, page)
            .with_context(|| format!("cannot write {}", report.display()))?;
        say!(
            "\nvalues: {}\nplots:  {}",
            self.out.display(),
            report.display()
        )?;
        say!(
            "next:   robotctl tune --can DEVICE apply {}",
            self.out.display()
        )?;
        Ok(())
    }
}

fn accel(files: &Files) -> Result<()> {
    let active = AccelCorrection::read(&files.active_parameters()?);
    let mut recordings = files.load(recording::Sensor::Accelerometer)?;
    for sample in recordings.iter_mut().flatten() {
        sample.value = active.undo(sample.value);
    }
    let fit = accel::calibrate(&recordings)?;
    print_accel(&fit)?;
    let page = report::accel_report(&fit)?;
    files.write("accel", &page, |file| fit.correction.write(file))
}

fn print_accel(fit: &AccelFit) -> Result<()> {
    say!(
        "{:<20} {:>8} {:>10} {:>10}",
        "still position",
        "from s",
        "before",
        "after"
    )?;
    let windows = fit.windows.iter().map(|w| (w, ""));
    let rejected = fit.rejected.iter().map(|w| (w, "left out"));
    for (window, mark) in windows.chain(rejected) {
        let up = Face::up(window.mean_mps2).map_or("slanted", Face::describe);
        let error = |c: &AccelCorrection| c.apply(window.mean_mps2).norm() - accel::GRAVITY_MPS2;
        say!(
            "{up:<20} {:>8.1} {:>+10.4} {:>+10.4} {mark}",
            window.start_s,
            error(&AccelCorrection::NONE),
            error(&fit.correction)
        )?;
    }
    say!(
        "{:<29} {:>10.4} {:>10.4} m/s² rms\n",
        "error of gravity",
        fit.residual_before_mps2,
        fit.residual_after_mps2
    )?;
    say!("axis  offset m/s²    scale")?;
    for (index, axis) in ["x", "y", "z"].iter().enumerate() {
        let (bias, scale) = (fit.correction.bias_mps2[index], fit.correction.scale[index]);
        say!("{axis:<4} {bias:>+12.4} {scale:>8.5}")?;
    }
    if !fit.is_checked() {
        say!(
            "\nSix positions for six unknowns: the error after is zero whatever was measured. Add a few slanted positions \
             to check it."
        )?;
    }
    Ok(())
}

fn mag(files: &Files, field_ut: Option<f64>) -> Result<()> {
    let active = MagCorrection::read(&files.active_parameters()?);
    let mut recordings = files.load(recording::Sensor::Magnetometer)?;
    for sample in recordings.iter_mut().flatten() {
        sample.value = active
            .undo(sample.value)
            .context("the active soft-iron matrix has no inverse")?;
    }
    let fit = mag::calibrate(&recordings, field_ut)?;
    print_mag(&fit)?;
    let page = report::mag_report(&fit)?;
    files.write("mag", &page, |file| fit.correction.write(file))
}

fn print_mag(fit: &MagFit) -> Result<()> {
    say!(
        "samples     {:>8}   {} left out",
        fit.samples.len(),
        fit.rejected
    )?;
    say!("directions  {:>6.0} %", fit.coverage.share * 100.0)?;
    say!("strength    {:>8.2} µT", fit.field_ut)?;
    say!(
        "it varies   {:>8.2} µT before, {:.2} µT after (rms)\n",
        fit.residual_before_ut,
        fit.residual_after_ut
    )?;
    say!("axis  offset µT   soft iron")?;
    for (row, axis) in ["x", "y", "z"].iter().enumerate() {
        let matrix = fit.correction.soft_iron.row(row);
        let parts: Vec<String> = matrix.iter().map(|v| format!("{v:>+8.4}")).collect();
        say!(
            "{axis:<4} {:>+10.2}  {}",
            fit.correction.bias_ut[row],
            parts.join(" ")
        )?;
    }
    Ok(())
}
