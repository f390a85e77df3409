//! The free robot for Foxglove's 3-D panel: where its parts are (`/tf`), and what they look like (`/scene`).

use std::sync::Arc;

use robot_description::{Link, Robot};
use robot_plant::{
    time::{NS, Ps, SECOND},
    world::Terrain,
};
use serde_json::{Value, json};

use crate::{
    course,
    signals::{SignalTable, Values},
    skeleton::{SIDES, Skeleton, SkeletonSignals, Vector, about_y_rad},
};

/// Shapes are written this often, so that a viewer that begins anywhere finds them.
pub(super) const SHAPES_PERIOD: Ps = SECOND;

const SIDE_NAMES: [&str; 2] = ["left", "right"];
const END_NAMES: [&str; 2] = ["front", "rear"];
/// Thickness of the drawn links, m.
const LINK_M: f64 = 0.02;
/// How far the ground is drawn each way, m.
const GROUND_M: f64 = 20.0;

/// Turns the robot's signals into messages.
pub(super) struct Scene {
    signals: SkeletonSignals,
    robot: Arc<Robot>,
    terrain: Terrain,
}

impl Scene {
    /// `None` for a robot that is not free.
    pub(super) fn new(table: &SignalTable, robot: &Arc<Robot>, terrain: Terrain) -> Option<Self> {
        Some(Self {
            signals: SkeletonSignals::find(table)?,
            robot: Arc::clone(robot),
            terrain,
        })
    }

    /// `foxglove.FrameTransforms`: world → body, body → thighs, shanks and wheels. The x axis of a link's frame runs along it.
    pub(super) fn transforms(&self, at: Ps, values: &Values) -> Option<Value> {
        let skeleton = self.signals.read(values, &self.robot)?;
        let mut frames = vec![frame(
            at,
            "world",
            "body",
            skeleton.place_m,
            skeleton.q_wxyz,
        )];
        for side in 0..SIDES.len() {
            self.leg_frames(at, &skeleton, side, &mut frames);
        }
        Some(json!({ "transforms": frames }))
    }

    fn leg_frames(&self, at: Ps, skeleton: &Skeleton, side: usize, frames: &mut Vec<Value>) {
        let leg = &skeleton.legs[side];
        for end in 0..END_NAMES.len() {
            let (hip, knee) = (leg.hips[end], leg.knees[end]);
            for (link, from, to) in [("thigh", hip, knee), ("shank", knee, leg.axle)] {
                let name = link_name(side, end, link);
                let q_wxyz = about_y(about_y_rad(from, to));
                frames.push(frame(at, "body", &name, from, q_wxyz));
            }
        }
        let centre = skeleton.wheel(side, &self.robot);
        let q_wxyz = about_y(skeleton.wheels_rad[side]);
        let name = format!("{}_wheel", SIDE_NAMES[side]);
        frames.push(frame(at, "body", &name, centre, q_wxyz));
    }

    /// `foxglove.SceneUpdate`: boxes for body and links, cylinders for the wheels, lines for the ground under each wheel.
    pub(super) fn shapes(&self, at: Ps) -> Value {
        let robot = &self.robot;
        let body = cube(robot.body.box_centre_m, robot.body.box_m, GREY);
        let mut entities = vec![entity(at, "body", &[("cubes", body)])];
        for (side, colour) in [BLUE, ORANGE].into_iter().enumerate() {
            for end in 0..END_NAMES.len() {
                for (link, shape) in [("thigh", &robot.legs.thigh), ("shank", &robot.legs.shank)] {
                    let name = link_name(side, end, link);
                    entities.push(entity(at, &name, &[("cubes", bar(shape, colour))]));
                }
            }
            let name = format!("{}_wheel", SIDE_NAMES[side]);
            let tyre = ("cylinders", tyre(robot, colour));
            let spoke = cube(
                [robot.wheels.radius_m / 2.0, 0.0, 0.0],
                [robot.wheels.radius_m, robot.wheels.width_m * 1.1, 0.01],
                GREY,
            );
            entities.push(entity(at, &name, &[tyre, ("cubes", spoke)]));
        }
        entities.push(entity(at, "world", &[("lines", self.ground())]));
        json!({ "deletions": [], "entities": entities })
    }

