//! What the scene accepts and what practice asks for, against dense computations of both models.

use faer::linalg::solvers::Solve;
use supel::error::Warning;
use supel::job::Job;
use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel::report::Observer;
use supel::size_forecast;
use supel::verification::check::{Check, Verdict};

use crate::chain::{EPS, Twin, direct, partition, rigid_group};
use crate::oracle::{Dense, answers, decibel, reduced};
use crate::run::{Files, block};

const BAND_END: f64 = 3000.0;

fn files() -> Files {
    Files::new(block(), vec![rigid_group("XMIN"), direct("tip", &[45])])
}

/// The full model in the order internal, interface, and the transformation that makes it.
fn full(files: &Files) -> (Dense, faer::Mat<f64>, usize) {
    let partition = partition(&files.model, &files.interfaces).expect("sound");
    let twin = Twin::new(&files.model, &files.interfaces, &partition);
    (Dense::of(&files.model).transformed(&twin.transformation), twin.transformation.clone(), partition.n_internal)
}

fn scene(accept: &str) -> String {
    format!("band_hz = [0, {BAND_END}]\nboundaries = [\"free\", \"fix:XMIN\"]\naccept = {{ {accept} }}")
}

fn check<'a>(outcome: &'a Outcome, id: &str) -> &'a Check {
    outcome.report.body.checks.iter().find(|check| check.id == id).unwrap_or_else(|| panic!("no {id}"))
}

fn warnings(outcome: &Outcome, code: &str) -> Vec<String> {
    let all = outcome.report.body.warnings.iter();
    all.filter(|warning| warning.code == code).map(|warning| warning.message.clone()).collect()
}

/// Asserts that a limit just above a value is met and one just below it fails, without the room between warning and failure that
/// other checks have; the file records it.
#[track_caller]
fn assert_limit(files: &Files, (key, id): (&str, &str), value: f64, more: &str) {
    for (limit, verdict) in [(1.01 * value, Verdict::Pass), (0.99 * value, Verdict::Fail)] {
        let outcome = files.reduce("craig-bampton", "count = 4", &(scene(&format!("{key} = {limit}")) + more));
        let found = check(&outcome, id);
        assert_eq!(found.verdict(), verdict, "{found:?}");
        assert_eq!(outcome.report.body.verdict() == Verdict::Fail, verdict == Verdict::Fail, "{key}");
        let record = &outcome.superelement.metadata().verification;
        assert!(record.checks.iter().any(|check| check.id == id), "{id} is not on record");
        assert!(found.fails_above() == limit, "{found:?}");
    }
}

#[test]
fn frequencies_are_accepted_by_dense_spectra() {
    let files = files();
    let outcome = files.reduce("craig-bampton", "count = 4", &scene("frequency = 1e-9"));
    let ((full, _, n_i), reduced) = (full(&files), reduced(&outcome.superelement));
    let (mut worst, mut rounding, mut at) = (0.0f64, 0.0f64, String::new());
    for (name, held, n_zero) in [("free", 0..0, 6), ("XMIN held", 0..6, 0)] {
        let under = |model: &Dense, first: usize| {
            let kept: Vec<usize> =
                (0..model.k.nrows()).filter(|i| !held.clone().any(|dof| first + dof == *i)).collect();
            model.restricted(&kept).modes().elastic_hz(n_zero)
        };
        let (of_full, of_reduced) = (under(&full, n_i), under(&reduced, 0));
        // n ε κ of λ, κ = λ_max/λ_1, with M factored as well.
        rounding = rounding.max(of_full.len() as f64 * EPS * (of_full[of_full.len() - 1] / of_full[0]).powi(2));
        for (mode, hz) in of_full.iter().enumerate().take_while(|(_, hz)| **hz <= BAND_END) {
            let error = (of_reduced[mode] / hz - 1.0).abs();
            if error > worst {
                (worst, at) = (error, format!("{name}, mode {}", mode + 1));
            }
        }
    }
    let found = check(&outcome, "M-29");
    assert!((found.value - worst).abs() <= 4.0 * rounding && worst > 1e3 * rounding, "{found:?}, expected {worst}");
    let said = found.worst.as_deref().expect("a place");
    assert!(said.starts_with(&at), "{said}, expected {at}");
    assert_limit(&files, ("frequency", "M-29"), worst, "");
}

