//! Frequencies under the boundaries of the scene against dense spectra.

use faer::Mat;
use supel::verification::preservation::BoundaryComparison;

use crate::chain::{EPS, Twin, direct, partition, rigid_group};
use crate::oracle::{Dense, reduced};
use crate::run::{Files, block};

fn files() -> Files {
    Files::new(block(), vec![rigid_group("XMIN"), direct("tip", &[5, 45])])
}

/// The full and the reduced model with interface dofs held, loaded and on springs.
fn spectra(full: &Dense, reduced: &Dense, held: &[usize], [load, springs]: [&[f64]; 2]) -> [Vec<f64>; 2] {
    let n_b = load.len();
    let n_i = full.k.nrows() - n_b;
    let supported = |model: &Dense, first: usize| {
        let mut loaded = Dense { k: model.k.clone(), m: model.m.clone() };
        for dof in 0..n_b {
            loaded.m[(first + dof, first + dof)] += load[dof];
            loaded.k[(first + dof, first + dof)] += springs[dof];
        }
        let kept: Vec<usize> = (0..model.k.nrows()).filter(|i| !held.iter().any(|dof| first + dof == *i)).collect();
        loaded.restricted(&kept)
    };
    let of_full = supported(full, n_i).modes().elastic_hz(0);
    // Near the first eigenvalue with an energy of its own; rounding leaves the zero ones some hertz at most.
    let first = of_full.iter().find(|hz| **hz > 1e-3 * of_full[of_full.len() - 1]).expect("an elastic one");
    let of_reduced = supported(reduced, 0).finite_hz((std::f64::consts::TAU * first).powi(2));
    [of_full, of_reduced]
}

fn assert_agrees(found: &BoundaryComparison, [full, reduced]: &[Vec<f64>; 2], n_zero: usize, band_end: f64) {
    // n ε κ of λ, κ = λ_max/λ_1, with M factored as well.
    let tolerance = full.len() as f64 * EPS * (full[full.len() - 1] / full[n_zero]).powi(2);
    assert!(tolerance < 1e-6, "{tolerance:e}");
    let in_band: Vec<&f64> = full[n_zero..].iter().take_while(|hz| **hz <= band_end).collect();
    assert_eq!(found.frequencies.len(), in_band.len(), "{}", found.boundary);
    assert!(!in_band.is_empty(), "{}", found.boundary);
    let mut worst = 0.0f64;
    for (j, pair) in found.frequencies.iter().enumerate() {
        assert!((pair.full_hz / full[n_zero + j] - 1.0).abs() <= tolerance, "{}: {pair:?}", found.boundary);
        assert!((pair.reduced_hz / reduced[n_zero + j] - 1.0).abs() <= tolerance, "{}: {pair:?}", found.boundary);
        assert_eq!(pair.relative_difference, pair.reduced_hz / pair.full_hz - 1.0);
        assert!(pair.in_band);
        worst = worst.max(pair.relative_difference.abs());
    }
    assert_eq!(found.worst_in_band, worst);
    // Zero modes are rounding of either sign, and no number is below it.
    let count = found.count.expect("counted");
    let below = n_zero + full[n_zero..].iter().filter(|hz| **hz < count.below_hz).count();
    assert!(count.below_hz > band_end, "{count:?}");
    assert_eq!((count.n_counted, count.n_found), (below, below), "{}", found.boundary);
}

/// Free, each interface held, each loaded: by default and as the scene says.
#[test]
fn frequencies_under_other_boundaries_are_those_of_dense_spectra() {
    let files = files();
    let partition = partition(&files.model, &files.interfaces).expect("sound");
    let twin = Twin::new(&files.model, &files.interfaces, &partition);
    let full = Dense::of(&files.model).transformed(&twin.transformation);
    let is_rotation =
        |dof: usize| partition.dofs[partition.n_internal + dof].site.expect("a site").direction.is_rotation();
    // The component's mass, and the moment of inertia of the same radius of gyration: rigid motions about the centre.
    let inertia = inertia(&files);
    let load = |dofs: std::ops::Range<usize>, mass: f64, n_nodes: f64| -> Vec<f64> {
        let of = |dof| if is_rotation(dof) { inertia.1 * mass / inertia.0 } else { mass } / n_nodes;
        (0..12).map(|dof| if dofs.contains(&dof) { of(dof) } else { 0.0 }).collect()
    };
    let nothing = vec![0.0; 12];
    let band_end = 5000.0;
    let scene =
        "band_hz = [0, 5000]\nboundaries = [\"free\", \"fix:XMIN\", \"fix:tip\", \"mass:XMIN\", \"mass:tip=70\"]";
    for method in ["herting", "craig-bampton", "macneal"] {
        let outcome = files.reduce(method, "count = 8", scene);
        let reduced = reduced(&outcome.superelement);
        let found = &outcome.report.body.preservation.boundaries;
        let names: Vec<&str> = found.iter().map(|comparison| comparison.boundary.as_str()).collect();
        assert_eq!(names, ["free", "fix:XMIN", "fix:tip", "mass:XMIN", "mass:tip=70"]);
        let held: [Vec<usize>; 5] = [vec![], (0..6).collect(), (6..12).collect(), vec![], vec![]];
        let loads = [&nothing, &nothing, &nothing, &load(0..6, inertia.0, 1.0), &load(6..12, 70.0, 2.0)];
        // Two held points leave the turn about the line through them.
        for (comparison, (held, (load, n_zero))) in
            found.iter().zip(held.iter().zip(loads.into_iter().zip([6, 0, 1, 6, 6])))
        {
            assert_agrees(comparison, &spectra(&full, &reduced, held, [load, &nothing]), n_zero, band_end);
        }
    }
}

