"""MuJoCo answers questions of the tests: oracle.py FREE.xml CLAMPED.xml < QUESTION.json > ANSWER.json

MuJoCo knows the robot as a tree of links: it gives the mass matrix, the bias forces and the Jacobians of the places where
the loops close. The loops are closed here, without the softness of MuJoCo's own constraints, by Lagrange multipliers.

A state has the position of the body's origin, its attitude (body to world, scalar first), its velocity in the world, its rate
in body axes, then four hips (left front, left rear, right front, right rear) and two wheels against their shanks.
"""

import json
import sys

import mujoco
import numpy as np

SIDES = ["left", "right"]
LIMBS = [f"{side}_{end}" for side in SIDES for end in ("front", "rear")]
BODY = {"Free": 6, "Clamped": 0}


class Oracle:
    """One robot, free or clamped."""

    def __init__(self, file, hold):
        self.model = mujoco.MjModel.from_xml_path(file)
        # Nothing but the tree: no loops, floor or joint limits.
        everything = mujoco.mjtDisableBit.mjDSBL_CONSTRAINT | mujoco.mjtDisableBit.mjDSBL_CONTACT
        self.model.opt.disableflags |= everything
        self.data = mujoco.MjData(self.model)
        self.body_dofs = BODY[hold]
        joints = lambda names: [self.model.joint(name) for name in names]
        self.hips = joints(f"{limb}_hip" for limb in LIMBS)
        self.knees = joints(f"{limb}_knee" for limb in LIMBS)
        self.wheels = joints(f"{side}_wheel" for side in SIDES)
        # The free coordinates in the order of the plant: body, hips, wheels.
        moved = [joint.dofadr[0] for joint in self.hips + self.wheels]
        self.independent = list(range(self.body_dofs)) + moved
        self.dependent = [joint.dofadr[0] for joint in self.knees]

    def pose(self, state):
        """Puts the model into a state, with the loops closed."""
        data = self.data
        if self.body_dofs:
            data.qpos[:7] = np.concatenate([state["position_m"], state["attitude"]])
            data.qvel[:6] = np.concatenate([state["velocity_mps"], state["rate_rps"]])
        for kind, joints in (("joint", self.hips), ("wheel", self.wheels)):
            for joint, angle, speed in zip(joints, state[f"{kind}_rad"], state[f"{kind}_rps"]):
                data.qpos[joint.qposadr] = angle
                data.qvel[joint.dofadr] = speed
        for side in range(2):
            self.close(2 * side, 2 * side + 1)
        data.qvel[self.dependent] = 0.0
        mujoco.mj_forward(self.model, data)
        gap = self.loop_jacobian()
        knees = -np.linalg.solve(gap[:, self.dependent], gap @ data.qvel)
        data.qvel[self.dependent] = knees
        mujoco.mj_forward(self.model, data)

    def close(self, front, rear):
        """Bends both knees so that the shanks meet below them: two circles about the knees."""
        knees, directions = [], []
        for limb, out in ((front, 1.0), (rear, -1.0)):
            angle = self.data.qpos[self.hips[limb].qposadr[0]]
            direction = out * np.array([np.cos(angle), np.sin(angle)])
            thigh = abs(self.model.body(f"{LIMBS[limb]}_shank").pos[0])
            hip = self.model.body(f"{LIMBS[limb]}_thigh").pos[[0, 2]]
            knees.append(hip + thigh * direction)
            directions.append(direction)
        shank = abs(self.model.site(f"{LIMBS[front]}_axle").pos[0])
        across = knees[0] - knees[1]
        down = np.array([across[1], -across[0]]) / np.linalg.norm(across)
        axle = (knees[0] + knees[1]) / 2 + down * np.sqrt(shank**2 - across @ across / 4)
        for limb, knee, along in zip((front, rear), knees, directions):
            below = axle - knee
            # From x towards z, as all joints of the legs turn.
            turn = np.arctan2(along[0] * below[1] - along[1] * below[0], along @ below)
            self.data.qpos[self.knees[limb].qposadr] = turn

    def loops(self):
        """Pairs of places that are one, with the axes of the leg's plane in the world."""
        plane = self.data.body("body").xmat.reshape(3, 3)[:, [0, 2]].T
        for side in SIDES:
            yield plane, f"{side}_front_axle", f"{side}_rear_axle"

    def jacobian(self, site):
        rows = np.zeros((3, self.model.nv))
        mujoco.mj_jacSite(self.model, self.data, rows, None, self.model.site(site).id)
        return rows

    def jacobian_rate(self, site):
        rows = np.zeros((3, self.model.nv))
        body = self.model.site(site).bodyid[0]
        point = self.data.site(site).xpos
        mujoco.mj_jacDot(self.model, self.data, rows, None, point, body)
        return rows

    def loop_jacobian(self):
        return np.vstack([p @ (self.jacobian(a) - self.jacobian(b)) for p, a, b in self.loops()])

    def loop_bias(self):
        rows = [p @ (self.jacobian_rate(a) - self.jacobian_rate(b)) for p, a, b in self.loops()]
        return np.vstack(rows) @ self.data.qvel

    def forces(self, inputs):
        """Generalised forces of motors and a push."""
        total = np.zeros(self.model.nv)
        for joint, torque in zip(self.hips + self.wheels, inputs["joint_nm"] + inputs["wheel_nm"]):
            total[joint.dofadr] += torque
        if inputs.get("push"):
            body = self.data.body("body")
            turn = body.xmat.reshape(3, 3)
            point = body.xpos + turn @ np.array(inputs["push"]["at_m"])
            force = np.array(inputs["push"]["force_n"])
            mujoco.mj_applyFT(
                self.model, self.data, force, np.zeros(3), point, self.model.body("body").id, total
            )
        return total

    def accelerations(self, state, inputs, hips_locked=False):
        """Accelerations of the free coordinates."""
        self.pose(state)
        nv = self.model.nv
        mass = np.zeros((nv, nv))
        mujoco.mj_fullM(self.model, self.data, mass)
        ties, ties_bias = self.loop_jacobian(), self.loop_bias()
        if hips_locked:
            hips = np.eye(nv)[[joint.dofadr[0] for joint in self.hips]]
            ties, ties_bias = np.vstack([ties, hips]), np.append(ties_bias, np.zeros(4))
        system = np.block([[mass, ties.T], [ties, np.zeros((len(ties),) * 2)]])
        right = np.concatenate([self.forces(inputs) - self.data.qfrc_bias, -ties_bias])
        return np.linalg.solve(system, right)[:nv][self.independent]

    def rolling_accelerations(self, state, inputs, radius_m, tyre_m):
        """Accelerations from rest, with the lowest place of each round tyre held by the ground."""
        self.pose(state)
        nv = self.model.nv
        mass = np.zeros((nv, nv))
        mujoco.mj_fullM(self.model, self.data, mass)
        ties = [self.loop_jacobian()]
        up = np.array([0.0, 0.0, 1.0])
        for side in SIDES:
            wheel = self.data.body(f"{side}_wheel")
            axle = wheel.xmat.reshape(3, 3)[:, 1]
            down = axle * axle[2] - up
            lowest = wheel.xpos + down / np.linalg.norm(down) * (radius_m - tyre_m) - up * tyre_m
            rows = np.zeros((3, nv))
            mujoco.mj_jac(self.model, self.data, rows, None, lowest, wheel.id)
            ties.append(rows)
        ties = np.vstack(ties)
        system = np.block([[mass, ties.T], [ties, np.zeros((len(ties),) * 2)]])
        right = np.concatenate([self.forces(inputs) - self.data.qfrc_bias, np.zeros(len(ties))])
        # Both wheels forbid one sideways motion: the forces are not determined, the accelerations are.
        return np.linalg.lstsq(system, right, rcond=1e-12)[0][:nv][self.independent]

    def energy(self, state):
        """Kinetic energy, and potential energy that is zero with the centre of mass at z = 0."""
        self.pose(state)
        mujoco.mj_energyPos(self.model, self.data)
        mujoco.mj_energyVel(self.model, self.data)
        return float(sum(self.data.energy))

    def holding_torques(self, state, axle_force_n):
        """Torques of the hips that hold the legs still against their weight and a force (forward, up) on each axle."""
        self.pose(state)
        ground = np.zeros(self.model.nv)
        for side, (forward, up) in zip(SIDES, axle_force_n):
            ground += self.jacobian(f"{side}_rear_axle").T @ np.array([forward, 0.0, up])
        # Along motions that keep the loops closed, hips and wheels alone do the work.
        loops = self.loop_jacobian()
        knees = -np.linalg.solve(loops[:, self.dependent], loops[:, self.independent])
        motions = np.zeros((self.model.nv, len(self.independent)))
        motions[self.independent] = np.eye(len(self.independent))
        motions[self.dependent] = knees
        torques = motions.T @ (self.data.qfrc_bias - ground)
        return torques[self.body_dofs : self.body_dofs + 4]


