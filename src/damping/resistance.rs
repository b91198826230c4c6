//! Damping that resists motion of a free component as a whole, on the full model.
//!
//! ```text
//! max_i |TᵀCT U|_i / (|T|ᵀ|C||T||U|)_i      force of a rigid-body motion at a dof, relative to the terms that it is the sum of, also
//!                                           those that cancel inside a patch; Cᵀ likewise
//! ```
//! Rounding of the data leaves of such a force what it leaves of K U, and the way that C was made more.

use faer::Mat;
use supel_runtime::{MOTIONS, MatrixKind};

use crate::dense::{self, NOISE_FACTOR};
use crate::error::{Error, Result};
use crate::job::{Job, MassActsOn, RigidMotionDamping};
use crate::partition::{CarriedMatrix, Partition};
use crate::rigid::RigidBodyModes;
use crate::sparse::{product, product_and_terms};

/// Share of its terms at which a force is none of rounding, whatever the digits of the data.
const LARGEST_ROUNDING: f64 = 1e-3;
/// Share of its terms up to which a force is none of a damper to the ground. Damping that a program makes of modes, M Φ diag(2ζω) Φᵀ M, has
/// the errors of these: rigid-body motions are orthogonal to them to ε times a ratio of eigenvalues, and the entries of a row cancel next to
/// that. Beams leave 2·10⁻¹¹, solids 10⁻¹³. As a force of translation in K has to exceed this before it is one of a support.
const MADE_OF_MODES: f64 = 1e-9;

/// Refuses damping of a free component that resists rigid-body motion, unless the job says that it is meant. Motions of mechanisms may
/// be damped.
///
/// # Errors
/// [`Error::DampingRigid`].
pub fn refuse_resistance(job: &Job, partition: &Partition, rigid: &RigidBodyModes) -> Result<()> {
    let n_whole = rigid.count() - rigid.n_mechanisms;
    if n_whole == 0 || job.rigid_motion() == RigidMotionDamping::Resist {
        return Ok(());
    }
    let rayleigh = job.damping.as_ref().and_then(|damping| damping.rayleigh);
    if rayleigh.is_some_and(|rayleigh| rayleigh.mass > 0.0 && rayleigh.mass_acts_on == MassActsOn::Motion) {
        let found = "a share of the mass in `damping.rayleigh`, which resists every motion".to_owned();
        return Err(Error::DampingRigid { found, remedy: "set its `mass_acts_on = \"deformation\"`" });
    }
    let u = rigid.modes.as_ref().subcols(0, n_whole).to_owned();
    let Some((forces, rounding)) = Forces::of_damping(&partition.matrices, &u) else { return Ok(()) };
    // What K leaves tells how well the motions are known, and what its digits are worth.
    let (forces_of_k, terms) = product_and_terms(&partition.stiffness, u.as_ref());
    let known = Known::of(rigid, &u);
    let left = Forces { forces: forces_of_k, terms }.worst(&known).0;
    let limit = (NOISE_FACTOR * left.max(rounding)).clamp(MADE_OF_MODES, LARGEST_ROUNDING);
    let (share, [dof, motion]) = forces.worst(&known);
    if share <= limit {
        return Ok(());
    }
    let motion = match MOTIONS.get(motion).filter(|_| rigid.is_classical) {
        Some(name) => (*name).to_owned(),
        None => format!("rigid-body mode {}", motion + 1),
    };
    let at = partition.name_of(dof % partition.n_dofs());
    let found =
        format!("{share:.1e} of the damping forces left under {motion} at {at}, where rounding explains {limit:.1e}");
    Err(Error::DampingRigid { found, remedy: "take out what damps against the ground" })
}

/// Forces of motions, and the sizes of the terms that they are sums of.
struct Forces {
    forces: Mat<f64>,
    terms: Mat<f64>,
}

impl Forces {
    /// Of the sum of the damping matrices and of its transpose, the one below the other; and the largest rounding of their entries.
    fn of_damping(matrices: &[CarriedMatrix], u: &Mat<f64>) -> Option<(Self, f64)> {
        let (n, n_u) = u.shape();
        let mut sum = Self { forces: Mat::zeros(2 * n, n_u), terms: Mat::zeros(2 * n, n_u) };
        let mut rounding = None;
        for carried in matrices.iter().filter(|carried| carried.facts.kind == MatrixKind::Damping) {
            rounding = Some(carried.facts.rounding.max(rounding.unwrap_or(f64::EPSILON)));
            let transposed = carried.matrix.transpose_view().to_csr();
            let forces = [&carried.matrix, &transposed].map(|matrix| product(matrix, u.as_ref()));
            let unit = faer::Scale(carried.facts.unit);
            for (at, (forces, terms)) in forces.into_iter().zip(carried.sizes_of_forces(u.as_ref())).enumerate() {
                let mut sums = sum.forces.as_mut().subrows_mut(at * n, n);
                sums += forces * unit;
                let mut sums = sum.terms.as_mut().subrows_mut(at * n, n);
                sums += terms * unit;
            }
        }
        rounding.map(|rounding| (sum, rounding))
    }

    /// The largest share of a force in its terms, with the dof and the motion.
    ///
    /// A dof that hardly takes part in a motion, as one on an axis in the rotation about it, has terms of the noise of the motions alone:
    /// whatever damps it shows in the motions in which it takes part.
    fn worst(&self, known: &Known) -> (f64, [usize; 2]) {
        let terms = self.terms.as_ref();
        let mut worst = (0.0, [0, 0]);
        for row in 0..terms.nrows() {
            let of_unit = |(motion, size): (usize, &f64)| if *size > 0.0 { terms[(row, motion)] / size } else { 0.0 };
            let largest = known.sizes.iter().enumerate().map(of_unit).fold(0.0, f64::max);
            for (motion, size) in known.sizes.iter().enumerate() {
                let term = terms[(row, motion)];
                let share =
                    if term > known.noise * largest * size { self.forces[(row, motion)].abs() / term } else { 0.0 };
                if dense::worse(share, worst.0) {
                    worst = (share, [row, motion]);
                }
            }
        }
        worst
    }
}

/// How large the motions of a body are, and how well they are known relative to that.
struct Known {
    sizes: Vec<f64>,
    noise: f64,
}

impl Known {
    fn of(rigid: &RigidBodyModes, u: &Mat<f64>) -> Self {
        let largest = |j| dense::column(u.as_ref(), j).iter().fold(0.0f64, |max, x| max.max(x.abs()));
        let own: Vec<f64> = (0..u.ncols()).map(largest).collect();
        // Positions are rounded relative to the extent, which is that of all rotations: one about a line moves no node of it.
        let extent = own.iter().copied().fold(0.0, f64::max);
        let is_rotation = |motion: usize| rigid.is_classical && motion >= MOTIONS.len() / 2;
        let sizes = own.into_iter().enumerate().map(|(at, size)| if is_rotation(at) { extent } else { size }).collect();
        let noise = NOISE_FACTOR * rigid.energy.largest_residual.max(f64::EPSILON);
        Self { sizes, noise: noise.min(LARGEST_ROUNDING) }
    }
}
