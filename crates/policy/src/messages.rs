//! What a run says of itself, cycle by cycle: topics of JSON messages, for a log or a viewer.

use robot_app::link::Uplink;
use serde_json::{Map, Value, json};

use crate::{
    PolicyDescription,
    action::Target,
    observation::{Commands, Layout},
    runner::Runner,
};

/// Topic of the network's input, term by term.
pub const OBSERVATION_TOPIC: &str = "/policy/observation";
/// Topic of the actions, clipped and not scaled.
pub const ACTION_TOPIC: &str = "/policy/actions";
/// Topic of what was sent, and what the joints did.
pub const JOINT_TOPIC: &str = "/policy/joints";
/// Topic of state, commands and lateness.
pub const RUN_TOPIC: &str = "/policy/run";

/// A topic.
#[derive(Clone, Debug, PartialEq)]
pub struct TopicPlan {
    /// Name.
    pub name: &'static str,
    /// Name of its schema.
    pub schema_name: &'static str,
    /// JSON Schema of its messages.
    pub schema: Value,
}

/// A cycle of a run.
#[derive(Clone, Copy)]
pub struct Entry<'a> {
    /// Time in s.
    pub time_s: f64,
    /// The run after the cycle.
    pub runner: &'a Runner,
    /// Where to go.
    pub commands: Commands,
    /// How late the cycle was, in s.
    pub late_s: f64,
    /// The robot's state.
    pub state: &'a Uplink,
}

/// Makes the messages of a policy's runs.
#[derive(Clone, Debug)]
pub struct Messages {
    names: Vec<String>,
    topics: [TopicPlan; 4],
}

impl Messages {
    /// Prepares the topics of a policy.
    pub fn new(policy: &PolicyDescription) -> Self {
        let layout = Layout::new(policy);
        let names: Vec<String> = policy.joints.iter().map(|it| it.name.clone()).collect();
        let terms = layout.blocks().iter();
        let terms = terms.map(|block| (field(&block.term, block.age), numbers(&block.values)));
        let terms = object(terms);
        let per_joint = |schema: Value| object(names.iter().map(|it| (it.clone(), schema.clone())));
        let joint = [
            "target_rad",
            "target_rps",
            "kp",
            "kd",
            "angle_rad",
            "speed_rps",
        ];
        let run = [
            "forward_mps",
            "left_mps",
            "yaw_rps",
            "late_ms",
            "robot_time_s",
            "battery_v",
        ];
        let run = run.map(|name| (name.to_owned(), number())).into_iter();
        let run = run.chain([("phase".to_owned(), json!({ "type": "string" }))]);
        let topic = |name, schema_name, schema| TopicPlan {
            name,
            schema_name,
            schema,
        };
        let topics = [
            topic(RUN_TOPIC, "jiling.policy.Run", object(run)),
            topic(
                JOINT_TOPIC,
                "jiling.policy.Joints",
                per_joint(numbers(&joint)),
            ),
            topic(OBSERVATION_TOPIC, "jiling.policy.Observation", terms),
            topic(ACTION_TOPIC, "jiling.policy.Actions", per_joint(number())),
        ];
        Self { names, topics }
    }

    /// Returns the topics.
    pub fn topics(&self) -> &[TopicPlan] {
        &self.topics
    }

    /// Returns the messages of a cycle, each with the place of its topic. Observation and actions are there only if the network
    /// ran.
    pub fn of(&self, entry: &Entry<'_>) -> Vec<(usize, Value)> {
        let runner = entry.runner;
        let mut messages = vec![(0, run(entry)), (1, self.joints(runner))];
        if runner.has_run() {
            messages.push((2, observation(runner.layout(), runner.input())));
            messages.push((3, self.actions(runner)));
        }
        messages
    }

    fn actions(&self, runner: &Runner) -> Value {
        let actions = self.names.iter().zip(runner.actions());
        let actions = actions.map(|(name, action)| (name.clone(), json!(action)));
        Value::Object(actions.collect())
    }

    fn joints(&self, runner: &Runner) -> Value {
        let reading = runner.reading();
        let measured = reading.joint_pos_rad.iter().zip(&reading.joint_vel_rps);
        let joints = self.names.iter().zip(measured).enumerate();
        let joints = joints.map(|(index, (name, (rad, rps)))| {
            let mut joint = json!({ "angle_rad": rad, "speed_rps": rps });
            match runner.sent().get(index) {
                Some(Target::Position { rad, kp, kd }) => {
                    joint["target_rad"] = json!(rad);
                    joint["kp"] = json!(kp);
                    joint["kd"] = json!(kd);
                }
                Some(Target::Speed { rps, kd }) => {
                    joint["target_rps"] = json!(rps);
                    joint["kd"] = json!(kd);
                }
                None => {}
            }
            (name.clone(), joint)
        });
        Value::Object(joints.collect())
    }
}

fn run(entry: &Entry<'_>) -> Value {
    json!({
        "phase": entry.runner.machine().phase().name(),
        "forward_mps": entry.commands.forward_mps,
        "left_mps": entry.commands.left_mps,
        "yaw_rps": entry.commands.yaw_rps,
        "late_ms": 1e3 * entry.late_s,
        "robot_time_s": entry.state.time_s,
        "battery_v": entry.state.battery_v,
    })
}

/// The values of an input by term and name.
fn observation(layout: &Layout, input: &[f32]) -> Value {
    let blocks = layout.blocks().iter().map(|block| {
        let values = block.values.iter().zip(input.iter().skip(block.offset));
        let values = values.map(|(name, value)| (name.clone(), json!(value)));
        (
            field(&block.term, block.age),
            Value::Object(values.collect()),
        )
    });
    Value::Object(blocks.collect())
}

/// A term of an older frame has its age behind its name, as in `dof_pos@1`.
fn field(term: &str, age: usize) -> String {
    match age {
        0 => term.to_owned(),
        _ => format!("{term}@{age}"),
    }
}

fn number() -> Value {
    json!({ "type": "number" })
}

fn numbers(names: &[impl ToString]) -> Value {
    object(names.iter().map(|name| (name.to_string(), number())))
}

fn object(fields: impl Iterator<Item = (String, Value)>) -> Value {
    json!({ "type": "object", "properties": fields.collect::<Map<_, _>>() })
}
