//! Motions, their parameters and tangent operators: identities of the paper, and central differences.

use std::f64::consts::PI;

use supel_models::SplitMix64;
use supel_runtime::motion::{
    self, IDENTITY_6, Matrix3, Matrix6, Motion, Vector3, Vector6, check, cross, hat, multiply_6, skew, tangent,
    tangent_3, tangent_inverse, tangent_inverse_3, tangent_inverse_rate, tangent_inverse_rate_3, times_6,
    transposed_times_6,
};

/// A central difference at this step has truncation errors of step² ≈ 1e-10 and rounding errors of 1e-16/1e-5 = 1e-11,
/// each times third derivatives of order one to ten.
const STEP: f64 = 1e-5;
const DIFFERENCE_TOLERANCE: f64 = 1e-8;

/// Some tens of operations on numbers of order one.
const ROUNDING: f64 = 1e-14;

#[track_caller]
fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (i, (x, y)) in found.iter().zip(expected).enumerate() {
        assert!((x - y).abs() <= tolerance, "entry {i}: {x} instead of {y}\n{found:?}\n{expected:?}");
    }
}

#[track_caller]
fn assert_same_motion(found: &Motion, expected: &Motion, tolerance: f64) {
    assert_close(found.rotation.as_flattened(), expected.rotation.as_flattened(), tolerance);
    assert_close(&found.translation, &expected.translation, tolerance);
}

fn plus(a: &Vector6, factor: f64, b: &Vector6) -> Vector6 {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

/// Parameters with |p_θ| up to 1.4, rotations up to 90 degrees.
fn samples() -> Vec<Vector6> {
    let mut random = SplitMix64::new(1);
    (0..20).map(|_| random.vector_6(0.8)).collect()
}

fn minus(p: &Vector6) -> Vector6 {
    p.map(|x| -x)
}

#[test]
fn motions_form_a_group() {
    let mut random = SplitMix64::new(2);
    let (a, b, c) = (random.motion(1.5), random.motion(1.5), random.motion(1.5));
    assert_same_motion(&a.compose(&b).compose(&c), &a.compose(&b.compose(&c)), ROUNDING);
    assert_same_motion(&a.compose(&a.inverse()), &Motion::IDENTITY, ROUNDING);
    assert_same_motion(&a.relative(&b), &a.inverse().compose(&b), ROUNDING);
    let x = random.vector_3(2.0);
    assert_close(&a.compose(&b).apply(&x), &a.apply(&b.apply(&x)), ROUNDING);
}

#[test]
fn a_drift_from_the_rotations_is_squared_away() {
    let mut random = SplitMix64::new(9);
    let h = random.motion(1.5);
    for drift in [1e-3, 1e-6] {
        let mut drifted = h;
        drifted.rotation.iter_mut().flatten().for_each(|entry| *entry += drift * random.either_sign());
        let back = drifted.orthonormalised();
        let gram = motion::multiply_transposed_3(&back.rotation, &back.rotation);
        assert_close(gram.as_flattened(), motion::IDENTITY_3.as_flattened(), 9.0 * drift * drift + ROUNDING);
        assert_same_motion(&back, &h, 3.0 * drift);
    }
}

#[test]
fn exponential_of_small_and_large_angles_turns_about_the_axis() {
    for angle in [0.0, 1e-9, 9.99e-3, 1.001e-2, 1.0, 3.0, 6.0] {
        let h = Motion::exp(&[1.0, 2.0, 3.0, 0.0, 0.0, angle]);
        let (sine, cosine) = angle.sin_cos();
        let rotation = [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]];
        assert_close(h.rotation.as_flattened(), rotation.as_flattened(), ROUNDING);
        // Constant velocity (1, 2) in a turning frame: the integral of R(s) (1, 2) over s from 0 to 1.
        let (a, b) = if angle == 0.0 { (1.0, 0.0) } else { (sine / angle, 2.0 * (0.5 * angle).sin().powi(2) / angle) };
        assert_close(&h.translation, &[a - 2.0 * b, b + 2.0 * a, 3.0], ROUNDING);
    }
}

#[test]
fn exponentials_of_one_vector_add_up() {
    let mut random = SplitMix64::new(3);
    let v = random.vector_6(1.0);
    let (first, second) = (Motion::exp(&v.map(|x| 0.3 * x)), Motion::exp(&v.map(|x| 0.7 * x)));
    assert_same_motion(&second.compose(&first), &Motion::exp(&v), ROUNDING);
}

