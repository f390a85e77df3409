"""Frames of the PC link, computed from the tables of its document alone.

Usage: python3 link_frames.py KIND > link_KIND.csv, where KIND is up, down, drive or tunnel. It needs no packages, and gives the
same lines every time.
"""

import math
import random
import struct
import sys

RANDOM = random.Random(460800)
NAN, INF = math.nan, math.inf
F32_MAX = struct.unpack("<f", b"\xff\xff\x7f\x7f")[0]

# Section 6: ranges. `None` is a float sent as it is.
ANGLE, SPEED, VOLTAGE = (-math.pi, math.pi, 65535), (-33.0, 33.0, 65535), (20.0, 60.0, 255)
WHEEL, JOINT, GAIN = (-200.0, 200.0, 65535), (-3.2, 3.2, 65535), (0.0, 1000.0, 65535)
# Sections 3 and 4, without header and CRC. Time, voltage, temperature, accelerometer, gyroscope, quaternion, keys, sticks.
UP = [None, VOLTAGE, "int8"] + [None] * 10 + ["keys"] + [None] * 5 + [ANGLE, SPEED] * 6
SHARE = (-1.0, 1.0, 65535)
DOWN = [WHEEL, GAIN, GAIN] * 2 + [JOINT, GAIN, GAIN] * 4


def crc8(data):
    """CRC-8/MAXIM-DOW as its definition has it: every byte reflected, polynomial 0x31, the result reflected."""
    crc = 0
    for byte in data:
        for bit in range(8):
            feedback = (crc >> 7) ^ (byte >> bit & 1)
            crc = crc << 1 & 0xFF
            if feedback:
                crc ^= 0x31
    return int(f"{crc:08b}"[::-1], 2)


assert crc8(b"123456789") == 0xA1


def f32(value):
    """The nearest single-precision float."""
    if math.isnan(value) or math.isinf(value):
        return value
    return struct.unpack("<f", struct.pack("<f", value))[0]


def exact_code(value, field):
    """Section 5.1, with NaN as the value nearest to 0, not yet rounded."""
    low, high, steps = field
    value = 0.0 if math.isnan(value) else value
    return (min(max(value, low), high) - low) / (high - low) * steps


def code(value, field):
    return math.floor(exact_code(value, field) + 0.5)


def put(value, field):
    """The bytes of a field."""
    if field is None:
        value = 0.0 if math.isnan(value) else min(max(value, -F32_MAX), F32_MAX)
        return struct.pack("<f", value)
    if field == "int8":
        return struct.pack("b", value)
    if field == "keys":
        return bytes(value)
    return code(value, field).to_bytes(1 if field[2] == 255 else 2, "little")


def seen(value, field):
    """What the receiver reads from a code: section 5.2."""
    low, high, steps = field
    return f"{code(value, field) / steps * (high - low) + low:.9g}"


def text(value, field):
    if field == "int8":
        return str(value)
    if field == "keys":
        return bytes(value).hex()
    return struct.pack(">f", value).hex()


def line(values, layout):
    frame = b"\xfe" + b"".join(put(*pair) for pair in zip(values, layout))
    frame += bytes([crc8(frame)])
    columns = [text(*pair) for pair in zip(values, layout)]
    columns += [frame.hex()]
    columns += [seen(value, field) for value, field in zip(values, layout) if isinstance(field, tuple)]
    print(",".join(columns))


def corners(field):
    """Minimum, middle, maximum and beyond."""
    if field == "int8":
        return [-128, -1, 0, 1, 127]
    if field == "keys":
        singles = [(1 << bit, 0) for bit in range(8)] + [(0, 1 << bit) for bit in range(8)]
        return [(0, 0), (255, 255), *singles]
    if field is None:
        return [-F32_MAX, 0.0, F32_MAX, -INF, INF, NAN]
    low, high, steps = field
    # A quarter of a step off the ends, where the direction of rounding shows.
    quarters = [low + (high - low) / steps * n / 4 for n in (1, 3, 4 * steps - 3, 4 * steps - 1)]
    beyond = [low - 1.0, high + 1.0, -F32_MAX, F32_MAX, -INF, INF, NAN, 0.0]
    return [f32(v) for v in [low, (low + high) / 2, high, *quarters, *beyond]]


def anything(field):
    """A random value. None lies so near the middle between two codes that single precision could round otherwise."""
    if field == "int8":
        return RANDOM.randint(-128, 127)
    if field == "keys":
        return (RANDOM.randrange(256), RANDOM.randrange(256))
    if field is None:
        return f32(RANDOM.uniform(-50.0, 50.0))
    low, high, _ = field
    while True:
        value = f32(RANDOM.uniform(low * 1.1 - 1.0, high * 1.1))
        if abs(exact_code(value, field) % 1.0 - 0.5) > 0.05:
            return value


def lines(layout):
    for place, field in enumerate(layout):
        for corner in corners(field):
            values = [anything(other) for other in layout]
            values[place] = corner
            line(values, layout)
    for rank in range(3):
        line([corners(field)[rank] for field in layout], layout)
    for _ in range(30):
        line([anything(field) for field in layout], layout)


def drive_lines():
    """Four shares, jump, count, frame, and what a receiver reads of the shares. `-` for jump: a frame to be refused."""

    def drive_line(shares, bits, count):
        body = bytes([0xFC]) + b"".join(put(share, SHARE) for share in shares) + bytes([bits, count])
        columns = [text(share, SHARE) for share in shares] + [str(bits) if bits < 2 else "-", str(count)]
        columns += [(body + bytes([crc8(body)])).hex()] + [seen(share, SHARE) for share in shares]
        print(",".join(columns))

    for place in range(4):
        for corner in corners(SHARE):
            shares = [anything(SHARE) for _ in range(4)]
            shares[place] = corner
            drive_line(shares, RANDOM.randrange(2), RANDOM.randrange(256))
    for bit in range(8):
        drive_line([0.0] * 4, 1 << bit, 1 << bit)


def tunnel_lines():
    """Identifier, payload, frame. Without a payload the frame must be refused."""

    def frame(head, data, flip=0):
        body = bytes([0xFD, *head, *data])
        return (body + bytes([crc8(body) ^ flip])).hex()

    def head(identifier, length):
        return identifier & 0xFF, identifier >> 8 | length << 4

    for identifier in range(0x7A0, 0x7B0):
        for length in range(9):
            payload = bytes(RANDOM.randrange(256) for _ in range(length))
            padded = payload + bytes(8 - length)
            print(f"{identifier:x},{payload.hex()}-,{frame(head(identifier, length), padded)}")
    for identifier in (0, 0x200, 0x79F, 0x7B0, 0x7FF):
        print(f"{identifier:x},,{frame(head(identifier, 8), bytes(8))}")
    for length in range(9, 16):
        print(f"7a0,,{frame(head(0x7A0, length), bytes(8))}")
    for length in range(8):
        print(f"7a0,,{frame(head(0x7A0, length), bytes([0] * length + [1] + [0] * (7 - length)))}")
    for bit in range(8):
        print(f"7a0,,{frame(head(0x7A0, 8), bytes(range(8)), 1 << bit)}")


match sys.argv[1:]:
    case ["up"]:
        lines(UP)
    case ["down"]:
        lines(DOWN)
    case ["drive"]:
        drive_lines()
    case ["tunnel"]:
        tunnel_lines()
    case _:
        sys.exit(__doc__)
