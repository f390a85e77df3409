"""The robot in the plane of its wheels, as equations for CasADi.

Written from the geometry of a five-bar: no code is shared with the simulated robot or with the design of the gains. Both
sides move as one, so that links, wheels and motors of a side count twice.
"""

import tomllib
from dataclasses import dataclass

import casadi as ca
import numpy as np

GRAVITY_MPS2 = 9.80665
# Motors as in crates/plant/src: m3508/motor.rs and joints/dm4310.rs.
SUPPLY_V = 24.0
WINDING_OHM = 0.194
NO_LOAD_A = 0.78
DRY_SHARE = 0.6
HIP_RPS_PER_NM = 2.79
HIP_DRY_NM = 0.15
# Dry friction grows over this speed, so that its derivative exists.
SMOOTH_RPS = 1.0
# Radius of the links, with which knees touch the ground.
LINK_M = 0.008

# Coordinates: place of the axle, pitch of the body (nose down), hips as in the robot's file, turn of the wheel.
X, PITCH, FRONT, REAR, WHEEL = range(5)
COORDINATES = 5
# Torques of one side.
WHEEL_NM, FRONT_NM, REAR_NM = range(3)
TORQUES = 3


@dataclass(frozen=True)
class Variation:
    """How the robot differs from its file. The body takes the difference in mass, and its inertia grows with it."""

    mass: float = 1.0
    torque: float = 1.0
    hip_nm: float | None = None


