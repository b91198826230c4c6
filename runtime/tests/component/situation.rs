//! States to evaluate components in.

use supel_runtime::component::{FloatingFrame, Measures, ModalComponent, State, Workspace};
use supel_runtime::motion::{Motion, Vector6};
use supel_runtime::{Matrix, Superelement, Tensors};

use crate::beam;
use supel_models::SplitMix64;

/// A state and its data.
#[derive(Clone)]
pub(crate) struct Situation {
    pub(crate) motions: Vec<Motion>,
    pub(crate) amplitudes: Vec<f64>,
    pub(crate) velocities: Vec<f64>,
    pub(crate) accelerations: Vec<f64>,
}

impl Situation {
    /// Motions that differ by about `size` from a common one, velocities and accelerations of order one.
    pub(crate) fn random(component: &ModalComponent, size: f64, seed: u64) -> Self {
        let mut random = SplitMix64::new(seed);
        let carrier = random.motion(1.2);
        let (k, n, r) = (component.n_nodes(), component.n_modal(), component.n_coordinates());
        Self {
            motions: (0..k).map(|_| carrier.compose(&random.motion(size))).collect(),
            amplitudes: random.vector(n, size),
            velocities: random.vector(r, 1.0),
            accelerations: random.vector(r, 1.0),
        }
    }

    pub(crate) fn state(&self) -> State<'_> {
        State {
            motions: &self.motions,
            amplitudes: &self.amplitudes,
            velocities: &self.velocities,
            accelerations: &self.accelerations,
        }
    }

    /// The configuration moved along `direction` (r), each motion by the exponential of its part.
    pub(crate) fn moved(&self, step: f64, direction: &[f64]) -> Self {
        let mut moved = self.clone();
        for (j, motion) in moved.motions.iter_mut().enumerate() {
            let increment: Vector6 = std::array::from_fn(|i| step * direction[6 * j + i]);
            *motion = motion.compose(&Motion::exp(&increment));
        }
        let of_modes = &direction[6 * self.motions.len()..];
        moved.amplitudes.iter_mut().zip(of_modes).for_each(|(x, d)| *x += step * d);
        moved
    }

    /// Forces and energies.
    pub(crate) fn evaluated(&self, component: &ModalComponent) -> Workspace {
        let mut workspace = component.workspace();
        component.evaluate(&self.state(), &mut workspace).expect("a moderate deformation");
        workspace
    }

    /// Forces, tangent matrices and exact stiffness.
    pub(crate) fn exact_tangents(&self, component: &ModalComponent) -> Workspace {
        let mut workspace = component.workspace();
        component.exact_tangents(&self.state(), &mut workspace).expect("a moderate deformation");
        workspace
    }

    /// Tangent matrices.
    pub(crate) fn tangents(&self, component: &ModalComponent) -> Workspace {
        let mut workspace = component.workspace();
        component.tangents(&self.state(), &mut workspace).expect("a moderate deformation");
        workspace
    }
}

/// Every choice of floating frame and measures.
pub(crate) const CHOICES: [(FloatingFrame, Measures); 4] = [
    (FloatingFrame::MassWeighted, Measures::MotionBased),
    (FloatingFrame::Rigid, Measures::MotionBased),
    (FloatingFrame::MassWeighted, Measures::Classical),
    (FloatingFrame::Rigid, Measures::Classical),
];

/// Superelements of random numbers, damped with and without their rigid-body motion, and a beam.
pub(crate) fn superelements() -> Vec<Superelement> {
    let build = |(tensors, metadata)| Superelement::new(tensors, metadata).expect("the parts fit");
    let damped = |(n_nodes, n_modal, seed), damping: fn(&Tensors) -> Matrix| {
        let (mut tensors, metadata) = beam::random_parts(n_nodes, n_modal, seed);
        tensors.damping = Some(damping(&tensors));
        build((tensors, metadata))
    };
    vec![
        damped((3, 4, 11), |tensors| tensors.mass.clone()),
        damped((2, 3, 12), |tensors| tensors.stiffness.clone()),
        damped((3, 1, 14), unsymmetric_motion),
        damped((2, 2, 15), unsymmetric_deformation),
        beam::arc(5).superelement,
        build(beam::random_parts(1, 2, 13)),
    ]
}

