"""Draws docs/images/so101-frames.svg: python crates/arm/tests/python/draw_frames.py (with jiling_arm installed)

The SO-101 with every joint at 0, from its right side and from above, as its URDF and the package place it.
"""

import pathlib

import numpy

from jiling_arm.ik.robot import Robot

repository = pathlib.Path(__file__).resolve().parents[4]
urdf = repository / "crates/arm/tests/data/so101.urdf"
joints = {
    "shoulder_pan": "shoulder_link",
    "shoulder_lift": "upper_arm_link",
    "elbow_flex": "lower_arm_link",
    "wrist_flex": "wrist_link",
    "wrist_roll": "gripper_link",
}
COLOURS = {"x": "#c0392b", "y": "#1e8449", "z": "#1f618d"}
SCALE, ARROW_M = 1000, 0.06


def pose(link):
    robot = Robot.from_urdf(urdf, tip=link)
    return robot.fkine([0.0] * robot.n)


class View:
    """One projection: which axis of the world goes right and which up, and where the origin is."""

    def __init__(self, title, right, up, x, y):
        self.title, self.right, self.up, self.x, self.y = title, right, up, x, y
        self.lines = [f'<text x="{x - 30}" y="{y + 60}">{title}</text>']

    def at(self, point):
        return self.x + SCALE * point[self.right], self.y - SCALE * point[self.up]

    def line(self, points):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(self.at, points))
        self.lines.append(f'<polyline points="{path}" fill="none" stroke="#95a5a6" stroke-width="9" stroke-linejoin="round"/>')

    def dot(self, point, label, dx, dy):
        x, y = self.at(point)
        self.lines.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="#2c3e50"/>')
        self.lines.append(f'<text x="{x + dx:.1f}" y="{y + dy:.1f}">{label}</text>')

    def axes(self, frame, label, dx, dy):
        origin = frame[:3, 3]
        x, y = self.at(origin)
        self.lines.append(f'<text x="{x + dx:.1f}" y="{y + dy:.1f}" font-weight="bold">{label}</text>')
        for column, name in enumerate("xyz"):
            end = origin + ARROW_M * frame[:3, column]
            ex, ey = self.at(end)
            if abs(ex - x) + abs(ey - y) < 0.4 * SCALE * ARROW_M:
                continue
            colour = COLOURS[name]
            self.lines.append(
                f'<line x1="{x:.1f}" y1="{y:.1f}" x2="{ex:.1f}" y2="{ey:.1f}" stroke="{colour}" stroke-width="3" marker-end="url(#{name})"/>'
            )
            tx, ty = ex + 0.2 * (ex - x), ey + 0.2 * (ey - y)
            self.lines.append(f'<text x="{tx:.1f}" y="{ty + 5:.1f}" text-anchor="middle" fill="{colour}">{name}</text>')


frames = {name: pose(link) for name, link in joints.items()}
tool, world = pose("gripper_frame_link"), numpy.eye(4)
chain = [world[:3, 3], *(frame[:3, 3] for frame in frames.values()), tool[:3, 3]]

side = View("from the right side", 0, 2, 60, 300)
side.line(chain)
for name, (dx, dy) in zip(joints, [(14, 5), (14, 22), (-36, -14), (-30, -14), (-24, 28)]):
    side.dot(frames[name][:3, 3], name, dx, dy)
side.axes(world, "base", -44, 24)
side.axes(tool, "tool", -14, -14)
top = View("from above", 0, 1, 60, 500)
top.line(chain)
top.axes(world, "base", -44, 24)
top.axes(tool, "tool", -14, 24)

markers = "".join(
    f'<marker id="{name}" viewBox="0 0 10 10" refX="8" refY="5" markerWidth="5" markerHeight="5" orient="auto">'
    f'<path d="M0 0 L10 5 L0 10 z" fill="{colour}"/></marker>'
    for name, colour in COLOURS.items()
)
svg = [
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 600 580" font-family="sans-serif" font-size="14">',
    '<rect width="600" height="580" fill="#ffffff"/>',
    f"<defs>{markers}</defs>",
    *side.lines,
    *top.lines,
    "</svg>",
]
(repository / "docs/images/so101-frames.svg").write_text("\n".join(svg) + "\n", encoding="utf-8")
