//! Recorded motion played through the sensor models into the shipped image, every trial from start to end, against the
//! same records fed to the estimator as they are.

mod support;

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
    thread,
};

use robot_plant::recording;
use robot_replay::{At, Figures, Mode, Trial};
use robot_sim::scenario::Scenario;
use robot_test_support::is_whole;

/// Each thread emulates one board; the trials take longest first, so that no thread ends much later than the other.
const THREADS: usize = 2;

/// The trials, where this computer has them.
fn recordings() -> Option<Vec<PathBuf>> {
    let data = std::env::var_os("ROBOT_DATA").map_or_else(
        || robot_test_support::repository().join("../shared/data/broad"),
        PathBuf::from,
    );
    let files = fs::read_dir(data.join("hz200")).ok()?;
    let paths = files.filter_map(|file| Some(file.ok()?.path()));
    let headers: Vec<_> = paths
        .filter(|p| p.extension().is_some_and(|e| e == "json"))
        .collect();
    (!headers.is_empty()).then_some(headers)
}

struct Compared {
    name: String,
    /// The estimator alone.
    host: Figures,
    image: Figures,
}

fn compare(header: &Path) -> Compared {
    let trial = Trial::read(header).expect("a trial");
    let run = robot_replay::run(&trial, Mode::NineAxis, [0.0; 3]);
    Compared {
        host: run.score(&trial, At::EveryTick).expect("a reference"),
        image: replay(header),
        name: trial.name,
    }
}

fn replay(trial: &Path) -> Figures {
    // The magnetometer sits as the IMU does.
    let text = "name = \"replay\"\nseconds = 1\nplant = \"stand\"\n\
                [[flash.record]]\ngroup = 8\nvalues = [0, 0]\n";
    let mut job = support::job(Scenario::parse(text, "replay").expect("it parses"));
    job.scenario.length = recording::run_length(trial).expect("a trial");
    job.imu_trial = Some(trial.to_owned());
    let outcome = job.run(&mut []).expect("the machine starts");
    assert!(outcome.summary.ok, "{:?}", outcome.summary.board_errors);
    assert_eq!(outcome.summary.control.missed, 0);
    let error = outcome.summary.attitude_error;
    let error = error.expect("something was scored");
    assert!(error.samples > 10_000, "{} ms scored", error.samples);
    Figures {
        total_deg: error.total_rmse_deg,
        heading_deg: error.heading_rmse_deg,
        inclination_deg: error.inclination_rmse_deg,
    }
}

/// Compares all trials on all cores. The results are in the order of the trials' names.
fn compare_all(mut trials: Vec<PathBuf>) -> Vec<Compared> {
    trials.sort_by_key(|trial| recording::run_length(trial).expect("a trial"));
    let waiting = Mutex::new(trials);
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).pop();
    let work = || {
        std::iter::from_fn(next)
            .map(|trial| compare(&trial))
            .collect()
    };
    let mut all: Vec<Compared> = thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS).map(|_| scope.spawn(work)).collect();
        let joined = threads.into_iter().map(|thread| thread.join());
        joined
            .flat_map(|compared: Result<Vec<_>, _>| compared.expect("no replay failed"))
            .collect()
    });
    all.sort_by(|a, b| a.name.cmp(&b.name));
    all
}

fn mean(all: &[Compared], figures: fn(&Compared) -> Figures) -> Figures {
    let all: Vec<_> = all.iter().map(figures).collect();
    Figures::mean(&all).expect("there are trials")
}

fn print(name: &str, host: Figures, image: Figures) {
    let parts = |f: Figures| [f.total_deg, f.heading_deg, f.inclination_deg];
    let [total, heading, inclination] = parts(host);
    print!("{name:50} {total:8.2} {heading:8.2} {inclination:8.2}");
    let [total, heading, inclination] = parts(image);
    println!("   {total:8.2} {heading:8.2} {inclination:8.2}");
}

/// Beyond what the estimator alone does. Samples are stamped to half a millisecond only (`docs/sensors.md`), and near
/// magnets the heading depends on which samples of the field are believed; neither adds up in the mean.
const WORSE_HEADING_DEG: f64 = 0.8;
const WORSE_INCLINATION_DEG: f64 = 0.15;
const WORSE_MEAN_DEG: f64 = 0.1;

/// The metric is that of `data/broad/score.py` at the estimate's times: the movement phase at 1 kHz, gaps of the
/// reference skipped, no alignment of any kind. The lead-in before a record is at rest and is not scored.
///
/// All trials take 9 minutes of processor time: half of that where two cores are free. The sample takes a third.
#[test]
fn the_attitude_follows_recorded_trials_as_on_the_host() {
    let Some(mut trials) = recordings() else {
        println!(
            "skipped: no recorded trials at ROBOT_DATA or ../shared/data/broad: `cargo xtask data` says how to get them"
        );
        return;
    };
    if !is_whole() {
        trials.sort();
        trials = trials.into_iter().step_by(3).collect();
    }
    let all = compare_all(trials);
    println!("RMSE in degrees, total, heading and inclination: the estimator alone; in the image");
    for Compared { name, host, image } in &all {
        print(name, *host, *image);
    }
    let (host, image) = (mean(&all, |c| c.host), mean(&all, |c| c.image));
    print("mean", host, image);
    for Compared { name, host, image } in &all {
        assert!(
            image.heading_deg <= host.heading_deg + WORSE_HEADING_DEG,
            "{name}: heading off by {:.2}°, on the host by {:.2}°",
            image.heading_deg,
            host.heading_deg
        );
        assert!(
            image.inclination_deg <= host.inclination_deg + WORSE_INCLINATION_DEG,
            "{name}: inclination off by {:.2}°, on the host by {:.2}°",
            image.inclination_deg,
            host.inclination_deg
        );
    }
    assert!(image.total_deg <= host.total_deg + WORSE_MEAN_DEG);
    assert!(image.heading_deg <= host.heading_deg + WORSE_MEAN_DEG);
    assert!(image.inclination_deg <= host.inclination_deg + WORSE_MEAN_DEG);
}
