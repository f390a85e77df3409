//! Rotations in double precision, written without a look at the filter's own.

pub type Vector = [f64; 3];

pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn scale(a: Vector, factor: f64) -> Vector {
    a.map(|part| part * factor)
}

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Unit quaternion; turns body vectors into the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    pub w: f64,
    pub v: Vector,
}

impl Rotation {
    pub const NONE: Self = Self {
        w: 1.0,
        v: [0.0; 3],
    };

    /// By the length of `vector_rad` about its direction: the exact exponential map.
    pub fn by(vector_rad: Vector) -> Self {
        let angle = norm(vector_rad);
        let share = if angle < 1e-9 {
            0.5
        } else {
            (angle / 2.0).sin() / angle
        };
        Self {
            w: (angle / 2.0).cos(),
            v: scale(vector_rad, share),
        }
    }

    pub fn by_deg(vector_deg: Vector) -> Self {
        Self::by(vector_deg.map(f64::to_radians))
    }

    pub fn from_wxyz([w, x, y, z]: [f64; 4]) -> Self {
        Self { w, v: [x, y, z] }
    }

    /// The turn `next`, seen from the body as it then is, added.
    pub fn then_in_body(self, next: Self) -> Self {
        let (a, b) = (self.v, next.v);
        let cross = [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ];
        Self {
            w: self.w * next.w - dot(a, b),
            v: add(cross, add(scale(b, self.w), scale(a, next.w))),
        }
    }

    pub fn inverse(self) -> Self {
        Self {
            w: self.w,
            v: scale(self.v, -1.0),
        }
    }

    pub fn unit(self) -> Self {
        let length = self.length();
        Self {
            w: self.w / length,
            v: scale(self.v, 1.0 / length),
        }
    }

    pub fn length(self) -> f64 {
        self.w.hypot(norm(self.v))
    }

    /// Body vector → world.
    pub fn turn(self, vector: Vector) -> Vector {
        let pure = Self { w: 0.0, v: vector };
        self.then_in_body(pure).then_in_body(self.inverse()).v
    }

    /// Length of the shortest turn that does the same.
    pub fn angle_deg(self) -> f64 {
        (2.0 * norm(self.v).atan2(self.w.abs())).to_degrees()
    }
}
