use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;

/// What a signed register holds for each value, by counting: the positive values come first, then the negative ones with the
/// sign's bit. No formula of the code under test is used.
fn counted(sign_bit: u32) -> BTreeMap<i32, u16> {
    let half = u16::try_from(2u32.pow(sign_bit)).expect("16 bits");
    let positive = (0..half).map(|raw| (i32::from(raw), raw));
    let mut negative = half;
    let mut table: BTreeMap<i32, u16> = positive.collect();
    for value in 1..i32::from(half) {
        negative += 1;
        table.insert(-value, negative);
    }
    table
}

proptest! {
    #[test]
    fn signed_registers_hold_what_counting_says(pick in 0usize..4, value in -40_000i32..40_000) {
        let (register, bit) = [
            (HOMING_OFFSET, 11),
            (PRESENT_LOAD, 10),
            (GOAL_POSITION, 15),
            (PRESENT_SPEED, 15),
        ][pick];
        let mut bytes = vec![];
        let is_taken = register.encode(value, &mut bytes);
        let wanted = counted(bit).get(&value).copied();
        prop_assert_eq!(is_taken, wanted.is_some());
        if let Some(raw) = wanted {
            prop_assert_eq!(&bytes[..], &raw.to_le_bytes()[..]);
            prop_assert_eq!(register.decode(&bytes), Some(value));
        }
    }
}

#[test]
fn every_pair_of_bytes_is_read_as_counting_says() {
    let value_of: BTreeMap<u16, i32> = counted(11).into_iter().map(|(v, raw)| (raw, v)).collect();
    for raw in 0..=u16::MAX {
        // Above the sign there is nothing, and the negative zero is zero.
        let wanted = value_of.get(&(raw % 4096)).copied().unwrap_or(0);
        assert_eq!(
            HOMING_OFFSET.decode(&raw.to_le_bytes()),
            Some(wanted),
            "{raw:#x}"
        );
    }
}

#[test]
fn registers_neither_overlap_nor_share_a_name() {
    for pair in ALL.windows(2) {
        assert!(
            pair[0].end() <= pair[1].address,
            "{} and {}",
            pair[0],
            pair[1]
        );
    }
    for register in ALL {
        assert_eq!(find(register.name()), Some(register));
    }
    assert_eq!(find("no such register"), None);
}

#[test]
fn too_few_bytes_are_no_value() {
    assert_eq!(PRESENT_POSITION.decode(&[1]), None);
    assert_eq!(ID.decode(&[]), None);
}
