//! The eigenproblem that the solvers take, and the result that they return.

use faer::{Mat, MatMut, MatRef};

use super::operator::ShiftInvert;
use super::orthogonalisation::mass_qr;
use crate::dense;
use crate::sparse::{Leading, product};

/// The eigenproblem: K enters through its shift-invert operator.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// (K − σM)⁻¹.
    pub operator: &'a dyn ShiftInvert,
    /// M, n × n.
    pub mass: Leading<'a>,
    /// Q and MQ, n × n_r each; empty where nothing is deflated.
    pub deflated: [MatRef<'a, f64>; 2],
}

impl Problem<'_> {
    /// F ← Pᵀ F: takes the rigid-body resultant out of forces.
    pub(super) fn equilibrate(&self, forces: MatMut<'_, f64>) {
        let [q, mass_q] = self.deflated;
        if q.ncols() > 0 {
            let resultant = dense::gram(q, forces.as_ref());
            dense::add_product(forces, -1.0, mass_q, resultant.as_ref());
        }
    }

    /// F ← P (K − σM)⁻¹ Pᵀ F: displacements of forces, both without rigid-body motion.
    pub(super) fn apply(&self, mut block: MatMut<'_, f64>) {
        self.equilibrate(block.as_mut());
        self.operator.solve_in_place(block.as_mut());
        self.deflate(block);
    }

    /// OP X, a step of inverse iteration but for its scale, which leaves nothing in X that M does not see.
    pub(super) fn step(&self, vectors: MatRef<'_, f64>) -> Mat<f64> {
        let mut image = product(self.mass, vectors);
        self.apply(image.as_mut());
        image
    }

    /// M-orthonormalises vectors, twice over. Errors of OP lie along the modes nearest to its shift, and where these come first
    /// they are taken out of the others; against those further away nothing is owed.
    pub(super) fn orthonormalise(&self, vectors: &mut Mat<f64>) {
        for _ in 0..2 {
            let mut momenta = product(self.mass, vectors.as_ref());
            let mut dependent = vec![false; vectors.ncols()];
            mass_qr(vectors, &mut momenta, 0.0, &mut dependent);
        }
    }

    /// X ← P X: takes the rigid-body motion out of displacements.
    pub(super) fn deflate(&self, displacements: MatMut<'_, f64>) {
        let [q, mass_q] = self.deflated;
        if q.ncols() > 0 {
            let motion = dense::gram(mass_q, displacements.as_ref());
            dense::add_product(displacements, -1.0, q, motion.as_ref());
        }
    }
}

/// Which eigenpairs are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// The lowest ones, completed to whole clusters.
    Count(usize),
    /// All up to this λ, completed to whole clusters; one that lies above it by no more than the gap of a cluster belongs to
    /// the band too, so that rounding does not decide on a mode at its edge.
    UpTo(f64),
}

impl Wanted {
    /// The end of the band that is asked for; none where a number of pairs is.
    pub fn band_end(self) -> Option<f64> {
        match self {
            Self::Count(_) => None,
            Self::UpTo(limit) => Some(limit),
        }
    }
}

/// The eigenpairs between two shifts, of which a Sturm count says how many there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower shift.
    pub from: f64,
    /// Upper shift.
    pub to: f64,
    /// Eigenvalues between them that are to be found.
    pub count: usize,
}

impl Interval {
    /// Whether an eigenvalue lies between the shifts.
    pub fn holds(&self, lambda: f64) -> bool {
        self.from < lambda && lambda < self.to
    }
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Eigenpairs {
    /// λ in ascending order.
    pub values: Vec<f64>,
    /// x, n × k, M-orthonormal.
    pub vectors: Mat<f64>,
    /// The next λ above, where there is one: the far side of the gap a Sturm count is taken in.
    pub next: Option<f64>,
    /// What it cost.
    pub work: EigenWork,
}

impl Eigenpairs {
    /// These pairs in ascending order.
    pub(super) fn ascending(self) -> Self {
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
        let vectors = dense::columns(self.vectors.as_ref(), &order);
        Self { values: order.iter().map(|j| self.values[*j]).collect(), vectors, ..self }
    }
}

/// Work counters of an eigensolution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct EigenWork {
    /// Right-hand sides solved.
    pub solves: usize,
    /// Block steps.
    pub steps: usize,
    /// Thick restarts.
    pub restarts: usize,
    /// Numeric factorisations in addition to that of K_II.
    pub factorisations: usize,
}

impl std::ops::AddAssign for EigenWork {
    fn add_assign(&mut self, other: Self) {
        self.solves += other.solves;
        self.steps += other.steps;
        self.restarts += other.restarts;
        self.factorisations += other.factorisations;
    }
}

/// Eigenvalues nearer than this, relatively, belong to one cluster.
pub const CLUSTER_GAP: f64 = 1e-6;

/// Whether an eigenvalue lies above a band.
pub(crate) fn is_above(lambda: f64, limit: f64) -> bool {
    lambda > limit * (1.0 + CLUSTER_GAP)
}

/// Whether an eigenvalue and the next one above belong to one cluster.
pub(crate) fn are_clustered(lower: f64, upper: f64) -> bool {
    (upper - lower).abs() <= CLUSTER_GAP * upper.abs()
}

pub(super) fn mass_norm(mass: Leading<'_>, vector: &Mat<f64>) -> f64 {
    let image = product(mass, vector.as_ref());
    dense::dot(dense::column(vector.as_ref(), 0), dense::column(image.as_ref(), 0)).max(0.0).sqrt()
}
