//! What the paper says of its examples, and what was found here.

use crate::examples::{Example, Variant, classical, motion_based};
use crate::integrator::Effort;
use crate::study::Study;

/// Whether a claim holds here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It does.
    Reached,
    /// Some of it does.
    Partly,
    /// It does not.
    NotReached,
}

/// A claim of the paper beside what was found.
#[derive(Clone, Debug)]
pub struct Claim {
    /// The paper's words, shortened.
    pub paper: &'static str,
    /// What was found here.
    pub found: String,
    /// Whether the claim holds here.
    pub verdict: Verdict,
}

/// What words of the paper without a number are taken for: the mean misfit up to which they are true, per cent.
pub const OVERALL: f64 = 15.0;
/// "Accurately".
pub const ACCURATE: f64 = 5.0;
/// "Excellent correlation".
pub const EXCELLENT: f64 = 2.0;
/// Share of the mean misfit by which modes must change it to be noticed.
pub const NOTICED: f64 = 0.25;

/// All claims on an example.
pub fn claims(study: &Study) -> Vec<Claim> {
    match study.example {
        Example::Bend => bend(study),
        Example::Rotating => rotating(study),
        Example::Spherical => spherical(study),
        Example::Crank => crank(study),
        Example::Elbow => elbow(study),
    }
}

/// A claim that holds in all respects, in some, or in none.
fn claim(paper: &'static str, holds: &[bool], found: String) -> Claim {
    let verdict = match holds.iter().filter(|holds| **holds).count() {
        0 => Verdict::NotReached,
        n if n == holds.len() => Verdict::Reached,
        _ => Verdict::Partly,
    };
    Claim { paper, found, verdict }
}

/// Root of the mean square misfit in per cent; infinite for a run that stopped.
fn rms(study: &Study, variant: Variant, column: usize, window: [f64; 2]) -> f64 {
    study.misfit(variant, column, window).map_or(f64::INFINITY, |misfit| 100.0 * misfit.rms)
}

/// Largest misfit in per cent; infinite for a run that stopped.
fn worst(study: &Study, variant: Variant, column: usize, window: [f64; 2]) -> f64 {
    study.misfit(variant, column, window).map_or(f64::INFINITY, |misfit| 100.0 * misfit.max)
}

/// A percentage in words.
fn percent(value: f64) -> String {
    if value.is_finite() { format!("{value:.2} %") } else { "no solution".to_owned() }
}

fn list(values: &[f64]) -> String {
    values.iter().map(|value| percent(*value)).collect::<Vec<_>>().join(", ")
}

fn stopped(study: &Study, variant: Variant) -> String {
    study.of(variant).stopped.clone().unwrap_or_else(|| "converges".to_owned())
}

/// What a motion-based variant took at a tolerance; none where it stopped.
fn effort(study: &Study, (layout, n_modes): (usize, usize), tolerance: f64) -> Option<Effort> {
    let own = motion_based(layout, n_modes);
    study.efforts.iter().find(|entry| entry.0 == own && entry.1 == tolerance).and_then(|entry| entry.2)
}

fn iterations(study: &Study, tolerance: f64) -> Vec<f64> {
    study
        .example
        .models()
        .iter()
        .map(|model| effort(study, *model, tolerance).map_or(f64::INFINITY, |e| e.mean()))
        .collect()
}

fn counts(values: &[f64]) -> String {
    let word = |value: &f64| if value.is_finite() { format!("{value:.2}") } else { "no convergence".to_owned() };
    values.iter().map(word).collect::<Vec<_>>().join(", ")
}

