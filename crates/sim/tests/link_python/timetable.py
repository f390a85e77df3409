"""Steers the robot over the PC link by a timetable in its own seconds: timetable.py EXAMPLES DEVICE 0=0 3=5 …

It knows the frames only from examples/pc_link.py. Each entry is a time and a speed of both wheels in rad/s. While that is 0
the joints are held where they are, otherwise 0.2 rad further. It prints the time of every state that it reads.
"""

import sys

sys.dont_write_bytecode = True
examples, device, *entries = sys.argv[1:]
sys.path.insert(0, examples)
import pc_link
import serial

timetable = [tuple(map(float, entry.split("="))) for entry in entries]

with serial.Serial(device, 460800, timeout=1) as port:
    print("open")
    held, resting = None, False
    for count, (seconds, _, _, angles, _) in enumerate(pc_link.states(lambda: port.read(max(1, port.in_waiting)))):
        speed = [speed for begin, speed in timetable if begin <= seconds][-1]
        if held is None or (speed == 0 and not resting):
            held = angles[2:]
        resting = speed == 0
        if count % 4 == 0:  # Kp of a wheel has no effect: as a counter it shows that this program is alive.
            wheels = [(speed, count // 4 % 1000, 1.0)] * 2
            lifted = 0.0 if resting else 0.2
            port.write(pc_link.command(wheels + [(angle + lifted, 20.0, 1.0) for angle in held]))
        print(seconds)
