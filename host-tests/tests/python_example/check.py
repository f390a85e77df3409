"""Checks examples/pc_link.py against the golden frames: check.py EXAMPLE VECTORS, both folders."""

import contextlib
import csv
import io
import math
import pathlib
import random
import struct
import sys

example_folder, vectors = (pathlib.Path(argument) for argument in sys.argv[1:])
sys.path.insert(0, str(example_folder))
sys.dont_write_bytecode = True
import pc_link


def floats(columns):
    return [struct.unpack(">f", bytes.fromhex(column))[0] for column in columns]


def rows(name):
    return list(csv.reader((vectors / name).open()))


def read_from(data):
    """Chunks of any length, then an end."""
    chunks, source = random.Random(1), io.BytesIO(data)
    while chunk := source.read(chunks.randrange(1, 300)):
        yield chunk


def states_of(data):
    chunks = read_from(data)
    ended = []

    def read():
        chunk = next(chunks, None)
        if chunk is None:
            raise EOFError
        return chunk

    try:
        for state in pc_link.states(read):
            ended.append(state)
    except EOFError:
        return ended


assert pc_link.crc8(b"123456789") == 0xA1

checked = 0
for row in rows("link_down.csv"):
    values = floats(row[:18])
    if not any(map(math.isnan, values)):
        motors = [values[at : at + 3] for at in range(0, 18, 3)]
        assert pc_link.command(motors).hex() == row[18], row
        checked += 1
assert checked > 250, checked

up = rows("link_up.csv")
# Whole frames with garbage and a cut frame between them. What follows on garbage does not count.
stream = bytes.fromhex(up[0][31])[40:]
stream += b"".join(bytes.fromhex(row[31]) * 2 + bytes(range(1 + place % 3)) for place, row in enumerate(up))
states = states_of(stream)
assert len(states) == len(up), (len(states), len(up))
for (seconds, key1, key2, angles, speeds), row in zip(states, up):
    (sent,) = floats(row[:1])
    sent = 0.0 if math.isnan(sent) else max(-3.4028234663852886e38, min(sent, 3.4028234663852886e38))
    assert seconds == sent, row
    assert bytes([key1, key2]).hex() == row[13], row
    motors = [float(column) for column in row[33:]]
    for found, expected in zip(angles + speeds, motors[::2] + motors[1::2]):
        assert abs(found - expected) < 1e-6, (found, expected)


def state_frame(seconds, ready, angle):
    """By the table of docs/pc-link.md, all sensors zero."""
    code = round((angle + math.pi) / (2 * math.pi) * 65535)
    keys = (0x02, 0x40) if ready else (0, 0x80)
    frame = struct.pack("<BfBb10f2B5f", 0xFE, seconds, 0, 0, *[0.0] * 10, *keys, *[0.0] * 5)
    frame += struct.pack("<12H", *[code, 32768] * 6)
    return frame + bytes([pc_link.crc8(frame)])


def drive(frames):
    """The commands as codes: one list of 18 for each frame sent."""
    commands, source = [], iter(frames)

    def read():
        frame = next(source, None)
        if frame is None:
            raise EOFError("the drive does not end")
        return frame

    def write(frame):
        assert len(frame) == 38 and frame[0] == 0xFE and frame[37] == pc_link.crc8(frame[:37])
        commands.append(struct.unpack_from("<18H", frame, 1))

    pc_link.drive(read, write)
    return commands


def speed(command):
    assert command[0] == command[3]
    return command[0] / 65535 * 400 - 200


def joints(command):
    return [code / 65535 * 6.4 - 3.2 for code in command[6::3]]


# Not ready for a second, ready for two, not ready for one, and ready for the rest with other angles.
ready = [False] * 400 + [True] * 800 + [False] * 400 + [True] * 2000
angle = [0.1 + place * 1e-4 for place in range(len(ready))]
frames = [state_frame(place / 400, *pair) for place, pair in enumerate(zip(ready, angle))]
frames.insert(0, frames[0])
printed = io.StringIO()
with contextlib.redirect_stdout(printed):
    commands = drive(frames)
for first, last in ((0, 100), (301, 400)):
    assert all(abs(speed(command)) < 0.01 for command in commands[first:last]), "it waits at rest"
for begin, end in ((100, 300), (400, len(commands))):
    at_rest, moving = commands[begin : begin + 50], commands[begin:end]
    assert all(abs(speed(command)) < 0.01 for command in at_rest), "it starts from rest"
    assert abs(max(map(speed, moving)) - 1.25) < 0.02, max(map(speed, moving))
    steps = [later - earlier for earlier, later in zip(map(speed, moving), map(speed, moving[1:]))]
    assert max(map(abs, steps)) < 0.03, "1 rad/s each second"
    # The joints hold where they were when the robot became ready.
    for command in moving[1:]:
        assert all(abs(joint - angle[begin * 4]) < 0.001 for joint in joints(command))
assert 740 < len(commands) < 760, "it ends half a second after the drive"
assert all(abs(speed(command)) < 0.01 for command in commands[700:]), "it ends at rest"
assert all(a != b for a, b in zip(commands, commands[1:])), "no two frames in a row are equal"
told = [line.split(", ", 1)[1] for line in printed.getvalue().splitlines() if "target" not in line]
waiting = "waiting: the radio's mode is not PC"
assert told == [waiting, "driving", waiting, "driving", "done"], told
assert pc_link.obstacle(0x01, 0x00) == "the radio is lost"
assert pc_link.obstacle(0x20, 0x40).startswith("the robot is not armed")
print("as in the golden frames")