    fn ground(&self) -> Vec<Value> {
        let profiles = course::profiles(&self.terrain);
        let lines = profiles.iter().zip(SIDES).map(|(profile, side)| {
            let ends = [-GROUND_M, GROUND_M].map(|x| [x, course::height_m(profile, x)]);
            let [first, last] = ends;
            let points = [first]
                .into_iter()
                .chain(profile.iter().copied())
                .chain([last]);
            let y = side * self.robot.wheels.track_m / 2.0;
            json!({
                "type": 0,
                "pose": pose([0.0; 3], [1.0, 0.0, 0.0, 0.0]),
                "thickness": 0.01,
                "scale_invariant": false,
                "points": points.map(|[x, z]| vector([x, y, z])).collect::<Vec<_>>(),
                "color": colour(GREY),
                "colors": [],
                "indices": [],
            })
        });
        lines.collect()
    }
}

type Rgb = [f64; 3];
const GREY: Rgb = [0.55, 0.58, 0.62];
const BLUE: Rgb = [0.04, 0.41, 0.85];
const ORANGE: Rgb = [0.74, 0.3, 0.0];

fn link_name(side: usize, end: usize, link: &str) -> String {
    format!("{}_{}_{link}", SIDE_NAMES[side], END_NAMES[end])
}

fn about_y(rad: f64) -> [f64; 4] {
    let (sin, cos) = (rad / 2.0).sin_cos();
    [cos, 0.0, sin, 0.0]
}

fn time(at: Ps) -> Value {
    json!({ "sec": at / SECOND, "nsec": at % SECOND / NS })
}

fn vector([x, y, z]: Vector) -> Value {
    json!({ "x": x, "y": y, "z": z })
}

fn quaternion([w, x, y, z]: [f64; 4]) -> Value {
    json!({ "x": x, "y": y, "z": z, "w": w })
}

fn pose(position: Vector, q_wxyz: [f64; 4]) -> Value {
    json!({ "position": vector(position), "orientation": quaternion(q_wxyz) })
}

fn colour([r, g, b]: Rgb) -> Value {
    json!({ "r": r, "g": g, "b": b, "a": 0.9 })
}

fn frame(at: Ps, parent: &str, child: &str, place: Vector, q_wxyz: [f64; 4]) -> Value {
    json!({
        "timestamp": time(at),
        "parent_frame_id": parent,
        "child_frame_id": child,
        "translation": vector(place),
        "rotation": quaternion(q_wxyz),
    })
}

/// A thing that stays in its frame until another of its name comes.
fn entity(at: Ps, frame: &str, shapes: &[(&str, Vec<Value>)]) -> Value {
    let mut entity = json!({
        "timestamp": time(at),
        "frame_id": frame,
        "id": frame,
        "lifetime": { "sec": 0, "nsec": 0 },
        "frame_locked": true,
        "metadata": [],
    });
    for kind in KINDS {
        let there = shapes.iter().find(|(name, _)| *name == kind);
        entity[kind] = Value::from(there.map_or_else(Vec::new, |(_, shapes)| shapes.clone()));
    }
    entity
}

/// Fields of `foxglove.SceneEntity` that hold shapes.
const KINDS: [&str; 8] = [
    "arrows",
    "cubes",
    "spheres",
    "cylinders",
    "lines",
    "triangles",
    "texts",
    "models",
];

fn cube(centre: Vector, size: Vector, rgb: Rgb) -> Vec<Value> {
    vec![json!({
        "pose": pose(centre, [1.0, 0.0, 0.0, 0.0]),
        "size": vector(size),
        "color": colour(rgb),
    })]
}

fn bar(link: &Link, rgb: Rgb) -> Vec<Value> {
    let centre = [link.length_m / 2.0, 0.0, 0.0];
    cube(centre, [link.length_m, LINK_M / 2.0, LINK_M], rgb)
}

/// A cylinder stands along z; a quarter turn about x lays it along y.
fn tyre(robot: &Robot, rgb: Rgb) -> Vec<Value> {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let across = 2.0 * robot.wheels.radius_m;
    vec![json!({
        "pose": pose([0.0; 3], [half, half, 0.0, 0.0]),
        "size": vector([across, across, robot.wheels.width_m]),
        "bottom_scale": 1.0,
        "top_scale": 1.0,
        "color": colour(rgb),
    })]
}

/// JSON Schema of `foxglove.FrameTransforms`.
pub(super) fn transforms_schema() -> Value {
    let transform = object(&[
        ("timestamp", time_schema("time")),
        ("parent_frame_id", json!({ "type": "string" })),
        ("child_frame_id", json!({ "type": "string" })),
        ("translation", numbers(&["x", "y", "z"])),
        ("rotation", numbers(&["x", "y", "z", "w"])),
    ]);
    object(&[("transforms", array(transform))])
}

