//! Forces of the ground on wheels, body and knees.

use super::{
    Vec2, Vec3,
    dynamics::Coordinates,
    five_bar::HIPS,
    grip::{Stick, Tread},
    ground::{Ground, Side},
    joint_forces::DryFriction,
    model::{BUMPERS, Model, SIDES},
    motion::Motion,
    parts::{Leg, lift},
    tyre::{Ring, TOUCHES, Touch},
};
use nalgebra::Matrix3;
use robot_description::LINK_RADIUS_M;

/// Assumed rolling resistance per newton of load, as a share of the radius.
const ROLLING_RESISTANCE: f64 = 0.015;

/// Depth from which the other side of the world is a wall.
const WALL_M: f64 = 0.01;

/// What remembers where the robot sticks, and the normal forces over the last step.
#[derive(Clone, Debug, Default)]
pub(super) struct Contacts {
    /// Side of the world on which each wheel is.
    sides: [Side; SIDES],
    treads: [[Option<(usize, Tread)>; TOUCHES]; SIDES],
    rolling: [DryFriction; SIDES],
    /// Against turning on the spot.
    twisting: [DryFriction; SIDES],
    bumpers: [Option<Stick>; BUMPERS],
    knees: [[Option<Stick>; HIPS]; SIDES],
    pub wheel_n: [f64; SIDES],
    pub body_n: f64,
}

/// What contacts need to know of the moment.
pub(super) struct Moment<'a> {
    pub model: &'a Model,
    pub ground: &'a Ground,
    pub motion: &'a Motion,
    pub legs: &'a [Leg; SIDES],
    /// Factor on the friction.
    pub grip: f64,
    pub dt_s: f64,
}

impl Moment<'_> {
    /// Whether body, hips and knees are above everything that they could hit.
    fn is_clear(&self) -> bool {
        self.motion.position.z - self.model.reach_m > self.ground.highest_m()
    }
}

/// A point of the robot in the world.
struct Point {
    place: Vec3,
    velocity: Vec3,
}

impl Contacts {
    pub fn act(&mut self, moment: &Moment, forces: &mut Coordinates) {
        let frame = Frame::of(moment.motion);
        for side in 0..SIDES {
            self.wheel_n[side] = self.wheel(side, moment, &frame, forces);
        }
        self.body_n = if moment.is_clear() {
            self.bumpers = Default::default();
            self.knees = Default::default();
            0.0
        } else {
            self.bumpers(moment, &frame, forces) + self.knees(moment, &frame, forces)
        };
    }

    fn wheel(
        &mut self,
        side: usize,
        moment: &Moment,
        frame: &Frame,
        forces: &mut Coordinates,
    ) -> f64 {
        let (model, wheel) = (moment.model, moment.legs[side].wheel());
        let leg_rps = moment.motion.rates().legs[side];
        let ring = Ring {
            centre: frame.place(wheel.place),
            axle: frame.rotation.column(1).into_owned(),
            radius_m: model.disc.radius_m,
            tyre_m: model.disc.tyre_m,
        };
        let touches = self.touches(side, &ring, moment.ground);
        let before = std::mem::take(&mut self.treads[side]);
        if touches[0].is_none() {
            self.rolling[side] = DryFriction::default();
            self.twisting[side] = DryFriction::default();
            return 0.0;
        }
        let turn = frame.rate + Vec3::new(0.0, wheel.turn_rps(leg_rps), 0.0);
        let (mut load_n, mut friction_n) = (0.0, Vec3::zeros());
        for (slot, touch) in touches.iter().enumerate() {
            let Some(touch) = touch else { continue };
            let at = frame.to_body(touch.point - moment.motion.position);
            let velocity = frame.to_world(
                frame.velocity
                    + frame.rate.cross(&at)
                    + wheel.velocity(leg_rps)
                    + Vec3::new(0.0, wheel.turn_rps(leg_rps), 0.0).cross(&(at - wheel.place)),
            );
            let normal_n = model
                .tyre
                .normal_n(touch.depth_m, velocity.dot(&touch.normal));
            let mut tread = inherited(&before, touch.feature, &touches);
            let [forward, left] = directions(&ring, touch);
            let slip_mps = Vec2::new(velocity.dot(&forward), velocity.dot(&left));
            let friction = friction_at(moment, touch.point);
            let along = tread.force_n(
                &model.tyre,
                slip_mps,
                turn.y * ring.radius_m,
                friction * normal_n,
                moment.dt_s,
            );
            self.treads[side][slot] = Some((touch.feature, tread));
            let force = touch.normal * normal_n + forward * along.x + left * along.y;
            forces.push_part(side, wheel, frame.to_body(force), at);
            load_n += normal_n;
            friction_n += touch.normal * (friction * normal_n);
        }
        let rolling_nm = self.rolling[side].torque_nm(
            turn.y,
            ROLLING_RESISTANCE * load_n * ring.radius_m,
            model.disc.spin_kgm2,
            moment.dt_s,
        );
        let up = frame.to_body(friction_n.try_normalize(0.0).unwrap_or_else(Vec3::z));
        let twisting_nm = self.twisting[side].torque_nm(
            turn.dot(&up),
            model.disc.twist_m * friction_n.norm(),
            model.disc.tilt_kgm2,
            moment.dt_s,
        );
        forces.twist_part(side, wheel, Vec3::y() * rolling_nm + up * twisting_nm);
        load_n
    }

