use super::*;

/// By hand, from a model of the board turned in front of the body: what the sensor reads on (x, y, z) when the robot stands
/// level, then when its nose points up, then when its left side points up. Where the axis points that the table calls 1.
#[rustfmt::skip]
const BY_HAND: [(&str, [Vector3; 3]); 24] = [
    ("x-forward-z-up",       [[0.0, 0.0, 1.0],  [1.0, 0.0, 0.0],  [0.0, 1.0, 0.0]]),
    ("x-forward-z-down",     [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0],  [0.0, -1.0, 0.0]]),
    ("x-forward-z-left",     [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0],  [0.0, 0.0, 1.0]]),
    ("x-forward-z-right",    [[0.0, 1.0, 0.0],  [1.0, 0.0, 0.0],  [0.0, 0.0, -1.0]]),
    ("x-backward-z-up",      [[0.0, 0.0, 1.0],  [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]),
    ("x-backward-z-down",    [[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
    ("x-backward-z-left",    [[0.0, 1.0, 0.0],  [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
    ("x-backward-z-right",   [[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]),
    ("x-left-z-up",          [[0.0, 0.0, 1.0],  [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]]),
    ("x-left-z-down",        [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0],  [1.0, 0.0, 0.0]]),
    ("x-left-z-forward",     [[0.0, 1.0, 0.0],  [0.0, 0.0, 1.0],  [1.0, 0.0, 0.0]]),
    ("x-left-z-backward",    [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]),
    ("x-right-z-up",         [[0.0, 0.0, 1.0],  [0.0, 1.0, 0.0],  [-1.0, 0.0, 0.0]]),
    ("x-right-z-down",       [[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]]),
    ("x-right-z-forward",    [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0],  [-1.0, 0.0, 0.0]]),
    ("x-right-z-backward",   [[0.0, 1.0, 0.0],  [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]]),
    ("x-up-z-forward",       [[1.0, 0.0, 0.0],  [0.0, 0.0, 1.0],  [0.0, -1.0, 0.0]]),
    ("x-up-z-backward",      [[1.0, 0.0, 0.0],  [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
    ("x-up-z-left",          [[1.0, 0.0, 0.0],  [0.0, 1.0, 0.0],  [0.0, 0.0, 1.0]]),
    ("x-up-z-right",         [[1.0, 0.0, 0.0],  [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]),
    ("x-down-z-forward",     [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0],  [0.0, 1.0, 0.0]]),
    ("x-down-z-backward",    [[-1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]]),
    ("x-down-z-left",        [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]),
    ("x-down-z-right",       [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0],  [0.0, 0.0, -1.0]]),
];

#[test]
fn readings_are_rotated_as_computed_by_hand() {
    for (number, (name, [level, nose_up, left_up])) in BY_HAND.into_iter().enumerate() {
        let orientation = Orientation::from_number(number as u32).unwrap();
        assert_eq!(orientation.name(), name);
        assert_eq!(orientation.number(), number as u32);
        // Robot axes: x forward, y left, z up.
        assert_eq!(orientation.rotate(level), [0.0, 0.0, 1.0], "{name}, level");
        assert_eq!(
            orientation.rotate(nose_up),
            [1.0, 0.0, 0.0],
            "{name}, nose up"
        );
        assert_eq!(
            orientation.rotate(left_up),
            [0.0, 1.0, 0.0],
            "{name}, left up"
        );
    }
    assert_eq!(Orientation::from_number(24), None);
    assert_eq!(Orientation::from_number(u32::MAX), None);
    assert_eq!(Orientation::default().name(), "x-forward-z-up");
}

/// The orientations are distinct, none is mirrored, and any two in sequence give a third.
#[test]
fn the_orientations_are_the_rotations_of_a_cube() {
    let turned =
        |o: Orientation| [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|v| o.rotate(v));
    let all = Orientation::ALL.map(turned);
    for (index, axes) in all.iter().enumerate() {
        let [x, y, z] = *axes;
        assert_eq!(vector::dot(vector::cross(x, y), z), 1.0, "{index}");
        assert!(
            all.iter().skip(index + 1).all(|other| other != axes),
            "{index}"
        );
        let outer = Orientation::ALL[index];
        for inner in Orientation::ALL {
            let both = turned(inner).map(|v| outer.rotate(v));
            assert!(all.contains(&both), "{} in {}", inner.name(), outer.name());
        }
    }
}

#[test]
fn rotating_back_undoes_a_rotation() {
    let felt = [0.1, -1234.5, 9.81];
    for orientation in Orientation::ALL {
        assert_eq!(orientation.rotate_back(orientation.rotate(felt)), felt);
    }
    assert_eq!(Orientation::default().rotate(felt), felt);
}
