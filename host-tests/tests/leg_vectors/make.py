"""Prints poses of a leg as MuJoCo finds them: make.py CLAMPED.xml

Each line: front and rear hip in rad; length in m and angle in rad of the line from hip centre to axle, angle forward positive;
by front and rear hip the derivatives of length, of angle, and of the turn about +y of the shank that carries the wheel.

No formula of a five-bar is used: Newton's method bends the knees until both shanks end in one place.
"""

import sys

import mujoco
import numpy as np

HIPS = ["left_front_hip", "left_rear_hip"]
KNEES = ["left_front_knee", "left_rear_knee"]
ENDS = ["left_front_axle", "left_rear_axle"]
FRONT_RAD = np.linspace(-1.2, 0.6, 10)
REAR_RAD = np.linspace(-0.6, 1.2, 10)
# A leg whose shanks are nearly in line is of no use.
LEAST_SINE = 0.3


class Leg:
    def __init__(self, file):
        self.model = mujoco.MjModel.from_xml_path(file)
        self.data = mujoco.MjData(self.model)
        self.hips, self.knees = ([self.model.joint(name) for name in names] for names in (HIPS, KNEES))
        self.places = [joint.qposadr[0] for joint in self.hips]
        self.knee_places = [joint.qposadr[0] for joint in self.knees]
        wheel = self.model.body("left_wheel")
        self.carrier = wheel.parentid[0]

    def site_rows(self, site):
        """Derivatives of a place, x and z, by hips and knees."""
        rows = np.zeros((3, self.model.nv))
        mujoco.mj_jacSite(self.model, self.data, rows, None, self.model.site(site).id)
        return self.pick(rows[[0, 2]])

    def pick(self, rows):
        dofs = [joint.dofadr[0] for joint in self.hips + self.knees]
        return rows[:, dofs[:2]], rows[:, dofs[2:]]

    def close(self, hips):
        """Newton's method from the pose before."""
        self.data.qpos[self.places] = hips
        for _ in range(30):
            mujoco.mj_kinematics(self.model, self.data)
            mujoco.mj_comPos(self.model, self.data)
            front, rear = (self.data.site(end).xpos[[0, 2]] for end in ENDS)
            if abs(front - rear).max() < 1e-14:
                break
            (_, a), (_, b) = (self.site_rows(end) for end in ENDS)
            self.data.qpos[self.knee_places] -= np.linalg.solve(a - b, front - rear)

    def go_to(self, hips, steps=40):
        """In small steps from the pose that the model starts with, so that the knees stay outward."""
        mujoco.mj_resetData(self.model, self.data)
        start = self.data.qpos[self.places].copy()
        for share in np.linspace(0.0, 1.0, steps):
            self.close(start + share * (np.array(hips) - start))

    def row(self, hips):
        (front_hips, front_knees), (rear_hips, rear_knees) = (self.site_rows(end) for end in ENDS)
        knees = -np.linalg.solve(front_knees - rear_knees, front_hips - rear_hips)
        axle = self.data.site(ENDS[0]).xpos - self.data.body("body").xpos
        axle_slopes = front_hips + front_knees @ knees
        length = np.hypot(axle[0], axle[2])
        angle = np.arctan2(axle[0], -axle[2])
        length_slopes = np.array([axle[0], axle[2]]) @ axle_slopes / length
        angle_slopes = np.array([-axle[2], axle[0]]) @ axle_slopes / length**2
        turns = np.zeros((3, self.model.nv))
        mujoco.mj_jacBody(self.model, self.data, None, turns, self.carrier)
        by_hips, by_knees = self.pick(turns[[1]])
        carrier_slopes = (by_hips + by_knees @ knees)[0]
        return [*hips, length, angle, *length_slopes, *angle_slopes, *carrier_slopes]

    def sine(self):
        """Of the angle between the shanks."""
        axes = [self.data.body(f"left_{end}_shank").xmat.reshape(3, 3)[:, 0] for end in ("front", "rear")]
        return np.linalg.norm(np.cross(*axes))


def main(file):
    leg = Leg(file)
    for front in FRONT_RAD:
        for rear in REAR_RAD:
            leg.go_to([front, rear])
            if leg.sine() > LEAST_SINE:
                print(",".join(f"{value:.10f}" for value in leg.row([front, rear])))


main(sys.argv[1])