#[test]
fn the_response_is_accepted_by_dense_elimination() {
    let files = files();
    let outcome = files.reduce("craig-bampton", "count = 4", &scene("response_db = 1e-9"));
    let ((full, _, n_i), reduced) = (full(&files), reduced(&outcome.superelement));
    let dofs: Vec<usize> = (n_i..full.k.nrows()).collect();
    let leading: Vec<usize> = (0..dofs.len()).collect();
    let response = outcome.report.body.preservation.response.as_ref().expect("a response");
    let error = |hz: f64| decibel(&full.response(&dofs, hz, 0.02), &reduced.response(&leading, hz, 0.02));
    let worst = response.samples.iter().map(|sample| error(sample.frequency_hz)).fold(0.0, f64::max);
    let found = check(&outcome, "M-30");
    // The test of the response derives what it is known to: far below a thousandth of a dB.
    assert!((found.value - worst).abs() < 1e-3 * (1.0 + worst) && worst > 1.0, "{found:?}, expected {worst}");
    assert_limit(&files, ("response_db", "M-30"), found.value, "");
    // Nor is it larger between the samples than a scan that is sharpened to a thousandth of its interval sees.
    let between = (0..=400).map(|i| error(30.0 * (BAND_END / 30.0).powf(f64::from(i) / 400.0))).fold(0.0, f64::max);
    assert!(between <= 1.002 * worst, "{between} between the samples, {worst} at them");
}

/// \[1 0; −K_II⁻¹K_IB Φ\] with the interface first in its columns and last in its rows, Φ the lowest modes of the held interface.
fn craig_bampton(full: &Dense, n_i: usize, n_modes: usize) -> faer::Mat<f64> {
    let n = full.k.nrows();
    let interior: Vec<usize> = (0..n_i).collect();
    let held = full.restricted(&interior);
    let coupling = faer::Mat::from_fn(n_i, n - n_i, |i, j| -full.k[(i, n_i + j)]);
    let statics = held.k.llt(faer::Side::Lower).expect("definite").solve(&coupling);
    let modes = held.modes().shapes;
    faer::Mat::from_fn(n, n - n_i + n_modes, |i, j| match (i < n_i, j < n - n_i) {
        (true, true) => statics[(i, j)],
        (true, false) => modes[(i, j - (n - n_i))],
        (false, _) => f64::from(u8::from(i - n_i == j)),
    })
}

/// Twice the strain energy of every column.
fn energies(k: &faer::Mat<f64>, columns: &faer::Mat<faer::c64>) -> Vec<f64> {
    let part = |of: fn(&faer::c64) -> f64| {
        let x = faer::Mat::from_fn(columns.nrows(), columns.ncols(), |i, j| of(&columns[(i, j)]));
        let forces = k * &x;
        (0..x.ncols()).map(|j| x.col(j).transpose() * forces.col(j)).collect::<Vec<f64>>()
    };
    part(|value| value.re).into_iter().zip(part(|value| value.im)).map(|(re, im)| re + im).collect()
}

/// The largest error of internal loads under a unit force at the interface, relative in the norm of the strain energy: the reduced answer is
/// that of Galerkin in the span of the basis.
fn load_error(full: &Dense, (basis, n_i): (&faer::Mat<f64>, usize), hz: f64, eta: f64) -> f64 {
    let reduced = full.transformed(basis);
    let n_b = full.k.nrows() - n_i;
    let (dofs, leading): (Vec<usize>, Vec<usize>) = ((n_i..n_i + n_b).collect(), (0..n_b).collect());
    let (u, own) = (answers(full, &dofs, hz, eta), answers(&reduced, &leading, hz, eta));
    let rise = faer::Mat::from_fn(basis.nrows(), basis.ncols(), |i, j| faer::c64::new(basis[(i, j)], 0.0));
    let difference = rise * own - &u;
    let (sizes, errors) = (energies(&full.k, &u), energies(&full.k, &difference));
    errors.iter().zip(&sizes).map(|(error, size)| (error / size).sqrt()).fold(0.0, f64::max)
}