def flat(state):
    keys = ["position_m", "attitude", "joint_rad", "wheel_rad", "velocity_mps", "rate_rps", "joint_rps", "wheel_rps"]
    return np.concatenate([state[key] for key in keys])


def unflat(y):
    places = np.split(y, [3, 7, 11, 13, 16, 19, 23])
    keys = ["position_m", "attitude", "joint_rad", "wheel_rad", "velocity_mps", "rate_rps", "joint_rps", "wheel_rps"]
    return dict(zip(keys, places))


def flight(oracle, state, inputs, step_s, steps, every):
    """The motion under torques that change as cosines: Runge-Kutta of the fourth order."""

    def slope(t, y):
        now = unflat(y)
        w, x, yy, z = now["attitude"]
        a, b, c = now["rate_rps"]
        turn = 0.5 * np.array(
            [-x * a - yy * b - z * c, w * a + yy * c - z * b, w * b + z * a - x * c, w * c + x * b - yy * a]
        )
        swing = np.cos(inputs["rps"] * t)
        torques = {
            kind: list(np.array(inputs[f"steady_{kind}"]) + swing * np.array(inputs[f"swing_{kind}"]))
            for kind in ("joint_nm", "wheel_nm")
        }
        found = oracle.accelerations(now, torques, inputs["hips_locked"])
        found = np.concatenate([np.zeros(6 - oracle.body_dofs), found])
        return np.concatenate([now["velocity_mps"], turn, now["joint_rps"], now["wheel_rps"], found])

    y, seen = flat(state), []
    for n in range(steps):
        t = n * step_s
        a = slope(t, y)
        b = slope(t + step_s / 2, y + a * step_s / 2)
        c = slope(t + step_s / 2, y + b * step_s / 2)
        d = slope(t + step_s, y + c * step_s)
        y = y + (a + 2 * b + 2 * c + d) * step_s / 6
        if (n + 1) % every == 0:
            seen.append({key: list(value) for key, value in unflat(y).items()})
    return seen


