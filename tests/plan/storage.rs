//! What is stored and what is solved for. K-15: a load at the interface costs no solve. K-16: rows of recovery are those of the whole. K-17:
//! constraint modes that the factor makes again agree with those that are stored.

use supel_models::transform::rounded;
use supel_models::{Inertia, Material, Section, frame};
use supel_runtime::Coordinate;

use crate::{CONDENSED, Case, HERTING, PATCH_AND_NODES, difference, model};

const METHODS: [&str; 5] = [
    "method = \"craig-bampton\", modes = { count = 6 }",
    HERTING,
    "method = \"rubin\", modes = { count = 6 }",
    "method = \"macneal\", modes = { count = 6 }",
    "method = \"mixed-interface\", modes = { count = 6 }, held = [\"root\"]",
];
const BY_FACTOR: &str = "[run]\nconstraint_modes = \"by-factor\"\n";

/// Of matrices with nine digits constraint modes carry rigid-body motion by their correction alone.
#[test]
fn modes_made_by_the_factor_agree_with_stored_ones() {
    let models = [model(), rounded(&model(), 9)];
    for (model, method) in models.iter().flat_map(|model| METHODS.map(|method| (model, method))) {
        let stored = Case::new(PATCH_AND_NODES, method, "").made_of(model, &[]);
        let by_factor = Case { rest: BY_FACTOR, ..Case::new(PATCH_AND_NODES, method, "") }.made_of(model, &[]);
        assert!(by_factor.checks().contains(&"M-32") && !stored.checks().contains(&"M-32"), "{method}");
        let error = difference(&by_factor.stiffness(), &stored.stiffness());
        assert!(error <= CONDENSED, "{method}: {error:e}");
        // MacNeal's mass is singular, and modes of like frequency may turn: the interface alone is compared entry by entry.
        let n_b = stored.n_b();
        let own: Vec<usize> = (0..n_b).collect();
        let [a, b] = [&by_factor, &stored].map(|made| crate::part(&made.mass(), &own, &own));
        let error = difference(&a, &b);
        assert!(error <= CONDENSED, "{method}: mass {error:e}");
        let [found, expected] = [&by_factor, &stored].map(|made| &made.file.tensors().frequencies);
        assert!(found.iter().zip(expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-10), "{method}");
    }
}

/// By a factor in single precision every product is a solve of its own, which a slender bow of rods amplifies 10⁵ times: columns, rows
/// and motions agree all the same, as those of stored modes do.
#[test]
fn modes_made_by_a_factor_in_single_precision_are_those_of_one_matrix() {
    const N: usize = 40;
    const ENDS: &str = "[[interface]]\nname = \"a\"\nnodes = [1]\n[[interface]]\nname = \"b\"\nnodes = [41]\n";
    const RUN: &str = "[run]\nprecision = \"mixed\"\nconstraint_modes = \"by-factor\"\n";
    let place_of = |i: usize| {
        let t = i as f64;
        [0.1 * t, 0.1 * (0.2 * t).sin(), 0.07 * (0.3 * t).cos()]
    };
    let nodes: Vec<[f64; 3]> = (0..=N).map(place_of).collect();
    let edges: Vec<[usize; 2]> = (0..N).map(|i| [i, i + 1]).collect();
    let bow = frame(&nodes, &edges, &Section::round(0.005), &Material::STEEL_SI, Inertia::Consistent);
    let case = Case { write: ", recovery = { nodes = [3, 22] }", rest: RUN, ..Case::new(ENDS, HERTING, "") };
    let made = case.made_of(&bow, &[]);
    let checks = made.report["body"]["checks"].as_array().expect("checks");
    let of_motions = checks.iter().filter(|check| check["id"] == "M-11" || check["id"] == "M-32");
    let past: Vec<_> = of_motions.filter(|check| check["verdict"] != "pass").collect();
    assert!(past.is_empty(), "{past:?}");
}

/// Rows of the basis come panel by panel, whatever form it has.
#[test]
fn recovered_rows_do_not_need_stored_modes() {
    let write = ", recovery = { nodes = [18, 45] }";
    let stored = Case { write, ..Case::new(PATCH_AND_NODES, HERTING, "") }.made();
    let by_factor = Case { write, rest: BY_FACTOR, ..Case::new(PATCH_AND_NODES, HERTING, "") }.made();
    let [a, b] = [&by_factor, &stored].map(|made| made.file.tensors().recovery.as_ref().expect("rows").rows().clone());
    // Displacements under unit displacements and rotations, of order one.
    let largest =
        (0..a.rows()).flat_map(|i| (0..15).map(move |j| (i, j))).map(|at| (a[at] - b[at]).abs()).fold(0.0, f64::max);
    assert!(largest <= CONDENSED, "{largest:e}");
}

/// K-15: a load on interface nodes alone makes no solve and no coordinate. One inside makes one of each.
#[test]
fn k_15_a_load_at_the_interface_costs_no_solve() {
    const AT_THE_INTERFACE: &str = "[[load]]\nname = \"pull\"\nnodes = [7, 28]\nforce = [1, 2, 3]\n";
    const INSIDE: &str = "[[load]]\nname = \"pull\"\nnodes = [45]\nforce = [1, 2, 3]\n";
    for method in METHODS {
        let made = |rest| Case { rest, ..Case::new(PATCH_AND_NODES, method, "") }.made();
        let (without, at_the_interface, inside) = (made(""), made(AT_THE_INTERFACE), made(INSIDE));
        let n_vectors = |made: &crate::Made| {
            let coordinates = made.file.metadata().coordinates.iter();
            coordinates.filter(|coordinate| matches!(coordinate, Coordinate::ResidualVector { .. })).count()
        };
        assert_eq!([&at_the_interface, &inside].map(n_vectors), [0, 1], "{method}");
        let solves = [&without, &at_the_interface, &inside].map(|made| made.work("n_solves"));
        assert!(solves[1] == solves[0] && solves[2] > solves[0], "{method}: {solves:?}");
        let [found, expected] = [&at_the_interface, &without].map(|made| made.file.tensors());
        let mut at = (0..without.n_b()).flat_map(|i| (0..without.n_b()).map(move |j| (i, j)));
        assert!(at.all(|at| found.stiffness[at] == expected.stiffness[at]), "{method}");
        assert_eq!(found.frequencies, expected.frequencies, "{method}");
    }
}

/// K-16: rows of some nodes have every bit that they have among those of all.
#[test]
fn k_16_rows_of_some_nodes_are_those_of_the_whole() {
    const ALL: &str = ", recovery = { nodes = { within = { box = { min = [-9, -9, -9], max = [9, 9, 9] } } } }";
    const SOME: &str = ", recovery = { nodes = [18, 45, 1, 28] }";
    for method in METHODS {
        let made = |write| Case { write, ..Case::new(PATCH_AND_NODES, method, "") }.made();
        let [all, some] = [made(ALL), made(SOME)];
        let [all, some] = [&all, &some].map(|made| made.file.tensors().recovery.as_ref().expect("rows"));
        assert_eq!((all.dofs().len(), some.dofs().len()), (252, 12), "{method}");
        for (row, dof) in some.dofs().iter().enumerate() {
            let of_all = all.dofs().iter().position(|other| other == dof).expect("a row");
            let n = some.rows().cols();
            assert!((0..n).all(|j| some.rows()[(row, j)] == all.rows()[(of_all, j)]), "{method}: {dof:?}");
        }
    }
}