/// M and a skew matrix that acts on rigid-body motion, too.
pub(crate) fn unsymmetric_motion(tensors: &Tensors) -> Matrix {
    let (skew, m) = (random_skew(tensors.mass.rows()), &tensors.mass);
    Matrix::from_fn(m.rows(), m.cols(), |i, j| m[(i, j)] + skew[(i, j)])
}

/// K + K S K with a skew S, which neither resists rigid-body motion nor makes forces on it.
pub(crate) fn unsymmetric_deformation(tensors: &Tensors) -> Matrix {
    let (k, r) = (&tensors.stiffness, tensors.stiffness.rows());
    let skew = random_skew(r);
    let half = Matrix::from_fn(r, r, |i, j| (0..r).map(|c| skew[(i, c)] * k[(c, j)]).sum());
    Matrix::from_fn(r, r, |i, j| k[(i, j)] + (0..r).map(|c| k[(i, c)] * half[(c, j)]).sum::<f64>())
}

pub(crate) fn random_skew(r: usize) -> Matrix {
    let entries = SplitMix64::new(16).vector(r * r, 0.5);
    Matrix::from_fn(r, r, |i, j| entries[i * r + j] - entries[j * r + i])
}

/// All of them in every choice of floating frame and measures.
pub(crate) fn components() -> Vec<ModalComponent> {
    let of = |superelement: &Superelement| {
        CHOICES.map(|(frame, measures)| {
            ModalComponent::with_measures(superelement, frame, measures).expect("a free body with whole nodes")
        })
    };
    superelements().iter().flat_map(of).collect()
}

pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(a, b)| a * b).sum()
}

/// A x for a matrix written row by row.
pub(crate) fn times(a: &[f64], x: &[f64]) -> Vec<f64> {
    a.chunks_exact(x.len()).map(|row| dot(row, x)).collect()
}

pub(crate) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |size, value| size.max(value.abs()))
}

/// Entries equal within `tolerance` of the largest expected one.
#[track_caller]
pub(crate) fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    let scale = largest(expected);
    assert!(scale > 0.0, "there is something to compare with");
    for (i, (x, y)) in found.iter().zip(expected).enumerate() {
        let error = (x - y).abs() / scale;
        assert!(error <= tolerance, "entry {i}: {x:e} instead of {y:e}, {error:.1e} of the largest");
    }
}

/// A matrix of the file in row-major order, by name.
pub(crate) fn file_matrix(superelement: &Superelement, of: impl Fn(&Tensors) -> &Matrix) -> Vec<f64> {
    of(superelement.tensors()).as_slice().to_vec()
}

/// Columns of the identity, r × r.
pub(crate) fn units(r: usize) -> Vec<Vec<f64>> {
    (0..r).map(|i| (0..r).map(|j| f64::from(u8::from(i == j))).collect()).collect()
}

/// (f(step) − f(−step)) / (2 step).
pub(crate) fn central_difference(step: f64, f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    f(step).iter().zip(f(-step)).map(|(ahead, behind)| (ahead - behind) / (2.0 * step)).collect()
}

/// −∂f/∂U of forces in the configuration (r × r, row by row), by central differences, added to a matrix of ones.
pub(crate) fn one_minus_derivative(
    step: f64,
    situation: &Situation,
    forces: impl Fn(&Situation) -> Vec<f64>,
) -> Vec<f64> {
    let r = situation.velocities.len();
    let mut sum = vec![1.0; r * r];
    for (j, unit) in units(r).iter().enumerate() {
        let column = central_difference(step, |s| forces(&situation.moved(s, unit)));
        column.iter().enumerate().for_each(|(i, value)| sum[i * r + j] -= value);
    }
    sum
}

/// The gradient of a scalar of the configuration, by central differences.
pub(crate) fn gradient(step: f64, situation: &Situation, energy: impl Fn(&Situation) -> f64) -> Vec<f64> {
    let each = units(situation.velocities.len());
    each.iter().flat_map(|unit| central_difference(step, |s| vec![energy(&situation.moved(s, unit))])).collect()
}