class Robot:
    """Functions of coordinates, speeds, accelerations, torques, the ground's force along itself, and the push's.

    `equations` are zero for a motion; `tyre` gives load and slip; `bounds` what the motors leave, the clearances over the
    ground and the leg's length, of which the first two are not negative; `seen` the figures named in `names`.
    """

    def __init__(self, file, variation=Variation()):
        with open(file, "rb") as text:
            self.file = tomllib.load(text)
        body, legs, wheels, joints = self.groups()
        links_kg = 4 * (legs["thigh"]["mass_kg"] + legs["shank"]["mass_kg"])
        named_kg = body["mass_kg"] + links_kg + 2 * (wheels["mass_kg"] + wheels["motor_mass_kg"])
        self.mass_kg = variation.mass * named_kg
        self.body_kg = body["mass_kg"] + self.mass_kg - named_kg
        self.body_kgm2 = body["inertia_kgm2"][1] * self.body_kg / body["mass_kg"]
        self.radius_m = wheels["radius_m"]
        self.nm_per_a = wheels["torque_nm_per_a"] * variation.torque
        self.dry_nm = wheels["torque_nm_per_a"] * NO_LOAD_A
        self.wheel_nm = wheels["max_current_a"] * self.nm_per_a
        self.no_load_rps = wheels["no_load_rps"]
        self.hip_nm = variation.hip_nm or joints["torque_limit_nm"]
        self.hip_free_rps = joints["no_load_rps"] + HIP_RPS_PER_NM * HIP_DRY_NM
        self.ranges_rad = joints["range_rad"]["front"], joints["range_rad"]["rear"]
        self.leg_m = legs["min_m"], legs["max_m"]
        self.derive()

    def groups(self):
        return [self.file[name] for name in ("body", "legs", "wheels", "joints")]

    def derive(self):
        q, v, a = (ca.SX.sym(name, COORDINATES) for name in "qva")
        torque, grip_n, push_n = ca.SX.sym("torque", TORQUES), ca.SX.sym("grip"), ca.SX.sym("push")
        rate = lambda value: ca.jtimes(value, q, v)
        acceleration = lambda value: ca.jtimes(value, q, v) + ca.jtimes(value, v, a)
        leg = Leg(self, q, v, rate)
        parts = leg.parts(self)
        height, middle = 0.0, 0.0
        energy = leg.rotors_j
        for kg, kgm2, place, turn_rps in parts:
            energy += 0.5 * kg * ca.sumsqr(rate(place)) + 0.5 * kgm2 * turn_rps**2
            height += kg * GRAVITY_MPS2 * place[1]
            middle += kg * place / self.mass_kg

        # Lagrange's equations.
        left = acceleration(ca.gradient(energy, v)) - ca.gradient(energy, q) + ca.gradient(height, q)
        moving = ca.vertcat(leg.spin_rps, v[FRONT], v[REAR])
        left -= ca.jtimes(moving, v, 2 * (torque - self.friction_nm(leg.spin_rps, v)), True)
        left -= ca.jacobian(parts[0][2], q).T @ ca.vertcat(push_n, 0)
        left -= ca.vertcat(grip_n, 0, 0, 0, -grip_n * self.radius_m)

        middle_mps = rate(middle)
        load_n = self.mass_kg * (GRAVITY_MPS2 + acceleration(middle_mps)[1])
        slip_mps = v[WHEEL] * self.radius_m - v[X]
        inputs = [q, v, a, torque, grip_n, push_n]
        self.equations = ca.Function("equations", inputs, [left])
        self.tyre = ca.Function("tyre", inputs, [load_n, slip_mps])
        motors = self.motors_leave(leg.spin_rps, v, torque)
        clearances = ca.vertcat(*leg.clearances_m(self))
        self.bounds = ca.Function("bounds", inputs, [motors, clearances, leg.length_m])
        self.length = ca.Function("length", [q], [leg.length_m])
        hip_mps = rate(leg.hip)
        seen = {
            "lean_rad": ca.atan2(leg.hip[0] - q[X], leg.hip[1] - self.radius_m),
            "pitch_rad": q[PITCH],
            "leg_m": leg.length_m,
            "hip_m": leg.hip[1],
            "hip_mps": hip_mps[0],
            "middle_mps": middle_mps[0],
            "axle_mps": v[X],
            "wheel_nm": torque[WHEEL_NM],
            "front_nm": torque[FRONT_NM],
            "rear_nm": torque[REAR_NM],
            "grip_n": grip_n,
            "load_n": load_n,
            "slip_mps": slip_mps,
        }
        self.names = list(seen)
        self.seen = ca.Function("seen", inputs, [ca.vertcat(*seen.values())])
        hip_mps2 = acceleration(hip_mps)
        self.hip_mps2 = ca.Function("hip", inputs, [hip_mps2])

    def friction_nm(self, spin_rps, v):
        smooth = lambda rps: ca.tanh(rps / SMOOTH_RPS)
        wheel = DRY_SHARE * smooth(spin_rps) + (1 - DRY_SHARE) * spin_rps / self.no_load_rps
        return ca.vertcat(self.dry_nm * wheel, HIP_DRY_NM * smooth(v[FRONT]), HIP_DRY_NM * smooth(v[REAR]))

    def motors_leave(self, spin_rps, v, torque):
        """Torque up to what the supply can drive against the speed, both ways."""
        back_emf_v = (SUPPLY_V - WINDING_OHM * NO_LOAD_A) * spin_rps / self.no_load_rps
        wheel_nm = lambda volts: self.nm_per_a * (volts - back_emf_v) / WINDING_OHM
        left = [wheel_nm(SUPPLY_V) - torque[WHEEL_NM], torque[WHEEL_NM] - wheel_nm(-SUPPLY_V)]
        for motor, joint in ((FRONT_NM, FRONT), (REAR_NM, REAR)):
            left.append((self.hip_free_rps - v[joint]) / HIP_RPS_PER_NM - torque[motor])
            left.append((self.hip_free_rps + v[joint]) / HIP_RPS_PER_NM + torque[motor])
        return ca.vertcat(*left)

    def standing(self, height_m):
        """Coordinates and torques of a robot that stands still and level on legs of this length."""
        low, high = self.ranges_rad[0]
        for _ in range(60):
            middle = 0.5 * (low + high)
            pose = ca.DM([0, 0, middle, -middle, 0])
            # Thighs that are further up make a shorter leg.
            low, high = (middle, high) if float(self.length(pose)) > height_m else (low, middle)
        still = ca.DM.zeros(COORDINATES)
        torque = ca.SX.sym("torque", TORQUES)
        left = ca.Function("left", [torque], [self.equations(pose, still, still, torque, 0, 0)])
        slopes = ca.Function("slopes", [torque], [ca.jacobian(left(torque), torque)])
        none = ca.DM.zeros(TORQUES)
        torques = np.linalg.lstsq(np.array(slopes(none)), -np.array(left(none)), rcond=None)[0]
        if float(ca.norm_inf(left(torques))) > 1e-6:
            raise SystemExit("the robot does not stand level: its body's centre of mass is not above its hips' centre")
        return pose, ca.DM(torques)

    def accelerations(self, pitch_rad, joints_rad, torques_nm):
        """Of a robot at rest whose wheels roll: of the hip centre, pitch and hips."""
        q, still = ca.DM([0, pitch_rad, *joints_rad, 0]), ca.DM.zeros(COORDINATES)
        unknown = ca.SX.sym("unknown", COORDINATES + 1)
        inputs = [q, still, unknown[:COORDINATES], ca.DM(torques_nm), unknown[COORDINATES], 0]
        left = ca.vertcat(self.equations(*inputs), unknown[X] - self.radius_m * unknown[WHEEL])
        linear = ca.Function("linear", [unknown], [left, ca.jacobian(left, unknown)])
        offset, slopes = linear(ca.DM.zeros(COORDINATES + 1))
        found = -ca.solve(slopes, offset)
        hip = self.hip_mps2(q, still, found[:COORDINATES], ca.DM(torques_nm), found[COORDINATES], 0)
        return [float(it) for it in (hip[0], hip[1], found[PITCH], found[FRONT], found[REAR])]


