//! A viewer that plays the run in the page: side and top view on a canvas, without any other file.

use std::fmt::Write;

use robot_description::Robot;

use super::Frame;
use crate::{course::Profiles, skeleton::SIDES};

const FRAMES: usize = 1_200;

/// The viewer with its data: numbers only, so that nothing in it can be taken for HTML.
pub(super) fn html(frames: &[Frame], robot: &Robot, ground: &Profiles) -> String {
    let mut data = String::from("{\"frames\":[");
    let step = frames.len().div_ceil(FRAMES).max(1);
    for (number, frame) in frames.iter().step_by(step).enumerate() {
        if number > 0 {
            data.push(',');
        }
        write_frame(&mut data, frame);
    }
    let [lx, ly, lz] = robot.body.box_m;
    let [cx, cy, cz] = robot.body.box_centre_m;
    let _ = write!(
        data,
        "],\"box\":[{lx},{ly},{lz},{cx},{cy},{cz}],\"gap\":{},\"plane\":{},\"radius\":{},\"track\":{},\"width\":{},\"ground\":{:?}}}",
        robot.legs.hip_gap_m,
        robot.legs.plane_y_m,
        robot.wheels.radius_m,
        robot.wheels.track_m,
        robot.wheels.width_m,
        ground
    );
    format!(
        "<div class=\"viewer\" id=\"viewer\">\n<canvas width=\"1000\" height=\"440\"></canvas>\n\
         <div class=\"controls\"><button type=\"button\">play</button>\
         <input type=\"range\" min=\"0\" max=\"1000\" value=\"0\" step=\"1\" aria-label=\"time\">\
         <select aria-label=\"speed\"><option value=\"0.1\">× 0.1</option><option value=\"0.3\">× 0.3</option>\
         <option value=\"1\" selected>× 1</option><option value=\"3\">× 3</option></select>\
         <span class=\"soft\"></span></div>\n</div>\n\
         <style>.viewer canvas {{ width: 100%; border: 1px solid #e1e4e8; border-radius: 8px; }}\
         .viewer .controls {{ display: flex; gap: 10px; align-items: center; }}\
         .viewer input {{ flex: 1; }} .viewer button {{ width: 64px; }}</style>\n\
         <script>\nconst run = {data};\n{}</script>\n",
        include_str!("viewer.js")
    )
}

/// Time; place; attitude, scalar first; then of each leg front knee, rear knee and axle (x and z in body axes) and the wheel's
/// angle; speed.
fn write_frame(data: &mut String, frame: &Frame) {
    let skeleton = &frame.skeleton;
    let _ = write!(data, "[{:.3}", frame.t_s);
    for value in skeleton.place_m.iter().chain(&skeleton.q_wxyz) {
        let _ = write!(data, ",{value:.4}");
    }
    for side in 0..SIDES.len() {
        let leg = &skeleton.legs[side];
        for point in [leg.knees[0], leg.knees[1], leg.axle] {
            let _ = write!(data, ",{:.4},{:.4}", point[0], point[2]);
        }
        let _ = write!(data, ",{:.3}", skeleton.wheels_rad[side]);
    }
    let _ = write!(
        data,
        ",{:.3},{:.4}]",
        skeleton.forward_mps, skeleton.pitch_rad
    );
}
