"""The policy of `planar_search.py` for the whole robot: both sides, roll and turns, from the observation to the actions."""

import json

import numpy

import planar_search
from circuit import FREE, Circuit
from planar import HIP_NM, RADIUS_M, WHEEL_NM

# Places in the observation of `policy/fivebar/flat`: one frame has 22 values, and commands follow three frames.
FRAME, HIPS, HIP_SPEEDS, WHEELS, RATES, GRAVITY, LAST = 22, 0, 4, 8, 10, 13, 16
FORWARD, TURN, WIDTH = 66, 68, 69
# What the observation is multiplied with, and what an action means (config.yaml).
RATE, SPEED, TURNS = 0.25, 0.05, 0.5
HIP_ACTION_RAD, WHEEL_ACTION_RPS = 0.25, 10.0
HIP_KP, HIP_KD, WHEEL_KD = planar_search.GAINS
HALF_TRACK_M = 0.21
FAST_RPS, SPINS_RPS, MOST_RPS = 26.0, 29.0, 80.0
# The runner stops a robot of which one wheel runs at 32.5 rad/s: one that is faster than WHEEL_RPS gets less torque.
WHEEL_RPS, WHEEL_OVER_NM = 26.0, 0.7
# It also stops one of which a hip is asked for more than its torque for half a second. A leg that carries a heavy robot alone would be
# asked to unfold with more: its motor gives no more, so nothing is lost by asking for less. To fold legs that are folded already means
# that the robot lies and does not get up, as with a wheel that counts the other way round: that shall end it.
HIP_UNFOLDS_NM = 0.98 * HIP_NM
# The default pose (base.yaml): legs folded. Angles here count from that of `planar.py`, those of an observation and of an action from
# the default pose.
DEFAULT_SWING_RAD, DEFAULT_FOLD_RAD = 0.0, 0.2
# Front hips count up when thighs rise, rear hips when they sink.
FRONT = (1.0, -1.0, 1.0, -1.0)
LEFT = (1.0, 1.0, -1.0, -1.0)
ROLLS = tuple(front * left for front, left in zip(FRONT, LEFT))
# What the search in the plane does not find, and `whole_search.py` does. name: guess, spread
FACTORS = {
    # Longer left leg in rad per rad of roll to the left and rad/s, and the share of it that stays. N·m per rad/s of the wheels.
    "roll_rad": (0.53, 0.1), "roll_rate_rad": (0.024, 0.006), "roll_hold": (0.81, 0.05), "turn_nm": (0.7, 0.15),
    # A robot sits on an edge by so much as pitch (its sine) + lies_folded · fold of the legs is beyond lies_rad: one with folded
    # legs early, one that stands not before it falls. For each unit it folds its legs, and swings them forward in a step. Wheels
    # faster than SPINS_RPS, less lies_rps for each unit, lose torque.
    "lies_folded": (0.5, 0.1), "lies_rad": (0.05, 0.05), "lies_fold": (3.3, 0.6), "lies_swing": (0.0, 0.02),
    "lies_rps": (5.0, 6.0), "spins_nm": (0.4, 0.1),
    # What is kept of a swing beyond this returns by this share a step.
    "centre_rad": (0.18, 0.04), "centre_by": (0.05, 0.02),
}
GUESS = {name: guess for name, (guess, _) in FACTORS.items()}
# Greatest fold of the legs, a little more than their stops.
FOLD_MOST_RAD = 0.3
# More than this does not count.
LIES_MOST = 0.45


