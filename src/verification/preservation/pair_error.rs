//! How much the responses of two models differ, pair by pair of interface dofs, and at outputs under a force on each interface dof.

use faer::c64;

use super::observed::Response;
use crate::dense;

/// A pair that responds this much less than its two driving points do is judged by them: symmetry uncouples such pairs,
/// and what is left of them is rounding. A thousandth is 60 dB, the dynamic range of a good measurement.
const UNCOUPLED: f64 = 1e-3;

/// Error of one pair.
#[derive(Clone, Copy)]
pub(super) struct PairError {
    pub(super) pair: (usize, usize),
    pub(super) decibel: f64,
}

/// |H_ij|, or the floor set by its driving points; of an output by the interface dof that moves most.
pub(super) fn magnitude(response: &Response, i: usize, j: usize) -> f64 {
    let root = |i: usize| response.get(i, i).norm().sqrt();
    let most = if i < response.n() { root(i) * root(j) } else { response.farthest(j) };
    response.get(i, j).norm().max(UNCOUPLED * most)
}

/// Roots of the driving-point responses: the floor of a pair is a thousandth of the product of its two.
fn roots(response: &Response) -> Vec<f64> {
    (0..response.n()).map(|i| length(response.get(i, i)).sqrt()).collect()
}

/// The pair of interface dofs, or of an output and an interface dof, whose responses differ most.
pub(super) fn worst_pair(full: &Response, reduced: &Response) -> PairError {
    let roots = roots(full);
    let (mut worst, mut pair) = (0.0, (0, 0));
    for j in 0..full.n() {
        for i in 0..=j {
            let excess = excess(full.get(i, j), reduced.get(i, j), UNCOUPLED * roots[i] * roots[j]);
            if dense::worse(excess, worst) {
                (worst, pair) = (excess, (i, j));
            }
        }
    }
    for (at, excess) in of_outputs(full, reduced).into_iter().enumerate() {
        if dense::worse(excess.0, worst) {
            (worst, pair) = (excess.0, (full.n() + at, excess.1));
        }
    }
    PairError { pair, decibel: decibel(worst) }
}

/// By how much the responses of each output differ at most, and the interface dof that is driven.
fn of_outputs(full: &Response, reduced: &Response) -> Vec<(f64, usize)> {
    let floors: Vec<f64> = (0..full.n()).map(|j| UNCOUPLED * full.farthest(j)).collect();
    let of_output = |i: usize| {
        floors.iter().enumerate().fold((0.0, 0), |worst, (j, floor)| {
            let excess = excess(full.get(i, j), reduced.get(i, j), *floor);
            if dense::worse(excess, worst.0) { (excess, j) } else { worst }
        })
    };
    (full.n()..full.n_rows()).map(of_output).collect()
}

/// The errors of outputs, in the order of their rows.
pub(super) fn output_errors(full: &Response, reduced: &Response) -> Vec<f64> {
    of_outputs(full, reduced).into_iter().map(|(excess, _)| excess).collect()
}

/// Where between two frequencies the responses of a pair pass nearest to nothing, and how far they differ there.
#[derive(Clone, Copy)]
pub(super) struct Dip {
    /// Place between the two, from 0 to 1.
    pub(super) place: f64,
    pub(super) decibel: f64,
}

/// The worst dip of all pairs if responses, full and reduced, moved in straight lines between two frequencies.
///
/// An antiresonance of a pair is as narrow as its response happens to pass by zero in the complex plane, and no damping widens it. From one
/// frequency to the next the response itself moves by little, so that its chord passes by zero where the response does.
pub(super) fn worst_dip([full, reduced]: [[&Response; 2]; 2]) -> Dip {
    let roots = full.map(roots);
    let (n, n_rows) = (full[0].n(), full[0].n_rows());
    let (mut worst, mut at) = (0.0, 0.5);
    for j in 0..n {
        let farthest = full[0].farthest(j).max(full[1].farthest(j));
        for i in (0..=j).chain(n..n_rows) {
            let most = || (roots[0][i] * roots[0][j]).max(roots[1][i] * roots[1][j]);
            let floor = UNCOUPLED * if i < n { most() } else { farthest };
            for (place, excess) in dips_of_pair([full, reduced], (i, j), floor) {
                if dense::worse(excess, worst) {
                    (worst, at) = (excess, place);
                }
            }
        }
    }
    Dip { place: at, decibel: decibel(worst) }
}

