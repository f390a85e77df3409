"""Balances a robot in MuJoCo with given gains: balance.py ROBOT.xml < QUESTION.json > ANSWER.json

The state is MuJoCo's own. Torques come late by whole milliseconds, and the motors of the file limit them.
"""

import json
import sys
from collections import deque

import mujoco
import numpy as np

SIDES = ["left", "right"]
TICK_S = 0.001
# Springs of the legs, beside what they carry.
LENGTH_N_PER_M = 1500.0
LENGTH_N_PER_MPS = 60.0


class Leg:
    """Length, angle and their derivatives by the two hips, from MuJoCo's Jacobians in body axes."""

    def __init__(self, model, side):
        self.side = side
        ends = [f"{side}_front", f"{side}_rear"]
        self.hips = [model.joint(f"{end}_hip").dofadr[0] for end in ends]
        self.knees = [model.joint(f"{end}_knee").dofadr[0] for end in ends]
        self.sites = [model.site(f"{end}_axle").id for end in ends]
        self.carrier = model.body(f"{side}_wheel").parentid[0]
        self.wheel = model.joint(f"{side}_wheel").dofadr[0]

    def measure(self, model, data):
        body = data.body("body")
        turn = body.xmat.reshape(3, 3)
        rows = []
        for site in self.sites:
            slopes = np.zeros((3, model.nv))
            mujoco.mj_jacSite(model, data, slopes, None, site)
            rows.append((turn.T @ slopes)[[0, 2]])
        front, rear = rows
        gap = front - rear
        self.by_knees = -np.linalg.solve(gap[:, self.knees], gap[:, self.hips])
        axle = (turn.T @ (data.site_xpos[self.sites[0]] - body.xpos))[[0, 2]]
        slopes = front[:, self.hips] + front[:, self.knees] @ self.by_knees
        self.length, self.angle = np.hypot(*axle), np.arctan2(axle[0], -axle[1])
        self.by_length = axle @ slopes / self.length
        self.by_angle = np.array([-axle[1], axle[0]]) @ slopes / self.length**2
        turns = np.zeros((3, model.nv))
        mujoco.mj_jacBody(model, data, None, turns, self.carrier)
        turns = (turn.T @ turns)[1]
        self.by_carrier = turns[self.hips] + turns[self.knees] @ self.by_knees
        speeds = data.qvel[self.hips]
        self.length_rate, self.angle_rate = self.by_length @ speeds, self.by_angle @ speeds
        moving = np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, moving, None, self.sites[0])
        self.place, self.velocity = data.site_xpos[self.sites[0]].copy(), moving @ data.qvel


def attitude(data):
    turn = data.body("body").xmat.reshape(3, 3)
    yaw = np.arctan2(turn[1, 0], turn[0, 0])
    pitch = -np.arcsin(np.clip(turn[2, 0], -1.0, 1.0))
    return yaw, pitch, turn @ data.qvel[3:6]


class Robot:
    def __init__(self, file, question):
        self.question = question
        self.model = mujoco.MjModel.from_xml_path(file)
        self.data = mujoco.MjData(self.model)
        self.legs = [Leg(self.model, side) for side in SIDES]
        self.steps = round(TICK_S / self.model.opt.timestep)
        self.gains = np.array(question["gains"])
        self.late = deque([np.zeros(6)] * question["delay_ticks"])
        self.way = 0.0

    def state(self):
        yaw, pitch, rate = attitude(self.data)
        ahead = np.array([np.cos(yaw), np.sin(yaw), 0.0])
        pitch_rate = rate @ np.array([-np.sin(yaw), np.cos(yaw), 0.0])
        speed = np.mean([leg.velocity @ ahead for leg in self.legs])
        self.way += speed * TICK_S
        found = [self.way, speed, yaw, rate[2]]
        for leg in self.legs:
            found += [pitch - leg.angle, pitch_rate - leg.angle_rate]
        return np.array(found + [pitch, pitch_rate])

    def torques(self, state):
        """Of hips and wheels, in the order of the motors."""
        question = self.question
        lean = question["lean_rad"]
        wanted = np.array([0, 0, 0, 0, lean, 0, lean, 0, 0, 0])
        wheels, legs = np.split(-self.gains @ (state - wanted), 2)
        legs = legs + question["leg_torque_nm"]
        hips = []
        for leg, wheel_nm, leg_nm in zip(self.legs, wheels, legs):
            force = (
                question["carried_n"] / 2
                + LENGTH_N_PER_M * (question["length_m"] - leg.length)
                - LENGTH_N_PER_MPS * leg.length_rate
            )
            # The reaction of the wheel is to act on the leg as a whole, not on one shank.
            reaction = wheel_nm * (leg.by_angle + leg.by_carrier)
            hips.append(force * leg.by_length - leg_nm * leg.by_angle + reaction)
        return np.concatenate([*hips, wheels])

    def run(self):
        question, data = self.question, self.data
        mujoco.mj_resetDataKeyframe(self.model, data, self.model.key("stand").id)
        half = question["pitch_rad"] / 2
        data.qpos[3:7] = [np.cos(half), 0.0, np.sin(half), 0.0]
        seen, most = [], np.zeros(6)
        for tick in range(round(question["seconds"] / TICK_S)):
            mujoco.mj_forward(self.model, data)
            for leg in self.legs:
                leg.measure(self.model, data)
            state = self.state()
            self.late.append(self.torques(state))
            data.ctrl[:] = self.late.popleft()
            pushed = tick == round(question["push_at_s"] / TICK_S)
            force = np.array(question["push_ns"]) / TICK_S if pushed else np.zeros(3)
            # At the centre of mass of the body, for a millisecond.
            data.xfrc_applied[self.model.body("body").id, :3] = force
            for _ in range(self.steps):
                mujoco.mj_step(self.model, data)
            most = np.maximum(most, abs(data.actuator_force))
            if (tick + 1) % 10 == 0:
                seen.append([data.time, *state, self.legs[0].length])
        return {"moments": [list(row) for row in seen], "most_nm": list(most)}


json.dump(Robot(sys.argv[1], json.load(sys.stdin)).run(), sys.stdout)
