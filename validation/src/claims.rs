//! What the paper says of its examples, and what was found here.

use crate::examples::{Example, Variant, classical, motion_based};
use crate::integrator::Effort;
use crate::study::{Study, taken};
use crate::verdict::{ABOUT, ACCURATE, Change, Claim, EXCELLENT, OVERALL};

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

fn counts(values: &[f64]) -> String {
    let word = |value: &f64| if value.is_finite() { format!("{value:.2}") } else { "no convergence".to_owned() };
    values.iter().map(word).collect::<Vec<_>>().join(", ")
}

/// Iterations per step with a matrix that never changes, as the paper has it, variant by variant.
fn convergence(study: &Study, paper: &'static str, n: f64) -> Claim {
    let holds = |run: &Option<Effort>| run.is_some_and(|effort| effort.mean() <= n + ABOUT);
    let holds: Vec<bool> = study.constant.iter().map(|(_, run)| holds(run)).collect();
    let constant: Vec<String> = study
        .constant
        .iter()
        .map(|(variant, run)| {
            let label = study.example.label((variant.layout, variant.n_modes));
            run.as_ref().map_or_else(|| format!("{label} stops"), |effort| format!("{label} {:.2}", effort.mean()))
        })
        .collect();
    Claim::new(
        paper,
        &holds,
        format!(
            "Mean iterations at tolerance {:.0e} with a matrix that never changes: {}. With that of the curves at the same tolerance: {}.",
            study.example.counted_at(),
            constant.join(", "),
            taken(study, study.example.counted_at())
        ),
    )
}

const ALL_LOADS: [f64; 2] = [0.0, 1000.0];