/// The span of the method is made here without the library.
#[test]
fn internal_loads_are_accepted_by_dense_elimination() {
    let files = files();
    let outcome = files.reduce("craig-bampton", "count = 4", &scene("internal_load = 1e-9"));
    let (full, _, n_i) = full(&files);
    let basis = craig_bampton(&full, n_i, 4);
    let error = |hz: f64| load_error(&full, (&basis, n_i), hz, 0.02);
    let loads = outcome.report.body.preservation.internal_loads.as_ref().expect("compared");
    for sample in &loads.samples {
        let expected = error(sample.frequency_hz);
        // Residuals of 1e-7 grow by the root of the condition of the interior, below 10³, and by 1/η at a resonance.
        let tolerance = 1e-7 * 1e3 / 0.02;
        assert!((sample.error - expected).abs() < tolerance, "{sample:?}, expected {expected}");
    }
    let worst = loads.samples.iter().map(|sample| sample.error).fold(0.0, f64::max);
    let found = check(&outcome, "M-34");
    assert!(found.value == worst && worst > 0.1, "{found:?}");
    assert_limit(&files, ("internal_load", "M-34"), worst, "");
    // Between the samples nothing is worse by more than a sample next to the resonance of the reduced model may miss.
    let between = (1..=200).map(|i| error(BAND_END * f64::from(i) / 200.0)).fold(0.0, f64::max);
    assert!(between <= 1.02 * worst, "{between} between the samples, {worst} at them");
}

/// However wide damping makes the resonances, where responses of a pair cancel an error is narrow.
#[test]
fn wide_resonances_hide_no_peak_of_the_error() {
    let files = files();
    let (full, _, n_i) = full(&files);
    let dofs: Vec<usize> = (n_i..full.k.nrows()).collect();
    let leading: Vec<usize> = (0..dofs.len()).collect();
    for ratio in [0.05, 0.3] {
        let scene = format!("damping = {{ ratio = {ratio} }}\n{}", scene("response_db = 1e-9"));
        let outcome = files.reduce("craig-bampton", "count = 3", &scene);
        let reduced = reduced(&outcome.superelement);
        let error = |hz: f64| {
            let eta = 2.0 * ratio;
            decibel(&full.response(&dofs, hz, eta), &reduced.response(&leading, hz, eta))
        };
        let worst = check(&outcome, "M-30").value;
        let between = (0..=600).map(|i| error(30.0 * (BAND_END / 30.0).powf(f64::from(i) / 600.0))).fold(0.0, f64::max);
        assert!(between <= 1.002 * worst, "ratio {ratio}: {between} between the samples, {worst} at them");
    }
}

#[test]
fn wide_resonances_hide_no_error_of_internal_loads() {
    let files = files();
    let (full, _, n_i) = full(&files);
    for (ratio, n_modes) in [(0.05, 2), (0.1, 3), (0.3, 3), (0.3, 5)] {
        let scene = format!("damping = {{ ratio = {ratio} }}\n{}", scene("internal_load = 1e-9"));
        let outcome = files.reduce("craig-bampton", &format!("count = {n_modes}"), &scene);
        let basis = craig_bampton(&full, n_i, n_modes);
        let worst = check(&outcome, "M-34").value;
        let at = |i: i32| 30.0 * (BAND_END / 30.0).powf(f64::from(i) / 300.0);
        let between = (0..=300).map(|i| load_error(&full, (&basis, n_i), at(i), 2.0 * ratio)).fold(0.0, f64::max);
        assert!(between <= 1.002 * worst, "ratio {ratio}: {between} between the samples, {worst} at them");
    }
}

const PUSH: &str = "\n[[load]]\nname = \"push\"\nnodes = [23]\nforce = [0, 1, 0]\nresidual = false\n";

