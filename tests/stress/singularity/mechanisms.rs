//! Motions without energy that are not rigid-body motions: S-05, S-06, S-22.

use faer::Mat;
use faer::linalg::solvers::Solve;
use supel::job::{InterfaceJob, NodeSelection};
use supel::outcome::Outcome;
use supel_models::model::Assembler;
use supel_models::transform::{join, supported, translated};
use supel_models::{Material, Model, brick};
use supel_runtime::Superelement;
use supel_testing::cases::{hinged, hinged_pins};
use supel_testing::pencil::unpacked;

use super::{CORNERS, block};

use crate::chain::direct;
use crate::program::{
    ALL, Case, FREE, METHODS, array, eigensolvers, eigenvalues, message_of, n_rigid, warnings, worst_ratio,
};

/// Two blocks that share one corner: a ball joint.
fn ball_jointed() -> Model {
    let block = brick([4, 2, 2], [4.0, 2.0, 2.0], &Material::UNIT);
    join(&block, &translated(&block, [4.0, 2.0, 2.0]), &[(45, 1)])
}

/// A model of two bodies with an interface on each, and the number of its zero modes.
type Jointed = (Model, [InterfaceJob; 2], usize);

fn jointed() -> [Jointed; 2] {
    let hinge = (hinged(), hinged_pins(), 7);
    let ball = (ball_jointed(), [direct("here", &[1, 2, 6]), direct("there", &[80, 83, 88])], 9);
    [hinge, ball]
}

/// Zero modes beyond the rigid ones are kept like rigid-body modes, by all methods alike, and told.
#[test]
fn s_05_ball_joint_and_hinge_are_kept_as_zero_modes() {
    for (model, interfaces, n_zero) in jointed() {
        let exact = supel_models::spectrum(&model);
        let top = exact[model.n - 1];
        // The gap of the catalogue.
        assert!(
            exact[n_zero - 1] <= 100.0 * f64::EPSILON * top && exact[n_zero] >= 1e-5 * top,
            "{:?}",
            &exact[..n_zero + 1]
        );
        // Jacobi rotations leave n ε of the largest eigenvalue.
        let rounding = model.n as f64 * 1e-15 * top;
        let agrees = |outcome: &Outcome, how: &str| {
            for (found, exact) in eigenvalues(outcome).iter().zip(&exact[n_zero..]) {
                assert!((found - exact).abs() <= rounding, "{how}: {found} for {exact}");
            }
        };
        for method in ALL {
            let outcome = Case::new(&model, &interfaces).method(method).warned(&["W-MECHANISM"]);
            assert_eq!(n_rigid(&outcome), n_zero, "{method}");
            let message = message_of(&outcome, "W-MECHANISM");
            let beyond = format!("{n_zero} motions cost no energy, {} of them inside", n_zero - 6);
            assert!(message.contains(&beyond) && message.contains("largest at node "), "{message}");
            // Mass properties are those of the body, mechanism or not.
            let mass = outcome.report.body.model.mass_properties.mass.expect("a mass");
            assert!((mass / model.total_mass(0) - 1.0).abs() < 1e-12, "{mass}");
            if FREE.contains(&method) {
                // A cluster comes whole.
                assert!((6..9).contains(&eigenvalues(&outcome).len()), "{method}");
                agrees(&outcome, method);
            }
        }
        for eigensolver in eigensolvers() {
            agrees(&Case::new(&model, &interfaces).by(eigensolver).accepted(), eigensolver);
        }
    }
}