#[test]
fn parameters_and_motions_map_to_each_other() {
    for p in samples() {
        let h = Motion::from_parameters(&p).expect("less than half a turn");
        assert_close(&h.parameters().expect("less than half a turn"), &p, ROUNDING);
    }
    assert_eq!(Motion::IDENTITY.parameters(), Some([0.0; 6]));
}

#[test]
fn the_rotation_parameter_is_twice_the_sine_of_half_the_angle() {
    for angle in [1e-8, 0.5, 2.0, 3.1] {
        let p = Motion::exp(&[0.0, 0.0, 0.0, 0.0, angle, 0.0]).parameters().expect("less than half a turn");
        // Near half a turn the square root divides rounding errors by cos(φ/2).
        assert_close(&p, &[0.0, 0.0, 0.0, 0.0, 2.0 * (0.5 * angle).sin(), 0.0], ROUNDING / (0.5 * angle).cos());
    }
}

#[test]
fn half_a_turn_and_not_a_number_have_no_parameters() {
    for angle in [PI, PI - 1e-4, PI + 1e-4, -PI] {
        for axis in 3..6 {
            let mut v = [0.1; 6];
            v[3..].fill(0.0);
            v[axis] = angle;
            assert_eq!(Motion::exp(&v).parameters(), None, "angle {angle}");
        }
    }
    for bad in [f64::NAN, f64::INFINITY] {
        for entry in 0..12 {
            let mut h = Motion::IDENTITY;
            if entry < 9 {
                h.rotation[entry / 3][entry % 3] = bad
            } else {
                h.translation[entry - 9] = bad
            }
            assert_eq!(h.parameters(), None, "entry {entry}");
        }
    }
    assert_eq!(Motion::from_parameters(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]), None);
    assert_eq!(Motion::from_parameters(&[0.0, 0.0, 0.0, 1.5, 1.5, 0.0]), None);
    assert_eq!(Motion::from_parameters(&[f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0]), None);
}

#[test]
fn tangent_operators_are_derivatives_of_the_motion() {
    let mut random = SplitMix64::new(4);
    for p in samples() {
        let direction = random.vector_6(1.0);
        let at = |s: f64| Motion::from_parameters(&plus(&p, s * STEP, &direction)).expect("less than half a turn");
        // H(p)⁻¹ dH = d̃U.
        let (h, ahead, behind) = (at(0.0), at(1.0), at(-1.0));
        let (forward, backward) = (h.relative(&ahead), h.relative(&behind));
        let difference = |i: usize, j: usize| (forward.rotation[i][j] - backward.rotation[i][j]) / (2.0 * STEP);
        let u: Vector3 = std::array::from_fn(|i| (forward.translation[i] - backward.translation[i]) / (2.0 * STEP));
        let found = times_6(&tangent(&p), &direction);
        assert_close(&found[..3], &u, DIFFERENCE_TOLERANCE);
        assert_close(&found[3..], &[difference(2, 1), difference(0, 2), difference(1, 0)], DIFFERENCE_TOLERANCE);
    }
}

#[test]
fn tangent_operators_and_their_inverses_fit() {
    for p in samples() {
        let product = multiply_6(&tangent(&p), &tangent_inverse(&p));
        assert_close(product.as_flattened(), IDENTITY_6.as_flattened(), ROUNDING);
        let rotation: Vector3 = [p[3], p[4], p[5]];
        for (found, expected) in [
            (corner(&tangent(&p), 0), tangent_3(&rotation)),
            (corner(&tangent(&p), 3), tangent_3(&rotation)),
            (corner(&tangent_inverse(&p), 0), tangent_inverse_3(&rotation)),
            (corner(&tangent_inverse(&p), 3), tangent_inverse_3(&rotation)),
        ] {
            assert_eq!(found, expected);
        }
    }
    assert_eq!(tangent(&[0.0; 6]), IDENTITY_6);
}

/// Diagonal block of three from `start`.
fn corner(a: &Matrix6, start: usize) -> Matrix3 {
    std::array::from_fn(|i| std::array::from_fn(|j| a[start + i][start + j]))
}

#[test]
fn inverse_tangent_of_opposite_parameters_differs_by_hat() {
    for p in samples() {
        let (plus, minus) = (tangent_inverse(&p), tangent_inverse(&minus(&p)));
        let difference: Vec<f64> = plus.as_flattened().iter().zip(minus.as_flattened()).map(|(x, y)| x - y).collect();
        assert_close(&difference, hat(&p).as_flattened(), ROUNDING);
    }
}

