//! Interfaces that cannot react, cannot exist, or are all there is: S-13, S-20, S-21, S-23 to S-27.

use supel::error::Error;
use supel_models::transform::{scaled, supported};
use supel_models::{Ends, HexMesh, Material, Model, spectrum, spring};

use super::{CORNERS, block};
use crate::chain::{direct, interface, rows};
use crate::program::{
    ALL, Case, METHODS, checks, eigensolvers, eigenvalues, lines, message_of, n_rigid, warnings, worst_ratio,
};
use supel::job::{Coupling, NodeSelection};
use supel::verification::check::Verdict;

/// The rank test comes before the factor and names the motion and the ways on; taken out, the factor fails later with another
/// error, or not at all. Rubin's method needs no such interface.
#[test]
fn s_20_interface_that_leaves_a_motion_free() {
    for (labels, rank, words) in [
        (vec![7], 3, "only 3 of the 6 rigid-body motions; free: rotation about the axis through"),
        (
            vec![1, 4],
            5,
            "only 5 of the 6 rigid-body motions; free: rotation about the axis through (0.0000, 0.0000, 0.0000) along",
        ),
        (
            vec![1, 2, 4],
            5,
            "only 5 of the 6 rigid-body motions; free: rotation about the axis through (0.0000, 0.0000, 0.0000) along",
        ),
    ] {
        for method in ALL {
            let case = Case::new(&block(), &[direct("pins", &labels)]).method(method);
            if method == "rubin" {
                // Attachment modes stand in the place of constraint modes, next to amplitudes of rigid-body motion.
                let file = case.verified();
                let n_modes = file.tensors().frequencies.len();
                assert!(n_modes >= 6, "{labels:?}");
                assert_eq!((file.n_rigid(), file.n_coordinates()), (6, 3 * labels.len() + 6 + n_modes), "{labels:?}");
                continue;
            }
            let error = case.refused(&[words, "add interface nodes off that axis, give the nodes rotations", "rubin"]);
            assert!(matches!(error, Error::InterfaceRank { rank: found, n_rigid: 6, .. } if found == rank), "{error}");
            if rank == 5 {
                // The three nodes lie on the x axis.
                let along = error.to_string();
                assert!(
                    along.contains("along (1.0000, 0.0000, 0.0000)")
                        || along.contains("along (-1.0000, 0.0000, 0.0000)"),
                    "{along}"
                );
            }
        }
    }
}

/// A third node off the line by δ: the condition of K_II eats the digits of (24), the correction gives them back.
#[test]
fn s_21_nearly_collinear_interface() {
    let mut ratio_before = 1.0;
    for delta in [0.5, 0.125, 0.03125] {
        // Node 5 is the middle of the edge y = z = 0, from node 1 to node 9.
        let model = bent_brick(delta);
        for method in METHODS {
            let outcome = Case::new(&model, &[direct("line", &[1, 5, 9])]).method(method).accepted();
            let carried = checks(&outcome, "M-11")[0];
            assert!(carried.value <= 1e-12, "{delta}, {method}: {:e}", carried.value);
            let ratio = checks(&outcome, "M-23")[0].value;
            assert_eq!(warnings(&outcome).contains(&"W-INTERFACE-ILL"), ratio > 100.0, "{delta}: {ratio}");
            assert_eq!(lines(&outcome, Verdict::Fail), [""; 0]);
            if method == "herting" {
                assert!(ratio > ratio_before, "{ratio} at {delta}");
                ratio_before = ratio;
            }
        }
    }
    assert!(ratio_before > 100.0, "the last is ill: {ratio_before}");
}

/// A beam of 8 × 2 × 2 hexahedra whose edge y = z = 0 sags by δ in its middle.
fn bent_brick(delta: f64) -> Model {
    let map = |[x, y, z]: [f64; 3]| {
        let sag = delta * (std::f64::consts::PI * x).sin() * (1.0 - y) * (1.0 - z);
        [8.0 * x, 2.0 * y + sag, 2.0 * z]
    };
    HexMesh::structured([8, 2, 2], map, |_| true).assemble(&Material::UNIT)
}

/// Without an interface the component's own modes are the model, rigid-body modes first.
#[test]
fn s_23_no_interface_is_a_modal_model() {
    let model = block();
    let exact = spectrum(&model);
    let rounding = model.n as f64 * 1e-15 * exact[model.n - 1];
    for method in METHODS {
        for eigensolver in eigensolvers() {
            let outcome = Case::new(&model, &[]).method(method).by(eigensolver).clean();
            let found = eigenvalues(&outcome);
            assert_eq!(n_rigid(&outcome), 6);
            for (found, exact) in found.iter().zip(&exact[6..]) {
                assert!((found - exact).abs() <= rounding, "{found} for {exact}");
            }
            let tensors = outcome.superelement.tensors();
            let r = 6 + found.len();
            assert_eq!((tensors.stiffness.rows(), tensors.mass.rows()), (r, r));
            for i in 0..r {
                for j in 0..r {
                    let (k, m) = (tensors.stiffness[(i, j)], tensors.mass[(i, j)]);
                    let lambda = if i >= 6 { found[i - 6] } else { 0.0 };
                    let (k_exact, m_exact) = if i == j { (lambda, 1.0) } else { (0.0, 0.0) };
                    // A few ε for each of n terms, K in units of its largest eigenvalue.
                    assert!((k - k_exact).abs() <= rounding && (m - m_exact).abs() <= 1e-13, "({i}, {j}): {k} {m}");
                }
            }
        }
    }
    let held = supported(&model, |(label, _)| model.groups["XMIN"].contains(&label));
    let by: Vec<_> = METHODS.iter().map(|method| eigenvalues(&Case::new(&held, &[]).method(method).clean())).collect();
    assert!(worst_ratio(&by[0], &by[1]) <= 1e-13);
}

