//! One full report and the superelement it belongs to, made by hand: a massless spring between two unit masses.

mod evidence;

use std::collections::{BTreeMap, BTreeSet};

use supel::cache::{Kind, Tally};
use supel::error::Result;
use supel::error::Warning;
use supel::input::Digits;
use supel::job::{Coupling, Eigensolver, Job, Method};
use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel::report::FacesReport;
use supel::report::{
    Completeness, DroppedCoordinate, Generator, InterfacePosition, InterfaceReport, MassProperties, MatrixReport,
    ModeKind, ModeRow, ModelReport, Observer, PositionOrigin, ReductionReport, Report, ReportBody, Reservations,
    RigidBodyModes, RunFacts, StageTime, WorkCounters,
};
use supel::rigid::RigidSource;
use supel::verification::check::{Check, Limits};
use supel_runtime::{
    CheckSummary, Coordinate, Direction, InterfaceNode, Matrix, Metadata, ModelSummary, Superelement, Tensors,
    Validity, Verdict, Verification,
};

/// A report in which every optional field is present, with checks of all three verdicts and limits.
pub fn full_report() -> Report {
    let mut report = passing_report();
    report.body.checks.push(Check {
        id: "M-09",
        name: "error bar from the digits of the input",
        equation: "ε_in c_j",
        value: 3.2e-5,
        limits: Limits { engineering: 1e-6, arithmetic: 1e-9, data: 2e-5 },
        fail_above: 1e-3,
        worst: Some("mode 3 at 311.2 Hz".to_owned()),
    });
    report.body.checks.push(Check {
        id: "M-16",
        name: "mass properties of the reduced model against those of the full one",
        equation: "|Û_Bᵀ M̂ Û_B − M_F| / |M_F|",
        value: 2.5e-2,
        limits: Limits { engineering: 1e-10, arithmetic: 3e-9, data: 0.0 },
        fail_above: 1e-6,
        worst: None,
    });
    report.body.checks.push(Check {
        id: "M-19",
        name: "effective mass of the kept modes, least carried",
        equation: "min Σ (φᵀΨ_DᵀΓ)² / ΓᵀM_II⁻¹Γ",
        value: 0.83,
        limits: Limits::NONE,
        fail_above: f64::INFINITY,
        worst: Some("rotation z".to_owned()),
    });
    report.body.warnings.push(Warning {
        code: "W-INTERFACE-ILL",
        message: "the interface holds the rotation about the axis through nodes 12 and 19 only weakly: singular value \
                  ratio 3.1e-3, below 1e-2; add an interface node away from that axis"
            .to_owned(),
    });
    report.body.reduction.dropped.push(DroppedCoordinate {
        coordinate: "mode 7".to_owned(),
        reason: "spanned by the constraint modes to 2.3e-11".to_owned(),
    });
    for mode in &mut report.body.reduction.modes {
        let (frequency, bar) = (mode.frequency_hz, 3.0 * mode.error_bar_hz);
        mode.enclosure_hz = Some([frequency - bar, frequency + bar]);
    }
    report
}

/// A report without anything to complain of.
pub fn passing_report() -> Report {
    Report { body: body(), run: run_facts() }
}

fn body() -> ReportBody {
    let row = |index: usize| ModeRow {
        coupling: 0.25,
        rank: index,
        index,
        frequency_hz: evidence::frequency(index),
        error_bar_hz: 1.7e-10 * (index as f64),
        backward_error: 3.1e-16,
        kind: ModeKind::FreeInterface,
        enclosure_hz: None,
    };
    ReportBody {
        generator: Generator::default(),
        model: model(),
        reduction: ReductionReport {
            method: Method::Herting,
            eigensolver: Eigensolver::Lanczos,
            interfaces: interfaces(),
            n_interface: 9,
            n_inertia_relief: 6,
            n_modes: 50,
            mass_rank: None,
            n_reduced: 65,
            modes_held: None,
            expansion: None,
            loads: Vec::new(),
            dropped: Vec::new(),
            skipped: Vec::new(),
            modes: (1..=50).map(row).collect(),
            unseen: Vec::new(),
        },
        checks: vec![Check {
            id: "M-01",
            name: "eigenpair backward error",
            equation: "|K x − λ M x| / ((|K| + λ |M|) |x|)",
            value: 3.1e-16,
            limits: Limits { engineering: 1e-13, arithmetic: 4e-14, data: 0.0 },
            fail_above: 1e-10,
            worst: Some("mode 12".to_owned()),
        }],
        warnings: Vec::new(),
        completeness: Completeness::SturmCount { below_hz: 16_200.25, n_counted: 56, n_found: 56, doubt: 0.01 },
        trust_intervals: evidence::trust_intervals(),
        rigid_body: evidence::rigid_body(&model().mass_properties),
        preservation: evidence::preservation(),
    }
}

fn interfaces() -> Vec<InterfaceReport> {
    vec![
        InterfaceReport {
            name: "hub".to_owned(),
            coupling: Coupling::Rigid,
            n_nodes: 96,
            n_dofs: 6,
            at: vec![InterfacePosition {
                node: None,
                position: [0.25, 0.0, -1.5e-3],
                origin: PositionOrigin::MeanOfNodes,
                faces: Some(FacesReport { count: 80, centroid: [0.25, 3e-3, -5.5e-3], distance: 5e-3 }),
                faces_unknown: None,
                fit: None,
                axes: None,
            }],
        },
        InterfaceReport { name: "foot".to_owned(), coupling: Coupling::Direct, n_nodes: 1, n_dofs: 3, at: Vec::new() },
    ]
}

