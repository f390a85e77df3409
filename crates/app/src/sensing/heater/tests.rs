use super::*;

/// A copper island as a first-order lag. The BMI088 shows it in eighths of a kelvin, renewed every 1.28 s.
struct Island {
    celsius: f32,
    ambient_c: f32,
    full_heat_k: f32,
    shown_c: f32,
    now_us: u64,
}

impl Island {
    const TIME_CONSTANT_S: f32 = 15.0;

    fn at(celsius: f32, full_heat_k: f32) -> Self {
        Self {
            celsius,
            ambient_c: celsius,
            full_heat_k,
            shown_c: celsius,
            now_us: 0,
        }
    }

    /// Runs at 200 Hz and passes on temperature and duty after each sample.
    fn heat(&mut self, heater: &mut Heater, seconds: u64, mut each: impl FnMut(f32, f32)) {
        for _ in 0..seconds * 200 {
            self.now_us += 5_000;
            if self.now_us % 1_280_000 < 5_000 {
                self.shown_c = (self.celsius * 8.0).round() / 8.0;
            }
            heater.step(Some(self.shown_c), self.now_us);
            let duty = heater.status().duty;
            let goal_c = self.ambient_c + duty * self.full_heat_k;
            self.celsius += (goal_c - self.celsius) * 0.005 / Self::TIME_CONSTANT_S;
            each(self.celsius, duty);
        }
    }
}

fn heater() -> Heater {
    Heater::new(HeaterConfig::default())
}

/// From 22 °C to 40 °C with a heater that can add 33 K: it arrives within half a minute, overshoots by less than 2 K
/// and then stays within 0.5 K.
#[test]
fn a_cold_package_is_heated_and_held() {
    let mut heater = heater();
    let mut island = Island::at(22.0, 33.0);
    let mut hottest_c: f32 = 0.0;
    island.heat(&mut heater, 5, |_, duty| assert_eq!(duty, 1.0));
    assert_eq!(heater.status().state, HeaterState::Heating);
    island.heat(&mut heater, 25, |celsius, _| {
        hottest_c = hottest_c.max(celsius);
    });
    assert_eq!(heater.status().state, HeaterState::Holding);
    assert!((37.0..42.0).contains(&island.celsius), "{}", island.celsius);
    island.heat(&mut heater, 60, |celsius, _| {
        hottest_c = hottest_c.max(celsius);
    });
    island.heat(&mut heater, 60, |celsius, _| {
        assert!((celsius - 40.0).abs() < 0.5, "{celsius}");
    });
    assert!(hottest_c < 42.0, "{hottest_c}");
}

/// After ten minutes at full duty below the target, the heater becomes five times as strong. It overshoots by less than
/// 1 K. With a wound-up integral it would be 3 K.
#[test]
fn a_supply_too_weak_for_the_target_does_not_wind_up() {
    let mut heater = heater();
    let mut island = Island::at(20.0, 12.0);
    island.heat(&mut heater, 600, |_, _| ());
    assert!((island.celsius - 32.0).abs() < 0.2);
    assert!(heater.at_limit());
    island.full_heat_k = 60.0;
    let mut hottest_c: f32 = 0.0;
    island.heat(&mut heater, 120, |celsius, _| {
        hottest_c = hottest_c.max(celsius);
    });
    assert!(hottest_c < 41.0, "{hottest_c}");
}

#[test]
fn without_a_valid_temperature_it_is_off() {
    for unknown in [None, Some(f32::NAN), Some(-41.0), Some(86.0)] {
        let mut heater = heater();
        heater.step(Some(25.0), 5_000);
        assert_eq!(heater.status().duty, 1.0);
        heater.step(unknown, 10_000);
        assert_eq!(heater.status().duty, 0.0);
        assert_eq!(heater.status().state, HeaterState::CutOff);
        heater.step(Some(25.0), 15_000);
        assert_eq!(heater.status().duty, 1.0, "back with the temperature");
    }
}

#[test]
fn after_overheating_it_stays_off_until_the_target_is_reached() {
    let mut heater = heater();
    let mut state_at = |celsius| {
        heater.step(Some(celsius), 5_000);
        heater.status().state
    };
    assert_eq!(state_at(50.0), HeaterState::Holding);
    assert_eq!(state_at(50.125), HeaterState::CutOff);
    assert_eq!(state_at(40.125), HeaterState::CutOff);
    assert_eq!(state_at(40.0), HeaterState::Holding);

    let mut hot = Heater::new(HeaterConfig {
        target_c: 60.0,
        ..HeaterConfig::default()
    });
    hot.step(Some(65.125), 5_000);
    assert_eq!(hot.status().state, HeaterState::CutOff);
}

#[test]
fn settings_can_switch_it_off_but_not_break_it() {
    let at = |celsius, change: fn(&mut HeaterConfig)| {
        let mut config = HeaterConfig::default();
        change(&mut config);
        let mut heater = Heater::new(config);
        heater.step(Some(celsius), 5_000);
        heater.step(Some(celsius), 10_000);
        *heater.status()
    };
    assert_eq!(at(30.0, |c| c.target_c = 19.9).state, HeaterState::Off);
    assert_eq!(at(30.0, |c| c.target_c = f32::NAN).state, HeaterState::Off);
    assert_eq!(at(30.0, |c| c.max_duty = 0.3).duty, 0.3);
    assert_eq!(at(30.0, |c| c.max_duty = 7.0).duty, 1.0);
    assert!(at(39.0, |_| ()).duty > 0.0);
    let broken: [fn(&mut HeaterConfig); 4] = [
        |c| c.kp = f32::NAN,
        |c| c.ki = f32::NAN,
        |c| c.max_duty = f32::NAN,
        |c| c.max_duty = -1.0,
    ];
    for change in broken {
        let mut config = HeaterConfig::default();
        change(&mut config);
        let mut heater = Heater::new(config);
        for step in 1..=10 {
            heater.step(Some(39.0), step * 5_000);
            assert_eq!(heater.status().duty, 0.0);
        }
    }
}
