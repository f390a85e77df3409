//! `MotorLayout` of a robot.

use robot_description::{Bus, JointMotor, Robot};

use crate::{
    Constants,
    literal::{f32, sign},
};

/// `pub const …: MotorLayout`.
pub fn constant(Constants { profile, layout }: &Constants, robot: &Robot) -> String {
    let joints: String = (0..4).map(|index| joint(robot, index)).collect();
    let wheels = wheels(robot);
    format!(
        "/// The motors of `{name}`.\n\
         pub const {layout}: MotorLayout = MotorLayout::new(&robots::{profile}, {wheels}, [{joints}]);\n",
        name = robot.name,
    )
}

fn wheels(robot: &Robot) -> String {
    let wheels = &robot.wheels;
    let [left, right] = wheels.escs;
    format!(
        "WheelGroup {{ bus: {bus}, escs: [esc({left}), esc({right})], max_current_ma: {max_ma} }}",
        bus = bus(wheels.bus),
        max_ma = f32(wheels.max_current_a * 1e3),
    )
}

/// One of left front, left rear, right front, right rear.
fn joint(robot: &Robot, index: usize) -> String {
    let joints = &robot.joints;
    let [min_rad, max_rad] = match index % 2 {
        0 => joints.range_rad.front,
        _ => joints.range_rad.rear,
    };
    let make = match joints.motor {
        JointMotor::Dm4310 => "dm4310",
        JointMotor::Rs00 => "rs00",
    };
    format!(
        "JointSlot {{ \
             bus: {bus}, \
             motor: {make}({id}, {reply}), \
             schedule: schedule({every}, {phase}), \
             max_torque_nm: {peak_nm}, \
             config: JointConfig {{ \
                 direction: {direction}, \
                 zero_rad: {zero_rad}, \
                 min_rad: {min_rad}, \
                 max_rad: {max_rad}, \
                 max_torque_nm: {torque_nm}, \
                 max_speed_rps: {speed_rps}, \
                 max_kp: {max_kp}, \
                 max_kd: {max_kd} \
             }} \
         }}, ",
        bus = bus(joints.bus),
        id = joints.ids[index],
        reply = joints.replies[index],
        every = joints.period_ticks,
        phase = joints.phases[index],
        peak_nm = f32(joints.peak_nm),
        direction = sign(joints.directions[index]),
        zero_rad = f32(joints.zeros_rad[index]),
        min_rad = f32(min_rad),
        max_rad = f32(max_rad),
        torque_nm = f32(joints.torque_limit_nm),
        speed_rps = f32(joints.speed_limit_rps),
        max_kp = f32(joints.max_kp),
        max_kd = f32(joints.max_kd),
    )
}

fn bus(bus: Bus) -> &'static str {
    match bus {
        Bus::Can1 => "BusId::Can1",
        Bus::Can2 => "BusId::Can2",
    }
}
