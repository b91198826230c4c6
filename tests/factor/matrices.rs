//! Definite matrices whose trees differ: bushy, long, a forest, one dense front.

use supel::sparse::{Declared, SparseMatrix, Triplets};
use supel_models::random::SplitMix64;

pub(crate) fn diagonal(values: &[f64]) -> SparseMatrix {
    let n = values.len();
    SparseMatrix::new((n, n), (0..=n).collect(), (0..n as u32).collect(), values.to_vec())
}

/// A matrix with given entries at `edges` and on its diagonal.
pub(crate) fn symmetric(
    n: usize,
    edges: &[(u32, u32)],
    mut off_diagonal: impl FnMut(u32, u32) -> f64,
    diagonal: impl Fn(usize) -> f64,
) -> SparseMatrix {
    let mut triplets = Triplets::default();
    edges.iter().for_each(|(row, col)| triplets.push(*row, *col, off_diagonal(*row, *col)));
    (0..n).for_each(|dof| triplets.push(dof as u32, dof as u32, diagonal(dof)));
    triplets.assemble(n, Declared::Symmetric, "symmetric".as_ref()).expect("a matrix").0
}

/// A diagonally dominant matrix with entries of both signs at `edges`.
pub(crate) fn spd(n: usize, edges: &[(u32, u32)]) -> SparseMatrix {
    let mut random = SplitMix64::new(7);
    let mut triplets = Triplets::default();
    let mut sums = vec![1.0; n];
    for (row, col) in edges {
        let value = random.uniform() - 0.7;
        triplets.push(*row, *col, value);
        sums[*row as usize] += value.abs();
        sums[*col as usize] += value.abs();
    }
    for (dof, sum) in sums.iter().enumerate() {
        triplets.push(dof as u32, dof as u32, *sum);
    }
    triplets.assemble(n, Declared::Symmetric, "spd".as_ref()).expect("a matrix").0
}

/// Neighbours of a box of points, as they are numbered.
fn grid_edges([a, b, c]: [usize; 3]) -> Vec<(u32, u32)> {
    let at = |i: usize, j: usize, k: usize| (i + a * (j + b * k)) as u32;
    let mut edges = Vec::new();
    for k in 0..c {
        for j in 0..b {
            for i in 0..a {
                let earlier = [
                    (i > 0).then(|| at(i - 1, j, k)),
                    (j > 0).then(|| at(i, j - 1, k)),
                    (k > 0).then(|| at(i, j, k - 1)),
                ];
                edges.extend(earlier.into_iter().flatten().map(|other| (at(i, j, k), other)));
            }
        }
    }
    edges
}

pub(crate) fn grid(size: [usize; 3]) -> SparseMatrix {
    spd(size.iter().product(), &grid_edges(size))
}

/// `edges` in an order drawn by lot, which is no postorder of its tree.
fn shuffled(n: usize, edges: &[(u32, u32)]) -> Vec<(u32, u32)> {
    let mut random = SplitMix64::new(3);
    let mut order: Vec<u32> = (0..n as u32).collect();
    for last in (1..n).rev() {
        order.swap(last, random.below(last as u64 + 1) as usize);
    }
    let moved = |(a, b): &(u32, u32)| {
        let (a, b) = (order[*a as usize], order[*b as usize]);
        (a.max(b), a.min(b))
    };
    edges.iter().map(moved).collect()
}

pub(crate) fn families() -> Vec<(&'static str, SparseMatrix)> {
    let path: Vec<(u32, u32)> = (1..3000).map(|i| (i, i - 1)).collect();
    let all: Vec<(u32, u32)> = (1..650).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
    let two: Vec<(u32, u32)> =
        grid_edges([9, 9, 3]).into_iter().flat_map(|(a, b)| [(a, b), (a + 243, b + 243)]).collect();
    let star: Vec<(u32, u32)> = (0..2000).map(|i| (2000, i)).collect();
    vec![
        ("a path", spd(3000, &path)),
        ("a sheet", grid([40, 40, 1])),
        ("a block", grid([14, 14, 14])),
        ("a small block", grid([8, 9, 9])),
        ("a shuffled sheet", spd(600, &shuffled(600, &grid_edges([30, 20, 1])))),
        ("two of them", spd(486, &two)),
        ("a dense matrix", spd(650, &all)),
        ("a star", spd(2001, &star)),
        ("points", diagonal(&(1..300).map(f64::from).collect::<Vec<_>>())),
    ]
}