/// Where the chords of a pair, full and reduced, pass by zero, and by how much the responses differ there.
fn dips_of_pair(ends: [[&Response; 2]; 2], (i, j): (usize, usize), floor: f64) -> impl Iterator<Item = (f64, f64)> {
    let chords = ends.map(|ends| ends.map(|response| response.get(i, j)));
    chords.into_iter().filter_map(nearest_to_zero).map(move |place| {
        let on = |[a, b]: [c64; 2]| a + (b - a) * place;
        (place, excess(on(chords[0]), on(chords[1]), floor))
    })
}

/// By how much the responses of each output differ at most where chords of theirs pass by zero between two frequencies, in the order of rows.
pub(super) fn output_dips([full, reduced]: [[&Response; 2]; 2]) -> Vec<f64> {
    let (n, n_rows) = (full[0].n(), full[0].n_rows());
    let floor = |j: usize| UNCOUPLED * full[0].farthest(j).max(full[1].farthest(j));
    let of_output = |i: usize| {
        let dips = (0..n).flat_map(|j| dips_of_pair([full, reduced], (i, j), floor(j)));
        dips.fold(0.0, |worst, (_, excess)| if dense::worse(excess, worst) { excess } else { worst })
    };
    (n..n_rows).map(of_output).collect()
}

/// The place on a chord, between 0 and 1, that is nearest to zero; none where that is one of its ends.
fn nearest_to_zero([a, b]: [c64; 2]) -> Option<f64> {
    let way = b - a;
    let (ahead, length) = (-(a.re * way.re + a.im * way.im), way.norm_sqr());
    (ahead > 0.0 && ahead < length).then(|| ahead / length)
}

/// By how much the larger of two responses exceeds the smaller, relatively, or their complex difference the full one, where that is more, so
/// that a wrong phase counts too. Levels in dB follow it, and a logarithm for every pair would take most of the time of a scan.
fn excess(full: c64, reduced: c64, floor: f64) -> f64 {
    let (size, other) = (length(full).max(floor), length(reduced).max(floor));
    // A larger response exceeds the full one by no more than it differs.
    let lacks = (size - other) / other;
    let differs = length(reduced - full) / size;
    if dense::worse(differs, lacks) { differs } else { lacks }
}

/// |z| of numbers whose squares are far from the ends of the range: responses in scaled units.
fn length(z: c64) -> f64 {
    z.norm_sqr().sqrt()
}

/// The level of 1 + x in dB, in all its digits where x is small.
fn decibel(excess: f64) -> f64 {
    20.0 * excess.ln_1p() / std::f64::consts::LN_10
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_are_nearest_to_zero_where_they_cross_an_axis() {
        assert_eq!(nearest_to_zero([c64::new(1.0, 0.125), c64::new(-3.0, 0.125)]), Some(0.25));
        assert_eq!(nearest_to_zero([c64::new(1.0, 0.0), c64::new(2.0, 0.0)]), None);
        assert_eq!(nearest_to_zero([c64::new(1.0, 1.0); 2]), None);
    }

    #[test]
    fn decibels_count_levels_and_phases() {
        let one = c64::new(1.0, 0.0);
        // Twice is 6.02 dB and half as well; the same size with the phase turned by 60° differs by one: 6.02 dB.
        let six = 20.0 * 2f64.log10();
        for other in [c64::new(2.0, 0.0), c64::new(0.5, 0.0), c64::new(0.5, 0.75f64.sqrt())] {
            assert!((decibel(excess(one, other, 0.0)) - six).abs() < 1e-12, "{other}");
        }
        assert!(decibel(excess(one * 1e-9, one * 2e-9, 1.0)) < 1e-7, "below the floor");
    }
}
