//! Whether a product with M would gain by storing one triangle of it. Prints one JSON document for each width of the block.
//!
//! ```text
//! cargo bench --bench triangle -- slender 89000        family and dofs
//! ```
//! Both products run on one thread over the same rows of the same packed block, which favours the single triangle: its scattered
//! sums let threads share no rows. Medians of repeated measurements, taken in turn.

use std::time::Instant;

use pulp::Arch;
use supel::sparse::{Leading, SparseMatrix};
use supel_models::{Family, Part};

const REPEATS: usize = 15;

fn main() {
    // Cargo adds an argument of its own.
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let family = Family::ALL.into_iter().find(|family| words.first().is_some_and(|word| word == family.name()));
    let dofs = words.get(1).and_then(|word| word.parse().ok()).unwrap_or(10_000);
    let mass = mass_of(family.unwrap_or(Family::Slender), dofs);
    measure::<1>(&mass);
    measure::<4>(&mass);
    measure::<8>(&mass);
    measure::<16>(&mass);
}

/// M in the order of elimination, as the eigensolver has it.
fn mass_of(family: Family, dofs: usize) -> SparseMatrix {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("triangle-{}-{dofs}", family.name()));
    Part::new(family, dofs).write(&folder, 50).expect("a folder to write to");
    let path = folder.join("job.toml");
    let text = std::fs::read_to_string(&path).expect("a job");
    let job = supel::job::Job::parse(&text, &path).and_then(|job| job.resolve(&folder)).expect("a job");
    let model = supel::model::Model::new(supel::input::read(&job.model).expect("files")).expect("a sound model");
    supel::partition::Partition::new(model, &job.interfaces).expect("two faces").mass
}

fn measure<const W: usize>(mass: &SparseMatrix) {
    let n = mass.rows();
    let upper = upper_triangle(mass);
    let x: Vec<[f64; W]> = (0..n).map(|i| std::array::from_fn(|w| 1.0 / (1 + i + w) as f64)).collect();
    let mut sums = [vec![[0.0; W]; n], vec![[0.0; W]; n]];
    let mut seconds = [Vec::new(), Vec::new()];
    for _ in 0..REPEATS {
        let start = Instant::now();
        Arch::new().dispatch(|| both(mass.into(), &x, &mut sums[0]));
        seconds[0].push(start.elapsed().as_secs_f64());
        let start = Instant::now();
        Arch::new().dispatch(|| one(Leading::from(&upper), &x, &mut sums[1]));
        seconds[1].push(start.elapsed().as_secs_f64());
    }
    let [both, one] = &sums;
    let differ = both.iter().flatten().zip(one.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let size = both.iter().flatten().fold(0.0, |max: f64, a| max.max(a.abs()));
    assert!(differ <= 1e-12 * size, "the products differ by {differ:e} of {size:e}");
    let [both, one] = seconds.map(median);
    println!(
        "{{\"dofs\": {n}, \"entries\": {}, \"columns\": {W}, \"both_ms\": {:.3}, \"one_ms\": {:.3}, \"ratio\": {:.2}}}",
        mass.nnz(),
        1e3 * both,
        1e3 * one,
        one / both
    );
}

fn upper_triangle(matrix: &SparseMatrix) -> SparseMatrix {
    let (mut pointers, mut indices, mut values) = (vec![0], Vec::new(), Vec::new());
    for (row, entries) in matrix.outer_iterator().enumerate() {
        for (col, value) in entries.iter().filter(|(col, _)| *col >= row) {
            indices.push(col as u32);
            values.push(*value);
        }
        pointers.push(indices.len());
    }
    SparseMatrix::new((matrix.rows(), matrix.cols()), pointers, indices, values)
}

/// Y = M X with every entry stored.
#[inline(always)]
fn both<const W: usize>(matrix: Leading<'_>, x: &[[f64; W]], y: &mut [[f64; W]]) {
    for (i, y) in y.iter_mut().enumerate() {
        let mut sums = [0.0; W];
        let (columns, values) = matrix.row(i);
        for (j, value) in columns.iter().zip(values) {
            sums.iter_mut().zip(&x[*j as usize]).for_each(|(sum, x)| *sum += value * x);
        }
        *y = sums;
    }
}

/// Y = M X with the upper triangle stored: an entry off the diagonal serves its row and its column.
#[inline(always)]
fn one<const W: usize>(upper: Leading<'_>, x: &[[f64; W]], y: &mut [[f64; W]]) {
    y.fill([0.0; W]);
    for (i, own) in x.iter().enumerate() {
        let mut sums = [0.0; W];
        let (columns, values) = upper.row(i);
        for (j, value) in columns.iter().map(|j| *j as usize).zip(values) {
            sums.iter_mut().zip(&x[j]).for_each(|(sum, x)| *sum += value * x);
            if j != i {
                y[j].iter_mut().zip(own).for_each(|(sum, x)| *sum += value * x);
            }
        }
        y[i].iter_mut().zip(&sums).for_each(|(y, sum)| *y += sum);
    }
}

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}
