//! Static stiffness of the interfaces against dense condensation, and the shapes of the modes.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use crate::chain::{EPS, Twin, direct, partition, rigid_group};
use crate::oracle::Dense;
use crate::run::{Files, block};

/// K condensed to these interface dofs with the other interface dofs held.
fn condensed(dense: &Dense, n_i: usize, dofs: &[usize]) -> Mat<f64> {
    let k_ii = dense.k.submatrix(0, 0, n_i, n_i).to_owned();
    let coupling = Mat::from_fn(n_i, dofs.len(), |i, j| dense.k[(i, n_i + dofs[j])]);
    let answer = k_ii.llt(Side::Lower).expect("K_II is definite").solve(&coupling);
    let own = Mat::from_fn(dofs.len(), dofs.len(), |i, j| dense.k[(n_i + dofs[i], n_i + dofs[j])]);
    own - coupling.transpose() * answer
}

#[test]
fn interface_stiffness_is_that_of_dense_condensation() {
    let pins = [1, 5, 15, 45];
    let files = Files::new(block(), vec![rigid_group("XMIN"), direct("tip", &[45, 5, 10])]);
    let partition = partition(&files.model, &files.interfaces).expect("sound");
    let twin = Twin::new(&files.model, &files.interfaces, &partition);
    let dense = Dense::of(&files.model).transformed(&twin.transformation);
    let statics = files.preservation("herting", "count = 4", "boundaries = []").statics;
    assert_eq!((statics.len(), pins.len()), (2, 4));
    let n_i = partition.n_internal;
    // A patch has its six dofs; three nodes of three dofs have six rigid motions about their centre.
    let tip: Vec<usize> = (6..15).collect();
    let centre: [f64; 3] = std::array::from_fn(|axis| {
        tip.iter().map(|dof| partition.dofs[n_i + dof].site.expect("a site").position[axis]).sum::<f64>() / 9.0
    });
    let r = Mat::from_fn(9, 6, |i, j| {
        let site = partition.dofs[n_i + tip[i]].site.expect("a site");
        let position = std::array::from_fn(|axis| site.position[axis] - centre[axis]);
        supel::model::Site { position, direction: site.direction }.rigid_motion()[j]
    });
    let patch = condensed(&dense, n_i, &(0..6).collect::<Vec<_>>());
    let tip = r.transpose() * condensed(&dense, n_i, &tip) * &r;
    for (found, expected) in statics.iter().zip([patch, tip]) {
        assert_eq!(found.dofs.len(), 6);
        // Rounding of K_II⁻¹: n ε κ, κ below 1e5 for this block, relative to the stiffness before condensation, which
        // here is at most a hundred times that after.
        let tolerance = 135.0 * EPS * 1e5 * 100.0;
        for i in 0..6 {
            for j in 0..6 {
                let size = (expected[(i, i)] * expected[(j, j)]).sqrt();
                for (table, which) in [(&found.full, "full"), (&found.reduced, "reduced")] {
                    let error = (table[i][j] - expected[(i, j)]).abs() / size;
                    assert!(error <= tolerance, "{} {which} {i} {j}: {error:e}", found.interface);
                }
            }
        }
        assert!(found.relative_difference <= 1e-12, "{:e}", found.relative_difference);
    }
}

/// A single node of a model of translations has three dofs, each by its name.
#[test]
fn small_interfaces_are_shown_dof_by_dof() {
    let files = Files::new(block(), vec![direct("pin", &[1]), direct("others", &[5, 45])]);
    let statics = files.preservation("craig-bampton", "count = 2", "boundaries = []").statics;
    assert_eq!(statics[0].dofs, ["node 1 ux", "node 1 uy", "node 1 uz"]);
    assert_eq!(statics[1].full.len(), 6);
}

/// A bar of square section has bending pairs: single vectors of a pair mean nothing, their plane is preserved.
#[test]
fn modes_of_pairs_are_preserved_as_planes() {
    let model = supel_models::brick([6, 2, 2], [3.0, 0.5, 0.5], &supel_models::Material::STEEL_SI);
    let files = Files::new(model, vec![rigid_group("XMIN"), rigid_group("XMAX")]);
    for method in ["herting", "craig-bampton"] {
        let preservation = files.preservation(method, "count = 6", "boundaries = []");
        let pairs = preservation.modes.windows(2).filter(|pair| pair[1].full_hz / pair[0].full_hz - 1.0 < 1e-6).count();
        assert!(pairs >= 2, "{method}: {pairs} pairs");
        for mode in &preservation.modes {
            // Rounding: a mode is known to n ε κ, its MAC to the square of that.
            assert!(1.0 - mode.mac < 1e-10, "{method}: {mode:?}");
            assert!(mode.relative_difference < 1e-9 && mode.backward_error < 1e-12, "{method}: {mode:?}");
        }
        assert_eq!(preservation.mac.len(), preservation.modes.len());
    }
}
