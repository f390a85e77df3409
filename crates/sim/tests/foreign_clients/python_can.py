"""Listens to the motors and reads a setting with python-can.

Usage: python3 python_can.py slcan|waveshare DEVICE. It knows the robot from docs/tuning.md and the C620 from its datasheet.
"""

import struct
import sys

import can

PATIENCE_S = 60
COMMAND, LEFT, RIGHT = 0x200, 0x201, 0x202
READ, REPLY = 0x7A1, 0x7A2
WHEEL_GEOMETRY, TRACK_M = 1, 1

interface, device = sys.argv[1:]
if interface == "slcan":
    options = {"channel": device, "bitrate": 1_000_000, "sleep_after_open": 0}
else:
    options = {"channel": device.removeprefix("tcp:")}

with can.Bus(interface=interface, **options) as bus:
    print("ready")
    frames = iter(lambda: bus.recv(PATIENCE_S), None)

    heard = {COMMAND: [], LEFT: [], RIGHT: []}
    for frame in frames:
        assert not frame.is_extended_id and not frame.is_remote_frame and frame.dlc == 8, frame
        heard[frame.arbitration_id].append(bytes(frame.data))
        if all(len(of_one) >= 100 for of_one in heard.values()):
            break
    for command in heard[COMMAND]:
        assert command == bytes(8), "unarmed: all zero"
    for feedback in heard[LEFT] + heard[RIGHT]:
        angle, rpm, current, temperature = struct.unpack(">HhhB", feedback[:7])
        assert angle < 8192 and rpm == 0 and 10 <= temperature <= 60, feedback.hex()
    print("counts", *(len(of_one) for of_one in heard.values()))

    # Kinds of frames that nobody on the bus uses, and a length of zero.
    bus.send(can.Message(arbitration_id=0x18FF50E5, data=[1, 2, 3], is_extended_id=True))
    bus.send(can.Message(arbitration_id=0x3FF, is_remote_frame=True, dlc=4, is_extended_id=False))
    bus.send(can.Message(arbitration_id=0x3FE, data=[], is_extended_id=False))
    request = bytes([0x21, WHEEL_GEOMETRY, TRACK_M])
    bus.send(can.Message(arbitration_id=READ, data=request, is_extended_id=False))
    reply = next(frame for frame in frames if frame.arbitration_id == REPLY)
    *head, track_m = struct.unpack("<BBBBf", reply.data)
    assert head == [0x21, WHEEL_GEOMETRY, TRACK_M, 0], reply
    print("track", track_m)
