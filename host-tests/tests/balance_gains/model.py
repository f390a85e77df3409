"""Gains of a balancing robot, from its file, by NumPy and SciPy.

The robot is a heap of point masses whose places are written in space, straight from the geometry. Speeds are complex-step
derivatives of places, the mass matrix is polarised kinetic energy, stiffness is a difference of slopes. Nothing here is
shared with the Rust code.

Usage: model.py FILE LEFT_M RIGHT_M COM_X_M CARRIER. Prints A, B, lean and leg torques of the equilibrium, K without and with
delay as one JSON object.
"""

import json
import sys
import tomllib

import numpy as np
from scipy.linalg import expm, solve_discrete_are
from scipy.optimize import brentq

GRAVITY = 9.80665
TICK = 0.001


def rotated(angle, across, up):
    """Turns a vector of the x-z plane about +y."""
    return np.cos(angle) * across + np.sin(angle) * up, np.cos(angle) * up - np.sin(angle) * across


class Robot:
    def __init__(self, file, lengths, com_x, carrier):
        with open(file, "rb") as text:
            self.file = tomllib.load(text)
        self.file["body"]["com_m"][0] = com_x
        self.file["wheels"]["carrier"] = carrier
        self.lengths = lengths

    def five_bar(self, length, beta):
        """Joint angles, hips, knees and axle in the leg's plane; works for complex numbers."""
        legs = self.file["legs"]
        l1, l2, half = legs["thigh"]["length_m"], legs["shank"]["length_m"], legs["hip_gap_m"] / 2
        axle = np.array([length * np.sin(beta), -length * np.cos(beta)])
        hips, knees, joints = [], [], []
        for side in (1, -1):
            hip = np.array([side * half, 0])
            # The knee is on two circles: from the middle of the chord outward.
            chord = axle - hip
            squared = chord @ chord
            part = (l1**2 - l2**2 + squared) / (2 * squared)
            height = np.sqrt(l1**2 / squared - part**2)
            outward = np.array([-chord[1], chord[0]]) * side
            knee = hip + part * chord + height * outward
            hips.append(hip)
            knees.append(knee)
            joints.append(np.arctan((knee - hip)[1] / (knee - hip)[0]))
        return joints, hips, knees, axle

    def places(self, q):
        """All point masses (mass, x, y, z), and the angles that inertias turn by (inertia, angle)."""
        s, yaw, lean, pitch = q[0], q[1], q[2:4], q[4]
        file = self.file
        body, legs, wheels, joints = file["body"], file["legs"], file["wheels"], file["joints"]
        ahead = sum(l * np.sin(a) for l, a in zip(self.lengths, lean)) / 2
        height = sum(l * np.cos(a) for l, a in zip(self.lengths, lean)) / 2
        # At yaw 0: no wheel moves sideways.
        hip = np.array([s + ahead, ahead * yaw, wheels["radius_m"] + height])

        def world(x, y, z):
            x, z = rotated(pitch, x, z)
            return hip + np.array([x * np.cos(yaw) - y * np.sin(yaw), x * np.sin(yaw) + y * np.cos(yaw), z])

        points, turns, axles, carriers = [], [], [], []
        # A body has the inertia of six masses on its axes.
        ix, iy, iz = body["inertia_kgm2"]
        for axis, moment in enumerate(((iy + iz - ix) / 2, (ix + iz - iy) / 2, (ix + iy - iz) / 2)):
            reach = np.sqrt(moment / (body["mass_kg"] / 3))
            for side in (-1, 1):
                place = list(body["com_m"])
                place[axis] += side * reach
                points.append((body["mass_kg"] / 6, world(*place)))
        for leg, side in enumerate((1, -1)):
            beta = pitch - lean[leg]
            angles, hips, knees, axle = self.five_bar(self.lengths[leg], beta)
            y = side * legs["plane_y_m"]
            for start, end, link in (
                (hips[0], knees[0], legs["thigh"]),
                (hips[1], knees[1], legs["thigh"]),
                (knees[0], axle, legs["shank"]),
                (knees[1], axle, legs["shank"]),
            ):
                along = (end - start) / link["length_m"]
                reach = np.sqrt(link["inertia_kgm2"] / link["mass_kg"])
                for shift in (-reach, reach):
                    x, z = start + along * (link["com_m"] + shift)
                    points.append((link["mass_kg"] / 2, world(x, y, z)))
            points.append((wheels["motor_mass_kg"], world(axle[0], y, axle[1])))
            centre = world(axle[0], side * wheels["track_m"] / 2, axle[1])
            points.append((wheels["mass_kg"], centre))
            spin = centre[0] / wheels["radius_m"]
            turns.append((wheels["inertia_kgm2"], spin))
            across = wheels["inertia_kgm2"] / 2 + wheels["mass_kg"] * wheels["width_m"] ** 2 / 12
            turns.append((across, yaw))
            knee = knees[0 if wheels["carrier"] == "front" else 1]
            shank = axle - knee
            # About +y: against the angle from x to z.
            turns.append((wheels["rotor_inertia_kgm2"], spin - (pitch - np.arctan(shank[1] / shank[0]))))
            turns += [(joints["armature_kgm2"], angle) for angle in angles]
            axles.append(spin)
        return points, turns, axles

    def rates(self, q, rates):
        """Square roots of masses times speeds, all in one vector: half its square is the kinetic energy."""
        points, turns, _ = self.places(q + 1e-30j * rates)
        parts = [np.sqrt(m) * place.imag * 1e30 for m, place in points]
        return np.concatenate(parts + [[np.sqrt(i) * np.imag(a) * 1e30 for i, a in turns]])

    def slope(self, q):
        """Derivative of the potential energy."""
        slope = np.zeros(5)
        for i, unit in enumerate(np.eye(5)):
            points, _, _ = self.places(q + 1e-30j * unit)
            slope[i] = sum(m * GRAVITY * np.imag(p[2]) * 1e30 for m, p in points)
        return slope

    def linear(self):
        def moment(lean):
            return self.slope(np.array([0, 0, lean, lean, 0]))[2:].sum()

        lean = brentq(moment, -1, 1, xtol=1e-15)
        q = np.array([0, 0, lean, lean, 0])
        jacobian = np.column_stack([self.rates(q, unit) for unit in np.eye(5)])
        mass = jacobian.T @ jacobian
        step = 1e-4
        stiffness = np.column_stack(
            [
                (8 * (self.slope(q + step * u) - self.slope(q - step * u))
                 - (self.slope(q + 2 * step * u) - self.slope(q - 2 * step * u))) / (12 * step)
                for u in np.eye(5)
            ]
        )
        work = np.zeros((5, 4))
        for i, unit in enumerate(np.eye(5)):
            _, _, spins = self.places(q + 1e-30j * unit)
            work[i, :2] = np.imag(spins) * 1e30
        for leg in (0, 1):
            work[2 + leg, leg] -= 1
            work[2 + leg, 2 + leg] += 1
            work[4, 2 + leg] -= 1
        a, b = np.zeros((10, 10)), np.zeros((10, 4))
        a[0::2, 1::2] = np.eye(5)
        a[1::2, 0::2] = -np.linalg.solve(mass, stiffness)
        b[1::2] = np.linalg.solve(mass, work)
        return a, b, lean, self.slope(q)[2:4]


def main():
    file, left, right, com_x, carrier = sys.argv[1:]
    robot = Robot(file, [float(left), float(right)], float(com_x), carrier)
    a, b, lean, leg_nm = robot.linear()
    both = np.zeros((14, 14))
    both[:10, :10], both[:10, 10:] = a, b
    held = expm(both * TICK)
    ad, bd = held[:10, :10], held[:10, 10:]
    control = robot.file["control"]
    q, r = (np.diag(control["weights"][w]) * TICK for w in ("q", "r"))
    cost = solve_discrete_are(ad, bd, q, r)
    k = np.linalg.solve(r + bd.T @ cost @ bd, bd.T @ cost @ ad)
    late = k @ np.linalg.matrix_power(ad - bd @ k, round(control["delay_s"] / TICK))
    result = {"a": a, "b": b, "lean": [lean], "leg_nm": leg_nm, "k": k, "late": late}
    print(json.dumps({name: np.asarray(value).ravel().tolist() for name, value in result.items()}))


main()
