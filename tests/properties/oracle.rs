//! Properties that a dense twin decides: the rank of an interface, counts of eigenvalues, error bars.

use proptest::prelude::*;
use supel::cli::ExitCode;
use supel::error::Error;
use supel::factor::count_below;
use supel_models::transform::rounded;
use supel_models::{Material, brick};

use crate::chain::{EPS, Twin, direct, partition, rigid_of};
use crate::component::component;
use crate::kept;
use crate::place::Place;

/// Rank of a few rows of six by Gaussian elimination with full pivoting; entries of order one.
fn rank(mut rows: Vec<[f64; 6]>) -> usize {
    let mut rank = 0;
    while let Some((row, column)) = largest(&rows[rank..]) {
        let row = rank + row;
        if rows[row][column].abs() < 1e-9 {
            break;
        }
        rows.swap(rank, row);
        let pivot = rows[rank];
        for other in &mut rows[rank + 1..] {
            let factor = other[column] / pivot[column];
            (0..6).for_each(|j| other[j] -= factor * pivot[j]);
            other[column] = 0.0;
        }
        rank += 1;
    }
    rank
}

fn largest(rows: &[[f64; 6]]) -> Option<(usize, usize)> {
    let all = (0..rows.len()).flat_map(|i| (0..6).map(move |j| (i, j)));
    all.max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs()))
}

proptest! {
    #![proptest_config(kept!("oracle"))]

    /// P4: an interface is refused for its rank where a dense rank says so, and only there.
    #[test]
    fn an_interface_is_refused_exactly_where_its_rank_falls_short(
        labels in prop::collection::btree_set(1..=27i64, 1..=4),
    ) {
        let model = brick([2, 2, 2], [1.0, 0.75, 0.5], &Material::UNIT);
        let labels: Vec<i64> = labels.into_iter().collect();
        let (partition, rigid) = rigid_of(&model, &[direct("nodes", &labels)]).expect("a free block");
        let motions = model.rigid_body_modes();
        let rows = model.dofs.iter().enumerate().filter(|(_, dof)| labels.contains(&dof.0));
        let rank = rank(rows.map(|(row, _)| std::array::from_fn(|j| motions[j][row])).collect());
        match supel::rigid::interface_rank(&partition, &rigid) {
            Ok(_) => prop_assert_eq!(rank, 6, "{:?} is accepted", labels),
            Err(Error::InterfaceRank { rank: found, n_rigid, .. }) => {
                prop_assert_eq!((found, n_rigid), (rank, 6), "{:?}", labels);
                prop_assert!(rank < 6, "{:?} is refused", labels);
            }
            Err(other) => prop_assert!(false, "{:?}: {}", labels, other),
        }
    }

    /// P10: counts below a shift are those of a dense solver, free and clamped, wherever the shift is not an eigenvalue.
    #[test]
    fn counts_are_those_of_a_dense_solver(component in component(), share in 1e-3f64..2.0) {
        let (model, interfaces) = (component.model(), component.interfaces());
        let partition = partition(&model, &interfaces).expect("a component");
        let twin = Twin::new(&model, &interfaces, &partition);
        let (free, clamped) = (twin.free_spectrum(), twin.clamped_spectrum());
        let top = free.last().copied().expect("a spectrum").max(*clamped.last().expect("a spectrum"));
        let sigma = share * clamped[clamped.len() / 2];
        // Both solvers move an eigenvalue by ε λ_max times a modest power of n; nearer than that the count has no meaning.
        let near = 100.0 * model.n as f64 * EPS * top;
        prop_assume!(free.iter().chain(&clamped).all(|lambda| (lambda - sigma).abs() > near));
        let analysis = partition.analysis().expect("memory");
        let count = count_below(&analysis, partition.pencil(), sigma).expect("no eigenvalue is met");
        let below = |spectrum: &[f64]| spectrum.iter().filter(|lambda| **lambda < sigma).count();
        prop_assert_eq!((count.clamped, count.free), (below(&clamped), below(&free)));
    }

    /// P8: what rounding the text to d digits does to a frequency stays within its printed bar.
    #[test]
    fn error_bars_contain_the_truth(
        sixteenths in [24..=48u8, 10..=20, 8..=16],
        digits in 6usize..=15,
    ) {
        let size = sixteenths.map(|value| f64::from(value) / 16.0);
        let model = brick([3, 1, 1], size, &Material::STEEL_SI);
        let exact = supel_models::spectrum(&model);
        let largest_eigenvalue = exact[model.n - 1];
        let place = Place::with(&rounded(&model, digits));
        let flags = "--interface ends=1,4,6,16 --method herting --modes 4 --allow-unverified --quiet";
        let ended = place.reduce(&place.model_flags(), flags);
        // With few digits the report fails or the text is refused; whatever is printed must be true.
        prop_assume!(matches!(ended.code, ExitCode::Done | ExitCode::CheckFailed));
        let body = &place.report("x.report.json")["body"];
        let modes = body["reduction"]["modes"].as_array().expect("modes").clone();
        prop_assert!(modes.len() >= 4);
        for (mode, exact) in modes.iter().zip(&exact[6..]) {
            let (found, bar) = (mode["frequency_hz"].as_f64().expect("Hz"), mode["error_bar_hz"].as_f64().expect("Hz"));
            let expected = exact.sqrt() / std::f64::consts::TAU;
            // Dense rotations err by n ε of the largest eigenvalue.
            let oracle = model.n as f64 * EPS * largest_eigenvalue / exact * expected;
            let error = (found - expected).abs();
            prop_assert!(error <= bar + oracle, "{} digits: {} Hz ± {:e} for {}: off {:e}", digits, found, bar, expected, error);
        }
    }
}
