//! The list of checks, in their order. New checks go to its end, because reports name the numbers.

use super::measured::{self, MeasureFn};

/// One check of a first board.
#[derive(Debug)]
pub struct Check {
    /// Names the check in reports; it never changes.
    pub id: &'static str,
    pub title: &'static str,
    pub connect: &'static str,
    /// What the user does.
    pub act: &'static str,
    /// What the user must see.
    pub see: &'static str,
    /// What the user notes beyond what the tool measures.
    pub note: &'static str,
    pub how: Method,
}

#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// The user looks and judges.
    Asked,
    /// The user prepares it, then the tool measures and judges.
    Prepared(MeasureFn),
    /// The tool measures and judges without the user.
    Alone(MeasureFn),
}

use Method::{Alone, Asked, Prepared};

pub static CHECKS: [Check; 24] = [
    Check {
        id: "boot",
        title: "The board starts",
        connect: "Board on USB or its 24 V supply, no motor powered, a probe on SWD, a CAN adapter on CAN1 or CAN2 with \
            the bus terminated at both ends.",
        act: "`cargo run --release`, end it with Ctrl-C, take the probe off, power off and on, `robotctl status \
            --can can0`.",
        see: "LED cyan, then blue or white; version; last reset `power-on`; IMU and magnetometer ready; no tick \
            missed.",
        note: "What is on the board's label and the chip's; USB or battery.",
        how: Alone(measured::boot),
    },
    Check {
        id: "battery",
        title: "The battery is measured",
        connect: "The battery, a multimeter at the board's 24 V connector.",
        act: "Read both.",
        see: "Both within 2 %.",
        note: "The multimeter's volts.",
        how: Alone(measured::battery),
    },
    Check {
        id: "radio",
        title: "The radio is heard",
        connect: "Receiver on DBUS, transmitter on.",
        act: "Wait for two seconds; move each stick and switch and watch `robotctl status --watch`.",
        see: "60 to 150 frames a second, all good; each control does what docs/driving.md says.",
        note: "Make of the receiver; frames a second with one decimal.",
        how: Prepared(measured::radio),
    },
    Check {
        id: "radio-off",
        title: "A lost transmitter is noticed",
        connect: "As before.",
        act: "Switch the transmitter OFF, wait for a second.",
        see: "`remote-lost` or `remote-failsafe`. If the robot sees nothing the receiver holds its last frame: \
            change its failsafe setting and begin anew. No firmware can notice a receiver that holds.",
        note: "How the receiver is set.",
        how: Prepared(measured::radio_off),
    },
    Check {
        id: "c620-silence",
        title: "What a C620 does when commands stop",
        connect: "Robot on a stand, wheels free in the air, both C620 powered; a second person at the transmitter. \
            `robotctl status` shows both wheels.",
        act: "`robotctl tune bring-up motor left-wheel --torque 300`, arm, hold the dead-man stick until the wheel \
            turns, and pull the board's CAN1 plug while it is held. Let go of the stick, e-stop, plug in again, \
            `robotctl tune bring-up off`.",
        see: "Nothing must be seen here: it is not known. Either the wheel coasts at once or the C620 goes on with \
            its last current.",
        note: "Whether and for how long it went on pushing; what the C620's LED did; its firmware version.",
        how: Asked,
    },
    Check {
        id: "joints-answer",
        title: "A disabled joint answers the disable frame",
        connect: "All four joint motors powered, on CAN2; the robot disarmed, on its stand.",
        act: "Nothing: the tool watches for two seconds.",
        see: "All four `disabled`, none silent for more than 10 ms, none reports that it gives torque.",
        note: "Motors' firmware versions and labels. If they are `silent` but work in their maker's tool: they do not \
            answer while disabled, and that must be reported.",
        how: Prepared(measured::joints_answer),
    },
    Check {
        id: "imu-flat",
        title: "IMU: board flat",
        connect: "Board alone, motors off, `mounting.board` and `mounting.mag` as delivered. Its front is where the picture in \
            docs/mounting.md has x, its top is where it has z.",
        act: "Lay it flat, hands off.",
        see: "z +9.8, x and y 0.",
        note: "Here and in the next checks, if it is wrong: which axis shows what. The picture is then wrong too.",
        how: Prepared(measured::flat),
    },
    Check {
        id: "imu-upside-down",
        title: "IMU: board upside down",
        connect: "As before.",
        act: "Lay it on its top.",
        see: "z -9.8, x and y 0.",
        note: "",
        how: Prepared(measured::upside_down),
    },
    Check {
        id: "imu-nose-up",
        title: "IMU: nose up",
        connect: "As before.",
        act: "Stand it on its back edge, nose up.",
        see: "x +9.8, y and z 0.",
        note: "",
        how: Prepared(measured::nose_up),
    },
    Check {
        id: "imu-left-up",
        title: "IMU: left side up",
        connect: "As before.",
        act: "Stand it on its right edge, left side up.",
        see: "y +9.8, x and z 0.",
        note: "",
        how: Prepared(measured::left_up),
    },
    Check {
        id: "gyro-left",
        title: "Gyro: a turn to the left",
        connect: "As before, flat on a table.",
        act: "Turn it to the left (counter-clockwise from above) for five seconds after Enter.",
        see: "z positive and by far the fastest.",
        note: "",
        how: Prepared(measured::left_turn),
    },
    Check {
        id: "mag-circle",
        title: "Magnetometer: a full circle",
        connect: "As before, flat on a wooden table, away from iron; a compass.",
        act: "Nose to magnetic north. After Enter turn it to the left once round, back to north, within fifteen \
            seconds.",
        see: "North ahead at first, then once round to the right.",
        note: "Northern or southern hemisphere (z is negative or positive when flat).",
        how: Prepared(measured::circle),
    },
    Check {
        id: "tick-jitter",
        title: "The control tick is regular",
        connect: "Everything on: motors powered, transmitter on, PC on CAN.",
        act: "Let it run for a minute since its last reset, `robotctl status --watch` meanwhile.",
        see: "At most 840 cycles of the chip's own counter (5 us), no tick missed.",
        note: "",
        how: Prepared(measured::jitter),
    },
    Check {
        id: "watchdog",
        title: "The watchdog's period",
        connect: "Motors OFF, probe on SWD, PC on CAN1.",
        act: "`candump -td can0,200:7FF` (or any tool with time stamps); `probe-rs debug --chip STM32F407IGHx`, in \
            it `break`; wait for a second, then end it and take the probe off.",
        see: "The frames pause once, for 17 to 40 ms, and come back by themselves; the last reset is by `watchdog`.",
        note: "Length of the pause in ms; the firmware's boot is 5 of them. Power off and on afterwards: a probe \
            leaves traces until then.",
        how: Prepared(measured::watchdog),
    },
    Check {
        id: "heater",
        title: "The heater reaches its target",
        connect: "Board as it will be mounted; once on USB and once on the battery.",
        act: "Power on cold, leave it alone until the LED blinks blue or white, at most five minutes.",
        see: "`holding`, calibration `done`, an offset of each axis below 2 deg/s.",
        note: "Room's temperature, and how long it took.",
        how: Prepared(measured::heater),
    },
    Check {
        id: "flash-erase",
        title: "How long an erase takes",
        connect: "Disarmed, enable off, motors powered and still.",
        act: "On a new board it comes by itself half a second after the first boot. Else change one setting some 120 \
            times, such as `for i in $(seq 120); do robotctl tune --can can0 set heater.ki 0.0$((i%2+1)); done`.",
        see: "One stall of 200 to 500 ms, everything saved.",
        note: "",
        how: Prepared(measured::erase),
    },
    Check {
        id: "settings-kept",
        title: "Settings outlast a power cut",
        connect: "As before.",
        act: "Change a setting, wait for `saved`, power off and on, read it.",
        see: "The new value.",
        note: "",
        how: Asked,
    },
    Check {
        id: "wheels-heard",
        title: "Both wheels report",
        connect: "Both C620 powered, wheels in the air.",
        act: "Turn each wheel by hand in its driving direction and watch `robotctl status --watch`.",
        see: "Both heard at most 10 ms ago; the right one moves.",
        note: "Sign of each rotor's rpm when the wheel drives forward.",
        how: Prepared(measured::wheels_heard),
    },
    Check {
        id: "joint-directions",
        title: "Joints: angles and directions",
        connect: "Joint motors powered, robot on its stand.",
        act: "`robotctl tune bring-up read-only`; turn each joint by hand; set `direction`; put each leg where its \
            angle is known, `robotctl joint zero NAME --angle RAD`.",
        see: "The right joint turns, the right way, and stands at the model's angle; the same after power off and \
            on.",
        note: "PMAX, VMAX, TMAX and the hardware version from the maker's tool.",
        how: Asked,
    },
    Check {
        id: "one-motor",
        title: "Each motor alone",
        connect: "Robot on its stand, wheels and legs free; a second person at the e-stop.",
        act: "`robotctl tune bring-up zero-torque`, arm: everything turns freely. Then each motor with `robotctl \
            tune bring-up motor NAME --torque 200`, dead-man stick held (docs/bring-up.md).",
        see: "The right motor, the right way; let go of the stick: it coasts at once.",
        note: "Which directions were wrong and what was set.",
        how: Asked,
    },
    Check {
        id: "joint-recovers",
        title: "A DM4310 comes back from a lost bus",
        connect: "As before, bring-up in `zero-torque`, armed.",
        act: "Pull the board's CAN2 plug for a second; enable off; plug in again; `robotctl status`; then enable off \
            and e-stop thrown for a second.",
        see: "Fault code 0xD (lost communication) at first, `disabled` after the clearing.",
        note: "Fault codes seen; whether a second clearing was needed.",
        how: Asked,
    },
    Check {
        id: "rs00-status",
        title: "RS00 only: bytes 6 and 7 of its reply",
        connect: "RS00 powered, on CAN2, PC there too.",
        act: "`candump can0,0F1:7FF` for some seconds.",
        see: "Bytes 6 and 7 are a temperature in tenths of a degree with the fault bit above it.",
        note: "Some of these lines, and the motor's temperature by hand.",
        how: Asked,
    },
    Check {
        id: "e-stop",
        title: "The e-stop stops",
        connect: "As in `one-motor`, one wheel turning at 300 mA.",
        act: "Throw the e-stop while the dead-man stick is still held.",
        see: "The wheel coasts at once; the LED is red.",
        note: "",
        how: Asked,
    },
    Check {
        id: "gyro-hour",
        title: "The gyro's axes after an hour",
        connect: "Board on, motors off, not reset for an hour.",
        act: "After Enter turn it to the left for five seconds, as before.",
        see: "z is still the axis that turns; no error counts beyond a few.",
        note: "",
        how: Prepared(measured::after_an_hour),
    },
];