/// The reduced answer û is the best in energy among those of the basis: ‖u − û‖² = ‖u‖² − ‖û‖², twice the work of the load each.
#[test]
fn statics_are_accepted_by_the_work_of_a_load() {
    let files = files();
    let outcome = files.reduce("craig-bampton", "count = 4", &(scene("static = 1e-6") + PUSH));
    let (full, transformation, n_i) = full(&files);
    let dof = files.model.dofs.iter().position(|dof| *dof == (23, 1)).expect("uy of node 23");
    let force = faer::Mat::from_fn(n_i, 1, |i, _| transformation[(dof, i)]);
    let interior: Vec<usize> = (0..n_i).collect();
    let work = |k: &faer::Mat<f64>, f: &faer::Mat<f64>| {
        let factor = k.llt(faer::Side::Lower).expect("definite");
        (f.transpose() * factor.solve(f))[(0, 0)]
    };
    let reduced = reduced(&outcome.superelement);
    let (n_b, r) = (full.k.nrows() - n_i, reduced.k.nrows());
    let vectors = outcome.superelement.tensors().load_vectors.as_ref().expect("a load");
    let projected = faer::Mat::from_fn(r - n_b, 1, |i, _| vectors[(n_b + i, 0)]);
    let modal: Vec<usize> = (n_b..r).collect();
    let ratio = work(&reduced.restricted(&modal).k, &projected) / work(&full.restricted(&interior).k, &force);
    let lacking = (1.0 - ratio).sqrt();
    let found = check(&outcome, "M-31");
    // Both works are known to n κ ε, κ below 10⁶ here, and the root halves that.
    assert!((found.value / lacking - 1.0).abs() < 1e-7 && lacking > 0.1, "{found:?}, expected {lacking}");
    assert!(found.worst.as_deref().is_some_and(|worst| worst.starts_with("load push")), "{found:?}");
    assert_limit(&files, ("static", "M-31"), lacking, PUSH);
    // With its residual vector the answer is exact.
    let exact = PUSH.replace("residual = false\n", "");
    let outcome = files.reduce("craig-bampton", "count = 4", &(scene("static = 1e-6") + &exact));
    assert_eq!(check(&outcome, "M-31").verdict(), Verdict::Pass);
}

#[test]
fn what_cannot_be_measured_meets_no_limit() {
    let files = files();
    let outcome = files.reduce("herting", "count = 4", "boundaries = []\naccept = { frequency = 0.1 }");
    let found = check(&outcome, "M-29");
    assert!(found.value.is_nan() && found.verdict() == Verdict::Fail, "{found:?}");
    assert!(found.worst.as_deref().is_some_and(|worst| worst.contains("scene.boundaries")), "{found:?}");
    // A component without an interface has no response.
    let free = Files::new(block(), Vec::new());
    let outcome = free.reduce("herting", "count = 4", "accept = { response_db = 1.0 }");
    let found = check(&outcome, "M-30");
    assert_eq!(found.verdict(), Verdict::Fail);
    assert!(found.worst.as_deref().is_some_and(|worst| worst.contains("no interface")), "{found:?}");
}

/// Sound practice is silent, one mode of the held interface is not; the file is the same as if nothing had been said.
#[test]
fn practice_warns_of_a_poor_model_and_not_of_a_good_one() {
    let files = files();
    let poor = files.reduce("craig-bampton", "count = 1", "");
    let said = warnings(&poor, "W-ACCURACY");
    let response = poor.report.body.preservation.response.as_ref().expect("a response");
    assert!(response.worst_db > 10.0, "{}", response.worst_db);
    assert!(said.iter().any(|said| said.contains("the frequency response differs by")), "{said:?}");
    assert!(said.iter().all(|said| said.contains("herting")), "{said:?}");
    assert_eq!(poor.report.body.verdict(), Verdict::Warn);
    assert_eq!(poor.superelement.metadata().verification.verdict, supel_runtime::Verdict::Pass);
    // Twice the band.
    let good = files.reduce("herting", "up_to_hz = 6000", &format!("band_hz = [0, {BAND_END}]"));
    assert_eq!((warnings(&good, "W-ACCURACY"), good.report.body.verdict()), (Vec::new(), Verdict::Pass));
    // Where the scene accepts the error there is nothing to warn of.
    let accepted = files.reduce("craig-bampton", "count = 1", "accept = { frequency = 9.0, response_db = 90.0 }");
    assert_eq!((warnings(&accepted, "W-ACCURACY"), accepted.report.body.verdict()), (Vec::new(), Verdict::Pass));
    // The response of the free component says nothing of one that is never free.
    let held = files.reduce("craig-bampton", "count = 1", "boundaries = [\"fix:XMIN\"]");
    assert!(
        warnings(&held, "W-ACCURACY").iter().all(|said| !said.contains("response")),
        "{:?}",
        held.report.body.warnings
    );
}

