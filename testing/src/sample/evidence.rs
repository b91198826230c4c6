//! Values for every part of the evidence, shaped like those of a real component: nothing here is compared with anything.

use supel::report::{EffectiveMass, Grounding, MassProperties, MassRoute, ModeKind, RigidBodyEvidence, TrustInterval};
use supel::verification::preservation::{
    Accuracy, AccuracyMeasure, BoundaryComparison, BoundaryCount, FrequencyPair, HighestFrequency, InterfaceStatics,
    LimitSource, Preservation, PreservedMode, ResponseComparison, ResponseSample, SizeError,
};

const DIRECTIONS: [&str; 6] =
    ["translation x", "translation y", "translation z", "rotation x", "rotation y", "rotation z"];

/// A number between zero and one that looks like noise and is always the same.
fn noise(seed: usize) -> f64 {
    let value = (seed as f64 * 12.9898 + 78.233).sin() * 43_758.547;
    value - value.floor()
}

pub(crate) fn frequency(index: usize) -> f64 {
    100.0 * (index as f64).powf(1.3)
}

pub(crate) fn trust_intervals() -> Vec<TrustInterval> {
    let interval = |from_hz, to_hz, number, pivot_growth| TrustInterval {
        from_hz,
        to_hz,
        kind: ModeKind::FreeInterface,
        n_counted: number,
        n_found: number,
        pivot_growth,
    };
    vec![interval(-71.2, 8_000.5, 35, 3.1), interval(8_000.5, 16_200.25, 21, 4.7e2)]
}

pub(crate) fn rigid_body(properties: &MassProperties) -> RigidBodyEvidence {
    let mut close = properties.clone();
    close.mass = close.mass.map(|mass| mass * (1.0 + 3e-13));
    let expected = MassProperties { inertia: None, ..properties.clone() };
    let route = |route, properties: &MassProperties| MassRoute { route, properties: properties.clone() };
    let share = |mode: usize, direction: usize| {
        let is_main = mode % 6 == direction;
        (if is_main { 0.62 } else { 0.02 * noise(mode * 7 + direction) }) / (1.0 + mode as f64 * mode as f64 / 40.0)
    };
    let mut cumulated = vec![0.0; 6];
    let effective_mass = (1..=50)
        .map(|mode| {
            let share: Vec<f64> = (0..6).map(|direction| share(mode, direction)).collect();
            cumulated.iter_mut().zip(&share).for_each(|(sum, share)| *sum += (1.0 - *sum) * share);
            EffectiveMass { mode, share, cumulated: cumulated.clone() }
        })
        .collect();
    let grounding = |(seed, direction): (usize, &&str)| Grounding {
        direction: (*direction).to_owned(),
        energy_ratio: 1e-14 * noise(seed),
        force_ratio: 1e-16 * (1.0 + noise(seed)),
        worst: Some(format!("node {} {}", 100 + seed * 37, ["ux", "uy", "uz"][seed % 3])),
    };
    RigidBodyEvidence {
        mass_routes: vec![
            route("geometry", properties),
            route("stiffness", &close),
            route("eigenvectors", properties),
            route("expected", &expected),
        ],
        frequencies_hz: (0..6).map(|index| 1e-5 * noise(index)).collect(),
        grounding: DIRECTIONS.iter().enumerate().map(grounding).collect(),
        effective_mass,
    }
}

pub(crate) fn preservation() -> Preservation {
    Preservation {
        band_hz: Some([0.0, 1000.0]),
        accuracy: accuracy(),
        modes: (1..=50).map(preserved).collect(),
        mac: mac(50),
        boundaries: vec![
            boundary("free", "nothing was held", 1e-14, 0.0),
            boundary("fix:hub", "interface hub was held", 2e-7, 5.5),
            boundary("fix:foot", "interface foot was held", 6e-7, 5.0),
            boundary("mass:hub", "a tenth of the mass was put on interface hub", 3e-9, 6.0),
        ],
        statics: vec![
            statics("hub", &["ux", "uy", "uz", "rx", "ry", "rz"]),
            statics("foot", &["ux of node 812", "uy of node 812", "uz of node 812"]),
        ],
        response: Some(response()),
        internal_loads: None,
        size_errors: (0..=10).map(size_error).collect(),
        highest: Some(HighestFrequency {
            frequency_hz: 61_234.5,
            explicit_step_s: 5.2e-6,
            is_damped: false,
            resolving_step_s: 8.17e-7,
        }),
        not_compared: vec!["static stiffness at rim: it has 96 dofs, of which 24 are shown at most".to_owned()],
    }
}

fn accuracy() -> Vec<Accuracy> {
    let measured = |measure, error, limit, at: &str| Accuracy {
        measure,
        error: Some(error),
        limit: Some(limit),
        set_by: LimitSource::Practice,
        at: Some(at.to_owned()),
        advice: None,
    };
    let at = "hub held, mode 5 at 812.3 Hz, 812.31 Hz in the reduced model";
    vec![
        measured(AccuracyMeasure::Frequency, 1.2e-5, 1e-2, at),
        measured(AccuracyMeasure::Response, 0.31, 10.0, "hub uz to foot uz at 977 Hz"),
    ]
}