    /// Contacts of a wheel with the side of the world that it is on. It changes to the other one where that is not a wall: walls
    /// along x are not felt, and a wheel goes on where it was.
    fn touches(&mut self, wheel: usize, ring: &Ring, ground: &Ground) -> [Option<Touch>; TOUCHES] {
        let over = Side::at(ring.centre.y);
        let found = ring.touches(ground.profile(over));
        let depth_m = found[0].map_or(0.0, |touch| touch.depth_m);
        if over == self.sides[wheel] || depth_m < WALL_M {
            self.sides[wheel] = over;
            return found;
        }
        ring.touches(ground.profile(self.sides[wheel]))
    }

    fn bumpers(&mut self, moment: &Moment, frame: &Frame, forces: &mut Coordinates) -> f64 {
        let down = frame.to_body(-Vec3::z());
        let mut sum_n = 0.0;
        for (bumper, stick) in moment.model.bumpers.iter().zip(&mut self.bumpers) {
            let lowest = bumper.place + down * bumper.radius_m;
            let point = Point {
                place: frame.place(lowest),
                velocity: frame.to_world(frame.velocity + frame.rate.cross(&lowest)),
            };
            if let Some((force, normal_n)) = point_force(moment, &point, stick) {
                forces.push_body(frame.to_body(force), lowest);
                sum_n += normal_n;
            }
        }
        sum_n
    }

    /// Knees are the ends of their thighs.
    fn knees(&mut self, moment: &Moment, frame: &Frame, forces: &mut Coordinates) -> f64 {
        let below = frame.to_body(-Vec3::z()) * LINK_RADIUS_M;
        let mut sum_n = 0.0;
        for side in 0..SIDES {
            let linkage = &moment.legs[side].linkage;
            for (hip, stick) in self.knees[side].iter_mut().enumerate() {
                let knee =
                    Vec3::new(0.0, moment.model.plane_y[side], 0.0) + lift(linkage.knee[hip]);
                let lowest = knee + below;
                // A hip turns its thigh about −y.
                let slope = lift(linkage.knee_slope[hip]) - Vec3::y().cross(&below);
                let swing = slope * moment.motion.hip_rps[side][hip];
                let point = Point {
                    place: frame.place(lowest),
                    velocity: frame.to_world(frame.velocity + frame.rate.cross(&lowest) + swing),
                };
                if let Some((force, normal_n)) = point_force(moment, &point, stick) {
                    let force = frame.to_body(force);
                    forces.push_body(force, lowest);
                    forces.legs[side][hip] += slope.dot(&force);
                    sum_n += normal_n;
                }
            }
        }
        sum_n
    }
}

/// Force in world axes on a point that hits the ground, and its normal part.
fn point_force(moment: &Moment, point: &Point, stick: &mut Option<Stick>) -> Option<(Vec3, f64)> {
    let profile = moment.ground.profile(Side::at(point.place.y));
    let Some((normal, depth_m)) = profile.depth_of(point.place) else {
        *stick = None;
        return None;
    };
    let stiffness = &moment.model.shell;
    let rising_mps = point.velocity.dot(&normal);
    let normal_n = stiffness.normal_n(depth_m, rising_mps);
    let along = stick.get_or_insert_default().force_n(
        stiffness,
        normal,
        point.velocity - normal * rising_mps,
        friction_at(moment, point.place) * normal_n,
        moment.dt_s,
    );
    Some((normal * normal_n + along, normal_n))
}

fn friction_at(moment: &Moment, place: Vec3) -> f64 {
    moment.model.ground_friction * moment.grip.max(0.0) * moment.ground.grip(place.x)
}

/// Forward and left of a wheel, along the ground.
fn directions(ring: &Ring, touch: &Touch) -> [Vec3; 2] {
    let forward = ring.axle.cross(&touch.normal);
    let length = forward.norm();
    // Any direction will do for a wheel that lies flat.
    let forward = if length > 1e-3 {
        forward / length
    } else {
        touch.normal.cross(&Vec3::y())
    };
    [forward, touch.normal.cross(&forward)]
}

/// The tread of a contact: its own of the step before, or that of a contact which has ended, since the tyre rolled on from there.
fn inherited(
    before: &[Option<(usize, Tread)>; TOUCHES],
    feature: usize,
    touches: &[Option<Touch>; TOUCHES],
) -> Tread {
    let goes_on = |feature: usize| touches.iter().flatten().any(|it| it.feature == feature);
    let mut known = before.iter().flatten();
    known
        .clone()
        .find(|(it, _)| *it == feature)
        .or_else(|| known.find(|(it, _)| !goes_on(*it)))
        .map_or_else(Tread::default, |(_, tread)| *tread)
}

/// The body's frame at the moment.
struct Frame {
    origin: Vec3,
    /// Body → world.
    rotation: Matrix3<f64>,
    /// In body axes.
    velocity: Vec3,
    rate: Vec3,
}

impl Frame {
    fn of(motion: &Motion) -> Self {
        let rotation = motion.attitude.to_rotation_matrix().into_inner();
        Self {
            origin: motion.position,
            velocity: rotation.tr_mul(&motion.velocity),
            rotation,
            rate: motion.rate,
        }
    }

    fn place(&self, body: Vec3) -> Vec3 {
        self.origin + self.rotation * body
    }

    fn to_world(&self, body: Vec3) -> Vec3 {
        self.rotation * body
    }

    fn to_body(&self, world: Vec3) -> Vec3 {
        self.rotation.tr_mul(&world)
    }
}