/// A load in balance on the second body, whose answer the file has exactly: K W q is the load again. The file is right by itself
/// and against its model.
#[test]
fn s_05_loads_behind_a_joint_are_answered() {
    for (model, interfaces, n_zero) in jointed() {
        let place = |label: i64| model.labels.iter().position(|other| *other == label).expect("a node");
        let row = |label: i64| model.dofs.iter().position(|dof| *dof == (label, 0)).expect("a dof");
        // Two nodes of the second body inside, pulled apart along the line between them.
        let inside: Vec<i64> =
            model.labels.iter().rev().copied().filter(|label| !is_held(&interfaces, *label)).collect();
        let (a, b) = (inside[0], inside[2]);
        let mut load = vec![0.0; model.n];
        for axis in 0..3 {
            let along = model.nodes[place(b)][axis] - model.nodes[place(a)][axis];
            (load[row(a) + axis], load[row(b) + axis]) = (-along, along);
        }
        for method in ALL {
            let file = Case {
                tables: "recovery = { nodes = { within = { box = { min = [-9, -9, -9], max = [9, 9, 9] } } } }\n\
                         [[load]]\nname = \"pull\"\nfile = \"f.mtx\"\n"
                    .to_owned(),
                files: vec![("f.mtx", array(std::slice::from_ref(&load)))],
                ..Case::new(&model, &interfaces).method(method)
            }
            .verified();
            assert_eq!(file.n_rigid(), n_zero, "{method}");
            let left = residual(&model, &file, &load);
            assert!(left <= 1e-10, "{method}: {left:e} of the load is left");
        }
    }
}

fn is_held(interfaces: &[InterfaceJob], label: i64) -> bool {
    let lists = interfaces.iter().map(|interface| &interface.nodes);
    lists.into_iter().any(|nodes| matches!(nodes, NodeSelection::Labels(labels) if labels.contains(&label)))
}

/// |K W q − f| / |f| for K̂ q = f̂ with q free of momentum.
fn residual(model: &Model, file: &Superelement, load: &[f64]) -> f64 {
    let tensors = file.tensors();
    let [k, m, u] = [&tensors.stiffness, &tensors.mass, &tensors.rigid_body_modes].map(unpacked);
    let momenta = &m * &u;
    // Momenta of unit length are held as stiffly as the component is.
    let unit = Mat::from_fn(momenta.nrows(), momenta.ncols(), |i, j| momenta[(i, j)] / momenta.col(j).norm_l2());
    let size = k.norm_max();
    let held = &k + (&unit * unit.transpose()) * faer::Scale(size);
    let q = held.partial_piv_lu().solve(unpacked(tensors.load_vectors.as_ref().expect("a load")));
    let moved = unpacked(tensors.recovery.as_ref().expect("all rows").rows()) * &q;
    let moved: Vec<f64> = (0..model.n).map(|i| moved[(i, 0)]).collect();
    let force = supel_models::model::multiply(&model.stiffness, &moved);
    let norm = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>().sqrt();
    norm(&mut force.iter().zip(load).map(|(a, b)| a - b)) / norm(&mut load.iter().copied())
}

/// Without coordinates the matrices tell the same number.
#[test]
fn s_05_hinge_without_coordinates_is_told_too() {
    let model = Model { dofs: Vec::new(), ..hinged() };
    let interfaces = [crate::chain::rows("pins", &[0, 1, 2, 4, 9, 10, 11, 18, 50, 51, 52, 53])];
    for method in METHODS {
        let outcome = Case::new(&model, &interfaces).method(method).warned(&["W-MECHANISM"]);
        assert_eq!(n_rigid(&outcome), 7, "{method}");
    }
}

/// A part that swings behind a hinge, and that no interface reaches, cannot be held: K_II is singular.
#[test]
fn s_05_loose_part_behind_a_joint_is_refused() {
    for method in ALL {
        let case = Case::new(&ball_jointed(), &[direct("here", &[1, 2, 6])]).method(method);
        case.refused(&["elimination stopped at node ", "mechanism"]);
    }
}

/// The hinge with a spring of stiffness k against its rotation: between two nodes that move apart when it turns.
fn sprung(k: f64) -> Model {
    let model = hinged();
    let row =
        |label: i64, direction: u8| model.dofs.iter().position(|dof| *dof == (label, direction)).expect("a dof") as u32;
    // Node 5 at (1, 1, 0) of the first beam and node 17 at (3, 2, 0) of the second, past the hinge at (2, 1).
    let position = |label: i64| model.nodes[model.labels.iter().position(|other| *other == label).expect("a node")];
    let (a, b) = (5, 17);
    let along: [f64; 3] = std::array::from_fn(|axis| position(b)[axis] - position(a)[axis]);
    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut stiffness = Assembler::default();
    stiffness.extend(model.stiffness.iter().copied());
    let ends: Vec<(u32, f64)> = (0..3)
        .flat_map(|axis| {
            let share = along[axis] / length;
            [(row(a, axis as u8), -share), (row(b, axis as u8), share)]
        })
        .filter(|(_, share)| *share != 0.0)
        .collect();
    for (i, of_i) in &ends {
        for (j, of_j) in &ends {
            stiffness.add(*i, *j, k * of_i * of_j);
        }
    }
    Model { stiffness: stiffness.finish(), ..model }
}

