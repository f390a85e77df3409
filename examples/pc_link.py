"""Drives the robot slowly forward for three seconds over the PC link (docs/pc-link.md), and prints what it reports.

pip install pyserial; python3 examples/pc_link.py /dev/ttyUSB0
It waits until the radio has armed the robot and selected mode PC. The joints hold the angles they have then.
"""
import struct, sys

ANGLE, SPEED, WHEEL, JOINT, GAIN = (-3.14159265, 3.14159265), (-33, 33), (-200, 200), (-3.2, 3.2), (0, 1000)

def crc8(data):
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8C if crc & 1 else 0)
    return crc

def command(motors):  # six times (speed or angle, Kp, Kd)
    ranges = [(WHEEL if motor < 2 else JOINT, GAIN, GAIN) for motor in range(6)]
    pairs = [pair for motor in zip(motors, ranges) for pair in zip(*motor)]
    codes = [round((min(max(v, low), high) - low) / (high - low) * 65535) for v, (low, high) in pairs]
    frame = struct.pack("<B18H", 0xFE, *codes)
    return frame + bytes([crc8(frame)])

def states(read):  # seconds, Key1, Key2, angles and speeds of the six motors; read() returns bytes
    buffer = b""
    while True:
        buffer += read()
        while len(buffer) >= 94:
            good = buffer[0] == 0xFE and crc8(buffer[:93]) == buffer[93]
            if good:
                seconds, _, _, *vectors, key1, key2, _, _, _, _, _ = struct.unpack_from("<fBb10f2B5f", buffer, 1)
                values = [code / 65535 * 2 * high - high
                          for code, (_, high) in zip(struct.unpack_from("<12H", buffer, 69), (ANGLE, SPEED) * 6)]
                yield seconds, key1, key2, values[::2], values[1::2]
            buffer = buffer[94 if good else 1:]

def drive(read, write, stop_after=3.0):
    began = held = None  # the time at which the robot was first seen ready, and its joints' angles then
    for count, (seconds, key1, key2, angles, speeds) in enumerate(states(read)):
        if not (key1 & 0x02 and key2 & 0x40):  # F1: armed, B: mode PC
            began = None
        elif began is None:
            began, held = seconds, angles[2:]
        since = 0.0 if began is None else seconds - began
        speed = max(0.0, min(2.0, since - 0.5, stop_after - since))  # from rest, and no faster than 1 rad/s each second
        if count % 4 == 0:  # 104 Hz. Kp of a wheel has no effect: as a counter it shows that this program is alive.
            wheels = [(speed, count // 4 % 1000, 1.0)] * 2
            write(command(wheels + [(angle, 20.0, 1.0) for angle in (angles[2:] if began is None else held)]))
        if count % 208 == 0:
            print(f"{seconds:.1f} s, target {speed:.2f} rad/s, wheels {speeds[0]:.2f} {speeds[1]:.2f}", flush=True)

if __name__ == "__main__":
    import serial
    with serial.Serial(sys.argv[1], 460800, timeout=1) as port:
        drive(lambda: port.read(max(94, port.in_waiting)), port.write)
