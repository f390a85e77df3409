"""Legs for the tests of leg.rs, from a solver that shares no formula with it: the axle is the root of two distances,
and all rates are differences. Needs SciPy. Prints the rows of vectors.csv."""

import numpy as np
from scipy.optimize import fsolve

STEP = 1e-5


def knees(gap, thigh, front, rear):
    return (
        np.array([gap / 2 + thigh * np.cos(front), thigh * np.sin(front)]),
        np.array([-gap / 2 - thigh * np.cos(rear), -thigh * np.sin(rear)]),
    )


def pose(gap, thigh, shank, front, rear):
    """Leg length, leg angle, and the angles of both shanks about +y."""
    a, b = knees(gap, thigh, front, rear)

    def closed(p):
        return [np.hypot(*(p - a)) - shank, np.hypot(*(p - b)) - shank]

    axle = fsolve(closed, [0.0, -shank], xtol=1e-13)
    turn = [np.arctan2(end[0], end[1]) for end in (axle - a, axle - b)]
    return np.array([np.hypot(*axle), np.arctan2(axle[0], -axle[1]), *turn])


def slope(gap, thigh, shank, front, rear, joint):
    step = np.eye(2)[joint] * STEP
    ahead = pose(gap, thigh, shank, front + step[0], rear + step[1])
    behind = pose(gap, thigh, shank, front - step[0], rear - step[1])
    change = (ahead - behind + np.pi) % (2 * np.pi) - np.pi
    return change / (2 * STEP)


print("gap,thigh,shank,front,rear,length,angle,length_f,length_r,angle_f,angle_r,front_f,front_r,rear_f,rear_r")
random = np.random.default_rng(14)
for lengths in ((0.10, 0.12, 0.22), (0.15, 0.15, 0.27), (0.08, 0.08, 0.16)):
    for _ in range(20):
        joints = random.uniform([-1.35, -0.75], [0.75, 1.35])
        length, angle, *_ = pose(*lengths, *joints)
        f, r = slope(*lengths, *joints, 0), slope(*lengths, *joints, 1)
        row = [*lengths, *joints, length, angle, f[0], r[0], f[1], r[1], f[2], r[2], f[3], r[3]]
        print(",".join(f"{value:.7f}" for value in row))
