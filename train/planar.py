"""A model of the robot in the plane in which it balances, for thousands of robots at once.

`planar_search.py` finds a policy in it within minutes; the whole robot is in `jiling_gym`. Both agree on the path of a pushed robot
within some centimetres a second until it falls. Left and right are one here: nothing rolls or turns.

A wheel stands on the ground and may slip. A leg of length L leans forward by phi, a body is pitched by theta, and the torque of
the hips acts between them. Axes: x forward, z up; angles are positive nose down. SI units and radians.

    body's centre = (x + L sin phi + c sin theta + d cos theta, r + L cos phi + c cos theta - d sin theta)
"""

import jax
import jax.numpy as jnp
import numpy

RADIUS_M, GRAVITY = 0.075, 9.81
STEP_S, SUBSTEP_S = 0.02, 0.002
SUBSTEPS = round(STEP_S / SUBSTEP_S)
# Wheels with their motors and the lower half of the shanks; body with thighs and the upper half (robots/fivebar.toml).
AXLE_KG, BODY_KG, BODY_KGM2 = 1.57, 4.98, 0.036
ROTORS_KGM2, WHEELS_KGM2, LEGS_KGM2, HIPS_KGM2 = 0.019, 0.0024, 0.006, 0.0072
SPIN_KGM2 = ROTORS_KGM2 + WHEELS_KGM2
# Of the legs.
HALF_GAP_M, THIGH_M, SHANK_M = 0.05, 0.12, 0.22
WHEEL_NM, HIP_NM = 4.5, 5.0
WHEEL_RPS = 33.0
# Speed of slip at which a tyre holds as much as it can.
SLIP_MPS = 0.08
DRY_NM, VISCOUS_NM = 0.28, 0.0037
# Angle of the thighs above the level when legs are folded.
FOLDED_RAD = 0.5


def leg(fold):
    """Length of a leg, and what changes with the fold, the mean angle of front and rear thighs up from the folded legs: the
    length, and the angle between leg and rear shank, which carries the wheel's motor."""
    sink = -(fold + FOLDED_RAD)
    knee_m = HALF_GAP_M + THIGH_M * jnp.cos(sink)
    shank_m = jnp.sqrt(SHANK_M**2 - knee_m**2)
    length = THIGH_M * jnp.sin(sink) + shank_m
    by_sink = THIGH_M * jnp.cos(sink) + knee_m * THIGH_M * jnp.sin(sink) / shank_m
    return length, -by_sink, THIGH_M * jnp.sin(sink) / shank_m


def robots(numbers, count, vary=True):
    """Draws robots as the environment does: mass, centre, friction, torque, delay, error of the board's pitch."""
    between = lambda low, high: numbers.uniform(low, high, count) if vary else numpy.full(count, (low + high) / 2)
    factor = between(0.8, 1.4) if vary else numpy.ones(count)
    body_kg = BODY_KG + (AXLE_KG + BODY_KG) * (factor - 1)
    drawn = {
        "kg": body_kg, "kgm2": BODY_KGM2 * body_kg / BODY_KG, "up_m": 0.017 + between(-0.03, 0.03), "ahead_m": between(-0.03, 0.03),
        "friction": between(0.4, 1.2), "strength": between(0.9, 1.1), "delay_s": 0.0015 + between(0.003, 0.008) + between(0.0, 0.005),
        "askew_rad": between(-0.0175, 0.0175),
    }
    return {name: jnp.asarray(values, jnp.float32) for name, values in drawn.items()}


def start(fold, speed_mps, pitch_rad):
    """A standing robot: speed, wheel, fold, phi, theta and their rates, torque of the wheels, force of the ground."""
    zero = jnp.zeros_like(speed_mps)
    return {
        "v": speed_mps, "spin": speed_mps / RADIUS_M, "fold": zero + fold, "phi": pitch_rad, "theta": pitch_rad,
        "dfold": zero, "dphi": zero, "dtheta": zero, "wheel_nm": zero, "normal_n": zero + (AXLE_KG + BODY_KG) * GRAVITY,
    }


def solve(matrix, right):
    """Solves symmetric positive equations, elementwise over robots, without pivoting."""
    size = len(right)
    matrix, right = [list(row) for row in matrix], list(right)
    for at in range(size):
        for row in range(at + 1, size):
            share = matrix[row][at] / matrix[at][at]
            for column in range(at + 1, size):
                matrix[row][column] = matrix[row][column] - share * matrix[at][column]
            right[row] = right[row] - share * right[at]
    found = [None] * size
    for row in reversed(range(size)):
        rest = sum((matrix[row][column] * found[column] for column in range(row + 1, size)), 0.0)
        found[row] = (right[row] - rest) / matrix[row][row]
    return found


def turning(s):
    """Speed of the wheels against their shanks, which the motors measure."""
    return s["spin"] - s["dphi"] + leg(s["fold"])[2] * s["dfold"]