/// JSON Schema of `foxglove.SceneUpdate`, with the shapes that are used here.
pub(super) fn shapes_schema() -> Value {
    let pose = object(&[
        ("position", numbers(&["x", "y", "z"])),
        ("orientation", numbers(&["x", "y", "z", "w"])),
    ]);
    let colour = numbers(&["r", "g", "b", "a"]);
    let cube = object(&[
        ("pose", pose.clone()),
        ("size", numbers(&["x", "y", "z"])),
        ("color", colour.clone()),
    ]);
    let cylinder = object(&[
        ("pose", pose.clone()),
        ("size", numbers(&["x", "y", "z"])),
        ("bottom_scale", json!({ "type": "number" })),
        ("top_scale", json!({ "type": "number" })),
        ("color", colour.clone()),
    ]);
    let line = object(&[
        ("type", json!({ "type": "integer" })),
        ("pose", pose),
        ("thickness", json!({ "type": "number" })),
        ("scale_invariant", json!({ "type": "boolean" })),
        ("points", array(numbers(&["x", "y", "z"]))),
        ("color", colour.clone()),
        ("colors", array(colour)),
        ("indices", array(json!({ "type": "integer" }))),
    ]);
    let mut fields = vec![
        ("timestamp", time_schema("time")),
        ("frame_id", json!({ "type": "string" })),
        ("id", json!({ "type": "string" })),
        ("lifetime", time_schema("duration")),
        ("frame_locked", json!({ "type": "boolean" })),
        ("metadata", array(object(&[]))),
    ];
    for kind in KINDS {
        let shape = match kind {
            "cubes" => cube.clone(),
            "cylinders" => cylinder.clone(),
            "lines" => line.clone(),
            _ => object(&[]),
        };
        fields.push((kind, array(shape)));
    }
    object(&[
        ("deletions", array(object(&[]))),
        ("entities", array(object(&fields))),
    ])
}

fn object(fields: &[(&str, Value)]) -> Value {
    let fields = fields
        .iter()
        .map(|(name, schema)| ((*name).to_owned(), schema.clone()));
    json!({ "type": "object", "properties": fields.collect::<serde_json::Map<_, _>>() })
}

fn array(items: Value) -> Value {
    json!({ "type": "array", "items": items })
}

fn numbers(names: &[&str]) -> Value {
    let fields: Vec<_> = names
        .iter()
        .map(|name| (*name, json!({ "type": "number" })))
        .collect();
    object(&fields)
}

fn time_schema(title: &str) -> Value {
    json!({
        "type": "object",
        "title": title,
        "properties": { "sec": { "type": "integer" }, "nsec": { "type": "integer" } },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::tests::at_rest;
    use robot_plant::world::Start;

    /// Every object of a message has the fields of its schema and no other.
    fn follows(message: &Value, schema: &Value) {
        match message {
            Value::Array(items) => items.iter().for_each(|it| follows(it, &schema["items"])),
            Value::Object(fields) => {
                let known = schema["properties"].as_object().expect("an object");
                assert!(fields.keys().eq(known.keys()), "{fields:?} {known:?}");
                for (name, value) in fields {
                    follows(value, &known[name]);
                }
            }
            _ => assert!(schema["type"].is_string(), "{message}"),
        }
    }

    #[test]
    fn messages_follow_their_schemas_and_every_shape_has_a_frame() {
        let (table, values, robot) = at_rest(Start::Sitting);
        let scene = Scene::new(&table, &robot, Terrain::Flat).expect("it is free");
        let transforms = scene.transforms(SECOND, &values).expect("values");
        let shapes = scene.shapes(SECOND);
        follows(&transforms, &transforms_schema());
        follows(&shapes, &shapes_schema());
        let names = |message: &Value, field: &str| -> Vec<String> {
            let items = message.as_array().into_iter().flatten();
            let names = items.filter_map(|it| it[field].as_str());
            names.map(str::to_owned).collect()
        };
        let mut frames = names(&transforms["transforms"], "child_frame_id");
        frames.push("world".to_owned());
        let drawn = names(&shapes["entities"], "frame_id");
        // Body, eight links, two wheels, the world.
        assert_eq!(drawn.len(), 12);
        assert!(drawn.iter().all(|it| frames.contains(it)), "{drawn:?}");
    }
}
