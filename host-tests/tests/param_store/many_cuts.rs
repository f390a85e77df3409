//! Repeated power cuts at random steps, in sessions that keep the store open over many saves.

use proptest::{prelude::*, test_runner::Config};
use robot_app::params::Store;
use robot_plant::flash_chip::Phase;

use crate::{
    bench::{Ledger, Tally, boot, new_chip, read, tidy},
    workload::nth_save,
};

/// Saves a session would make if the power stayed.
const SESSION: usize = 150;

fn phase() -> impl Strategy<Value = Phase> {
    prop_oneof![
        4 => Just(Phase::Middle),
        1 => Just(Phase::Before),
        1 => Just(Phase::After),
    ]
}

proptest! {
    #![proptest_config(Config::with_cases(100))]
    #[test]
    fn many_cuts_in_a_row_lose_nothing(
        seed in any::<u64>(),
        cuts in prop::collection::vec((prop_oneof![1..30u64, 1..1500u64], phase()), 1..25),
    ) {
        let mut chip = new_chip(seed);
        let mut ledger = Ledger::default();
        let mut tally = Tally::default();
        let mut count = 0;
        for (steps, phase) in cuts {
            let case = format!("{steps} {phase:?}");
            let found = read(&mut Store::open(&mut chip));
            tally.check(&ledger, &found, &case);
            chip.cut_at(chip.steps() + steps, phase);
            if let Ok((mut store, found)) = boot(&mut chip) {
                tally.check_report(&store, &case);
                tally.check(&ledger, &found, &case);
                ledger.settle(&found);
                for _ in 0..SESSION {
                    count += 1;
                    // A cut ends it where it ends.
                    if ledger.save(&mut store, &nth_save(count)).and_then(|()| tidy(&mut store)).is_err() {
                        break;
                    }
                }
            }
            chip.power_up();
        }
        let (_, found) = boot(&mut chip).expect("a good chip");
        tally.check(&ledger, &found, "at the end");
        prop_assert_eq!(tally.first, None);
    }
}