def inputs(circuit):
    """Names what the robot sees, in SI units, now and one step ago (`…'`)."""
    for age, mark in ((0, ""), (1, "'")):
        base = FRAME * age
        hips = lambda first, signs, unit: {base + first + n: sign / 4 * unit for n, sign in enumerate(signs)}
        both = (1.0, 1.0, 1.0, 1.0)
        circuit.name("pitch" + mark, {base + GRAVITY: 1.0})
        circuit.name("roll" + mark, {base + GRAVITY + 1: 1.0})
        circuit.name("rate" + mark, {base + RATES + 1: 1 / RATE})
        circuit.name("roll_rate" + mark, {base + RATES: 1 / RATE})
        circuit.name("turns" + mark, {base + WHEELS: 0.5 / SPEED, base + WHEELS + 1: 0.5 / SPEED})
        circuit.name("lean" + mark, hips(HIPS, both, 1.0))
        circuit.name("lean_rate" + mark, hips(HIP_SPEEDS, both, 1 / SPEED))
        circuit.name("folded" + mark, hips(HIPS, FRONT, 1.0))
        circuit.name("swing" + mark, hips(LAST, both, HIP_ACTION_RAD))
        circuit.name("fold" + mark, hips(LAST, FRONT, HIP_ACTION_RAD))
        circuit.name("tilt" + mark, hips(LAST, ROLLS, HIP_ACTION_RAD))
    circuit.name("left_rps", {WHEELS: 1 / SPEED})
    circuit.name("right_rps", {WHEELS + 1: 1 / SPEED})
    circuit.name("wanted_rps", {FORWARD: 1 / RADIUS_M})
    circuit.name("differ_rps", {WHEELS: 0.5 / SPEED, WHEELS + 1: -0.5 / SPEED, TURN: HALF_TRACK_M / RADIUS_M / TURNS})


