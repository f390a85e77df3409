use super::*;

fn write(chip: &mut Ist8310, register: u8, value: u8, now: Ps) -> bool {
    let acknowledged = chip.address(0x0E, false, 400_000, now)
        && chip.write(register, now)
        && chip.write(value, now);
    chip.stop();
    acknowledged
}

fn read<const N: usize>(chip: &mut Ist8310, register: u8, now: Ps) -> [u8; N] {
    assert!(chip.address(0x0E, false, 400_000, now));
    assert!(chip.write(register, now));
    assert!(chip.address(0x0E, true, 400_000, now));
    let bytes = std::array::from_fn(|_| chip.read(now));
    chip.stop();
    bytes
}

#[test]
fn is_silent_until_it_has_started_and_to_any_other_address() {
    let mut chip = Ist8310::new(1, MotionSource::Physics);
    assert!(!chip.address(0x0E, false, 400_000, MS));
    assert!(!chip.address(0x0F, false, 400_000, 60 * MS));
    assert_eq!(read::<1>(&mut chip, 0x00, 60 * MS), [0x10]);
    assert!(!chip.address(0x0E, false, 400_001, 60 * MS));
    assert!(chip.misuse(0x0E, 400_001).is_some());
    assert_eq!(chip.misuse(0x0E, 400_000), None);
}

#[test]
fn single_shot_at_16_averages_is_the_mean_of_6_ms_in_left_handed_counts_of_0_3_ut() {
    let mut chip = Ist8310::new(1, MotionSource::Physics);
    let start = 60 * MS;
    assert!(write(&mut chip, 0x41, 0x24, start));
    assert!(write(&mut chip, 0x0A, 0x01, start));
    assert_eq!(chip.next_event(), start + 6 * MS);
    assert!(chip.is_converting(start + 250 * US) && chip.is_converting(start + 6 * MS));
    assert_eq!(read::<1>(&mut chip, 0x02, start + 5 * MS)[0] & 1, 0);
    for field_ut in [[20.0, 60.0, -90.0], [40.0, 60.0, -90.0]] {
        chip.sample_field(field_ut);
    }
    chip.convert();
    assert_eq!(read::<1>(&mut chip, 0x02, start + 6 * MS)[0] & 1, 1);
    let raw: [u8; 6] = read(&mut chip, 0x03, start + 6 * MS);
    let axis = |i: usize| f64::from(i16::from_le_bytes([raw[i], raw[i + 1]]));
    // 100, −200 and −300 counts, with noise of less than one count.
    for (got, expected) in [(axis(0), 100.0), (axis(2), -200.0), (axis(4), -300.0)] {
        assert!((got - expected).abs() <= 3.0, "{got} against {expected}");
    }
    assert_eq!(read::<1>(&mut chip, 0x02, start + 7 * MS)[0] & 1, 0);
}

#[test]
fn reset_pin_loses_the_settings() {
    let mut chip = Ist8310::new(1, MotionSource::Physics);
    assert!(write(&mut chip, 0x41, 0x24, 60 * MS));
    chip.set_reset_pin(false, 70 * MS);
    assert!(!chip.address(0x0E, false, 400_000, 71 * MS));
    chip.set_reset_pin(true, 80 * MS);
    assert_eq!(read::<1>(&mut chip, 0x41, 130 * MS), [0]);
}
