"""Prints poses of the SO-101's tool as yourdfpy computes them: yourdfpy_poses.py URDF

A line holds five joint angles, and the first three rows of the pose in base_link.
"""

import sys

import numpy
import yourdfpy

robot = yourdfpy.URDF.load(sys.argv[1], load_meshes=False, build_scene_graph=True)
names = ["shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll"]
random = numpy.random.default_rng(7)
for _ in range(200):
    q = random.uniform(-2.0, 2.0, 5)
    robot.update_cfg({**dict(zip(names, q)), "gripper": 0.0})
    pose = robot.get_transform("gripper_frame_link", "base_link")
    print(*map(repr, map(float, [*q, *pose[:3].flatten()])))