def network(f):
    """Returns the layers for a set of factors: those of the plane with `stand_rad`, and these, which are guesses where not given."""
    f = {**GUESS, **f}
    circuit = Circuit(WIDTH)
    inputs(circuit)
    most, held = f["most_rps"], f["most_held_rps"]
    for mark in ("", "'"):
        circuit.add("error" + mark, {"turns" + mark: 1.0, "wanted_rps": -1.0}, low=-most, high=most)
        falls = {"rate" + mark: 1.0, "pitch" + mark: f["fall_pitch"], "error" + mark: f["fall_speed"]}
        circuit.add("falls" + mark, falls)
        circuit.add("less" + mark, falls, low=-f["falls_at"], high=f["falls_at"])
    circuit.add("held", {"turns": 1.0, "wanted_rps": -1.0}, low=-held, high=held)
    circuit.add("slow", {"turns": 1.0}, low=-FAST_RPS, high=FAST_RPS)
    away = f["lies_folded"] * DEFAULT_FOLD_RAD - f["lies_rad"]
    circuit.add("lies_ahead", {"pitch": 1.0, "folded": f["lies_folded"]}, bias=away, low=0.0, high=LIES_MOST)
    circuit.add("lies_behind", {"pitch": -1.0, "folded": f["lies_folded"]}, bias=away, low=0.0, high=LIES_MOST)
    quick = {"pitch": f["pitch_rad"], "rate": f["rate_rad"], "error": f["speed_rad"], "lean": f["swing_rad"],
             "lean_rate": f["swing_rate_rad"], "falls": f["falls_rad"], "less": -f["falls_rad"]}
    was = {name + "'": -factor for name, factor in quick.items()}
    away = DEFAULT_SWING_RAD * (1 - f["swing_rad"])
    circuit.add("kept", {**was, "swing": 1.0}, bias=away)
    circuit.add("near", {**was, "swing": 1.0}, bias=away, low=-f["centre_rad"], high=f["centre_rad"])
    swing = {**quick, **was, "swing": 1.0, "held": f["hold"],
             "kept": -f["centre_by"], "near": f["centre_by"],
             "lies_ahead": f["lies_swing"], "lies_behind": -f["lies_swing"]}
    circuit.add("new_swing", swing, low=-1.0 - DEFAULT_SWING_RAD, high=1.0 - DEFAULT_SWING_RAD)
    by = planar_search.STANDS_BY
    fold = {"fold": 1 - by, "lies_ahead": by * f["lies_fold"], "lies_behind": by * f["lies_fold"]}
    circuit.add("new_fold", fold, bias=by * (f["stand_rad"] - DEFAULT_FOLD_RAD), low=-1.75 - DEFAULT_FOLD_RAD, high=FOLD_MOST_RAD - DEFAULT_FOLD_RAD)
    torque = {"pitch": f["pitch_nm"], "rate": f["rate_nm"] * (1 + f["lead"]), "rate'": -f["rate_nm"] * f["lead"], "error": f["speed_nm"],
              "lean": f["swing_nm"], "lean_rate": f["swing_rate_nm"], "swing": f["held_nm"], "falls": f["falls_nm"],
              "less": -f["falls_nm"], "turns": -f["fast_nm"], "slow": f["fast_nm"]}
    away = DEFAULT_SWING_RAD * (f["swing_nm"] + f["held_nm"])
    circuit.add("torque", torque, bias=away, low=-WHEEL_NM, high=WHEEL_NM)
    hold = f["roll_hold"]
    tilt = {"tilt": hold, "roll": (1 - hold) * f["roll_rad"], "roll_rate": -(1 - hold) * f["roll_rate_rad"]}
    circuit.add("new_tilt", tilt, low=-0.5, high=0.5)
    circuit.add("turn", {"differ_rps": -f["turn_nm"]}, low=-WHEEL_NM, high=WHEEL_NM)
    # Wheels of a robot that sits slip: they shall not run away.
    circuit.add("spins_ahead", {"turns": 1.0, "lies_ahead": f["lies_rps"]}, bias=-SPINS_RPS, low=0.0)
    circuit.add("spins_behind", {"turns": -1.0, "lies_behind": f["lies_rps"]}, bias=-SPINS_RPS, low=0.0)
    for wheel, sign in (("left", 1.0), ("right", -1.0)):
        circuit.add(f"{wheel}_ahead", {f"{wheel}_rps": 1.0}, bias=-WHEEL_RPS, low=0.0)
        circuit.add(f"{wheel}_behind", {f"{wheel}_rps": -1.0}, bias=-WHEEL_RPS, low=0.0)
        torque = {"torque": 1.0, f"{wheel}_ahead": -WHEEL_OVER_NM, f"{wheel}_behind": WHEEL_OVER_NM, "spins_ahead": -f["spins_nm"], "spins_behind": f["spins_nm"], "turn": sign}
        circuit.add(f"{wheel}_nm", torque, low=-WHEEL_NM, high=WHEEL_NM)
    for hip, (front, rolls) in enumerate(zip(FRONT, ROLLS)):
        circuit.name(f"idle{hip}", {HIPS + hip: 1.0, HIP_SPEEDS + hip: HIP_KD / HIP_KP / SPEED})
        pull = {"new_swing": 1.0, "new_fold": front, "new_tilt": rolls, f"idle{hip}": -1.0}
        most = HIP_UNFOLDS_NM / HIP_KP
        low, high = (-most, FREE) if front > 0 else (-FREE, most)
        circuit.add(f"pull{hip}", pull, low=low, high=high)
        circuit.add(f"hip{hip}", {f"idle{hip}": 1 / HIP_ACTION_RAD, f"pull{hip}": 1 / HIP_ACTION_RAD})
    for wheel in ("left", "right"):
        limit = MOST_RPS / WHEEL_ACTION_RPS
        circuit.add(f"{wheel}_wheel", {f"{wheel}_rps": 1 / WHEEL_ACTION_RPS, f"{wheel}_nm": 1 / WHEEL_KD / WHEEL_ACTION_RPS}, low=-limit, high=limit)
    return circuit.layers(["hip0", "hip1", "hip2", "hip3", "left_wheel", "right_wheel"])


def factors_of(path):
    """Reads the factors of a network of `export.py`, or of a file of `planar_search.py` or `whole_search.py`."""
    return {**GUESS, **read(path)[0]}


def read(path):
    """Returns the factors of such a file, and the arguments of the search that found them."""
    if path.suffix == ".onnx":
        import onnx

        said = {entry.key: entry.value for entry in onnx.load(path).metadata_props}
        if "factors" not in said:
            raise SystemExit(f"{path}: it was not made of factors alone (export.py --factors)")
        return json.loads(said["factors"]), said["arguments"]
    file = numpy.load(path)
    values = {name: file[name] for name in file.files if file[name].ndim == 0 and file[name].dtype.kind == "f"}
    return {name: float(value) for name, value in values.items()}, str(file["arguments"])
