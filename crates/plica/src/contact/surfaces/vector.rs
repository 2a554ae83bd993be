//! Vectors (z, x, y) in three dimensions.

/// A point or a vector (z, x, y).
pub type Vector = [f64; 3];

/// Returns a · b.
#[inline(always)]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns a − b.
#[inline(always)]
pub fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns a + t b.
#[inline(always)]
pub fn plus(a: Vector, t: f64, b: Vector) -> Vector {
    [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]]
}

/// Returns the point at the fraction t between a and b.
#[inline(always)]
pub fn between(a: Vector, b: Vector, t: f64) -> Vector {
    [0, 1, 2].map(|i| (1.0 - t) * a[i] + t * b[i])
}

/// Returns the length of a.
#[inline(always)]
pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Returns a × b.
#[inline(always)]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
