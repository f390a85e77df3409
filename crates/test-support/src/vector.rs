//! Vectors in double precision.

/// x, y and z.
pub type Vector = [f64; 3];

/// The sum of two vectors.
pub fn add(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

/// `a` times `factor`.
pub fn scale(a: Vector, factor: f64) -> Vector {
    a.map(|part| part * factor)
}

/// The scalar product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The vector product.
pub fn cross([ax, ay, az]: Vector, [bx, by, bz]: Vector) -> Vector {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

/// The length.
pub fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}
