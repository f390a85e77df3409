"""Listens to the motors and reads a setting through a CAN-TO-ETH gateway in UDP mode, without any package.

Usage: python3 can_to_eth.py udp:HOST:PORT. Frames are packed as the C code of the gateway's document packs them.
"""

import socket
import struct
import sys

PATIENCE_S = 60
EXTENDED, REMOTE = 0x80, 0x40
LEFT, READ, REPLY = 0x201, 0x7A1, 0x7A2
WHEEL_GEOMETRY, TRACK_M = 1, 1


def frame(can_id, data=b"", kind=0):
    return bytes([kind | len(data)]) + can_id.to_bytes(4, "big") + data.ljust(8, b"\0")


def parse(buf):
    frame_info = buf[0]
    can_id = buf[1] << 24 | buf[2] << 16 | buf[3] << 8 | buf[4]
    assert frame_info & 0xF0 == 0, "a standard data frame"
    return can_id, buf[5 : 5 + (frame_info & 0x0F)]


protocol, host, port = sys.argv[1].split(":")
assert protocol == "udp"
gateway = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
gateway.settimeout(PATIENCE_S)
gateway.connect((host, int(port)))
# The gateway answers whoever sent last: the first frame opens the way back.
gateway.send(frame(0x3FE))
print("ready")


def frames():
    while True:
        packet = gateway.recv(2048)
        assert packet and len(packet) % 13 == 0, len(packet)
        largest.append(len(packet) // 13)
        for start in range(0, len(packet), 13):
            yield parse(packet[start : start + 13])


largest = []
heard = frames()
feedback = 0
while feedback < 100:
    can_id, data = next(heard)
    feedback += can_id == LEFT and len(data) == 8
print("batch", max(largest))

# Four frames of a packet are fit for the bus. The others have a reserved bit, a length of 9 and an identifier of 12 bits,
# and a part of a frame follows.
packet = frame(0x18FF50E5, b"\1\2\3", EXTENDED) + frame(0x3FF, b"", REMOTE | 4)
packet += frame(0x123, b"\1", 0x20) + bytes([9]) + bytes(12) + frame(0x800, b"\1")
packet += frame(0x7FF, bytes(8)) + frame(READ, bytes([0x21, WHEEL_GEOMETRY, TRACK_M])) + b"\x08\0\0"
gateway.send(packet)
reply = next(data for can_id, data in heard if can_id == REPLY)
*head, track_m = struct.unpack("<BBBBf", reply)
assert head == [0x21, WHEEL_GEOMETRY, TRACK_M, 0], reply.hex()
print("track", track_m)