/// The frequency that the advice names is enough.
#[test]
fn modes_that_the_advice_names_meet_the_limit() {
    let files = files();
    let scene = "band_hz = [0, 2500]\nboundaries = [\"free\"]\naccept = { frequency = 1e-4 }";
    let poor = files.reduce("craig-bampton", "up_to_hz = 6000", scene);
    let said = check(&poor, "M-29").worst.clone().expect("a place");
    let (_, rest) = said.split_once("modes to about ").unwrap_or_else(|| panic!("{said}"));
    let hertz: f64 = rest.split(' ').next().and_then(|hz| hz.parse().ok()).expect("a frequency");
    assert!(hertz > 6000.0 && check(&poor, "M-29").verdict() == Verdict::Fail, "{said}");
    let better = files.reduce("craig-bampton", &format!("up_to_hz = {hertz}"), scene);
    assert_eq!(check(&better, "M-29").verdict(), Verdict::Pass, "{said}: {:?}", check(&better, "M-29"));
}

/// A frequency in another unit leaves no modes, and the first one is named.
#[test]
fn no_mode_below_a_frequency_is_told_with_the_first_one() {
    let files = files();
    let (full, _, n_i) = full(&files);
    let interior: Vec<usize> = (0..n_i).collect();
    let first = |zero: usize, model: &Dense| model.modes().elastic_hz(zero)[0];
    for (method, expected) in [("herting", first(6, &full)), ("craig-bampton", first(0, &full.restricted(&interior)))] {
        let outcome = files.reduce(method, "up_to_hz = 12.0", "");
        let said = warnings(&outcome, "W-NO-MODES").pop().unwrap_or_else(|| panic!("{method}: no word"));
        let named: f64 =
            said.split("is at ").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok()).expect(&said);
        // Four digits are printed.
        assert!((named / expected - 1.0).abs() < 5e-4, "{said}, expected {expected}");
    }
    let outcome = files.reduce("herting", "count = 4", "band_hz = [0, 12.0]");
    assert_eq!(warnings(&outcome, "W-NO-MODES").len(), 1, "{:?}", outcome.report.body.warnings);
    let outcome = files.reduce("herting", "count = 4", "");
    assert!(warnings(&outcome, "W-NO-MODES").is_empty());
}

/// 2/ω of the highest eigenvalue of the reduced pencil, interface dofs included.
#[test]
fn the_largest_explicit_step_is_that_of_the_dense_spectrum() {
    let files = files();
    let outcome = files.reduce("herting", "count = 4", "");
    let highest = outcome.report.body.preservation.highest.expect("a highest frequency");
    let lambda = *reduced(&outcome.superelement).modes().lambda.last().expect("modes");
    // n ε κ(M̂) at the upper end of the spectrum.
    assert!((highest.explicit_step_s * lambda.sqrt() / 2.0 - 1.0).abs() < 1e-9, "{highest:?}");
    assert!((highest.frequency_hz * std::f64::consts::TAU / lambda.sqrt() - 1.0).abs() < 1e-9, "{highest:?}");
}

/// At the step that the report gives, 4M/h² − 2C/h − K is singular, and definite below it; of modal damping it is 2/ω (√(1 + ζ²) − ζ).
#[test]
fn the_largest_explicit_step_knows_the_damping_of_the_file() {
    let files = files();
    let undamped = files.reduce("herting", "count = 4", "");
    let undamped = undamped.report.body.preservation.highest.expect("a highest frequency");
    assert!(!undamped.is_damped);
    for (law, ratio) in [
        ("modal = { ratio = 0.5 }", Some(0.5)),
        ("rayleigh = { mass = 0.0, stiffness = 1e-3 }", None),
        ("rayleigh = { mass = 0.0, stiffness = 1e-9 }", None),
    ] {
        let outcome = files.reduce("herting", "count = 4", &format!("\n[damping]\n{law}"));
        let highest = outcome.report.body.preservation.highest.expect("a highest frequency");
        let omega = std::f64::consts::TAU * highest.frequency_hz;
        let zeta = ratio.unwrap_or(0.5 * omega * if law.contains("1e-3") { 1e-3 } else { 1e-9 });
        let expected = 2.0 / omega * (zeta.hypot(1.0) - zeta);
        assert!(highest.is_damped && highest.frequency_hz == undamped.frequency_hz, "{law}");
        assert!((highest.explicit_step_s / expected - 1.0).abs() < 1e-6, "{law}: {highest:?}, expected {expected:e}");
        assert!(highest.explicit_step_s < undamped.explicit_step_s, "{law}");
    }
}

