//! The budgets of time and buses (docs/figures.md#the-image) hold on the shipped image.

mod support;

use robot_sim::scenario::Scenario;

/// Six motors, magnetometer, radio, requests on both tuning channels, and a rogue node in bursts, or for a whole second.
#[test]
fn full_traffic_and_a_flooded_bus_leave_time_to_spare() {
    for name in ["full-traffic", "can1-flooded"] {
        let path = robot_test_support::repository().join(format!("scenarios/{name}.toml"));
        let scenario = Scenario::read(&path).expect("the scenario is there");
        let outcome = support::job(scenario)
            .run(&mut [])
            .expect("the run goes through");
        let budgets = outcome.summary.budgets;
        assert_eq!(budgets.len(), 7);
        let over: Vec<_> = budgets.iter().filter(|budget| !budget.ok).collect();
        assert!(over.is_empty(), "{name}: {over:?}");
    }
}
