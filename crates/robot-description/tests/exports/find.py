"""Prints what MuJoCo and yourdfpy find in a robot's files: find.py FREE.xml CLAMPED.xml ROBOT.urdf HIPS..."""

import json
import sys

import mujoco
import numpy as np
import yourdfpy

LIMBS = [f"{side}_{end}" for side in ("left", "right") for end in ("front", "rear")]
# Any angles do: both trees are open.
KNEES_RAD = [-1.2, 1.7, -2.1, 0.6]
WHEELS_RAD = [0.4, -0.9]
SPEEDS_RPS = np.linspace(-3.0, 4.0, 10)


def angles(hips):
    """Angle of each joint by its name."""
    named = {}
    for limb, hip, knee in zip(LIMBS, hips, KNEES_RAD):
        named[f"{limb}_hip"] = hip
        named[f"{limb}_knee"] = knee
    return named | dict(zip(("left_wheel", "right_wheel"), WHEELS_RAD))


def posed(model, named):
    """A state of the model with the angles, and speeds that differ from joint to joint."""
    data = mujoco.MjData(model)
    order = []
    for speed, (name, angle) in zip(SPEEDS_RPS, named.items()):
        joint = model.joint(name)
        data.qpos[joint.qposadr] = angle
        data.qvel[joint.dofadr] = speed
        order.append(joint.dofadr[0])
    mujoco.mj_forward(model, data)
    return data, order


def tree_of(model, data, order):
    """Mass matrix without rotors, and bias forces, in the order of the joints' names."""
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    full -= np.diag(model.dof_armature)
    return full[np.ix_(order, order)], data.qfrc_bias[order]


def start(free):
    data = mujoco.MjData(free)
    mujoco.mj_resetDataKeyframe(free, data, free.key("stand").id)
    mujoco.mj_forward(free, data)
    body = data.body("body").xpos
    return {
        "mass_kg": free.body("body").subtreemass[0],
        "axles_m": {limb: list(data.site(f"{limb}_axle").xpos - body) for limb in LIMBS},
        "wheels_m": {side: list(data.body(f"{side}_wheel").xpos) for side in ("left", "right")},
        "wheel_parents": {
            side: free.body(free.body(f"{side}_wheel").parentid[0]).name for side in ("left", "right")
        },
    }


def main(free, clamped, urdf_file, hips):
    named = angles(hips)
    free = mujoco.MjModel.from_xml_path(free)
    clamped = mujoco.MjModel.from_xml_path(clamped)
    from_urdf = mujoco.MjModel.from_xml_path(urdf_file)
    # URDF has no gravity.
    from_urdf.opt.gravity = clamped.opt.gravity
    in_mjcf, order = posed(clamped, named)
    in_urdf, urdf_order = posed(from_urdf, named)
    mass, bias = tree_of(clamped, in_mjcf, order)
    urdf_mass, urdf_bias = tree_of(from_urdf, in_urdf, urdf_order)

    reader = yourdfpy.URDF.load(urdf_file, load_meshes=False)
    reader.update_cfg(named)
    complaints = [] if reader.validate() else [str(error) for error in reader.errors]
    origin = in_mjcf.body("body").xpos

    def seen(body):
        return in_mjcf.body(body).xpos - origin

    def read(body):
        return reader.get_transform(body, "body")[:3, 3]

    moving = [f"{limb}_{part}" for limb in LIMBS for part in ("thigh", "shank")] + ["left_wheel", "right_wheel"]
    inertials = [link.inertial for link in reader.robot.links if link.inertial]
    found = {
        "mjcf": start(free) | {"knees_m": {limb: list(seen(f"{limb}_shank")) for limb in LIMBS}},
        "urdf": {
            "mass_kg": sum(inertial.mass for inertial in inertials),
            "knees_m": {limb: list(read(f"{limb}_shank")) for limb in LIMBS},
            "complaints": complaints,
            "apart_from_mjcf": {
                "mass_matrix": abs(mass - urdf_mass).max(),
                "bias_nm": abs(bias - urdf_bias).max(),
                # Relative to the body, which the URDF has at the world's origin.
                "places_m": max(abs(seen(body) - in_urdf.body(body).xpos).max() for body in moving),
                "yourdfpy_places_m": max(abs(seen(body) - read(body)).max() for body in moving),
            },
        },
    }
    print(json.dumps(found))


main(*sys.argv[1:4], [float(word) for word in sys.argv[4:]])
