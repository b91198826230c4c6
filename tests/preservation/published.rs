//! A measured example: BRICK 24 × 3 × 3, eight corner nodes, no modes or modes up to 1 to 4 times the end of a band of nine elastic
//! modes, 2 % structural damping, free-free response at the corners.
//!
//! The published figures are Frobenius norms over all pairs, largest over the band, and the largest frequency error. Of
//! the samples and the proportions of the brick nothing is published but the sizes of the reduced models, which are those
//! of one brick only. A figure of one digit at a peak that samples may miss by half its width, where the response has
//! fallen to 1/√2, can be repeated to a factor of two and not better.

use faer::{Mat, c64};
use supel_models::{Material, Model, brick};

use crate::chain::direct;
use crate::oracle::{AllModes, Dense, reduced};
use crate::run::Files;

const ETA: f64 = 0.02;
/// The proportions that have the published numbers of free and of clamped modes at all five cut-offs.
const SIZE: [f64; 3] = [10.0, 1.0, 1.0];

/// A line of the published table: cut-off factor, order of the reduced model, response error, frequency error.
struct Line {
    method: &'static str,
    factor: f64,
    n_reduced: usize,
    response: f64,
    frequency: f64,
}

const fn line(method: &'static str, factor: f64, n_reduced: usize, response: f64, frequency: f64) -> Line {
    Line { method, factor, n_reduced, response, frequency }
}

/// Craig-Bampton's columns and inertia relief.
const RELIEVED: &str = "craig-bampton with inertia relief";

const PUBLISHED: [Line; 16] = [
    line("craig-bampton", 1.0, 33, 9.5, 4e-1),
    line("craig-bampton", 1.5, 39, 0.71, 8e-3),
    line("craig-bampton", 2.0, 43, 0.71, 8e-3),
    line("craig-bampton", 3.0, 50, 0.11, 1.4e-3),
    line("craig-bampton", 4.0, 57, 3e-2, 4e-4),
    line(RELIEVED, 1.0, 39, 0.43, 2e-1),
    line(RELIEVED, 1.5, 45, 0.30, 4e-3),
    line(RELIEVED, 2.0, 49, 4e-2, 7e-4),
    line(RELIEVED, 3.0, 56, 1e-2, 2e-4),
    line(RELIEVED, 4.0, 63, 3e-3, 6e-5),
    line("guyan", 1.0, 24, 17.0, 10.0),
    line("herting", 1.0, 39, 5e-2, 1e-13),
    line("herting", 1.5, 42, 4.5e-3, 2e-13),
    line("herting", 2.0, 46, 8e-4, 1e-13),
    line("herting", 3.0, 53, 9e-5, 1e-13),
    line("herting", 4.0, 57, 4e-5, 1e-13),
];

fn corners() -> Vec<i64> {
    let label = |i: i64, j: i64, k: i64| 1 + i + 25 * (j + 4 * k);
    [0, 3].iter().flat_map(|k| [0, 3].iter().flat_map(move |j| [0, 24].map(|i| label(i, *j, *k)))).collect()
}

/// Rows of the corners in the order of the interface.
fn rows(model: &Model) -> Vec<usize> {
    let row = |label: i64| (0..model.n).find(|row| model.dofs[*row].0 == label).expect("a node");
    corners().into_iter().flat_map(|label| row(label)..row(label) + 3).collect()
}

fn frobenius(h: &Mat<c64>) -> f64 {
    (0..h.ncols()).flat_map(|j| (0..h.nrows()).map(move |i| h[(i, j)].norm_sqr())).sum::<f64>().sqrt()
}

/// Largest relative Frobenius error of the response over the band.
fn response_error(full: &AllModes, rows: &[usize], reduced: &Dense, samples: &[f64]) -> f64 {
    let leading: Vec<usize> = (0..rows.len()).collect();
    let error = |hz: &f64| {
        let h = full.response(rows, 6, *hz, ETA);
        let difference = reduced.response(&leading, *hz, ETA) - &h;
        frobenius(&difference) / frobenius(&h)
    };
    samples.iter().map(error).fold(0.0, f64::max)
}

#[test]
fn published_errors_of_the_brick_are_repeated() {
    let model = brick([24, 3, 3], SIZE, &Material::UNIT);
    let full = Dense::of(&model).modes();
    let rows = rows(&model);
    let elastic = full.elastic_hz(6);
    let top = 6.0 * elastic[0];
    let in_band: Vec<f64> = elastic.iter().copied().take_while(|hz| *hz <= top).collect();
    assert_eq!(in_band.len(), 9, "{elastic:?}");
    let start = 0.1 * elastic[0];
    let grid = (0..=60).map(|i| start * (top / start).powf(f64::from(i) / 60.0));
    let samples: Vec<f64> = grid.chain(in_band.iter().copied()).collect();
    let files = Files::new(model, vec![direct("corners", &corners())]);
    for line in &PUBLISHED {
        let scene = format!("band_hz = [0, {top}]\nboundaries = [\"free\"]");
        let modes = format!("modes = {{ up_to_hz = {} }}", line.factor * top);
        let reduction = match line.method {
            RELIEVED => format!("method = \"craig-bampton\"\n{modes}\ninertia_relief = true"),
            "guyan" => "method = \"guyan\"".to_owned(),
            method => format!("method = \"{method}\"\n{modes}"),
        };
        let outcome = files.reduce_by(&reduction, &scene);
        let reduced = reduced(&outcome.superelement);
        let preservation = &outcome.report.body.preservation;
        let what = format!("{} up to {} times the band", line.method, line.factor);
        assert_eq!(reduced.k.nrows(), line.n_reduced, "{what}");
        let error = response_error(&full, &rows, &reduced, &samples);
        let free = &preservation.boundaries[0];
        assert_eq!(free.frequencies.len(), 9);
        println!(
            "{what}: response {error:.2e} ({:.1e} published), frequencies {:.2e} ({:.0e} published), worst pair {:.2e} dB",
            line.response,
            free.worst_in_band,
            line.frequency,
            preservation.response.as_ref().expect("a response").worst_db
        );
        assert!((0.5..=2.0).contains(&(error / line.response)), "{what}: response {error:e}");
        if line.frequency > 1e-9 {
            assert!((0.5..=2.0).contains(&(free.worst_in_band / line.frequency)), "{what}: {:e}", free.worst_in_band);
        } else {
            // Zero in exact arithmetic: n ε κ bounds it.
            assert!(free.worst_in_band < 1e-9, "{what}: {:e}", free.worst_in_band);
        }
    }
}
