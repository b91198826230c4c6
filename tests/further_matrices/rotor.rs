//! A shaft that spins: gyroscopic forces split its bending frequencies as they split those of the full model.

use faer::Mat;
use supel_models::{Inertia, Material, Section, frame};

use super::{Case, Entries, damped_eigenvalues, dense, unpacked};

/// The lowest whirling frequencies of a shaft with discs that is held at both ends, forward and backward, are those of the full model.
#[test]
fn whirling_splits_as_in_the_full_model() {
    let nodes: Vec<[f64; 3]> = (0..9).map(|k| [0.1 * f64::from(k), 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..8).map(|k| [k, k + 1]).collect();
    let mut model = frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent);
    // Discs of a polar inertia 2J and a diametral one J on the nodes 3 and 6.
    const J: f64 = 0.02;
    let disc = |node: u32| {
        [
            (6 * node, 5.0),
            (6 * node + 1, 5.0),
            (6 * node + 2, 5.0),
            (6 * node + 3, 2.0 * J),
            (6 * node + 4, J),
            (6 * node + 5, J),
        ]
    };
    for (row, mass) in disc(2).into_iter().chain(disc(5)) {
        let entry = model.mass.iter_mut().find(|(i, j, _)| (*i, *j) == (row, row)).expect("the diagonal");
        entry.2 += mass;
    }
    // Per unit of the rotation speed: the moment about y of a slope about z that changes.
    let gyroscopic: Entries = [2u32, 5]
        .into_iter()
        .flat_map(|node| [(6 * node + 4, 6 * node + 5, 2.0 * J), (6 * node + 5, 6 * node + 4, -2.0 * J)])
        .collect();
    let (n, ends) = (model.n, 6..model.n - 6);
    let inner = |a: Mat<f64>| a.as_ref().submatrix(6, 6, n - 12, n - 12).to_owned();
    let [k, m, g] = [&model.stiffness, &model.mass, &gyroscopic].map(|entries| inner(dense(n, entries)));
    assert_eq!(ends.len(), n - 12);
    let case = Case::new(model);
    case.matrix("G.mtx", "skew-symmetric", &gyroscopic);
    let more = "[[matrix]]\nname = \"spin\"\nkind = \"gyroscopic\"\nfile = \"G.mtx\"\n";
    let interfaces = "{ name = \"a\", nodes = [1] }, { name = \"b\", nodes = [9] }";
    let file = case.reduced(interfaces, "method = \"craig-bampton\", modes = { count = 30 }", more);
    let (n_b, n_eta) = (file.n_interface(), file.n_modal());
    let held = |a: Mat<f64>| a.as_ref().submatrix(n_b, n_b, n_eta, n_eta).to_owned();
    let tensors = file.tensors();
    let [k_red, m_red, g_red] = [&tensors.stiffness, &tensors.mass, &tensors.matrices[0]].map(|a| held(unpacked(a)));
    for speed in [0.0, 300.0, 900.0] {
        let full = damped_eigenvalues([&k, &(&g * faer::Scale(speed)), &m]);
        let reduced = damped_eigenvalues([&k_red, &(&g_red * faer::Scale(speed)), &m_red]);
        for ([_, found], [_, expected]) in reduced.iter().zip(&full).take(6) {
            // Thirty of forty-two modes are kept; those left out lie a hundred times higher.
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} for {expected} at {speed}");
        }
        let split = full[1][1] / full[0][1] - 1.0;
        assert!(if speed > 0.0 { split > 1e-3 } else { split < 1e-8 }, "{split} at {speed}");
    }
}