fn model() -> ModelReport {
    let matrix = |n_nonzeros, digit: &str| MatrixReport {
        n_nonzeros,
        digits: Digits { significant: 12, ..Digits::DOUBLE },
        digest: digit.repeat(64),
    };
    ModelReport {
        n_dofs: 123_486,
        n_nodes: Some(41_162),
        n_bodies: 1,
        held: None,
        stiffness: matrix(9_472_104, "a"),
        mass: Some(matrix(3_157_368, "b")),
        files: [("dofs", "c".repeat(64)), ("nodes", "d".repeat(64))].into(),
        mass_properties: MassProperties {
            mass: Some(1.234e-3),
            cg: Some([0.0, -1.5e-17, 41.2]),
            inertia: Some([[1.25, 0.0, -0.015], [0.0, 2.5, 0.0], [-0.015, 0.0, 3.1]]),
        },
        rigid_body_modes: RigidBodyModes { count: 6, source: RigidSource::Geometric },
        units: Some("mm-t-s".to_owned()),
        notes: vec![
            "stiffness: declared general but held one triangle; it was mirrored".to_owned(),
            "mass: 12 entries repeated an earlier position and were added to it".to_owned(),
        ],
    }
}

fn run_facts() -> RunFacts {
    let stage = |name, seconds| StageTime { name, seconds };
    RunFacts {
        stages: vec![stage("read", 1.31), stage("factor", 4.2), stage("modes", 6.9), stage("write", 0.004)],
        peak_memory_bytes: Some(1_932_735_283),
        file_bytes: Some(81_920),
        file_digest: Some("c".repeat(64)),
        n_threads: 2,
        work: WorkCounters {
            n_factorisations: 2,
            n_solves: 412,
            n_restarts: 3,
            factor_flops: 4.1e10,
            factor_nonzeros: 61_204_551,
        },
        superelement: Some("/models/bracket.supel".into()),
        report: Some("/models/bracket.report.json".into()),
        cache: Some(Tally {
            parts: 1,
            taken: [(Kind::Factor, 1), (Kind::Count, 2)].into(),
            kept: [(Kind::Modes, 1)].into(),
            damaged: BTreeSet::new(),
            not_kept: None,
        }),
        reservations: Reservations::Accepted,
    }
}

/// A superelement of two translations: k = 4, m = 1 each, free along x.
pub fn superelement() -> Superelement {
    let node = |name: &str, x: f64| InterfaceNode {
        name: name.to_owned(),
        label: Some(12),
        dofs: vec![Direction::Ux],
        position: [x, 0.0, 0.0],
    };
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let matrix =
        |rows, values: &[f64]| Matrix::from_row_major(rows, values.len() / rows, values.to_vec()).expect("size");
    let tensors = Tensors {
        stiffness: matrix(2, &[4.0, -4.0, -4.0, 4.0]),
        mass: matrix(2, &[1.0, 0.0, 0.0, 1.0]),
        rigid_body_modes: matrix(2, &[1.0, 1.0]),
        rigid_body_mass: matrix(1, &[2.0]),
        interface_positions: vec![[0.0; 3], [1.0, 0.0, 0.0]],
        interface_frames: vec![identity, identity],
        frequencies: vec![std::f64::consts::TAU * 0.5],
        ..Tensors::default()
    };
    Superelement::new(tensors, metadata(vec![node("hub", 0.0), node("foot", 1.0)])).expect("a valid superelement")
}

fn metadata(interface_nodes: Vec<InterfaceNode>) -> Metadata {
    let coordinate = |node| Coordinate::Interface { node, direction: Direction::Ux };
    Metadata {
        generator: supel_runtime::Generator {
            name: "supel".to_owned(),
            version: "0.1.0".to_owned(),
            parts_of_earlier_runs: None,
        },
        method: supel_runtime::Method::Herting,
        units: Some("kg-m-s".to_owned()),
        interface_nodes,
        coordinates: vec![coordinate(0), coordinate(1)],
        dropped: Vec::new(),
        load_names: Vec::new(),
        modes_held: Vec::new(),
        quantities: Vec::new(),
        matrices: Vec::new(),
        validity: Validity::default(),
        flags: BTreeSet::new(),
        model: ModelSummary {
            n_dofs: 123_486,
            rigid_body_modes: supel_runtime::RigidBodyModes::Algebraic,
            mass_properties: None,
        },
        inputs: BTreeMap::from([("stiffness".to_owned(), "a".repeat(64))]),
        job: serde_json::json!({
            "model": { "stiffness": "/models/K.mtx", "mass": "/models/M.mtx" },
            "interface": [{ "name": "hub", "nodes": [12] }],
            "reduction": { "method": "herting", "modes": { "count": 1 } },
            "write": { "superelement": "/models/bracket.supel" }
        }),
        verification: Verification {
            verdict: Verdict::Pass,
            checks: vec![CheckSummary {
                id: "M-01".to_owned(),
                value: Some(3.1e-16),
                limit: 1e-13,
                verdict: Verdict::Pass,
            }],
        },
    }
}

/// A pipeline that answers every job with the same component.
#[allow(clippy::unnecessary_wraps)]
pub fn pipeline(_job: &Job, _resources: Resources, observer: &mut dyn Observer) -> Result<Outcome> {
    observer.stage("read");
    observer.stage("factor");
    let report = Report { run: RunFacts { work: run_facts().work, ..RunFacts::default() }, ..passing_report() };
    Ok(Outcome { superelement: superelement(), report })
}
