//! Which mode of a superelement each mode of its component is, by their shapes.
//!
//! ```text
//! S_ij   (x_iᵀMy_j)², x_i and y_j = Ψq_j of unit mass: the share of mode j of the superelement that is mode i of the component
//! W_ij   Σ S_kj over the modes k of the group of i, which are combinations of each other as far as practice can tell
//! ```
//! A mode that is lost moves all numbers above it by one. By number its neighbours would be blamed for it.

use faer::Mat;

use super::checks::FREQUENCY;

/// Share that a mode of the superelement has at least of the mode that it is taken for.
const MUCH: f64 = 0.1;
/// What all of a difference in frequency weighs against a share: among equal shapes the nearest frequencies are paired.
const NEARNESS: f64 = 1e-3;

/// For each of λ of the component the mode of the superelement that it is, none that it has not; no mode is taken twice. `shares` is S.
pub(super) fn paired(full: &[f64], reduced: &[f64], shares: &Mat<f64>) -> Vec<Option<usize>> {
    let groups = groups(full);
    let (n, columns) = (full.len(), reduced.len().max(full.len()));
    let share = |i: usize, j: usize| {
        let of_group: f64 = (0..n).filter(|k| groups[*k] == groups[i]).map(|k| shares[(k, j)]).sum();
        // What has no mass has no share of any.
        if of_group.is_nan() { 0.0 } else { of_group }
    };
    let weight = Mat::from_fn(n, reduced.len(), share);
    let cost = Mat::from_fn(n, columns, |i, j| match reduced.get(j) {
        Some(lambda) => NEARNESS * (lambda / full[i]).ln().abs().min(1.0) - weight[(i, j)],
        None => NEARNESS,
    });
    let is_had = |i: usize, j: &usize| *j < reduced.len() && weight[(i, *j)] >= MUCH;
    assigned(&cost).into_iter().enumerate().map(|(i, j)| Some(j).filter(|j| is_had(i, j))).collect()
}

/// The number of the group of each of λ: runs in which neighbours differ by no more than practice accepts of a frequency.
fn groups(full: &[f64]) -> Vec<usize> {
    let mut group = 0;
    let of_mode = |at: usize| {
        if at > 0 && full[at] > full[at - 1] * (1.0 + FREQUENCY).powi(2) {
            group += 1;
        }
        group
    };
    (0..full.len()).map(of_mode).collect()
}

/// The column of each row such that the sum of the costs is least, n × m with n ≤ m: shortest augmenting paths with potentials
/// (Jonker and Volgenant 1987).
fn assigned(cost: &Mat<f64>) -> Vec<usize> {
    let (n, m) = (cost.nrows(), cost.ncols());
    // Row and column 0 are none: `row_of[0]` is the row that looks for a column.
    let (mut of_row, mut of_column, mut row_of) = (vec![0.0; n + 1], vec![0.0; m + 1], vec![0; m + 1]);
    for row in 1..=n {
        row_of[0] = row;
        let (mut least, mut before, mut is_done) = (vec![f64::INFINITY; m + 1], vec![0; m + 1], vec![false; m + 1]);
        let mut column = 0;
        while row_of[column] != 0 {
            is_done[column] = true;
            let at = row_of[column];
            let (mut step, mut next) = (f64::INFINITY, 0);
            for j in (1..=m).filter(|j| !is_done[*j]) {
                let reached = cost[(at - 1, j - 1)] - of_row[at] - of_column[j];
                if reached < least[j] {
                    (least[j], before[j]) = (reached, column);
                }
                if least[j] < step {
                    (step, next) = (least[j], j);
                }
            }
            for j in 0..=m {
                if is_done[j] {
                    of_row[row_of[j]] += step;
                    of_column[j] -= step;
                } else {
                    least[j] -= step;
                }
            }
            column = next;
        }
        while column != 0 {
            row_of[column] = row_of[before[column]];
            column = before[column];
        }
    }
    let mut columns = vec![0; n];
    (1..=m).filter(|j| row_of[*j] > 0).for_each(|j| columns[row_of[j] - 1] = j - 1);
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_assignment_is_the_cheapest_of_all() {
        let mut random = fastrand(11);
        for (n, m) in [(1, 1), (2, 3), (4, 4), (4, 6), (5, 6)] {
            for _ in 0..20 {
                let cost = Mat::from_fn(n, m, |_, _| random());
                let found: f64 = assigned(&cost).iter().enumerate().map(|(i, j)| cost[(i, *j)]).sum();
                assert!((found - cheapest(&cost, 0, &mut vec![false; m])).abs() < 1e-12);
            }
        }
    }

    fn cheapest(cost: &Mat<f64>, row: usize, taken: &mut Vec<bool>) -> f64 {
        if row == cost.nrows() {
            return 0.0;
        }
        let mut least = f64::INFINITY;
        for j in 0..cost.ncols() {
            if !taken[j] {
                taken[j] = true;
                least = least.min(cost[(row, j)] + cheapest(cost, row + 1, taken));
                taken[j] = false;
            }
        }
        least
    }

    /// Numbers between zero and one.
    fn fastrand(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    #[test]
    fn a_lost_mode_is_named_and_not_those_above_it() {
        // Three modes, of which the superelement has the first and the last, and one of the middle's shape far above.
        let shares = Mat::from_fn(3, 3, |i, j| [[1.0, 0.0, 0.0], [0.0, 0.0, 0.9], [0.0, 1.0, 0.0]][i][j]);
        assert_eq!(paired(&[1.0, 4.0, 5.0], &[1.0, 5.0, 9.0], &shares), [Some(0), Some(2), Some(1)]);
        // Its shape is nowhere.
        let without = Mat::from_fn(3, 3, |i, j| if (i, j) == (1, 2) { 0.05 } else { shares[(i, j)] });
        assert_eq!(paired(&[1.0, 4.0, 5.0], &[1.0, 5.0, 9.0], &without), [Some(0), None, Some(1)]);
        // It has fewer modes than the component.
        assert_eq!(paired(&[1.0, 4.0, 5.0], &[1.0, 5.0], &shares), [Some(0), None, Some(1)]);
        // Modes of one frequency are combinations of each other.
        let turned = Mat::from_fn(2, 2, |_, _| 0.5);
        assert_eq!(paired(&[1.0, 1.0], &[1.0, 1.3], &turned), [Some(0), Some(1)]);
    }
}