fn preserved(index: usize) -> PreservedMode {
    let relative_difference = 1e-14 * noise(index) * index as f64;
    PreservedMode {
        index,
        full_hz: frequency(index),
        reduced_hz: frequency(index) * (1.0 + relative_difference),
        relative_difference,
        backward_error: 1e-15 * noise(index),
        mac: 1.0 - 1e-13 * noise(index + 3),
    }
}

/// Ones on the diagonal, and a pair of one frequency whose shapes are mixed.
fn mac(order: usize) -> Vec<Vec<f64>> {
    let entry = |row: usize, column: usize| match (row, column) {
        (3, 3) | (4, 4) => 0.7,
        (3, 4) | (4, 3) => 0.3,
        _ if row == column => 1.0 - 1e-13,
        _ => 1e-9 * noise(row * 50 + column),
    };
    (0..order).map(|row| (0..order).map(|column| entry(row, column)).collect()).collect()
}

fn boundary(name: &str, description: &str, scale: f64, power: f64) -> BoundaryComparison {
    let pair = |index: usize| {
        let full_hz = frequency(index) * 0.83;
        let relative_difference = scale * (0.2 + noise(index)) * (full_hz / 1000.0).powf(power);
        FrequencyPair {
            full_hz,
            full_error_bar_hz: 1e-12 * full_hz,
            reduced_hz: full_hz * (1.0 + relative_difference),
            relative_difference,
            in_band: full_hz <= 8_000.0,
        }
    };
    let frequencies: Vec<FrequencyPair> = (1..=40).map(pair).collect();
    let in_band = frequencies.iter().filter(|pair| pair.in_band);
    let worst_in_band = in_band.map(|pair| pair.relative_difference).fold(0.0, f64::max);
    let count = Some(BoundaryCount { below_hz: 34_000.0, n_counted: 46, n_found: 46 });
    let (boundary, description) = (name.to_owned(), description.to_owned());
    BoundaryComparison { boundary, description, frequencies, worst_in_band, count }
}

fn statics(name: &str, dofs: &[&str]) -> InterfaceStatics {
    let entry = |row: usize, column: usize| {
        if row == column { 1.2345e6 * (1.0 + row as f64) } else { 3.1e3 * (noise(row + column) - 0.5) }
    };
    let matrix = |factor: f64| -> Vec<Vec<f64>> {
        (0..dofs.len()).map(|row| (0..dofs.len()).map(|column| factor * entry(row, column)).collect()).collect()
    };
    InterfaceStatics {
        interface: name.to_owned(),
        dofs: dofs.iter().map(|dof| (*dof).to_owned()).collect(),
        full: matrix(1.0),
        reduced: matrix(1.0 + 4e-13),
        relative_difference: 4e-13,
    }
}

/// Ten resonances with two percent of structural damping; the reduced ones are a little too high.
fn response() -> ResponseComparison {
    let receptance = |hz: f64, stiffening: f64| {
        let (mut real, mut imaginary) = (0.0, 0.0);
        for index in 1..=10 {
            let natural = frequency(index) * (1.0 + stiffening * (index as f64).powi(4));
            let (a, b) = (natural * natural - hz * hz, 0.02 * natural * natural);
            let weight = (0.5 - noise(index)) * 1e3 / (a * a + b * b);
            (real, imaginary) = (real + weight * a, imaginary - weight * b);
        }
        real.hypot(imaginary)
    };
    let samples: Vec<ResponseSample> = (0..=360)
        .map(|step| {
            let frequency_hz = 10.0 * 200.0_f64.powf(f64::from(step) / 360.0);
            let (full, reduced) = (receptance(frequency_hz, 0.0), receptance(frequency_hz, 3e-7));
            ResponseSample { frequency_hz, full, reduced, error_db: (20.0 * (reduced / full).log10()).abs() }
        })
        .collect();
    let worst = samples.iter().max_by(|a, b| a.error_db.total_cmp(&b.error_db)).expect("samples");
    ResponseComparison {
        boundary: "free".to_owned(),
        damping: 0.02,
        rotation_length: 83.4,
        n_outputs: 0,
        residual: 7.3e-9,
        worst_pair: ["hub rx".to_owned(), "foot uz of node 812".to_owned()],
        worst_db: worst.error_db,
        worst_at_hz: worst.frequency_hz,
        peak_shift: 2.9e-3,
        scan_step: 0.01,
        samples,
    }
}

fn size_error(step: usize) -> SizeError {
    SizeError {
        n_modes: step * 5,
        n_reduced: 15 + step * 5,
        frequency_error: 0.4 * (-(step as f64) * 0.9).exp() * (0.8 + 0.4 * noise(step)),
        response_error_db: Some(22.0 * (-(step as f64) * 0.7).exp() * (0.8 + 0.4 * noise(step + 9))),
        internal_load_error: None,
    }
}