class OnGround(Oracle):
    """A free robot on MuJoCo's floor, with MuJoCo's own loops, contacts and steps."""

    def __init__(self, file, question):
        super().__init__(file, "Free")
        model = self.model
        model.opt.disableflags = 0
        model.opt.timestep = question["step_s"]
        model.opt.impratio = 100.0
        model.eq_solref[:] = [2 * question["step_s"], 1.0]
        floor = model.geom("floor")
        for side in SIDES:
            wheel = model.geom(f"{side}_wheel")
            # Friction against twisting and rolling is a length in MuJoCo: torque per newton of load. Its cone of friction makes
            # one of both weaker while the other slips, so that they are compared one at a time.
            for geom in (wheel, floor):
                geom.friction = [question[kind] for kind in ("friction", "twisting_m", "rolling_m")]
            model.joint(f"{side}_wheel").frictionloss = question["rolling_nm"]
            wheel.condim = 6
            if "tyre_n_per_m" in question:
                self.soften(wheel, "tyre", question)

    def soften(self, geom, kind, question):
        """Makes a contact a spring and damper. MuJoCo asks for both per inverse weight; with a small impedance nothing of its
        own comes in between."""
        weight = self.model.body_invweight0[geom.bodyid[0], 0]
        geom.solref = [-question[f"{kind}_n_per_{unit}"] * weight for unit in ("m", "mps")]
        geom.solimp = [1e-3, 1e-3, 0.001, 0.5, 2.0]
        geom.priority = 1

    def run(self, question):
        """Hips held by springs and dampers at their first angles, wheels under a constant torque."""
        model, data = self.model, self.data
        self.pose(question["state"])
        hips = [joint.dofadr[0] for joint in self.hips]
        wheels = [joint.dofadr[0] for joint in self.wheels]
        places = [joint.qposadr[0] for joint in self.hips]
        wanted = data.qpos[places].copy()
        seen = []
        for n in range(question["steps"]):
            data.qfrc_applied[hips] = (
                question["kp"] * (wanted - data.qpos[places]) - question["kd"] * data.qvel[hips]
            )
            data.qfrc_applied[wheels] = question["wheel_nm"]
            mujoco.mj_step(model, data)
            self.stepped(question["step_s"])
            if (n + 1) % question["every"] == 0:
                seen.append(list(self.moment()))
        return seen

    def stepped(self, step_s):
        """Sees every step."""

    def moment(self):
        """Place x and z, pitch, yaw, hips, wheels."""
        data = self.data
        x, _, z = data.qpos[:3]
        w, _, y, yaw = data.qpos[3:7]
        turns = 2 * np.arctan2([y, yaw], w)
        places = [joint.qposadr[0] for joint in self.hips]
        wheels = [joint.dofadr[0] for joint in self.wheels]
        return [x, z, *turns, *data.qpos[places], *data.qvel[wheels]]


