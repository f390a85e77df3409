"""Drives the robot slowly forward for three seconds over the PC link (docs/pc-link.md), and prints what it reports.

python3 examples/pc_link.py /dev/ttyUSB0    # needs pyserial: sudo apt install python3-serial
It waits until the radio has armed the robot and selected mode PC. The joints hold the angles they have then.
When it ends, at whatever point, the robot hears no commands any more, and takes all torque away after 0.1 s.
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
    buffer, good = b"", False
    while True:
        buffer += read()
        while len(buffer) >= 94:
            before, good = good, buffer[0] == 0xFE and crc8(buffer[:93]) == buffer[93]
            if good and before:  # One of 256 wrong frames passes the CRC, but not two in a row.
                seconds, _, _, *vectors, key1, key2, _, _, _, _, _ = struct.unpack_from("<fBb10f2B5f", buffer, 1)
                values = [code / 65535 * 2 * high - high
                          for code, (_, high) in zip(struct.unpack_from("<12H", buffer, 69), (ANGLE, SPEED) * 6)]
                yield seconds, key1, key2, values[::2], values[1::2]
            buffer = buffer[94 if good else 1:]

def obstacle(key1, key2):
    if key1 & 0x01:  # F2
        return "the radio is lost"
    if not key2 & 0x40:  # B
        return "the radio's mode is not PC"
    return None if key1 & 0x02 else "the robot is not armed: switch enable off and on"  # F1

def drive(read, write, length=3.0):
    began = held = said = None  # the time at which the robot was first seen ready, and its joints' angles then
    for count, (seconds, key1, key2, angles, speeds) in enumerate(states(read)):
        why = obstacle(key1, key2)
        if why or began is None:
            began, held = None if why else seconds, angles[2:]
        since = 0.0 if why else seconds - began
        speed = max(0.0, min(since - 0.5, length - since))  # from rest, up and down by 1 rad/s each second
        if count % 4 == 0:  # 104 Hz. Kp of a wheel has no effect: as a counter it shows that this program is alive.
            write(command([(speed, count // 4 % 1000, 1.0)] * 2 + [(angle, 20.0, 1.0) for angle in held]))
        state = f"waiting: {why}" if why else "driving" if since < length else "done"
        if state != said:
            print(f"{seconds:.1f} s, {state}", flush=True)
        elif state == "driving" and count % 208 == 0:
            print(f"{seconds:.1f} s, target {speed:.2f} rad/s, wheels {speeds[0]:.2f} {speeds[1]:.2f}", flush=True)
        said = state
        if since > length + 0.5:  # at rest for a while
            return

if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} DEVICE, such as /dev/ttyUSB0 or COM4")
    try:
        import serial
        with serial.Serial(sys.argv[1], 460800, timeout=1, exclusive=True) as port:  # one program at a time
            def read():
                data = port.read(max(94, port.in_waiting))
                if not data:
                    print(f"nothing comes from {port.name}: is the robot on, and TXD connected to RXD?", flush=True)
                return data
            drive(read, port.write)
    except ImportError:
        sys.exit("pyserial is missing: sudo apt install python3-serial")
    except OSError as error:  # serial.SerialException among them
        sys.exit(str(error))
    except KeyboardInterrupt:
        sys.exit("stopped")
