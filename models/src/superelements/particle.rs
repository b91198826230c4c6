//! Superelements small enough to be known in closed form.
//!
//! The component is a rigid body with one interface node at p, mass m_a and principal inertia, and inside it, at the
//! same point, a particle of mass m_i on three springs. Clamped at the interface the particle oscillates with
//! ω² = k / m_i; free, body and particle oscillate against each other with ω² = k / μ, 1/μ = 1/m_a + 1/m_i. In both cases
//! the dynamic mode is a relative displacement s of the particle, normalised to unit modal mass.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

use supel_runtime::{
    CheckSummary, Coordinate, Direction, DropCause, DroppedColumn, Generator, InterfaceDof, InterfaceNode,
    MassProperties, Matrix, Metadata, Method, ModelSummary, Precision, RecoveredDof, Recovery, RigidBodyModes,
    Superelement, Tensors, Validity, Verdict, Verification, mass_properties,
};

const POSITION: [f64; 3] = [0.5, -0.25, 2.0];
const BODY_MASS: f64 = 3.0;
const PARTICLE_MASS: f64 = 1.0;
const BODY_INERTIA: [f64; 3] = [0.5, 0.75, 1.0];
const SPRINGS: [f64; 3] = [1e4, 4e4, 9e4];

/// Mass properties of the component about which nothing has been computed.
pub const MASS_PROPERTIES: MassProperties = MassProperties {
    mass: BODY_MASS + PARTICLE_MASS,
    center_of_mass: POSITION,
    inertia: [[BODY_INERTIA[0], 0.0, 0.0], [0.0, BODY_INERTIA[1], 0.0], [0.0, 0.0, BODY_INERTIA[2]]],
};

/// Numbers and metadata of the component reduced by Craig-Bampton or Herting: six interface coordinates and three modes.
pub fn parts(method: Method) -> (Tensors, Metadata) {
    let modal_mass = match method {
        Method::CraigBampton => PARTICLE_MASS,
        _ => BODY_MASS * PARTICLE_MASS / (BODY_MASS + PARTICLE_MASS),
    };
    let s = 1.0 / modal_mass.sqrt();
    let omega = SPRINGS.map(|k| (k / modal_mass).sqrt());
    let mass = Matrix::from_fn(9, 9, |i, j| match (i.min(j), i.max(j)) {
        (a, b) if a == b && a < 3 => BODY_MASS + PARTICLE_MASS,
        (a, b) if a == b && a < 6 => BODY_INERTIA[a - 3],
        (a, b) if a == b => PARTICLE_MASS * s * s,
        (a, b) if a + 6 == b => PARTICLE_MASS * s,
        _ => 0.0,
    });
    let stiffness = Matrix::from_fn(9, 9, |i, j| if i == j && i >= 6 { SPRINGS[i - 6] * s * s } else { 0.0 });
    let rigid = Matrix::from_fn(9, 6, |i, j| if i < 6 { rigid_motion(j)[i] } else { 0.0 });
    let tensors = Tensors {
        rigid_body_mass: congruence(&mass, &rigid),
        stiffness,
        mass,
        rigid_body_modes: rigid,
        interface_positions: vec![POSITION],
        interface_frames: vec![[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]],
        frequencies: omega.to_vec(),
        ..Tensors::default()
    };
    let interface = Direction::ALL.map(|direction| Coordinate::Interface { node: 0, direction });
    let mode = |(mode, omega): (usize, f64)| {
        let (frequency_hz, error_bar_hz) = (omega / TAU, Some(1e-9));
        match method {
            Method::CraigBampton => Coordinate::FixedInterfaceMode { mode, frequency_hz, error_bar_hz },
            _ => Coordinate::ElasticMode { mode, frequency_hz, error_bar_hz },
        }
    };
    let modes = omega.into_iter().enumerate().map(mode);
    let node = InterfaceNode { name: "hub".into(), label: Some(12), dofs: Direction::ALL.to_vec(), position: POSITION };
    let metadata = Metadata {
        interface_nodes: vec![node],
        coordinates: interface.into_iter().chain(modes).collect(),
        model: ModelSummary {
            n_dofs: 9,
            rigid_body_modes: RigidBodyModes::Geometric,
            mass_properties: mass_properties(&tensors.rigid_body_mass),
        },
        ..bare_metadata(method)
    };
    (tensors, metadata)
}

/// The component as a superelement.
pub fn component(method: Method) -> Superelement {
    let (tensors, metadata) = parts(method);
    Superelement::new(tensors, metadata).expect("the parts fit")
}