/// Without an interior Ψ = I: the matrices come back to the bit.
#[test]
fn s_24_every_dof_interface_keeps_the_matrices() {
    // A power of two and an odd factor, so that scaling has something to undo.
    let model = scaled(&block(), 1.7, 0.3);
    for method in ALL {
        let outcome = Case::new(&model, &[direct("all", &model.labels)]).method(method).accepted();
        let tensors = outcome.superelement.tensors();
        assert_eq!(tensors.stiffness.rows(), model.n, "{method}");
        let is_macneal = method == "macneal";
        // MacNeal's mass is that of modes and rigid-body motion alone, with an interior or without.
        assert_eq!(outcome.report.body.reduction.mass_rank, is_macneal.then_some(6 + eigenvalues(&outcome).len()));
        for (name, matrix, entries) in [("K", &tensors.stiffness, &model.stiffness), ("M", &tensors.mass, &model.mass)]
        {
            if is_macneal && name == "M" {
                continue;
            }
            let mut full = vec![0.0f64; model.n * model.n];
            entries.iter().for_each(|(i, j, value)| full[*i as usize * model.n + *j as usize] = *value);
            for i in 0..model.n {
                for j in 0..model.n {
                    // Zeros may come back with either sign.
                    assert!(matrix[(i, j)] == full[i * model.n + j], "{name}({i}, {j}) by {method}");
                }
            }
        }
    }
    let chain = spring(20_002, Ends::Free);
    let error =
        Case::new(&chain, &[rows("all", &(0..20_001).collect::<Vec<_>>())]).refused(&["20,001 dofs", "at most 20,000"]);
    assert!(matches!(error, Error::InterfaceTooLarge { .. }), "{error}");
}

#[test]
fn s_25_repeated_interface_nodes() {
    let twice = Case::new(&block(), &[direct("pins", &[1, 12, 1])]).refused(&["\"pins\"", "node 1", "list each once"]);
    assert!(matches!(twice, Error::InterfaceRepeats { .. }), "{twice}");
    let shared = Case::new(&block(), &[direct("a", &CORNERS), direct("b", &[12])]).refused(&["`a` and `b`", "node 12"]);
    assert!(matches!(shared, Error::InterfaceOverlap { .. }), "{shared}");
    let again = rows("pins", &[0, 3, 0]);
    let error =
        Case::new(&Model { dofs: Vec::new(), ..block() }, &[again]).refused(&["\"pins\"", "row 0", "list each once"]);
    assert!(matches!(error, Error::InterfaceRepeats { .. }), "{error}");
}

/// A node held in all directions has no row and is refused; one held in some is reduced without them, and told.
#[test]
fn s_26_constrained_interface_node() {
    let all = supported(&block(), |(label, _)| label == 12);
    let some = supported(&block(), |dof| dof == (12, 2));
    let patch = interface("pins", NodeSelection::Labels(vec![1, 4, 12, 28]), Coupling::Rigid);
    for method in METHODS {
        let error = Case::new(&all, &[direct("pins", &CORNERS)]).method(method).refused(&["node 12", "constrained"]);
        assert!(matches!(error, Error::InterfaceNodeWithoutRows { node: 12, .. }), "{error}");
        for job in [direct("pins", &CORNERS), patch.clone()] {
            let outcome = Case::new(&some, &[job]).method(method).accepted();
            let message = message_of(&outcome, "W-CONSTRAINED-INTERFACE");
            assert!(message.contains("node 12 of interface \"pins\" has no uz"), "{message}");
        }
    }
}

/// Multipliers of rigid links: a zero on the diagonal of a row that is not empty.
#[test]
fn s_27_multiplier_rows_are_refused() {
    let mut model = block();
    // ux of node 1 tied to ux of node 2 by a multiplier in a row of its own.
    let multiplier = model.n as u32;
    for (row, value) in [(0, 1.0), (3, -1.0)] {
        model.stiffness.extend([(multiplier, row, value), (row, multiplier, value)]);
    }
    model.dofs.push((99, 0));
    model.labels.push(99);
    model.nodes.push([0.0; 3]);
    model.n += 1;
    model.stiffness.sort_by_key(|(row, column, _)| (*row, *column));
    for method in METHODS {
        let error = Case::new(&model, &[direct("pins", &CORNERS)]).method(method).refused(&[
            "row 109",
            "multiplier",
            "eliminate constraints before exporting",
        ]);
        assert!(matches!(error, Error::MultiplierRow { row: 109, .. }), "{error}");
    }
}
