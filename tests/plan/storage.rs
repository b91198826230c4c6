//! K-17: constraint modes that the factor makes again agree with those that are stored.

use crate::{CONDENSED, Case, HERTING, PATCH_AND_NODES, difference};

const METHODS: [&str; 5] = [
    "method = \"craig-bampton\", modes = { count = 6 }",
    HERTING,
    "method = \"rubin\", modes = { count = 6 }",
    "method = \"macneal\", modes = { count = 6 }",
    "method = \"mixed-interface\", modes = { count = 6 }, held = [\"root\"]",
];
const BY_FACTOR: &str = "[run]\nconstraint_modes = \"by-factor\"\n";

#[test]
fn modes_made_by_the_factor_agree_with_stored_ones() {
    for method in METHODS {
        let stored = Case::new(PATCH_AND_NODES, method, "").made();
        let by_factor = Case { rest: BY_FACTOR, ..Case::new(PATCH_AND_NODES, method, "") }.made();
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