/// Herting's with every optional tensor and every list filled.
pub fn complete_parts() -> (Tensors, Metadata) {
    let (mut tensors, mut metadata) = parts(Method::Herting);
    let s = tensors.mass[(0, 6)] / PARTICLE_MASS;
    tensors.damping = Some(Matrix::from_fn(9, 9, |i, j| 1e-3 * tensors.stiffness[(i, j)]));
    tensors.mixing = Some(Matrix::from_fn(3, 3, |i, j| if i == j { 1.0 } else { 0.0 }));
    // Unit gravity along axis j loads every coordinate with M̂ times the unit translation.
    tensors.gravity = Some(Matrix::from_fn(9, 3, |i, j| tensors.mass[(i, j)]));
    tensors.load_vectors = Some(Matrix::from_fn(9, 1, |i, _| if i == 2 { 1.0 } else { 0.0 }));
    let particle = Matrix::from_fn(3, 9, |i, j| if i == j { 1.0 } else { f64::from(u8::from(i + 6 == j)) * s });
    let dofs = Direction::ALL[..3].iter().map(|&direction| RecoveredDof { node: 77, direction }).collect();
    tensors.recovery = Some(Recovery::new(particle, dofs, Precision::Single).expect("three rows, three dofs"));
    metadata.load_names = vec!["thrust".into()];
    metadata.units = Some("m-kg-s".into());
    metadata.dropped = (0..3)
        .map(|index| DroppedColumn {
            column: Coordinate::InertiaRelief { index },
            reason: "spanned by the elastic modes".into(),
            cause: DropCause::Spanned,
        })
        .collect();
    metadata.validity.band_hz = Some([0.0, 20.0]);
    metadata.validity.assumptions = vec!["gravity is \"uniform\"".into()];
    metadata.validity.unloaded = vec![InterfaceDof { node: 0, direction: Direction::Rz }];
    metadata.inputs = BTreeMap::from([("mass".into(), "ab".repeat(32)), ("stiffness".into(), "01".repeat(32))]);
    metadata.job = serde_json::json!({ "model": { "stiffness": "k.mtx" }, "scene": { "band_hz": [0.0, 0.1] } });
    metadata.verification = Verification {
        verdict: Verdict::Warn,
        checks: vec![
            CheckSummary { id: "M-12".into(), value: Some(1.0 / 3.0), limit: 1e-11, verdict: Verdict::Warn },
            CheckSummary { id: "M-16".into(), value: None, limit: 1e-10, verdict: Verdict::Pass },
        ],
    };
    (tensors, metadata)
}

/// Herting's with every optional tensor and every list filled, as a superelement.
pub fn complete() -> Superelement {
    let (tensors, metadata) = complete_parts();
    Superelement::new(tensors, metadata).expect("the parts fit")
}

/// The smallest superelement: two particles on a line joined by a spring, one end the interface, without any node.
pub fn two_particles() -> Superelement {
    let omega = 300.0;
    let matrix = |rows, cols, values: &[f64]| Matrix::from_row_major(rows, cols, values.to_vec()).expect("sizes agree");
    let tensors = Tensors {
        stiffness: matrix(2, 2, &[0.0, 0.0, 0.0, omega * omega]),
        mass: matrix(2, 2, &[2.0, 1.0, 1.0, 1.0]),
        rigid_body_modes: matrix(2, 1, &[1.0, 0.0]),
        rigid_body_mass: matrix(1, 1, &[2.0]),
        frequencies: vec![omega],
        ..Tensors::default()
    };
    let metadata = Metadata {
        coordinates: vec![
            Coordinate::InterfaceRow { row: 0 },
            Coordinate::FixedInterfaceMode { mode: 0, frequency_hz: omega / TAU, error_bar_hz: None },
        ],
        model: ModelSummary { n_dofs: 2, rigid_body_modes: RigidBodyModes::Algebraic, mass_properties: None },
        ..bare_metadata(Method::CraigBampton)
    };
    Superelement::new(tensors, metadata).expect("the parts fit")
}

fn bare_metadata(method: Method) -> Metadata {
    Metadata {
        generator: Generator { name: "supel".into(), version: "0.1.0".into(), parts_of_earlier_runs: None },
        method,
        units: None,
        interface_nodes: Vec::new(),
        coordinates: Vec::new(),
        dropped: Vec::new(),
        load_names: Vec::new(),
        modes_held: Vec::new(),
        quantities: Vec::new(),
        matrices: Vec::new(),
        validity: Validity::default(),
        flags: BTreeSet::new(),
        model: ModelSummary { n_dofs: 0, rigid_body_modes: RigidBodyModes::Algebraic, mass_properties: None },
        inputs: BTreeMap::new(),
        job: serde_json::json!({}),
        verification: Verification { verdict: Verdict::Pass, checks: Vec::new() },
    }
}

/// Displacement and rotation of the interface node under rigid motion `j`: e_j, or e_a × p with rotation e_a.
fn rigid_motion(j: usize) -> [f64; 6] {
    let [x, y, z] = POSITION;
    match j {
        3 => [0.0, -z, y, 1.0, 0.0, 0.0],
        4 => [z, 0.0, -x, 0.0, 1.0, 0.0],
        5 => [-y, x, 0.0, 0.0, 0.0, 1.0],
        _ => std::array::from_fn(|i| f64::from(u8::from(i == j))),
    }
}

/// UᵀMU.
fn congruence(m: &Matrix, u: &Matrix) -> Matrix {
    let n = m.rows();
    let entry = |a: usize, b: usize| (0..n * n).map(|k| u[(k / n, a)] * m[(k / n, k % n)] * u[(k % n, b)]).sum();
    Matrix::from_fn(u.cols(), u.cols(), entry)
}
