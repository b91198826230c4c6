//! The example of a client's own integrator runs, and keeps what a free body keeps.

use supel_models::superelements::beam;
#[path = "../examples/own_integrator.rs"]
#[allow(dead_code, missing_docs, unreachable_pub)]
mod example;

use example::{Flight, Kept};
use supel_runtime::Superelement;

const SPIN: f64 = 1.0;
const GRAVITY: f64 = 9.81;

fn arc() -> Superelement {
    beam::arc(3).superelement
}

/// Half a second.
fn flown(step: f64) -> (Vec<Kept>, f64) {
    let mut flight = Flight::new(&arc(), SPIN, GRAVITY).expect("a free body");
    let mut states = vec![flight.kept(0.0, 0).expect("a weight")];
    for i in 1..=(0.5 / step).round() as usize {
        let iterations = flight.step(step).expect("balance");
        states.push(flight.kept(i as f64 * step, iterations).expect("a weight"));
    }
    (states, flight.mass())
}

/// Largest errors of energy, momentum and angular momentum, as shares of the energy at the start, of the momentum of the fall, and
/// of the angular momentum at the start.
fn errors(step: f64) -> [f64; 3] {
    let (states, mass) = flown(step);
    let (first, fastest) = (states[0], mass * GRAVITY * 0.5);
    let mut worst = [0.0_f64; 3];
    for kept in &states {
        let fallen = [0.0, 0.0, mass * GRAVITY * kept.time];
        let away = (0..3).map(|i| (kept.momentum[i] - first.momentum[i] + fallen[i]).abs()).fold(0.0, f64::max);
        let now = [
            (kept.energy - first.energy).abs() / first.energy,
            away / fastest,
            (kept.about_vertical - first.about_vertical).abs() / first.about_vertical,
        ];
        worst = std::array::from_fn(|i| worst[i].max(now[i]));
    }
    worst
}

#[test]
fn energy_and_momentum_are_kept_to_the_second_order() {
    let step = 2e-3;
    let [coarse, fine] = [step, 0.5 * step].map(errors);
    println!("{coarse:?} {fine:?}");
    // With R_m the rotation in the middle and Ω̂ that of the step, a step changes the momentum m R v by
    // m h g + m h³ R_m [Ω̂² R_mᵀg/8 − Ω̂³ v_m/12], as cosh and sinh of Ω̂ h/2 say. In the time T, in which v grows to g T, that is
    // (Ω h)² (1/8 + Ω T/12) of m g T; the moments of the same forces give no more of the angular momentum.
    let (square, time) = (14.0 * SPIN * SPIN, 0.5);
    let limit = square * step * step * (0.125 + square.sqrt() * time / 12.0);
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(coarse < limit, "{coarse:e} for {limit:e}");
        // An iteration that ends at 1e-10 of the forces leaves 1e-10 of a second's change of momentum.
        assert!(fine < 1e-10 || (3.8..4.2).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
}

#[test]
fn steps_take_few_iterations() {
    let (states, _) = flown(2e-3);
    let iterations: Vec<usize> = states.iter().skip(1).map(|kept| kept.iterations).collect();
    // The exact tangent but for the exponential: an error is multiplied by h/2 |v| ≈ 4e-3, so that 1e-10 takes five at most.
    assert!(iterations.iter().all(|n| *n <= 5), "{iterations:?}");
}

#[test]
fn program_flies_a_superelement_from_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("arc.supel");
    arc().write(&file).expect("the file can be written");
    let mut out = Vec::new();
    let arguments = [file.to_str().expect("a path"), "1", "2e-3", "20"].map(str::to_owned);
    example::fly(&arguments, &mut out).expect("a flight");
    let text = String::from_utf8(out).expect("text");
    let energies: Vec<f64> = text
        .lines()
        .skip(1)
        .map(|line| line.split_whitespace().nth(1).expect("a column").parse().expect("a number"))
        .collect();
    assert_eq!(energies.len(), 11);
    assert!(energies.iter().all(|energy| (energy / energies[0] - 1.0).abs() < 1e-4), "{energies:?}");
    assert!(example::fly(&[], &mut Vec::new()).is_err());
}