class Leg:
    """Places in the world, turns about the axis to the left. Joint angles are as in the robot's file."""

    def __init__(self, robot, q, v, rate):
        _, legs, wheels, joints = robot.groups()
        self.q, self.v = q, v
        half_m, thigh_m, shank_m = legs["hip_gap_m"] / 2, legs["thigh"]["length_m"], legs["shank"]["length_m"]
        self.thighs = [
            ca.vertcat(ca.cos(q[FRONT]), ca.sin(q[FRONT])),
            ca.vertcat(-ca.cos(q[REAR]), -ca.sin(q[REAR])),
        ]
        self.hips = [ca.DM([half_m, 0]), ca.DM([-half_m, 0])]
        self.knees = [hip + thigh_m * thigh for hip, thigh in zip(self.hips, self.thighs)]
        # Both shanks end on the line that halves the one between the knees.
        across = self.knees[0] - self.knees[1]
        width_m = ca.norm_2(across)
        down = ca.vertcat(across[1], -across[0]) / width_m
        axle = (self.knees[0] + self.knees[1]) / 2 + down * ca.sqrt(shank_m**2 - width_m**2 / 4)
        self.shanks = [(axle - knee) / shank_m for knee in self.knees]
        self.length_m = ca.norm_2(axle)
        self.hip = ca.vertcat(q[X], robot.radius_m) - self.turned(axle)
        self.thigh_rps = [v[PITCH] - v[joint] for joint in (FRONT, REAR)]
        self.shank_rps = [v[PITCH] + rate(ca.atan2(-shank[0], -shank[1])) for shank in self.shanks]
        self.spin_rps = v[WHEEL] - self.shank_rps[wheels["carrier"] == "rear"]
        # Of both sides. A rotor turns with its gear.
        self.rotors_j = (
            wheels["inertia_kgm2"] * v[WHEEL] ** 2
            + wheels["rotor_inertia_kgm2"] * self.spin_rps**2
            + joints["armature_kgm2"] * (v[FRONT] ** 2 + v[REAR] ** 2)
        )

    def turned(self, place):
        cos, sin = ca.cos(self.q[PITCH]), ca.sin(self.q[PITCH])
        return ca.vertcat(cos * place[0] + sin * place[1], -sin * place[0] + cos * place[1])

    def parts(self, robot):
        """Mass, inertia, place of the centre of mass and turn rate of the body and of both sides' links and wheels."""
        body, legs, wheels, _ = robot.groups()
        centre = ca.DM([body["com_m"][0], body["com_m"][2]])
        parts = [(robot.body_kg, robot.body_kgm2, self.hip + self.turned(centre), self.v[PITCH])]
        for end in range(2):
            for link, start, along, turn_rps in (
                (legs["thigh"], self.hips[end], self.thighs[end], self.thigh_rps[end]),
                (legs["shank"], self.knees[end], self.shanks[end], self.shank_rps[end]),
            ):
                place = self.hip + self.turned(start + link["com_m"] * along)
                parts.append((2 * link["mass_kg"], 2 * link["inertia_kgm2"], place, turn_rps))
        axle = ca.vertcat(self.q[X], robot.radius_m)
        parts.append((2 * (wheels["mass_kg"] + wheels["motor_mass_kg"]), 0.0, axle, 0.0))
        return parts

    def clearances_m(self, robot):
        """Of the body's corners and the knees over the ground."""
        body = robot.file["body"]
        half, centre = (np.array([body[name][0], body[name][2]]) for name in ("box_m", "box_centre_m"))
        half = half / 2
        corners = [ca.DM(centre + half * [x, z]) for x in (-1, 1) for z in (-1, 1)]
        above = [(self.hip + self.turned(corner))[1] for corner in corners]
        return above + [(self.hip + self.turned(knee))[1] - LINK_M for knee in self.knees]