/// A dof without mass has no frequency, and no explicit step follows it.
#[test]
fn a_motion_without_mass_has_no_explicit_step() {
    let folder = tempfile::tempdir().expect("a folder");
    let banner = "%%MatrixMarket matrix coordinate real symmetric\n";
    let springs: String =
        (1..5).map(|i| format!("{i} {i} {}\n{} {i} -1\n", if i == 1 { 1 } else { 2 }, i + 1)).collect();
    // The first two masses are missing: the first dof of the interface carries nothing but the second.
    let masses: String = (3..=5).map(|i| format!("{i} {i} 1\n")).collect();
    std::fs::write(folder.path().join("K.mtx"), format!("{banner}5 5 9\n{springs}5 5 1\n")).expect("written");
    std::fs::write(folder.path().join("M.mtx"), format!("{banner}5 5 3\n{masses}")).expect("written");
    for (rows, has_step) in [("[0, 2, 4]", false), ("[2, 4]", true)] {
        let text = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\" }}\n\
             interface = [{{ name = \"ends\", nodes = {{ rows = {rows} }} }}]\n\
             reduction = {{ method = \"craig-bampton\", modes = {{ count = 1 }} }}\nwrite = {{ superelement = \"x.supel\" }}\n"
        );
        let job = Job::parse(&text, "job.toml".as_ref()).and_then(|job| job.resolve(folder.path())).expect("a job");
        let outcome = supel::reduce(&job, Resources::default(), &mut ()).expect("reduced");
        assert_eq!(outcome.report.body.preservation.highest.is_some(), has_step, "{rows}");
    }
}

/// What a run tells while it runs: stages, and warnings between them.
#[derive(Default)]
struct Told(Vec<String>);

impl Observer for Told {
    fn stage(&mut self, name: &'static str) {
        self.0.push(name.to_owned());
    }

    fn warned(&mut self, warning: &Warning) {
        self.0.push(warning.message.clone());
    }
}

/// A patch that was left with its own dofs is told before the long work, and stands in the report.
#[test]
fn a_large_interface_is_told_before_the_work() {
    let labels = |n: i64| (1..=n).collect::<Vec<i64>>();
    let files = Files::new(block(), vec![direct("rim", &labels(34))]);
    let mut told = Told::default();
    let job = files.job("craig-bampton", "count = 1", "boundaries = []");
    let outcome = supel::reduce(&job, Resources::default(), &mut told).expect("reduced");
    let said = warnings(&outcome, "W-LARGE");
    assert_eq!(said.len(), 1, "{:?}", outcome.report.body.warnings);
    assert!(said[0].contains("`rim` has 34 nodes") && said[0].contains("102 coordinates"), "{said:?}");
    let at = |what: &str| told.0.iter().position(|line| line == what).unwrap_or_else(|| panic!("{what}: {:?}", told.0));
    assert!(at(&said[0]) < at("factor"), "{:?}", told.0);
    // A hundred dofs, or a patch of any size, are not.
    let small =
        Files::new(block(), vec![direct("rim", &labels(33))]).reduce("craig-bampton", "count = 1", "boundaries = []");
    assert!(warnings(&small, "W-LARGE").is_empty());
    let patch = supel::job::InterfaceJob { coupling: supel::job::Coupling::Rigid, ..direct("rim", &labels(34)) };
    let patch = Files::new(block(), vec![patch]).reduce("craig-bampton", "count = 1", "boundaries = []");
    assert!(warnings(&patch, "W-LARGE").is_empty());
}

/// The warning of many modes needs their number alone, which a count tells before they are looked for.
#[test]
fn many_modes_are_told_by_their_number() {
    let files = files();
    let job = files.job("herting", "up_to_hz = 12e9", "");
    assert!(size_forecast::of_modes(400, &job).is_none());
    let said = size_forecast::of_modes(3894, &job).expect("W-LARGE");
    assert!(said.message.contains("3,894 modes") && said.message.contains("unit"), "{}", said.message);
    let job = files.job("herting", "count = 500", "");
    assert!(size_forecast::of_modes(500, &job).is_some_and(|said| said.message.contains("asks for 500")));
}