fn bend(study: &Study) -> Vec<Claim> {
    let (z, x) = (2, 0);
    let of = |variant: fn(usize, usize) -> Variant, column| -> Vec<f64> {
        [1, 2, 4].map(|layout| worst(study, variant(layout, 0), column, ALL_LOADS)).to_vec()
    };
    let (motion, motion_x) = (of(motion_based, z), of(motion_based, x));
    let (other, other_x) = (of(classical, z), of(classical, x));
    let falls = |values: &[f64]| values.windows(2).all(|pair| Change::between(pair[0], pair[1]).is_better());
    let gain = |i: usize| {
        [(other[i], motion[i]), (other_x[i], motion_x[i])].map(|(from, to)| (to / from, Change::between(from, to)))
    };
    let is_gained = |i: usize| gain(i).iter().all(|(_, change)| change.is_better());
    let each = |variant: fn(usize, usize) -> Variant| {
        [1, 2, 4].map(|layout| {
            let run = study.of(variant(layout, 0));
            if run.stopped.is_none() { run.effort.mean() } else { f64::INFINITY }
        })
    };
    let (own, theirs) = (each(motion_based), each(classical));
    vec![
        Claim::new(
            "Both approaches converge towards the reference as the number of modal elements increases.",
            &[falls(&motion), falls(&other[1..])],
            format!(
                "Largest misfit out of the plane over ten loads with 1, 2, 4 elements: motion-based {}; classical {}.",
                list(&motion),
                list(&other)
            ),
        )
        .against(study, &[z]),
        Claim::new(
            "With classical measures convergence could not be achieved with a single modal element.",
            &[study.of(classical(1, 0)).stopped.is_some()],
            format!("Classical, one element: {}.", stopped(study, classical(1, 0))),
        ),
        Claim::new(
            "The proposed measures are more accurate, particularly in the plane.",
            &[is_gained(1) && is_gained(2), [1, 2].iter().all(|i| gain(*i)[1].0 < gain(*i)[0].0)],
            format!(
                "In the plane (x) with 1, 2, 4 elements: motion-based {}; classical {}.",
                list(&motion_x),
                list(&other_x)
            ),
        )
        .against(study, &[z, x]),
        Claim::new(
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
    let second = Change::between(second_without, second_with);
    let classically = [0, 3].map(|modes| of(classical(1, modes), whole));
    vec![
        Claim::new(
            "A single motion-based element captures the response accurately.",
            &[without < ACCURATE && with < ACCURATE],
            format!("RMS misfit of the transverse displacement without and with modes: {}.", list(&[without, with])),
        )
        .against(study, &[0]),
        Claim::new(
            "Three modes do not improve the first phase noticeably.",
            &[!Change::between(first_without, first_with).is_noticed()],
            format!("RMS misfit before 15 s without and with modes: {}.", list(&[first_without, first_with])),
        )
        .against(study, &[0]),
        Claim::new(
            "A marginal improvement in the second, purely vibratory phase.",
            &[second.is_better(), !second.is_noticed()],
            format!("RMS misfit after 15 s without and with modes: {}.", list(&[second_without, second_with])),
        )
        .against(study, &[0]),
        convergence(study, "Convergence in about two iterations with a constant iteration matrix.", 2.0),
        Claim::new(
            "Poor correlation of the classical measures, which modes do not improve.",
            &[classically[0] > ACCURATE, !Change::between(classically[0], classically[1]).is_better()],
            format!("Classical, mean misfit without and with modes: {}.", list(&classically)),
        )
        .against(study, &[0]),
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
    let metres = |values: &[f64]| values.iter().map(|v| format!("{v:.4} m")).collect::<Vec<_>>().join(", ");
    vec![
        Claim::new(
            "Proposed and classical measures are equally accurate.",
            &[motion.iter().zip(&other).all(|(from, to)| !Change::between(*from, *to).is_noticed())],
            format!(
                "Largest error of a coordinate of the tip with 0, 6, 12 modes: motion-based {}; classical {}.",
                metres(&motion),
                metres(&other)
            ),
        )
        .against(study, &[1, 2, 3]),
        Claim::new(
            "Without modes the response is not captured accurately.",
            &[spin[0] > ACCURATE],
            format!("RMS misfit of the angular velocity without modes: {}.", percent(spin[0])),
        )
        .against(study, &[0]),
        Claim::new(
            "Modes improve the correlation considerably.",
            &[0, 1].map(|i| Change::between(spin[i], spin[i + 1]) == Change::Better),
            format!("RMS misfit of the angular velocity with 0, 6, 12 modes: {}.", list(&spin)),
        )
        .against(study, &[0]),
        convergence(study, "Convergence in about three iterations with a constant iteration matrix.", 3.0),
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
    vec![
        Claim::new(
            "The motion-based elements capture the response accurately.",
            &[before.iter().chain(&on_crank).chain(&on_rod).all(|misfit| *misfit < ACCURATE)],
            format!(
                "RMS misfit without and with modes: before the lock M {}, N {}; from 5 s to 7 s M {}, N {}. Later the \
                 phase drifts.",
                list(&before[..2]),
                list(&before[2..]),
                list(&on_crank),
                list(&on_rod)
            ),
        )
        .against(study, &[m, n]),
        Claim::new(
            "Modes have no noticeable effect on the crank and improve the rod slightly.",
            &[
                !Change::between(on_crank[0], on_crank[1]).is_noticed(),
                Change::between(on_rod[0], on_rod[1]) == Change::SlightlyBetter,
            ],
            format!("From 5 s to 7 s without and with modes: M {}; N {}.", list(&on_crank), list(&on_rod)),
        )
        .against(study, &[m, n]),
        convergence(study, "Convergence in less than about 4 iterations with a constant iteration matrix.", 4.0),
        Claim::new(
            "The classical measures are accurate without modes, too.",
            &[classical_crank[0] < ACCURATE, classical_rod[0] < ACCURATE],
            format!(
                "Classical, 5 s to 7 s without modes: M {}, N {}.",
                percent(classical_crank[0]),
                percent(classical_rod[0])
            ),
        )
        .against(study, &[m, n]),
        Claim::new(
            "With classical measures modes degrade the rod.",
            &[Change::between(classical_rod[0], classical_rod[1]).is_worse()],
            format!("Classical, N, 5 s to 7 s without and with modes: {}.", list(&classical_rod)),
        )
        .against(study, &[n]),
    ]
}

fn elbow(study: &Study) -> Vec<Claim> {
    let of = |variant: fn(usize, usize) -> Variant, modes| {
        [1, 2, 3].map(|strategy| rms(study, variant(strategy, modes), 0, [0.0, 30.0]))
    };
    let [without, with] = [0, 6].map(|modes| of(motion_based, modes));
    let [classical_without, classical_with] = [0, 6].map(|modes| of(classical, modes));
    vec![
        Claim::new(
            "A single element with three nodes captures the overall motion.",
            &[without[0] < OVERALL],
            format!("RMS misfit of strategy 1: {}.", percent(without[0])),
        )
        .against(study, &[0]),
        Claim::new(
            "More elements and more modes give significantly more accurate solutions.",
            &[
                (0..2).all(|i| Change::between(without[i], without[i + 1]) == Change::Better),
                (0..3).all(|i| Change::between(without[i], with[i]) == Change::Better),
            ],
            format!("Strategies 1, 2, 3: without modes {}; with 6 modes {}.", list(&without), list(&with)),
        )
        .against(study, &[0]),
        Claim::new(
            "Excellent correlation of the third strategy.",
            &[without[2] < EXCELLENT, with[2] < EXCELLENT],
            format!("Strategy 3 without and with modes: {}.", list(&[without[2], with[2]])),
        )
        .against(study, &[0]),
        Claim::new(
            "Classical measures: no convergence with a single element.",
            &[study.of(classical(1, 0)).stopped.is_some()],
            format!("Strategy 1, classical: {}.", stopped(study, classical(1, 0))),
        ),
        Claim::new(
            "Classical measures: improved accuracy with the other two strategies.",
            &[0, 1].map(|i| Change::between(classical_without[i], classical_without[i + 1]).is_better()),
            format!("Classical, strategies 1, 2, 3 without modes: {}.", list(&classical_without)),
        )
        .against(study, &[0]),
        Claim::new(
            "Classical measures: modes degrade strategy 2 and improve strategy 3.",
            &[
                Change::between(classical_without[1], classical_with[1]).is_worse(),
                Change::between(classical_without[2], classical_with[2]).is_better(),
            ],
            format!(
                "Classical, strategies 1, 2, 3: without modes {}; with 6 modes {}.",
                list(&classical_without),
                list(&classical_with)
            ),
        )
        .against(study, &[0]),
        convergence(study, "Convergence in about two iterations with a constant iteration matrix.", 2.0),
    ]
}
