"""The best motion after a push, by direct collocation: two Radau points an interval, in which torques are constant."""

from dataclasses import dataclass

import casadi as ca
import numpy as np
from robot import COORDINATES, FRONT, PITCH, REAR, TORQUES, WHEEL, X

# A push in one instant, as in crates/plant/src/world/push.rs.
PUSH_S = 0.01
# What `cargo xtask envelope --task push` wants, and how long the robot must keep it here before it stands.
SPEED_MPS = 0.05
PITCH_RAD = np.radians(2.0)
STAYS_S = (0.1, 0.9)
# The robot with the largest push stands again after this. Intervals are short up to the first.
LARGEST_S = (0.5, 2.5)
# Wheels that are about to lift; a motion through the air is not looked for.
LEAST_LOAD_N = 2.0
# Slip at which a tyre has three quarters of its friction, where it may slip.
SLIP_MPS = 0.05
# A body that is kept level and at its height: what the motion may deviate.
LEVEL_RAD = 0.02
LEVEL_M = 0.005
# Cost of a change of torque beside that of time in s or push in m/s: between motions as good, the smoother one.
SMOOTH = 1e-6
POINTS = 2


@dataclass(frozen=True)
class Question:
    """`goal` is `still` (least time until the robot stands as before), `criterion` (until speed and pitch stay within
    those of the task) or `largest` (largest push after which it stands again)."""

    goal: str = "still"
    push_mps: float = 1.5
    friction: float = 0.8
    height_m: float = 0.195
    delay_s: float = 0.0
    level: bool = False
    slips: bool = False
    intervals: int = 32


@dataclass
class Answer:
    found: bool
    status: str
    rest_s: float
    push_mps: float
    times_s: np.ndarray
    seen: dict
    variables: ca.DM


def radau():
    """Points, and the matrix that gives the slopes there of a polynomial by its values at the start and at the points."""
    points = np.array([0.0, *ca.collocation_points(POINTS, "radau")])
    powers = np.vander(points, increasing=True)
    slopes = [[k * t ** (k - 1) if k else 0.0 for k in range(POINTS + 1)] for t in points[1:]]
    return points[1:], np.array(slopes) @ np.linalg.inv(powers)


class Program:
    """Variables with bounds and first guesses, constraints with bounds, and a cost."""

    def __init__(self):
        self.variables, self.bounds, self.constraints, self.limits = [], [], [], []
        self.cost = 0.0

    def variable(self, name, count, low, high, first):
        made = ca.MX.sym(name, count)
        full = lambda value: ca.DM(value) if ca.DM(value).numel() == count else ca.DM.ones(count) * value
        self.variables.append(made)
        self.bounds.append((full(low), full(high), full(first)))
        return made

    def require(self, value, low, high):
        count = value.numel()
        self.constraints.append(ca.vec(value))
        self.limits.append((ca.DM.ones(count) * low, ca.DM.ones(count) * high))

    def solve(self, first=None, talks=False):
        options = {
            "expand": True,
            "print_time": False,
            "ipopt.sb": "yes",
            "ipopt.print_level": 5 if talks else 0,
            "ipopt.max_iter": 1000,
            "ipopt.tol": 1e-5,
            # Good enough is a cost that has not changed by 0.04 % in six steps.
            "ipopt.acceptable_tol": 10.0,
            "ipopt.acceptable_constr_viol_tol": 2e-2,
            "ipopt.acceptable_dual_inf_tol": 1e6,
            "ipopt.acceptable_compl_inf_tol": 1e-1,
            "ipopt.acceptable_obj_change_tol": 4e-4,
            "ipopt.acceptable_iter": 6,
        }
        x = ca.vertcat(*self.variables)
        problem = {"x": x, "f": 100.0 * self.cost, "g": ca.vertcat(*self.constraints)}
        solver = ca.nlpsol("solver", "ipopt", problem, options)
        low, high, guess = (ca.vertcat(*it) for it in zip(*self.bounds))
        least, most = (ca.vertcat(*it) for it in zip(*self.limits))
        found = solver(x0=guess if first is None else first, lbx=low, ubx=high, lbg=least, ubg=most)
        return x, found["x"], solver.stats()


