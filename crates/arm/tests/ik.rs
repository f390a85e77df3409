//! Inverse kinematics, judged by poses alone.

#[path = "kinematics/arms.rs"]
#[allow(dead_code, reason = "tests of the kinematics need more of them")]
mod arms;
#[path = "ik/follow.rs"]
mod follow;
#[path = "ik/judge.rs"]
mod judge;
#[path = "ik/reasons.rs"]
mod reasons;
#[path = "ik/solve.rs"]
mod solve;
