//! The robots of the folder `robots/`.

use std::sync::{Arc, LazyLock};

pub use robot_description::JointMotor;
use robot_description::Robot;

static FIVEBAR: LazyLock<Arc<Robot>> = LazyLock::new(|| {
    built_in(
        include_str!("../../../robots/fivebar.toml"),
        "robots/fivebar.toml",
    )
});
static FIVEBAR_RS00: LazyLock<Arc<Robot>> = LazyLock::new(|| {
    built_in(
        include_str!("../../../robots/fivebar-rs00.toml"),
        "robots/fivebar-rs00.toml",
    )
});

fn built_in(text: &str, file: &str) -> Arc<Robot> {
    Arc::new(Robot::parse(text, file).expect("the files in robots/ are checked by their own tests"))
}

/// The robot of this repository with these joint motors: `robots/fivebar.toml` or `robots/fivebar-rs00.toml`.
pub fn with_joints(motor: JointMotor) -> Arc<Robot> {
    Arc::clone(match motor {
        JointMotor::Dm4310 => &FIVEBAR,
        JointMotor::Rs00 => &FIVEBAR_RS00,
    })
}
