//! A step allocates nothing, whatever the policy.

use std::path::Path;

use allocation_counter::measure;
use robot_policy::{
    action::Decoder,
    config,
    observation::{Commands, Observer, Reading},
};

#[test]
fn observing_and_decoding_allocate_nothing() {
    let policies = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vectors/policies");
    for (robot, name) in [
        ("fivebar", "flat"),
        ("fivebar", "flat-by-term"),
        ("legs-and-wheels", "oldest-first"),
    ] {
        let policy = config::read(&policies, robot, name).expect("a policy");
        let mut observer = Observer::new(&policy);
        let mut decoder = Decoder::new(&policy);
        let reading = Reading::at_default_pose(&policy);
        let output = vec![0.5; policy.joints.len()];
        for start in 0..2 {
            let allocated = measure(|| {
                observer.reset();
                decoder.reset();
                for _ in 0..5 {
                    let actions = decoder.last_actions();
                    let input = observer.observe(&reading, &Commands::default(), actions);
                    input.expect("an input");
                    decoder.decode(&output).expect("targets");
                }
            });
            assert_eq!(allocated.count_total, 0, "{robot}/{name}, start {start}");
        }
    }
}
