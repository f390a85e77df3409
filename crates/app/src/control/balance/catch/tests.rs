use super::*;

const DT_S: f32 = 0.001;

fn falls(fast_mps: f32, lean_rad: f32) -> Fall {
    Fall::Falls {
        fast_mps,
        lean_rad,
        lean_rps: 0.0,
    }
}

fn after(fall: Fall, seconds: f32) -> Catch {
    let mut catch = Catch::default();
    for _ in 0..(seconds / DT_S) as usize {
        catch.step(fall, DT_S);
    }
    catch
}

#[test]
fn a_body_pitches_towards_where_it_falls_and_back_while_it_brakes() {
    for forward in [1.0, -1.0] {
        let falling = after(falls(forward * 1.8, forward * 0.3), 0.3);
        assert!(forward * falling.pitch.value > 0.2, "{falling:?}");
        assert_eq!(falling.height.value, 0.0);
        let braking = after(falls(forward * 1.8, forward * -0.5), 0.3);
        assert!(forward * braking.pitch.value < -0.05, "{braking:?}");
        assert!(braking.height.value < -0.03, "{braking:?}");
        let stop = Fall::Stops {
            lean_rad: forward * -0.5,
        };
        let stopping = after(stop, 0.3);
        assert!(forward * stopping.pitch.value < -0.04, "{stopping:?}");
        assert!(stopping.height.value < -0.01, "{stopping:?}");
    }
}

#[test]
fn a_lean_that_grows_counts_before_it_is_there() {
    for forward in [1.0, -1.0] {
        let fall = Fall::Falls {
            fast_mps: forward * 1.8,
            lean_rad: 0.0,
            lean_rps: forward * 4.0,
        };
        let falling = after(fall, 0.1);
        assert!(forward * falling.pitch.value > 0.05, "{falling:?}");
    }
}

#[test]
fn a_body_pitches_no_further_than_it_may() {
    let falling = after(falls(2.0, 0.9), 2.0);
    assert!((falling.pitch.value - MOST_PITCH_RAD).abs() < 1e-3);
}

#[test]
fn slow_hips_need_no_help() {
    let slow = after(falls(0.2, 0.3), 0.3);
    assert_eq!((slow.pitch.value, slow.height.value), (0.0, 0.0));
}

#[test]
fn body_and_legs_come_back_when_the_push_is_over() {
    let mut catch = after(falls(1.8, -0.5), 0.3);
    assert!(catch.helps);
    let mut lasts_s = 0.0;
    while catch.helps {
        catch.step(Fall::Over, DT_S);
        lasts_s += DT_S;
        assert!(lasts_s < 1.5);
    }
    assert!(lasts_s > 0.1, "{lasts_s}");
    assert_eq!(catch, Catch::default());
}