/// From a stiff spring to none: elastic while the data tell, then grey and said so, then a mechanism; never a failed check.
///
/// The catalogue calls elastic what lies a thousand error bars above zero. A bar is the sum of all roundings with one sign;
/// at ten of them λ is known to a tenth and no zero reaches it (0.1 bars are measured), so ten decide, and what lies below
/// 10⁴ is told.
#[test]
fn s_06_near_mechanism_is_told_and_never_flips() {
    let interfaces = [direct("here", &[1, 2, 4, 7]), direct("there", &[18, 21, 15])];
    for method in METHODS {
        let mut seen = Vec::new();
        for p in 2..=16 {
            let case = Case::new(&sprung(10f64.powi(-p)), &interfaces).method(method);
            // The softer the spring, the more of a solve with K_II goes into its motion; the other modes are found with it deflated.
            let outcome = case.accepted();
            let codes: Vec<_> = warnings(&outcome);
            let zone = match (codes.contains(&"W-MECHANISM"), codes.contains(&"W-GREY")) {
                (false, false) => 0,
                (false, true) => 1,
                (true, _) => 2,
            };
            assert_eq!(n_rigid(&outcome), if zone == 2 { 7 } else { 6 }, "{method}, 10^-{p}");
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
            assert_eq!(warnings(&pool.install(|| case.run().expect("the same outcome"))), codes, "{method}, 10^-{p}");
            if p <= 10 {
                assert_eq!(zone, 0, "{method}, 10^-{p}: {codes:?}");
            }
            seen.push(zone);
        }
        assert!(seen.is_sorted() && seen.contains(&1) && seen.last() == Some(&2), "{method}: {seen:?}");
    }
}

/// A node that nothing holds, with mass: free motions of its own, told. Without mass it is an empty row.
#[test]
fn s_22_hanging_interface_node() {
    let with_node = |mass: f64| {
        let mut model = block();
        for direction in 0..3 {
            model.dofs.push((99, direction));
            if mass > 0.0 {
                model.mass.push((model.n as u32, model.n as u32, mass));
            }
            model.n += 1;
        }
        model.labels.push(99);
        model.nodes.push([9.0, 9.0, 9.0]);
        model
    };
    let interface = [direct("pins", &[&CORNERS[..], &[99]].concat())];
    for method in METHODS {
        let outcome = Case::new(&with_node(1.0), &interface).method(method).warned(&["W-FREE-PARTICLE", "W-HANGING"]);
        assert_eq!(n_rigid(&outcome), 9);
        assert!(
            message_of(&outcome, "W-HANGING").contains("3 interface dofs")
                && message_of(&outcome, "W-HANGING").contains("node 99 ux")
        );
        let alone = Case::new(&block(), &interface_of_block()).method(method).accepted();
        assert!(worst_ratio(&eigenvalues(&outcome), &eigenvalues(&alone)) <= 1e-12);
        Case::new(&with_node(0.0), &interface).method(method).refused(&["3 rows", "node 99 ux", "leave unused"]);
    }
    // A rotation that only carries inertia: the node is connected, the dof is not.
    let mut drilling = supported(&block(), |_| false);
    drilling.dofs.push((1, 5));
    drilling.mass.push((drilling.n as u32, drilling.n as u32, 0.5));
    drilling.n += 1;
    for method in METHODS {
        let outcome = Case::new(&drilling, &interface_of_block()).method(method).accepted();
        let codes = warnings(&outcome);
        assert!(codes.contains(&"W-HANGING") && codes.contains(&"W-MECHANISM"), "{method}: {codes:?}");
    }
}

fn interface_of_block() -> [supel::job::InterfaceJob; 1] {
    [direct("pins", &CORNERS)]
}
