//! Held beams and bodies against closed formulae.

use std::f64::consts::{PI, TAU};

use supel_models::{Material, Section};
use supel_testing::place::{frequencies_hz, steel_brick};

use crate::{Case, beam, n_rigid};

const N: usize = 20;
const LENGTH: f64 = 1.0;
const RADIUS: f64 = 0.005;

/// Bending frequencies of Euler and Bernoulli for the roots βL, each twice: a round bar bends in two planes.
fn bending(roots: &[f64]) -> Vec<(f64, f64)> {
    let (section, steel) = (Section::round(RADIUS), Material::STEEL_SI);
    let stiffness = (steel.young * section.second_moment_y / (steel.density * section.area)).sqrt();
    roots.iter().flat_map(|root| [(*root, (root / LENGTH).powi(2) * stiffness / TAU); 2]).collect()
}

/// Cubic elements with consistent mass come from above, their eigenvalues off by (βh)⁴/720 of themselves and by terms of higher order.
fn assert_bending(found: &[f64], roots: &[f64]) {
    let expected = bending(roots);
    assert!(found.len() >= expected.len(), "{found:?}");
    for (found, (root, expected)) in found.iter().zip(expected) {
        let surplus = (found / expected).powi(2) - 1.0;
        let of_elements = (root / N as f64).powi(4) / 720.0;
        // The largest eigenvalue is 1e8 times the first; a rounding of it is what the first is known to.
        assert!((-1e-8..=2.0 * of_elements + 1e-8).contains(&surplus), "βL = {root}: {surplus:e}, {of_elements:e}");
    }
}

fn case(fixed: &'static str, interface: &'static str) -> Case {
    Case { name: "beam", model: beam(N, LENGTH, RADIUS), interface, fixed, has_nodes: true }
}

/// cos βL cosh βL = −1.
#[test]
fn clamped_free_beam() {
    let made = case("{ nodes = [1] }", r#"{ name = "tip", nodes = [21] }"#).made("herting", 6);
    assert_eq!(n_rigid(&made.report), 0);
    assert_bending(&frequencies_hz(&made.file), &[1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_612]);
}

/// βL = nπ.
#[test]
fn beam_pinned_at_both_ends() {
    let fixed = r#"{ nodes = [1], dofs = ["ux", "uy", "uz", "rx"] }, { nodes = [21], dofs = ["uy", "uz"] }"#;
    let made = case(fixed, r#"{ name = "middle", nodes = [11] }"#).made("herting", 6);
    assert_eq!(n_rigid(&made.report), 0);
    assert_bending(&frequencies_hz(&made.file), &[PI, 2.0 * PI, 3.0 * PI]);
}

/// The beam between its pins turns about itself: one rigid-body mode, and the bending of before.
#[test]
fn beam_between_points_turns_about_its_axis() {
    let fixed = r#"{ nodes = [1], dofs = ["ux", "uy", "uz"] }, { nodes = [21], dofs = ["uy", "uz"] }"#;
    let made = case(fixed, r#"{ name = "middle", nodes = [11] }"#).made("herting", 6);
    assert_eq!(n_rigid(&made.report), 1);
    let u = &made.file.tensors().rigid_body_modes;
    // Of the interface only rx moves, but for what rounding turns the motion by.
    let largest = u[(3, 0)].abs();
    for row in [0, 1, 2, 4, 5] {
        assert!(u[(row, 0)].abs() <= 1e-8 * largest, "row {row}: {:e} of {largest:e}", u[(row, 0)]);
    }
    assert_bending(&frequencies_hz(&made.file), &[PI, 2.0 * PI, 3.0 * PI]);
}

/// tan βL = tanh βL for a beam on one pin, which also turns with it.
#[test]
fn beam_on_one_pin_keeps_three_rotations() {
    let made =
        case(r#"{ nodes = [1], dofs = ["ux", "uy", "uz"] }"#, r#"{ name = "tip", nodes = [21] }"#).made("herting", 6);
    assert_eq!(n_rigid(&made.report), 3);
    assert_bending(&frequencies_hz(&made.file), &[3.926_602_312_047_919, 7.068_582_745_628_732, 10.210_176_122_813_03]);
}

/// The rotations about the point: U_B = θ × (x − x₀) at every interface node, for three independent θ.
#[test]
fn a_body_held_at_one_point_turns_about_it() {
    let model = steel_brick();
    let at = model.nodes[0];
    let (labels, positions): (Vec<i64>, Vec<[f64; 3]>) =
        [5, 15, 45].map(|label: i64| (label, model.nodes[label as usize - 1])).into_iter().unzip();
    assert_eq!(labels, [5, 15, 45]);
    let interface = r#"{ name = "tip", nodes = [5, 15, 45] }"#;
    let case = Case { name: "body", model, interface, fixed: "{ nodes = [1] }", has_nodes: true };
    let made = case.made("craig-bampton", 4);
    assert_eq!(n_rigid(&made.report), 3);
    let u = &made.file.tensors().rigid_body_modes;
    for mode in 0..3 {
        // No point of a body nears the one it turns about: x · u = 0.
        let size = (0..9).map(|row| u[(row, mode)].abs()).fold(0.0, f64::max);
        for (node, x) in positions.iter().enumerate() {
            let radial: f64 = (0..3).map(|axis| (x[axis] - at[axis]) * u[(3 * node + axis, mode)]).sum();
            // The motion is known to what rounding of K leaves of it, some hundred roundings; the body has unit size.
            assert!(radial.abs() <= 1e-11 * size, "mode {mode}, node {node}: {radial:e} of {size:e}");
        }
    }
}
