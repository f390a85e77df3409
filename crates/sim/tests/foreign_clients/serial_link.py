"""Reads the robot's state over the PC link with pyserial and sends commands that ask for nothing.

Usage: python3 serial_link.py DEVICE. It decodes with code of its own, written from the link's document. Times are the
robot's, so it does not matter how fast robot and computer run.
"""

import math
import struct
import sys

import serial

PATIENCE_S = 60
STATES = 500
UP, DOWN = 94, 38


def crc8(data):
    """CRC-8/MAXIM-DOW."""
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0x8C if crc & 1 else crc >> 1
    return crc


def rest(number):
    """No speed and no gain. Kp of the wheels has no effect and counts, so that no two frames are equal."""
    middle = 32768
    wheels = struct.pack("<HHH", middle, number % 65536, 0) * 2
    frame = b"\xfe" + wheels + struct.pack("<HHH", middle, 0, 0) * 4
    return frame + bytes([crc8(frame)])


def check(state):
    """Checks what a robot at rest must report."""
    battery_v = 20 + state[5] / 255 * 40
    (mcu_c,) = struct.unpack_from("<b", state, 6)
    accel, gyro = struct.unpack_from("<3f", state, 7), struct.unpack_from("<3f", state, 19)
    quaternion, sticks = struct.unpack_from("<4f", state, 31), struct.unpack_from("<5f", state, 49)
    assert 22 < battery_v < 27, battery_v
    assert 10 < mcu_c < 80, mcu_c
    assert 9.5 < accel[2] < 10.1 and math.hypot(*accel[:2]) < 0.5, accel
    assert math.hypot(*gyro) < 0.2, gyro
    assert abs(math.hypot(*quaternion) - 1) < 1e-3, quaternion
    assert all(abs(stick) < 0.05 for stick in sticks), sticks
    start, armed = state[47] >> 5 & 1, state[47] >> 1 & 1
    assert not start and not armed, state[47]
    for motor in range(6):
        angle, speed = struct.unpack_from("<HH", state, 69 + 4 * motor)
        assert abs(speed / 65535 * 66 - 33) < 0.01, (motor, speed)


with serial.Serial(sys.argv[1], 460800, timeout=PATIENCE_S) as port:
    print("ready")
    buffer, run, longest, states, sent, damaged = bytearray(), [], [], 0, 0, 0
    while states < STATES:
        heard = port.read(max(1, port.in_waiting))
        assert heard, f"silence after {states} states"
        buffer += heard
        while len(buffer) >= UP:
            if buffer[0] != 0xFE or crc8(buffer[: UP - 1]) != buffer[UP - 1]:
                # The first frame may be cut, and a computer that is too slow loses bytes.
                del buffer[0]
                damaged += states > 0
                run = []
                continue
            state = bytes(buffer[:UP])
            del buffer[:UP]
            check(state)
            states += 1
            run.append(struct.unpack_from("<f", state, 1)[0])
            longest = max(longest, run, key=len)
            if states % 4 == 0:
                port.write(rest(states))
                sent += 1

steps = [after - before for before, after in zip(longest, longest[1:])]
print("run", len(longest))
print("rate", len(steps) / (longest[-1] - longest[0]))
print("steps", min(steps), max(steps))
print("damaged", damaged)
print("sent", sent)