/// Translations on springs: of the one node of a patch, which still turns, and of two nodes, which still turn about their line.
#[test]
fn frequencies_on_springs_are_those_of_dense_spectra() {
    let files = files();
    let partition = partition(&files.model, &files.interfaces).expect("sound");
    let twin = Twin::new(&files.model, &files.interfaces, &partition);
    let full = Dense::of(&files.model).transformed(&twin.transformation);
    let is_rotation =
        |dof: usize| partition.dofs[partition.n_internal + dof].site.expect("a site").direction.is_rotation();
    let springs = |dofs: std::ops::Range<usize>, each: f64| -> Vec<f64> {
        (0..12).map(|dof| if dofs.contains(&dof) && !is_rotation(dof) { each } else { 0.0 }).collect()
    };
    let nothing = vec![0.0; 12];
    let scene = "band_hz = [0, 5000]\nboundaries = [\"spring:XMIN=1e8\", \"spring:tip=2e9\"]";
    for method in ["herting", "craig-bampton", "macneal"] {
        let outcome = files.reduce(method, "count = 8", scene);
        let reduced = reduced(&outcome.superelement);
        let found = &outcome.report.body.preservation;
        assert_eq!(found.not_compared, Vec::<String>::new());
        let expected = [("spring:XMIN=100000000", 0..6, 1e8, 3), ("spring:tip=2000000000", 6..12, 1e9, 1)];
        assert_eq!(found.boundaries.len(), 2);
        for (comparison, (name, dofs, each, n_zero)) in found.boundaries.iter().zip(expected) {
            assert_eq!(comparison.boundary, name);
            let spectra = spectra(&full, &reduced, &[], [&nothing, &springs(dofs, each)]);
            assert_agrees(comparison, &spectra, n_zero, 5000.0);
        }
    }
}

/// Mass and mean moment of inertia of a model of translations, about its centre of mass.
fn inertia(files: &Files) -> (f64, f64) {
    let model = &files.model;
    let m = Dense::of(model).m;
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let column = &model.rigid_body_modes()[axis];
        Mat::from_fn(model.n, 1, |i, _| column[i])
    });
    let mass = (x.transpose() * &m * &x)[(0, 0)];
    let at = |axis: usize| {
        Mat::from_fn(model.n, 1, |i, _| {
            let label = model.dofs[i].0;
            model.nodes[model.labels.iter().position(|other| *other == label).expect("a node")][axis]
        })
    };
    // Σ m r² of each coordinate about the centre, with the directions' own translations as weights.
    let spread = |axis: usize, unit: &Mat<f64>| {
        let moved = Mat::from_fn(model.n, 1, |i, _| at(axis)[(i, 0)] * unit[(i, 0)]);
        let first = (unit.transpose() * &m * &moved)[(0, 0)];
        (moved.transpose() * &m * &moved)[(0, 0)] - first * first / mass
    };
    let sum = spread(0, &y) + spread(1, &z) + spread(2, &x);
    // Each axis turns the other two coordinates.
    (mass, 2.0 * sum / 3.0)
}

#[test]
fn nothing_is_compared_where_the_list_is_empty() {
    let preservation = files().preservation("herting", "count = 4", "boundaries = []");
    assert!(preservation.boundaries.is_empty());
    assert!(preservation.response.is_some() && preservation.not_compared.is_empty());
}

#[test]
fn the_default_is_free_held_and_loaded() {
    let preservation = files().preservation("herting", "count = 4", "");
    let names: Vec<&str> = preservation.boundaries.iter().map(|comparison| comparison.boundary.as_str()).collect();
    assert_eq!(names, ["free", "fix:XMIN", "fix:tip", "mass:XMIN", "mass:tip"]);
    let band_end = preservation.modes[3].full_hz / 1.5;
    let response = preservation.response.expect("a response");
    assert!((response.samples.last().expect("samples").frequency_hz / band_end - 1.0).abs() < 4.0 * EPS);
}

/// A point of the size-error curve is what a job with as many modes finds, the mass of its modes alone where the method has no other.
#[test]
fn a_point_of_the_curve_is_the_job_of_that_size() {
    let files = Files::new(block(), vec![rigid_group("XMIN"), direct("tip", &[45])]);
    let scene = "band_hz = [0, 3000]\nboundaries = [\"free\", \"fix:XMIN\", \"mass:tip=70\"]";
    for method in ["herting", "macneal"] {
        let curve = files.preservation(method, "count = 6", scene).size_errors;
        let counts: Vec<usize> = curve.iter().map(|point| point.n_modes).collect();
        assert_eq!(counts, [0, 1, 2, 3, 4, 5, 6]);
        for point in curve {
            let smaller = files.preservation(method, &format!("count = {}", point.n_modes), scene);
            let expected = smaller.boundaries.iter().map(|comparison| comparison.worst_in_band).fold(0.0, f64::max);
            assert_eq!(smaller.boundaries.len(), 3);
            // Differences of frequencies that both pencils give to some ten digits (M-14).
            let is_same = point.frequency_error == expected || (point.frequency_error - expected).abs() <= 1e-9;
            assert!(is_same, "{method}, {} modes: {} for {expected}", point.n_modes, point.frequency_error);
        }
    }
}
