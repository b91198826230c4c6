//! Rigid patches of nodes that have internal forces, whose arms turn with the patch.

use std::array::from_fn;

use supel_models::SplitMix64;
use supel_runtime::{Coordinate, Superelement};
use supel_testing::pencil::{eigen, unpacked};

use crate::network::{Network, Nodes, rotated, tower};
use crate::theory::assert_verified;
use crate::{Made, made, n_rigid};

/// Tension over stiffness and length, as much as the nodes with rotations stand: forces and their arms are some hundredths of the stiffness.
const STRAIN: f64 = 0.03;
const BOTH: [Nodes; 2] = [Nodes::Points, Nodes::Bodies];
const FOOT: &str = r#"{ name = "foot", nodes = [1, 2, 3, 4], coupling = "rigid" }"#;
const REST: &str = r#"{ name = "rest", nodes = [5, 6, 7, 8, 9, 10, 11, 12] }"#;

/// Where the coordinates of a file take the nodes of a network: those that none of them names move with its one node without a label, as a
/// body that turns by a finite angle.
fn displacements(network: &Network, file: &Superelement, x: &[f64]) -> Vec<f64> {
    let (metadata, n) = (file.metadata(), network.n_directions);
    let mut u = vec![f64::NAN; network.model.n];
    let (mut body, mut centre) = ([0.0; 6], [0.0; 3]);
    for (coordinate, x) in metadata.coordinates.iter().zip(x) {
        let Coordinate::Interface { node, direction } = *coordinate else { panic!("{coordinate:?}") };
        let named = &metadata.interface_nodes[node];
        match named.label {
            Some(label) => u[n * (label as usize - 1) + direction as usize] = *x,
            None => (body[direction as usize], centre) = (*x, named.position),
        }
    }
    let theta = [body[3], body[4], body[5]];
    for node in (0..12).filter(|node| u[n * node].is_nan()).collect::<Vec<_>>() {
        let arm: [f64; 3] = from_fn(|i| network.model.nodes[node][i] - centre[i]);
        let turned = rotated(theta, arm);
        (0..3).for_each(|i| u[n * node + i] = body[i] + turned[i] - arm[i]);
        (3..n).for_each(|i| u[n * node + i] = theta[i - 3]);
    }
    assert!(u.iter().all(|u| u.is_finite()));
    u
}

/// K̂ is the second derivative of the energy of a network with a part of it rigid, and all the rest among the coordinates.
#[track_caller]
fn assert_second_derivative(network: &Network, made: &Made) {
    /// As in the tests of the networks themselves.
    const H: f64 = 1e-3;
    let k = unpacked(&made.file.tensors().stiffness);
    let mut random = SplitMix64::new(5);
    for turned_alone in [true, false, false, false] {
        let of_body = |i: usize| {
            matches!(made.file.metadata().coordinates[i], Coordinate::Interface { node, direction }
            if made.file.metadata().interface_nodes[node].label.is_none() && direction as usize >= 3)
        };
        let x: Vec<f64> =
            (0..k.nrows()).map(|i| if turned_alone && !of_body(i) { 0.0 } else { random.normal() }).collect();
        let at = |h: f64| {
            let x: Vec<f64> = x.iter().map(|x| h * x).collect();
            network.energy(&displacements(network, &made.file, &x))
        };
        let second = (at(H) + at(-H) - 2.0 * at(0.0)) / (H * H);
        let expected: f64 = (0..x.len()).map(|i| (0..x.len()).map(|j| x[i] * k[(i, j)] * x[j]).sum::<f64>()).sum();
        assert!((second / expected - 1.0).abs() < 100.0 * H * H, "{turned_alone}: {second} {expected}");
    }
}

#[test]
fn a_patch_turns_the_arms_of_its_forces() {
    for nodes in BOTH {
        let network = tower(nodes, STRAIN);
        let all = made(&network, &format!("{FOOT}, {REST}"), r#"method = "guyan""#);
        assert_second_derivative(&network, &all);
        let [k, m] = [&all.file.tensors().stiffness, &all.file.tensors().mass].map(unpacked);
        let free = eigen(k.as_ref(), m.as_ref(), 1e4).0;
        assert!(free[2].abs() < 1e-6 * free[3], "{free:?}");
        let interface = format!(r#"{FOOT}, {{ name = "tip", nodes = [11, 12] }}"#);
        for method in ["herting", "rubin", "macneal"] {
            let made = made(&network, &interface, &format!(r#"method = "{method}", modes = {{ count = 8 }}"#));
            assert_eq!(n_rigid(&made.report), 3, "{method}");
            for (omega, lambda) in made.file.tensors().frequencies.iter().zip(&free[3..]) {
                // Both pencils have K̂ to rounding, which conditions of 1e4 enlarge.
                assert!((omega * omega / lambda - 1.0).abs() < 1e-9, "{method}: {} {lambda}", omega * omega);
            }
            assert_verified(&made);
        }
        let made = made(&network, &interface, r#"method = "craig-bampton", modes = { count = 8 }"#);
        assert_verified(&made);
    }
}

/// A patch by itself holds the whole component; rotations of its node are coordinates, or none of them.
#[test]
fn one_patch_alone() {
    let network = tower(Nodes::Points, STRAIN);
    let made_with = |interface: &str| made(&network, interface, r#"method = "herting", modes = { count = 8 }"#);
    let whole = made_with(FOOT);
    assert_verified(&whole);
    let without = made_with(&FOOT.replace(" }", r#", dofs = ["ux", "uy", "uz"] }"#));
    assert_verified(&without);
    for (one, other) in whole.file.tensors().frequencies.iter().zip(&without.file.tensors().frequencies) {
        assert!((one / other - 1.0).abs() < 1e-9, "{one} {other}");
    }
}

/// A carrier is the node of a rigid body: of a patch and of single nodes.
#[test]
fn a_carrier_turns_the_arms_of_its_forces() {
    for nodes in BOTH {
        let network = tower(nodes, STRAIN);
        let foot = FOOT.replace("[1, 2, 3, 4]", "[1, 2, 3]");
        let interface = format!(
            "{foot}, {{ name = \"corner\", nodes = [4] }}, {REST}]
            scene.prescribed = [{{ name = \"table\", interfaces = [\"foot\", \"corner\"] }}"
        );
        let made = made(&network, &interface, r#"method = "guyan""#);
        assert_second_derivative(&network, &made);
        assert_verified(&made);
    }
}
