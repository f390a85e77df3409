"""Compares inverse kinematics with roboticstoolbox on the same poses of the SO-101: roboticstoolbox_ik.py [POSES]

    pip install roboticstoolbox-python==1.5.0 ./crates/arm
    python crates/arm/tests/python/roboticstoolbox_ik.py

A pose is that of random joint values within the limits, and the search begins at other such values. Solved is what is within
1e-6 m and 1e-6 rad of the pose, in the parts that the mask counts, and within the limits; roboticstoolbox judges nothing here.
Times are those of the processor, with the call from Python. Each question is asked three times and the shortest counts, since
another program on the same core slows them down; where roboticstoolbox begins anew, it does so elsewhere each time, and so its
luckiest draw counts.
"""

import math
import sys
import time

import numpy
from roboticstoolbox.tools.p_servo import angle_axis
from roboticstoolbox_values import so101

from jiling_arm.ik.robot import create_so101_5dof

poses = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
masks = {"1 1 1 1 1 1": [1] * 6, "1 1 1 1 1 0": [1, 1, 1, 1, 1, 0], "1 1 1 0 0 0": [1, 1, 1, 0, 0, 0]}
robot, chain = create_so101_5dof(), so101()
chain.qlim = robot.qlim
lower, upper = robot.qlim
random = numpy.random.default_rng(16)
questions = [(robot.fkine(random.uniform(lower, upper)), random.uniform(lower, upper)) for _ in range(poses)]


def is_solved(Tep, q, mask):
    if not (lower <= q).all() or not (q <= upper).all():
        return False
    error = numpy.array(mask) * angle_axis(chain.fkine(q).A, Tep)
    return numpy.linalg.norm(error[:3]) < 1.01e-6 and numpy.linalg.norm(error[3:]) < 1.01e-6


def toolbox(limits, tol):
    return lambda Tep, q0, mask: chain.ik_LM(Tep, q0=q0, mask=mask, joint_limits=limits, tol=tol)[0]


solvers = {
    "jiling_arm": lambda Tep, q0, mask: robot.ikine_LM(Tep, q0=q0, mask=mask)[0],
    # Its tolerance is of half the squared error: this is 1e-6 of the error.
    "roboticstoolbox": toolbox(True, 5e-13),
    "roboticstoolbox, limits off": toolbox(False, 5e-13),
    "roboticstoolbox, limits off, its own tolerance": toolbox(False, 1e-6),
}
print(f"{'solver':47} {'mask':12} solved  mean us   p99 us")
for mask_name, mask in masks.items():
    for name, solve in solvers.items():
        mask_array, times, solved = numpy.array(mask, float), [], 0
        for Tep, q0 in questions:
            shortest = math.inf
            for _ in range(3):
                begin = time.thread_time_ns()
                q = solve(Tep, q0, mask_array)
                shortest = min(shortest, time.thread_time_ns() - begin)
            times.append(shortest / 1000)
            solved += is_solved(Tep, q, mask)
        print(f"{name:47} {mask_name:12} {solved:6} {numpy.mean(times):8.1f} {numpy.quantile(times, 0.99):8.1f}", flush=True)