class Falling(OnGround):
    """The same, with a body and links that give where they hit the floor."""

    def __init__(self, file, question):
        super().__init__(file, question)
        model = self.model
        model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
        self.sum_ns = 0.0
        # Across a contact MuJoCo has a damper only, as much stronger than that along it. Its default would hold like a rigid body;
        # this is as strong as the plant's spring and damper are over the few milliseconds of a hit.
        model.opt.impratio = 3.0
        for joint in self.hips:
            weight = model.dof_invweight0[joint.dofadr[0]]
            joint.range = [joint.range[0] - question["stop_rad"], joint.range[1] + question["stop_rad"]]
            model.jnt_solref[joint.id] = [-question["stop_nm_per_rad"] * weight, -question["stop_nm_per_rps"] * weight]
            model.jnt_solimp[joint.id] = [1e-3, 1e-3, 0.001, 0.5, 2.0]
        self.tyres = {model.geom(f"{side}_wheel").id for side in SIDES}
        for n in range(model.ngeom):
            geom = model.geom(n)
            # Both links of a leg end in its knee, which is one place and hits the floor once. A shank's other end is inside of the
            # wheel.
            if model.body(geom.bodyid[0]).name.endswith("_shank"):
                geom.contype, geom.conaffinity = 0, 0
            touches = geom.contype[0] or geom.conaffinity[0]
            if touches and geom.bodyid[0] != 0 and n not in self.tyres:
                self.soften(geom, "shell", question)

    def hits_n(self):
        """Normal force of the floor on everything but the tyres."""
        total, force = 0.0, np.zeros(6)
        for n, contact in enumerate(self.data.contact):
            if not self.tyres & set(contact.geom):
                mujoco.mj_contactForce(self.model, self.data, n, force)
                total += force[0]
        return total

    def stepped(self, step_s):
        self.sum_ns += self.hits_n() * step_s

    def moment(self):
        """Place, attitude, energy, what the floor has given to everything but the tyres."""
        return [*self.data.qpos[:7], sum(self.data.energy), self.sum_ns]


def answer(files, question):
    match question["task"]:
        case "ground":
            return OnGround(files["Free"], question).run(question)
        case "fall":
            return Falling(files["Free"], question).run(question)
    oracle = Oracle(files[question["hold"]], question["hold"])
    states = question.get("states", [])
    match question["task"]:
        case "accelerations":
            pairs = zip(states, question["inputs"])
            return [list(oracle.accelerations(*pair)) for pair in pairs]
        case "rolling":
            sizes = question["radius_m"], question["tyre_m"]
            pairs = zip(states, question["inputs"])
            return [list(oracle.rolling_accelerations(*pair, *sizes)) for pair in pairs]
        case "energies":
            return [oracle.energy(state) for state in states]
        case "holding":
            pairs = zip(states, question["axle_force_n"])
            return [list(oracle.holding_torques(*pair)) for pair in pairs]
        case "flight":
            keys = ("state", "inputs", "step_s", "steps", "every")
            return flight(oracle, *(question[key] for key in keys))


def main(free, clamped):
    files = {"Free": free, "Clamped": clamped}
    json.dump(answer(files, json.load(sys.stdin)), sys.stdout)


main(*sys.argv[1:])
