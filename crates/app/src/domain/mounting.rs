//! The orientation of a sensor: where its axes point (docs/mounting.md).

use crate::math::{Vector3, vector};

const FORWARD: Vector3 = [1.0, 0.0, 0.0];
const BACKWARD: Vector3 = [-1.0, 0.0, 0.0];
const LEFT: Vector3 = [0.0, 1.0, 0.0];
const RIGHT: Vector3 = [0.0, -1.0, 0.0];
const UP: Vector3 = [0.0, 0.0, 1.0];
const DOWN: Vector3 = [0.0, 0.0, -1.0];

macro_rules! orientations {
    ($($variant:ident = $number:literal, $name:literal, $x:ident, $z:ident;)*) => {
        /// One of the 24 orientations of right-handed axes, named by where x and z point. The numbers are on the wire
        /// and in flash and never change.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        #[repr(u32)]
        pub enum Orientation {
            #[default]
            $(#[doc = $name] $variant = $number),*
        }

        impl Orientation {
            /// All orientations, by number.
            pub const ALL: [Self; 24] = [$(Self::$variant),*];

            /// Its name, such as `x-forward-z-up`.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),*
                }
            }

            /// Where x and z point.
            const fn x_and_z(self) -> [Vector3; 2] {
                match self {
                    $(Self::$variant => [$x, $z]),*
                }
            }
        }
    };
}

orientations! {
    XForwardZUp = 0, "x-forward-z-up", FORWARD, UP;
    XForwardZDown = 1, "x-forward-z-down", FORWARD, DOWN;
    XForwardZLeft = 2, "x-forward-z-left", FORWARD, LEFT;
    XForwardZRight = 3, "x-forward-z-right", FORWARD, RIGHT;
    XBackwardZUp = 4, "x-backward-z-up", BACKWARD, UP;
    XBackwardZDown = 5, "x-backward-z-down", BACKWARD, DOWN;
    XBackwardZLeft = 6, "x-backward-z-left", BACKWARD, LEFT;
    XBackwardZRight = 7, "x-backward-z-right", BACKWARD, RIGHT;
    XLeftZUp = 8, "x-left-z-up", LEFT, UP;
    XLeftZDown = 9, "x-left-z-down", LEFT, DOWN;
    XLeftZForward = 10, "x-left-z-forward", LEFT, FORWARD;
    XLeftZBackward = 11, "x-left-z-backward", LEFT, BACKWARD;
    XRightZUp = 12, "x-right-z-up", RIGHT, UP;
    XRightZDown = 13, "x-right-z-down", RIGHT, DOWN;
    XRightZForward = 14, "x-right-z-forward", RIGHT, FORWARD;
    XRightZBackward = 15, "x-right-z-backward", RIGHT, BACKWARD;
    XUpZForward = 16, "x-up-z-forward", UP, FORWARD;
    XUpZBackward = 17, "x-up-z-backward", UP, BACKWARD;
    XUpZLeft = 18, "x-up-z-left", UP, LEFT;
    XUpZRight = 19, "x-up-z-right", UP, RIGHT;
    XDownZForward = 20, "x-down-z-forward", DOWN, FORWARD;
    XDownZBackward = 21, "x-down-z-backward", DOWN, BACKWARD;
    XDownZLeft = 22, "x-down-z-left", DOWN, LEFT;
    XDownZRight = 23, "x-down-z-right", DOWN, RIGHT;
}

impl Orientation {
    /// Its number on the wire and in flash.
    pub const fn number(self) -> u32 {
        self as u32
    }

    /// Returns `None` unless `number` comes from [`number`](Self::number).
    pub fn from_number(number: u32) -> Option<Self> {
        let index = usize::try_from(number).ok()?;
        Self::ALL.get(index).copied()
    }

    /// Rotates a vector from the sensor's axes to the outer ones.
    pub fn rotate(self, [x, y, z]: Vector3) -> Vector3 {
        let [x_axis, y_axis, z_axis] = self.axes();
        vector::add(
            vector::add(vector::scale(x_axis, x), vector::scale(y_axis, y)),
            vector::scale(z_axis, z),
        )
    }

    /// Rotates a vector from the outer axes to the sensor's.
    pub fn rotate_back(self, outer: Vector3) -> Vector3 {
        self.axes().map(|axis| vector::dot(axis, outer))
    }

    /// Where x, y and z point.
    fn axes(self) -> [Vector3; 3] {
        let [x, z] = self.x_and_z();
        [x, vector::cross(z, x), z]
    }
}

#[cfg(test)]
mod tests;