/// Iteration matrices beyond the first of each variant.
fn renewals(study: &Study, tolerance: f64) -> String {
    let of = |effort: &Effort| effort.renewals.to_string();
    let one = |model: &(usize, usize)| effort(study, *model, tolerance).as_ref().map_or("–".to_owned(), of);
    study.example.models().iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Which variants need more than one iteration matrix.
fn constant(study: &Study) -> String {
    let one = |(variant, why): &(Variant, String)| {
        format!("With one that never changes, {} stops: {why}.", study.example.label((variant.layout, variant.n_modes)))
    };
    study.constant.iter().map(one).collect::<Vec<_>>().join(" ")
}

/// "About n": within half an iteration and a little.
fn about(values: &[f64], n: f64) -> bool {
    values.iter().all(|value| (value - n).abs() <= 0.6)
}

const ALL_LOADS: [f64; 2] = [0.0, 1000.0];

fn bend(study: &Study) -> Vec<Claim> {
    let (z, x) = (2, 0);
    let of = |variant: fn(usize, usize) -> Variant, column| -> Vec<f64> {
        [1, 2, 4].map(|layout| worst(study, variant(layout, 0), column, ALL_LOADS)).to_vec()
    };
    let (motion, motion_x) = (of(motion_based, z), of(motion_based, x));
    let (other, other_x) = (of(classical, z), of(classical, x));
    let falls = |values: &[f64]| values.windows(2).all(|pair| pair[1] < pair[0]);
    let each = |variant: fn(usize, usize) -> Variant| {
        [1, 2, 4].map(|layout| {
            let run = study.of(variant(layout, 0));
            if run.stopped.is_none() { run.effort.mean() } else { f64::INFINITY }
        })
    };
    let (own, theirs) = (each(motion_based), each(classical));
    vec![
        claim(
            "Both approaches converge towards the reference as the number of modal elements increases.",
            &[falls(&motion) && falls(&other[1..])],
            format!(
                "Largest misfit out of the plane over ten loads with 1, 2, 4 elements: motion-based {}; classical {}.",
                list(&motion),
                list(&other)
            ),
        ),
        claim(
            "With classical measures convergence could not be achieved with a single modal element.",
            &[study.of(classical(1, 0)).stopped.is_some()],
            format!("Classical, one element: {}.", stopped(study, classical(1, 0))),
        ),
        claim(
            "The proposed measures are more accurate, particularly in the plane.",
            &[1, 2].map(|i| motion[i] < other[i] && motion_x[i] < other_x[i]),
            format!(
                "In the plane (x) with 1, 2, 4 elements: motion-based {}; classical {}.",
                list(&motion_x),
                list(&other_x)
            ),
        ),
        claim(
            "Fewer iterations per load step than with the classical measures.",
            &[(0..3).all(|i| own[i] < theirs[i])],
            format!(
                "Mean iterations with 1, 2, 4 elements, tangent (82) with load stiffness, tolerance 1e-9: motion-based {}; \
                 classical {}.",
                counts(&own),
                counts(&theirs)
            ),
        ),
    ]
}

fn rotating(study: &Study) -> Vec<Claim> {
    let (whole, first, second) = ([0.0, 20.0], [0.0, 15.0], [15.0, 20.0]);
    let of = |variant, window| rms(study, variant, 0, window);
    let [without, with] = [0, 3].map(|modes| of(motion_based(1, modes), whole));
    let [first_without, first_with] = [0, 3].map(|modes| of(motion_based(1, modes), first));
    let [second_without, second_with] = [0, 3].map(|modes| of(motion_based(1, modes), second));
    let classically = [0, 3].map(|modes| of(classical(1, modes), whole));
    let [needed, finer] = [1e-6, 1e-8].map(|tolerance| iterations(study, tolerance));
    vec![
        claim(
            "A single motion-based element captures the response accurately.",
            &[without < ACCURATE && with < ACCURATE],
            format!("Mean misfit of the transverse displacement without and with modes: {}.", list(&[without, with])),
        ),
        claim(
            "Three modes do not improve the first phase noticeably.",
            &[(first_with - first_without).abs() < NOTICED * first_without],
            format!("Mean misfit before 15 s without and with modes: {}.", list(&[first_without, first_with])),
        ),
        claim(
            "A marginal improvement in the second, purely vibratory phase.",
            &[second_with < second_without],
            format!("Mean misfit after 15 s without and with modes: {}.", list(&[second_without, second_with])),
        ),
        claim(
            "Convergence in about two iterations with a constant iteration matrix.",
            &[needed.iter().all(|count| *count < 2.6)],
            format!(
                "Mean iterations without and with modes: {} at tolerance 1e-6, {} at 1e-8.",
                counts(&needed),
                counts(&finer)
            ),
        ),
        claim(
            "Poor correlation of the classical measures, which modes do not improve.",
            &[classically[0] > ACCURATE, (classically[1] - classically[0]).abs() < NOTICED * classically[0]],
            format!("Classical, mean misfit without and with modes: {}.", list(&classically)),
        ),
    ]
}

fn spherical(study: &Study) -> Vec<Claim> {
    // A coordinate of the tip's place is the robust metric: the reference's angular velocity is itself uncertain by 2 %.
    let tip = |variant| {
        let run = study.of(variant);
        let pairs = run.curves.values.iter().zip(&study.reference.values);
        let away = |(own, other): (&Vec<f64>, &Vec<f64>)| (1..4).map(|d| (own[d] - other[d]).abs()).fold(0.0, f64::max);
        if run.stopped.is_none() { pairs.map(away).fold(0.0, f64::max) } else { f64::INFINITY }
    };
    let motion = [0, 6, 12].map(|modes| tip(motion_based(1, modes)));
    let other = [0, 6, 12].map(|modes| tip(classical(1, modes)));
    let spin = [0, 6, 12].map(|modes| rms(study, motion_based(1, modes), 0, [0.0, 50.0]));
    let needed = iterations(study, 1e-6);
    let metres = |values: &[f64]| values.iter().map(|v| format!("{v:.4} m")).collect::<Vec<_>>().join(", ");
    vec![
        claim(
            "Proposed and classical measures are equally accurate.",
            &[motion.iter().zip(&other).all(|(a, b)| b / a < 1.5 && a / b < 1.5)],
            format!(
                "Largest error of a coordinate of the tip with 0, 6, 12 modes: motion-based {}; classical {}.",
                metres(&motion),
                metres(&other)
            ),
        ),
        claim(
            "Without modes the response is not captured accurately.",
            &[spin[0] > OVERALL],
            format!("Mean misfit of the angular velocity without modes: {}.", percent(spin[0])),
        ),
        claim(
            "Modes improve the correlation considerably.",
            &[spin[1] < spin[0] / 3.0, spin[2] < spin[1] / 2.0],
            format!("Mean misfit of the angular velocity with 0, 6, 12 modes: {}.", list(&spin)),
        ),
        claim(
            "Convergence in about three iterations with a constant iteration matrix.",
            &[about(&needed, 3.0)],
            format!("Mean iterations with 0, 6, 12 modes at tolerance 1e-6: {}.", counts(&needed)),
        ),
    ]
}

fn crank(study: &Study) -> Vec<Claim> {
    let (driven, after) = ([0.0, 5.0], [5.0, 7.0]);
    let (m, n) = (0, 1);
    let of = |variant: fn(usize, usize) -> Variant, column, window| {
        [0, 3].map(|modes| rms(study, variant(2, modes), column, window))
    };
    let before = [of(motion_based, m, driven), of(motion_based, n, driven)].concat();
    let [on_crank, on_rod] = [m, n].map(|column| of(motion_based, column, after));
    let [classical_crank, classical_rod] = [m, n].map(|column| of(classical, column, after));
    let needed = iterations(study, 1e-5);
    vec![
        claim(
            "The motion-based elements capture the response accurately.",
            &[before.iter().chain(&on_crank).chain(&on_rod).all(|misfit| *misfit < ACCURATE)],
            format!(
                "Mean misfit without and with modes: before the lock M {}, N {}; from 5 s to 7 s M {}, N {}. Later the \
                 phase drifts.",
                list(&before[..2]),
                list(&before[2..]),
                list(&on_crank),
                list(&on_rod)
            ),
        ),
        claim(
            "Modes have no noticeable effect on the crank and improve the rod slightly.",
            &[(on_crank[1] - on_crank[0]).abs() < NOTICED * on_crank[0], on_rod[1] < on_rod[0]],
            format!("From 5 s to 7 s without and with modes: M {}; N {}.", list(&on_crank), list(&on_rod)),
        ),
        Claim {
            paper: "Convergence in less than about 4 iterations with a constant iteration matrix.",
            verdict: match needed.iter().all(|count| *count < 4.0) {
                true if study.constant.is_empty() => Verdict::Reached,
                true => Verdict::Partly,
                false => Verdict::NotReached,
            },
            found: format!(
                "Mean iterations without and with modes at tolerance 1e-5: {}, with the matrix renewed in {} of 10,000 steps, \
                 after 8 iterations. {} The rows of the joints are renewed in every step.",
                counts(&needed),
                renewals(study, 1e-5),
                constant(study)
            ),
        },
        claim(
            "The classical measures are accurate without modes, too.",
            &[classical_crank[0] < ACCURATE, classical_rod[0] < ACCURATE],
            format!(
                "Classical, 5 s to 7 s without modes: M {}, N {}.",
                percent(classical_crank[0]),
                percent(classical_rod[0])
            ),
        ),
        claim(
            "With classical measures modes degrade the rod.",
            &[classical_rod[1] > classical_rod[0]],
            format!("Classical, N, 5 s to 7 s without and with modes: {}.", list(&classical_rod)),
        ),
    ]
}

fn elbow(study: &Study) -> Vec<Claim> {
    let of = |variant: fn(usize, usize) -> Variant, modes| {
        [1, 2, 3].map(|strategy| rms(study, variant(strategy, modes), 0, [0.0, 30.0]))
    };
    let [without, with] = [0, 6].map(|modes| of(motion_based, modes));
    let [classical_without, classical_with] = [0, 6].map(|modes| of(classical, modes));
    let needed = iterations(study, 1e-3);
    vec![
        claim(
            "A single element with three nodes captures the overall motion.",
            &[without[0] < OVERALL],
            format!("Mean misfit of strategy 1: {}.", percent(without[0])),
        ),
        claim(
            "More elements and more modes give significantly more accurate solutions.",
            &[without[1] < without[0] && without[2] < without[1], (0..3).all(|i| with[i] < without[i])],
            format!("Strategies 1, 2, 3: without modes {}; with 6 modes {}.", list(&without), list(&with)),
        ),
        claim(
            "Excellent correlation of the third strategy.",
            &[without[2] < EXCELLENT, with[2] < EXCELLENT],
            format!("Strategy 3 without and with modes: {}.", list(&[without[2], with[2]])),
        ),
        claim(
            "Classical measures: no convergence with a single element.",
            &[study.of(classical(1, 0)).stopped.is_some()],
            format!("Strategy 1, classical: {}.", stopped(study, classical(1, 0))),
        ),
        claim(
            "Classical measures: modes degrade strategy 2 and improve strategy 3.",
            &[classical_with[1] > classical_without[1], classical_with[2] < classical_without[2]],
            format!(
                "Classical, strategies 1, 2, 3: without modes {}; with 6 modes {}.",
                list(&classical_without),
                list(&classical_with)
            ),
        ),
        claim(
            "Convergence in about two iterations with a constant iteration matrix.",
            &[about(&[needed[1], needed[2], needed[4], needed[5]], 2.0), about(&[needed[0], needed[3]], 2.0)],
            format!(
                "Strategies 1, 2, 3, then with 6 modes, at tolerance 1e-3: {}, with the matrix renewed in {} of 3,000 steps, \
                 after 8 iterations. {}",
                counts(&needed),
                renewals(study, 1e-3),
                constant(study)
            ),
        ),
    ]
}
