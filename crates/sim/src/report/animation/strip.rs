//! A strip of pictures: the robot from its right side at chosen instants.

use std::fmt::Write;

use robot_description::Robot;

use super::Frame;
use crate::{
    course::{Profiles, height_m},
    skeleton::{Skeleton, Vector},
};

/// Pictures in a row, and rows.
const COLUMNS: usize = 6;
const ROWS: usize = 2;
/// Size of a picture in pixels, and pixels per metre.
const WIDTH: f64 = 166.0;
const HEIGHT: f64 = 150.0;
const SCALE: f64 = 230.0;
/// Height of the ground at the robot in the picture.
const GROUND: f64 = 118.0;

const LEFT: &str = "#0969da";
const RIGHT: &str = "#bc4c00";

pub(super) fn svg(frames: &[Frame], robot: &Robot, ground: &Profiles) -> String {
    let (width, height) = (WIDTH * COLUMNS as f64, HEIGHT * ROWS as f64);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"none\" stroke-linecap=\"round\">\n"
    );
    for (number, frame) in chosen(frames, COLUMNS * ROWS).into_iter().enumerate() {
        let (column, row) = (number % COLUMNS, number / COLUMNS);
        let _ = writeln!(
            svg,
            "<svg x=\"{}\" y=\"{}\" width=\"{WIDTH}\" height=\"{HEIGHT}\">",
            WIDTH * column as f64,
            HEIGHT * row as f64
        );
        picture(&mut svg, frame, robot, ground);
        svg += "</svg>\n";
    }
    svg + "</svg>\n"
}

/// Frames between which the robot moves about as much, the first and the last among them.
fn chosen(frames: &[Frame], count: usize) -> Vec<&Frame> {
    let mut moved = vec![0.0];
    for pair in frames.windows(2) {
        let before = moved.last().copied().unwrap_or_default();
        moved.push(before + change(&pair[0], &pair[1]));
    }
    let whole = moved.last().copied().unwrap_or_default();
    (0..count)
        .filter_map(|number| {
            let goal = whole * number as f64 / (count - 1) as f64;
            let place = moved.partition_point(|way| *way < goal);
            frames.get(place.min(frames.len() - 1))
        })
        .collect()
}

/// How much the robot moves between two frames: 5 cm of height or leg, 0.2 rad of a tilt, half a metre of way or 2 s count 1.
fn change(a: &Frame, b: &Frame) -> f64 {
    let (p, q) = (&a.skeleton, &b.skeleton);
    let off = |axis: usize| (p.place_m[axis] - q.place_m[axis]).abs();
    let leg = |side: usize| (p.legs[side].axle[2] - q.legs[side].axle[2]).abs();
    let tilt: f64 = p.q_wxyz.iter().zip(q.q_wxyz).map(|(a, b)| a * b).sum();
    let tilt_rad = 2.0 * tilt.abs().min(1.0).acos();
    off(2) / 0.05
        + (leg(0) + leg(1)) / 0.1
        + tilt_rad / 0.2
        + off(0).hypot(off(1)) / 0.5
        + (b.t_s - a.t_s) / 2.0
}

/// The projection onto the plane of heading and vertical, ahead to the right, around the robot.
struct View<'a> {
    skeleton: &'a Skeleton,
    heading: [f64; 2],
    ground_m: f64,
}

impl View<'_> {
    fn at(&self, body: Vector) -> [f64; 2] {
        let [x, y, z] = self.skeleton.in_world(body);
        let [px, py, _] = self.skeleton.place_m;
        let ahead = (x - px) * self.heading[0] + (y - py) * self.heading[1];
        [
            WIDTH / 2.0 + SCALE * ahead,
            GROUND - SCALE * (z - self.ground_m),
        ]
    }

    fn line(&self, svg: &mut String, points: &[Vector], style: &str) {
        svg.push_str("<polyline points=\"");
        for point in points {
            let [u, v] = self.at(*point);
            let _ = write!(svg, "{u:.1},{v:.1} ");
        }
        let _ = writeln!(svg, "\" {style}/>");
    }
}

fn picture(svg: &mut String, frame: &Frame, robot: &Robot, ground: &Profiles) {
    let skeleton = &frame.skeleton;
    let yaw_rad = skeleton.yaw_rad();
    let [x, ..] = skeleton.place_m;
    let view = View {
        skeleton,
        heading: [yaw_rad.cos(), yaw_rad.sin()],
        ground_m: height_m(&ground[1], x).min(height_m(&ground[0], x)),
    };
    for (profile, colour) in ground.iter().zip(["#8c959f", "#57606a"]) {
        svg.push_str("<polyline points=\"");
        for step in -36..=36 {
            let ahead = f64::from(step) * 0.01;
            let z = height_m(profile, x + ahead * view.heading[0]);
            let u = WIDTH / 2.0 + SCALE * ahead;
            let _ = write!(svg, "{u:.1},{:.1} ", GROUND - SCALE * (z - view.ground_m));
        }
        let _ = writeln!(svg, "\" stroke=\"{colour}\" stroke-width=\"1.5\"/>");
    }
    leg(svg, &view, 0, robot, LEFT);
    body(svg, &view, robot);
    leg(svg, &view, 1, robot, RIGHT);
    let _ = writeln!(
        svg,
        "<text x=\"6\" y=\"{:.0}\" fill=\"#57606a\">{:.2} s</text>",
        HEIGHT - 8.0,
        frame.t_s
    );
}

fn leg(svg: &mut String, view: &View, side: usize, robot: &Robot, colour: &str) {
    let leg = &view.skeleton.legs[side];
    for (hip, knee) in leg.hips.iter().zip(leg.knees) {
        let style = format!("stroke=\"{colour}\" stroke-width=\"3\"");
        view.line(svg, &[*hip, knee, leg.axle], &style);
    }
    let centre = view.skeleton.wheel(side, robot);
    let radius = robot.wheels.radius_m;
    let (sin, cos) = view.skeleton.wheels_rad[side].sin_cos();
    let rim: Vec<Vector> = (0..=24)
        .map(|step| {
            let (s, c) = (f64::from(step) * std::f64::consts::TAU / 24.0).sin_cos();
            [centre[0] + radius * c, centre[1], centre[2] + radius * s]
        })
        .collect();
    view.line(
        svg,
        &rim,
        &format!("stroke=\"{colour}\" stroke-width=\"2\" fill=\"{colour}\" fill-opacity=\"0.12\""),
    );
    let spoke = [
        centre[0] + radius * cos,
        centre[1],
        centre[2] - radius * sin,
    ];
    view.line(
        svg,
        &[centre, spoke],
        &format!("stroke=\"{colour}\" stroke-width=\"1\""),
    );
}

/// The side of the body's box, with a stroke at its front.
fn body(svg: &mut String, view: &View, robot: &Robot) {
    let ([lx, _, lz], [cx, cy, cz]) = (robot.body.box_m, robot.body.box_centre_m);
    let corner = |x: f64, z: f64| [cx + x * lx / 2.0, cy, cz + z * lz / 2.0];
    let outline = [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
        corner(-1.0, -1.0),
    ];
    view.line(
        svg,
        &outline,
        "stroke=\"#24292f\" stroke-width=\"1.5\" fill=\"#d0d7de\" fill-opacity=\"0.85\"",
    );
    view.line(
        svg,
        &[corner(1.0, -1.0), corner(1.0, 1.0)],
        "stroke=\"#1a7f37\" stroke-width=\"4\"",
    );
}
