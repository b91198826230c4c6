//! Vectors and matrices of three and six, and the operators hat (54) and check (55).

/// Vector of three.
pub type Vector3 = [f64; 3];
/// Vector of six: translation part, then rotation part.
pub type Vector6 = [f64; 6];
/// 3 × 3, row by row.
pub type Matrix3 = [[f64; 3]; 3];
/// 6 × 6, row by row.
pub type Matrix6 = [[f64; 6]; 6];

/// 3 × 3 identity.
pub const IDENTITY_3: Matrix3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Zero, 3 × 3.
pub(crate) const ZERO_3: Matrix3 = [[0.0; 3]; 3];

/// 6 × 6 identity.
pub const IDENTITY_6: Matrix6 = {
    let mut identity = [[0.0; 6]; 6];
    let mut i = 0;
    while i < 6 {
        identity[i][i] = 1.0;
        i += 1;
    }
    identity
};

/// aᵀb.
#[inline]
pub fn dot(a: &Vector3, b: &Vector3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
#[inline]
pub fn cross(a: &Vector3, b: &Vector3) -> Vector3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// ã, with ã b = a × b.
#[inline]
pub fn skew(a: &Vector3) -> Matrix3 {
    [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]]
}

/// A b.
#[inline]
pub fn times_3(a: &Matrix3, b: &Vector3) -> Vector3 {
    core::array::from_fn(|i| dot(&a[i], b))
}

/// Aᵀb.
#[inline]
pub fn transposed_times_3(a: &Matrix3, b: &Vector3) -> Vector3 {
    core::array::from_fn(|i| a[0][i] * b[0] + a[1][i] * b[1] + a[2][i] * b[2])
}

/// A B.
#[inline]
pub fn multiply_3(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    core::array::from_fn(|i| transposed_times_3(b, &a[i]))
}

/// AᵀB.
#[inline]
pub fn multiply_transposed_3(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    core::array::from_fn(|i| transposed_times_3(b, &[a[0][i], a[1][i], a[2][i]]))
}

/// Translation part and rotation part.
#[inline]
pub fn split(a: &Vector6) -> (Vector3, Vector3) {
    ([a[0], a[1], a[2]], [a[3], a[4], a[5]])
}

/// (u; θ).
#[inline]
pub fn join(u: &Vector3, theta: &Vector3) -> Vector6 {
    [u[0], u[1], u[2], theta[0], theta[1], theta[2]]
}

/// A b.
#[inline]
pub fn times_6(a: &Matrix6, b: &Vector6) -> Vector6 {
    core::array::from_fn(|i| a[i].iter().zip(b).map(|(x, y)| x * y).sum())
}

/// Aᵀb.
#[inline]
pub fn transposed_times_6(a: &Matrix6, b: &Vector6) -> Vector6 {
    let mut product = [0.0; 6];
    for (row, factor) in a.iter().zip(b) {
        for (sum, entry) in product.iter_mut().zip(row) {
            *sum += entry * factor;
        }
    }
    product
}

/// A B.
#[inline]
pub fn multiply_6(a: &Matrix6, b: &Matrix6) -> Matrix6 {
    core::array::from_fn(|i| transposed_times_6(b, &a[i]))
}

/// V̂ = [ω̃, ṽ; 0, ω̃] for V = (v; ω), with Â B = −B̂ A; eq. (54).
#[inline]
pub fn hat(v: &Vector6) -> Matrix6 {
    let (linear, angular) = split(v);
    let (linear, angular) = (skew(&linear), skew(&angular));
    blocks(&angular, &linear, &ZERO_3, &angular)
}

/// V̌ = [0, ṽ; ṽ, ω̃] for V = (v; ω), with Âᵀ B = B̌ A; eq. (55).
#[inline]
pub fn check(v: &Vector6) -> Matrix6 {
    let (linear, angular) = split(v);
    let (linear, angular) = (skew(&linear), skew(&angular));
    blocks(&ZERO_3, &linear, &linear, &angular)
}

/// [a, b; c, d].
#[inline]
pub(crate) fn blocks(a: &Matrix3, b: &Matrix3, c: &Matrix3, d: &Matrix3) -> Matrix6 {
    core::array::from_fn(|i| if i < 3 { join(&a[i], &b[i]) } else { join(&c[i - 3], &d[i - 3]) })
}
