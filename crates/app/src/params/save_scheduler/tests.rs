use super::*;

const START_US: u64 = 60_000_000;

/// A scheduler that gets changes as from the service, and the name of the group it would save.
struct Bench {
    save_scheduler: SaveScheduler,
    config: RobotConfig,
    revision: u32,
}

impl Bench {
    fn new() -> Self {
        let config = RobotConfig::default();
        Self {
            save_scheduler: SaveScheduler::new(config),
            config,
            revision: 0,
        }
    }

    fn change(&mut self, at_ms: u64, change: impl FnOnce(&mut RobotConfig)) {
        change(&mut self.config);
        self.revision = self.revision.wrapping_add(1);
        self.due(at_ms);
    }

    fn due(&mut self, at_ms: u64) -> Option<&'static str> {
        let now_us = START_US + at_ms * 1_000;
        self.save_scheduler
            .observe(&self.config, self.revision, 0, now_us);
        self.save_scheduler.due(now_us).map(|(_, group)| group.name)
    }

    fn position(&self, at_ms: u64) -> GroupIndex {
        self.save_scheduler.due(START_US + at_ms * 1_000).unwrap().0
    }

    fn save(&mut self, at_ms: u64) {
        self.save_scheduler
            .mark_saved(self.position(at_ms), &self.config);
    }

    fn fail(&mut self, at_ms: u64) {
        self.save_scheduler.mark_failed(self.position(at_ms));
    }
}

/// The pause of docs/parameters.md.
#[test]
fn a_save_waits_for_half_a_second_without_changes() {
    let mut bench = Bench::new();
    assert_eq!(bench.due(0), None);
    bench.change(0, |config| config.heater.target_c = 30.0);
    assert_eq!(bench.due(499), None);
    bench.change(499, |config| config.heater.target_c = 31.0);
    assert_eq!(bench.due(998), None);
    assert_eq!(bench.due(999), Some("heater"));
    bench.save(999);
    assert_eq!(bench.due(5_000), None);
    assert_eq!(bench.save_scheduler.unsaved(), 0);
}

#[test]
fn every_changed_group_is_saved_once() {
    for (position, group) in PARAMETERS.iter().enumerate() {
        let mut bench = Bench::new();
        bench.change(0, |config| {
            for parameter in group.parameters {
                parameter.write(config, parameter.min).unwrap();
            }
        });
        assert_eq!(bench.save_scheduler.unsaved(), 1 << position);
        assert_eq!(bench.due(500), Some(group.name));
        bench.save(500);
        assert_eq!(bench.due(1_000), None);
    }
}

#[test]
fn a_value_restored_before_the_save_is_not_saved() {
    let mut bench = Bench::new();
    bench.change(0, |config| config.heater.kp = 1.0);
    assert_ne!(bench.save_scheduler.unsaved(), 0);
    bench.change(100, |config| *config = RobotConfig::default());
    assert_eq!(bench.save_scheduler.unsaved(), 0);
    assert_eq!(bench.due(10_000), None);
}

/// The record may be in flash although reading it back failed.
#[test]
fn a_value_restored_after_a_failed_save_is_saved_again() {
    let mut bench = Bench::new();
    bench.change(0, |config| config.heater.kp = 1.0);
    bench.fail(500);
    bench.change(600, |config| *config = RobotConfig::default());
    assert_eq!(bench.due(1_100), Some("heater"));
    bench.save(1_100);
    bench.change(1_200, |config| config.safety.stick_centre = 0.1);
    assert_eq!(bench.due(1_700), Some("safety"));
    bench.save(1_700);
    assert_eq!(bench.due(1_701), None);
}

#[test]
fn a_change_after_a_save_is_saved_again() {
    let mut bench = Bench::new();
    bench.change(0, |config| config.heater.kp = 1.0);
    bench.save(500);
    bench.change(501, |config| config.heater.kp = 0.5);
    assert_eq!(bench.due(1_000), None);
    assert_eq!(bench.due(1_001), Some("heater"));
    bench.save(1_001);
    // The default is not what flash holds.
    bench.change(1_100, |config| *config = RobotConfig::default());
    assert_eq!(bench.due(1_600), Some("heater"));
}

/// The configuration changed after it was passed to the save, so the newer value must still be saved.
#[test]
fn a_change_during_a_save_is_saved_afterwards() {
    let mut bench = Bench::new();
    bench.change(0, |config| config.heater.kp = 1.0);
    let position = bench.position(500);
    let in_flash = bench.config;
    bench.change(501, |config| config.heater.kp = 2.0);
    bench.save_scheduler.mark_saved(position, &in_flash);
    bench.change(502, |config| config.safety.stick_centre = 0.1);
    assert_eq!(bench.due(1_002), Some("safety"));
    bench.save(1_002);
    assert_eq!(bench.due(1_003), Some("heater"));
}

#[test]
fn a_group_that_cannot_be_saved_does_not_block_the_others() {
    let mut bench = Bench::new();
    bench.change(0, |config| {
        config.wheel_odom.wheel_track_m = 0.3;
        config.safety.stick_centre = 0.1;
        config.heater.kp = 1.0;
    });
    let mut tried = Vec::new();
    for _ in 0..4 {
        tried.push(bench.due(500).unwrap());
        bench.fail(500);
    }
    assert_eq!(
        tried,
        ["wheel-geometry", "safety", "heater", "wheel-geometry"]
    );
    bench.save(500);
    assert_eq!(bench.due(501), Some("heater"));
}

#[test]
fn the_revision_may_wrap() {
    let mut bench = Bench::new();
    bench.revision = u32::MAX - 1;
    bench.change(0, |config| config.heater.kp = 1.0);
    bench.save(500);
    bench.change(1_000, |config| config.heater.kp = 2.0);
    assert_eq!(bench.revision, 0);
    assert_eq!(bench.due(1_500), Some("heater"));
}