def substep(s, robot, wheel_nm, swing_nm, fold_nm, push_n):
    """Moves all robots by SUBSTEP_S under the torque of both wheels, the hips' torques of swing and fold, and a push."""
    kg, up_m, ahead_m = robot["kg"], robot["up_m"], robot["ahead_m"]
    length, by_fold, opens = leg(s["fold"])
    rate = by_fold * s["dfold"]
    sp, cp, st, ct = jnp.sin(s["phi"]), jnp.cos(s["phi"]), jnp.sin(s["theta"]), jnp.cos(s["theta"])
    c1, c2 = up_m * ct - ahead_m * st, up_m * st + ahead_m * ct
    # How the body's centre moves with x, phi, theta and fold: columns of its Jacobian.
    ways = ((1.0, 0.0), (length * cp, -length * sp), (c1, -c2), (by_fold * sp, by_fold * cp))
    ax = 2 * rate * cp * s["dphi"] - length * sp * s["dphi"] ** 2 - c2 * s["dtheta"] ** 2
    az = -2 * rate * sp * s["dphi"] - length * cp * s["dphi"] ** 2 - c1 * s["dtheta"] ** 2
    mass = [[kg * (a[0] * b[0] + a[1] * b[1]) for b in ways] for a in ways]
    mass[0][0] = mass[0][0] + AXLE_KG
    mass[1][1] = mass[1][1] + LEGS_KGM2 + ROTORS_KGM2 * WHEELS_KGM2 / SPIN_KGM2 + HIPS_KGM2
    mass[1][2] = mass[1][2] - HIPS_KGM2
    mass[2][1] = mass[2][1] - HIPS_KGM2
    mass[2][2] = mass[2][2] + robot["kgm2"] + HIPS_KGM2
    mass[3][3] = mass[3][3] + HIPS_KGM2 + 0.002
    turns = turning(s)
    wheel_nm = wheel_nm - DRY_NM * jnp.tanh(turns / 0.5) - VISCOUS_NM * turns
    hold_n = robot["friction"] * jnp.maximum(s["normal_n"], 0.0) * jnp.clip((RADIUS_M * s["spin"] - s["v"]) / SLIP_MPS, -1, 1)
    force = [kg * (-a[0] * ax - a[1] * (az + GRAVITY)) + a[0] * push_n for a in ways]
    force[0] = force[0] + hold_n
    # Of the torque on the shank.
    back_nm = (ROTORS_KGM2 * RADIUS_M * hold_n + WHEELS_KGM2 * wheel_nm) / SPIN_KGM2
    force[1] = force[1] - back_nm - swing_nm
    force[2] = force[2] + swing_nm
    force[3] = force[3] + fold_nm + opens * back_nm
    av, aphi, atheta, afold = solve(mass, force)
    aspin = (wheel_nm - RADIUS_M * hold_n + ROTORS_KGM2 * aphi) / SPIN_KGM2
    lift = az + sum(way[1] * a for way, a in zip(ways, (av, aphi, atheta, afold)))
    new = {**s, "v": s["v"] + SUBSTEP_S * av, "spin": s["spin"] + SUBSTEP_S * aspin, "normal_n": AXLE_KG * GRAVITY + kg * (GRAVITY + lift)}
    for name, acceleration in (("phi", aphi), ("theta", atheta), ("fold", afold)):
        new["d" + name] = s["d" + name] + SUBSTEP_S * acceleration
        new[name] = s[name] + SUBSTEP_S * new["d" + name]
    return new


def step(s, robot, last, now, gains, push_n):
    """Moves all robots by STEP_S. `last` and `now` are targets: swing and fold in rad, speed of the wheels in rad/s."""
    kp, kd, wheel_kd = gains

    def once(index, s):
        arrived = (index + 1) * SUBSTEP_S > robot["delay_s"]
        swing, fold, turns = (jnp.where(arrived, new, old) for old, new in zip(last, now))
        wanted = 2 * robot["strength"] * jnp.clip(wheel_kd * (turns - turning(s)), -WHEEL_NM, WHEEL_NM)
        wheel_nm = s["wheel_nm"] + 0.6 * (wanted - s["wheel_nm"])
        lean, dlean = s["theta"] - s["phi"], s["dtheta"] - s["dphi"]
        motors = [
            robot["strength"] * jnp.clip(kp * (swing + sign * fold - lean - sign * s["fold"]) - kd * (dlean + sign * s["dfold"]), -HIP_NM, HIP_NM)
            for sign in (1, -1)
        ]
        moved = substep(s, robot, wheel_nm, 2 * (motors[0] + motors[1]), 2 * (motors[0] - motors[1]), jnp.where(index < SUBSTEPS // 2, push_n, 0.0))
        return {**moved, "wheel_nm": wheel_nm}

    return jax.lax.fori_loop(0, SUBSTEPS, once, s)


def seen(s, robot):
    """What the policy sees: pitch, its rate, speed of the wheels, swing, its rate, fold, its rate."""
    turns = jnp.clip(turning(s), -WHEEL_RPS, WHEEL_RPS)
    return (
        jnp.sin(s["theta"] + robot["askew_rad"]), s["dtheta"], turns, s["theta"] - s["phi"], s["dtheta"] - s["dphi"], s["fold"], s["dfold"],
    )