class Motion:
    def __init__(self, robot, question):
        self.robot, self.question = robot, question
        self.points, self.slopes = radau()
        self.program = Program()
        self.pose, self.torques = robot.standing(question.height_m)
        self.track = []
        if question.goal == "largest":
            self.rest_s = ca.MX(LARGEST_S[1])
            self.push_mps = self.program.variable("push", 1, 0.1, 6.0, question.push_mps)
            self.program.cost -= self.push_mps
        else:
            self.rest_s = self.program.variable("rest", 1, 0.15, 4.0, 1.0)
            self.push_mps = ca.MX(question.push_mps)
            self.program.cost += self.rest_s
        self.build()

    def phases(self):
        """Name, length in s and number of intervals, one after the other."""
        question = self.question
        late_s = min(question.delay_s, PUSH_S)
        if late_s > 0.0:
            yield "late", ca.MX(late_s), 1
        if late_s < PUSH_S:
            yield "push", ca.MX(PUSH_S - late_s), 2
        if question.goal == "largest":
            yield "recover", ca.MX(LARGEST_S[0] - PUSH_S), question.intervals
            yield "recover", self.rest_s - LARGEST_S[0], question.intervals
        else:
            yield "recover", self.rest_s - PUSH_S, question.intervals
        if question.goal == "criterion":
            for length_s, intervals in zip(STAYS_S, (4, 12)):
                yield "stay", ca.MX(length_s), intervals

    def build(self):
        q, v = ca.MX(self.pose), ca.MX.zeros(COORDINATES)
        began_s, last = ca.MX(0.0), ca.MX(self.torques)
        most_nm = ca.DM([self.robot.wheel_nm, self.robot.hip_nm, self.robot.hip_nm])
        for phase, length_s, intervals in self.phases():
            for index in range(intervals):
                if phase == "late":
                    torque = last
                else:
                    torque = self.program.variable("torque", TORQUES, -most_nm, most_nm, self.torques)
                    self.program.cost += SMOOTH * ca.sumsqr(torque - last)
                step_s = length_s / intervals
                q, v = self.interval(phase, began_s + step_s * index, step_s, (q, v), torque)
                last = torque
            began_s = began_s + length_s
        self.program.require(q[PITCH : REAR + 1] - self.pose[PITCH : REAR + 1], -1e-4, 1e-4)
        self.program.require(v, -1e-3, 1e-3)

    def interval(self, phase, began_s, step_s, start, torque):
        """Adds an interval, and returns coordinates and speeds at its end."""
        program, robot = self.program, self.robot
        ranges = zip([-5.0, -1.0], [5.0, 1.0]), robot.ranges_rad, [(-80.0, 80.0)]
        low, high = (ca.DM(list(it)) for it in zip(*(pair for group in ranges for pair in group)))
        fastest, hardest = ca.DM([5, 25, 30, 30, 90]), ca.DM([1e3, 1e4, 1e4, 1e4, 2e4])
        pushes = phase in ("late", "push")
        push_n = self.push_mps * robot.mass_kg / PUSH_S if pushes else ca.MX(0.0)
        qs, vs, accelerations, grips = [start[0]], [start[1]], [], []
        for _ in self.points:
            qs.append(program.variable("q", COORDINATES, low, high, self.pose))
            vs.append(program.variable("v", COORDINATES, -fastest, fastest, 0.0))
            accelerations.append(program.variable("a", COORDINATES, -hardest, hardest, 0.0))
            grips.append(program.variable("grip", 1, -600.0, 600.0, 0.0))
        for point, row in enumerate(self.slopes):
            a = accelerations[point]
            for values, slope in ((qs, vs[point + 1]), (vs, a)):
                program.require(sum(w * it for w, it in zip(row, values)) - step_s * slope, 0, 0)
            inputs = (qs[point + 1], vs[point + 1], a, torque, grips[point], push_n)
            program.require(robot.equations(*inputs), 0, 0)
            self.require_grip(phase, inputs)
            self.require_bounds(phase, inputs)
            self.track.append((began_s + step_s * self.points[point], robot.seen(*inputs)))
        return qs[-1], vs[-1]

    def require_grip(self, phase, inputs):
        _, _, a, _, grip_n, _ = inputs
        friction = self.question.friction
        load_n, slip_mps = self.robot.tyre(*inputs)
        if self.question.slips:
            self.program.require(grip_n - friction * load_n * ca.tanh(slip_mps / SLIP_MPS), 0, 0)
        else:
            self.program.require(a[X] - self.robot.radius_m * a[WHEEL], 0, 0)
            if phase == "late":
                # Nobody steers yet: rolling is assumed.
                return
            self.program.require(friction * load_n - grip_n, 0, np.inf)
            self.program.require(friction * load_n + grip_n, 0, np.inf)
        self.program.require(load_n, LEAST_LOAD_N, np.inf)

    def require_bounds(self, phase, inputs):
        program, robot, question = self.program, self.robot, self.question
        motors, clearances, length_m = robot.bounds(*inputs)
        if phase != "late":
            program.require(motors, 0, np.inf)
        program.require(clearances, 0, np.inf)
        program.require(length_m, *robot.leg_m)
        seen = dict(zip(robot.names, ca.vertsplit(robot.seen(*inputs))))
        if phase == "stay":
            program.require(seen["hip_mps"], -SPEED_MPS, SPEED_MPS)
            program.require(seen["pitch_rad"], -PITCH_RAD, PITCH_RAD)
        if question.level and phase in ("recover", "stay"):
            height_m = robot.radius_m + question.height_m
            program.require(seen["pitch_rad"], -LEVEL_RAD, LEVEL_RAD)
            program.require(seen["hip_m"], height_m - LEVEL_M, height_m + LEVEL_M)

    def solve(self, first=None, talks=False):
        x, found, stats = self.program.solve(first, talks)
        times_s, seen = (list(it) for it in zip(*self.track))
        look = ca.Function("look", [x], [self.rest_s, self.push_mps, ca.vertcat(*times_s), ca.horzcat(*seen)])
        rest_s, push_mps, times_s, seen = look(found)
        return Answer(
            found=stats["success"],
            status=stats["return_status"],
            rest_s=float(rest_s),
            push_mps=float(push_mps),
            times_s=np.array(times_s).ravel(),
            seen=dict(zip(self.robot.names, np.array(seen))),
            variables=found,
        )