#[test]
fn tangent_times_inverse_tangent_of_opposite_parameters_is_the_inverse_motion_tensor() {
    for p in samples() {
        let h = Motion::from_parameters(&p).expect("less than half a turn");
        let product = multiply_6(&tangent(&p), &tangent_inverse(&minus(&p)));
        assert_close(product.as_flattened(), h.inverse().tensor().as_flattened(), ROUNDING);
    }
}

#[test]
fn relative_parameters_follow_both_frames() {
    let mut random = SplitMix64::new(5);
    for _ in 0..20 {
        let (a, b) = (random.motion(0.4), random.motion(0.4));
        let (da, db) = (random.vector_6(1.0), random.vector_6(1.0));
        let at = |s: f64| {
            let step = |v: &Vector6| Motion::exp(&v.map(|x| s * STEP * x));
            a.compose(&step(&da)).relative(&b.compose(&step(&db))).parameters().expect("less than half a turn")
        };
        let p = at(0.0);
        let found = plus(&times_6(&tangent_inverse(&p), &db), -1.0, &times_6(&tangent_inverse(&minus(&p)), &da));
        let expected = plus(&at(1.0), -1.0, &at(-1.0)).map(|x| x / (2.0 * STEP));
        assert_close(&found, &expected, DIFFERENCE_TOLERANCE);
    }
}

#[test]
fn rates_are_derivatives_of_the_inverse_tangents() {
    let mut random = SplitMix64::new(6);
    for p in samples() {
        let rate = random.vector_6(1.0);
        let (ahead, behind) = (plus(&p, STEP, &rate), plus(&p, -STEP, &rate));
        let difference =
            |f: &[f64], b: &[f64]| -> Vec<f64> { f.iter().zip(b).map(|(f, b)| (f - b) / (2.0 * STEP)).collect() };
        let expected = difference(tangent_inverse(&ahead).as_flattened(), tangent_inverse(&behind).as_flattened());
        assert_close(tangent_inverse_rate(&p, &rate).as_flattened(), &expected, DIFFERENCE_TOLERANCE);
        let rotation = |p: &Vector6| [p[3], p[4], p[5]];
        let expected = difference(
            tangent_inverse_3(&rotation(&ahead)).as_flattened(),
            tangent_inverse_3(&rotation(&behind)).as_flattened(),
        );
        let found = tangent_inverse_rate_3(&rotation(&p), &rotation(&rate));
        assert_close(found.as_flattened(), &expected, DIFFERENCE_TOLERANCE);
    }
}

#[test]
fn hat_is_the_commutator_and_check_its_adjoint() {
    let mut random = SplitMix64::new(7);
    let (a, b) = (random.vector_6(1.0), random.vector_6(1.0));
    assert_close(&times_6(&hat(&a), &b), &times_6(&hat(&b), &a).map(|x| -x), ROUNDING);
    assert_close(&transposed_times_6(&hat(&a), &b), &times_6(&check(&b), &a), ROUNDING);
    // exp(a) exp(b) exp(−a) exp(−b) turns by [a, b] to second order, with errors of third order.
    let small = |v: &Vector6, s: f64| Motion::exp(&v.map(|x| s * x));
    let loop_at = |s: f64| {
        let there = small(&a, s).compose(&small(&b, s));
        there.compose(&small(&a, -s)).compose(&small(&b, -s)).parameters().expect("a small motion")
    };
    // The third-order term is odd in s and drops out of the mean.
    let s = 1e-3;
    let mean: Vector6 = std::array::from_fn(|i| 0.5 * (loop_at(s)[i] + loop_at(-s)[i]) / (s * s));
    assert_close(&mean, &times_6(&hat(&a), &b), 1e-5);
    let (x, y) = (random.vector_3(1.0), random.vector_3(1.0));
    assert_eq!(motion::times_3(&skew(&x), &y), cross(&x, &y));
}

#[test]
fn the_motion_tensor_turns_material_into_spatial_increments() {
    let mut random = SplitMix64::new(8);
    let (h, v) = (random.motion(1.0), random.vector_6(1e-6));
    // H exp(v) = exp(C v) H to first order in every entry, exactly in the group.
    let spatial = Motion::exp(&times_6(&h.tensor(), &v)).compose(&h);
    assert_same_motion(&h.compose(&Motion::exp(&v)), &spatial, ROUNDING);
}
