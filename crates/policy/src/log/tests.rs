use std::collections::BTreeSet;

use mcap::MessageStream;
use serde_json::{Value, json};

use super::*;
use crate::{
    machine::Phase,
    messages::{ACTION_TOPIC, JOINT_TOPIC, OBSERVATION_TOPIC, RUN_TOPIC},
    observation::Commands,
    runner::testing,
};

#[test]
fn a_log_has_each_value_of_each_term_by_name() {
    let path = std::env::temp_dir().join(format!("policy-log-{}.mcap", std::process::id()));
    let mut bench = testing::Bench::new([0.25; 6]);
    let mut log = Log::create(&path, &testing::policy()).expect("a file");
    bench.until(Phase::Policy);
    for _ in 0..8 {
        bench.state.motors[2].vel_rps = 2.0;
        bench.cycle();
        let entry = Entry {
            time_s: bench.time_s,
            runner: &bench.runner,
            commands: Commands::default(),
            late_s: 0.0,
            state: &bench.state,
        };
        log.add(&entry).expect("it is written");
    }
    log.finish().expect("it is written");
    let bytes = std::fs::read(&path).expect("the file");
    std::fs::remove_file(&path).expect("the file");
    let messages = MessageStream::new(&bytes).expect("MCAP");
    let messages: Vec<_> = messages.map(|it| it.expect("a message")).collect();
    let of = |topic: &str| -> Vec<Value> {
        let found = messages.iter().filter(|it| it.channel.topic == topic);
        found
            .map(|it| serde_json::from_slice(&it.data).expect("JSON"))
            .collect()
    };
    let (observations, runs) = (of(OBSERVATION_TOPIC), of(RUN_TOPIC));
    assert_eq!(
        (observations.len(), of(ACTION_TOPIC).len(), runs.len()),
        (2, 2, 8)
    );
    let last = observations
        .last()
        .and_then(Value::as_object)
        .expect("terms");
    let terms: BTreeSet<&str> = last
        .keys()
        .map(String::as_str)
        .filter(|name| !name.contains('@'))
        .collect();
    let wanted = [
        "actions",
        "ang_vel",
        "commands",
        "dof_pos",
        "dof_vel",
        "gravity_vec",
        "wheel_joint_vel",
    ];
    assert_eq!(terms, BTreeSet::from(wanted));
    let values: usize = last
        .values()
        .map(|term| term.as_object().expect("values").len())
        .sum();
    assert_eq!(values, 69);
    assert_eq!(
        last["dof_vel"]["left_front_hip"],
        json!(0.1_f32),
        "2 rad/s times 0.05"
    );
    assert_eq!(runs[0]["phase"], "policy");
    assert_eq!(of(JOINT_TOPIC)[7]["left_front_hip"]["kp"], json!(20.0));
}
