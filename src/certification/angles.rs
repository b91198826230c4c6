//! How far a shape is from the modes of its cluster, in the norm of A = K − σM.
//!
//! ```text
//! s = ρ − σ,  r = Kx − ρMx,  δ² = rᵀA⁻¹r / (s xᵀMx)
//! γ     relative distance of s to λ − σ of the nearest other mode
//! sin ∠(x, modes of the cluster) ≤ δ/γ
//! ```
//! This takes all force that is left over for that of the nearest mode. Where neighbours are close, the rounding of a shape, which is
//! spread over all modes, then looks like much of a neighbour. Where all modes below τ are known, the parts are told apart:
//!
//! ```text
//! Ŷ     n' × m  their Ritz vectors: ŶᵀMŶ = I, ŶᵀKŶ diagonal; Q  rigid-body motion
//! a_k = ŷ_kᵀMx  what the shape has of each other one, whose share of its length is a_k² (λ_k − σ) / s
//! δ_⊥² = δ² − Σ_k (ŷ_kᵀr)² / ((λ_k − σ) s)    the force outside of them, by Pythagoras in A⁻¹
//! γ_⊥ = 1 − s / (τ − σ)                       all modes outside of them lie above τ
//! sin ∠ ≤ √(Σ a_k² (λ_k − σ) / s) + δ_⊥/γ_⊥ √(1 + (δ/γ)²)
//! ```
//! The root is how far Ritz vectors turn among each other by what is outside of them (Saad 2011, theorem 4.6). Of both bounds the smaller
//! one counts. Roundings δx of a shape change the first by ‖δx‖/γ and the second by ‖δx‖ (1 + 1/γ_⊥), relative to ‖x‖. They change √Σ a_k², what
//! it has of other known modes in the norm of M, by no more than ‖δx‖ in that norm, where they are no larger than the digits say: however
//! few digits tell of modes beyond τ, of the others they tell much.

use std::ops::Range;

use faer::Mat;

use super::band::Completed;
use super::claims::Claims;
use super::measured::Measured;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::{ModalProblem, Spectral};
use crate::error::Result;
use crate::sparse::product;

/// A bound of the sine of an angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angle {
    pub(super) value: f64,
    /// How often the length of what a shape is rounded by it counts.
    pub(super) per_rounding: f64,
}

/// The shapes of a result among the known modes.
pub(super) struct AmongKnown {
    /// λ_k, ascending.
    lambda: Vec<f64>,
    /// ŶᵀMX, m × k.
    along: Mat<f64>,
    /// ŶᵀR, m × k.
    forces: Mat<f64>,
    /// λ up to which there are no others.
    tau: f64,
}

impl AmongKnown {
    /// The shapes among the modes of a band; none where these are not all modes below some frequency.
    ///
    /// # Errors
    /// A dense eigenproblem that does not converge.
    pub(super) fn of(
        problem: ModalProblem<'_>,
        (claims, measured): (&Claims, &Measured),
        completed: &Completed,
    ) -> Result<Option<Self>> {
        let modes = &completed.modes;
        let tau = match &completed.certificate {
            Some(certificate) if completed.ends[0] <= 0.0 => certificate.count.sigma,
            _ => return Ok(None),
        };
        let m = modes.lambda.partition_point(|lambda| *lambda < tau);
        let Some(first) = modes.lambda.first().filter(|_| m == modes.count()) else { return Ok(None) };
        let y = modes.shapes.as_ref();
        let [in_stiffness, in_mass] = [product(problem.stiffness, y), product(problem.mass, y)];
        let [k, mass] = [&in_stiffness, &in_mass].map(|product| {
            let mut gram = dense::gram(y, product.as_ref());
            dense::symmetrise(&mut gram);
            gram
        });
        let Some(ritz) = Spectral::if_definite(k.as_ref(), mass.as_ref(), *first)? else { return Ok(None) };
        let vectors: Vec<Vec<f64>> = (0..m).map(|mode| ritz.eigenvector(mode)).collect();
        let turned = Mat::from_fn(m, m, |i, j| vectors[j][i]);
        let of_shapes = |product: &Mat<f64>| {
            let along = dense::gram(product.as_ref(), claims.shapes.as_ref());
            dense::gram(turned.as_ref(), along.as_ref())
        };
        let (along, mut forces) = (of_shapes(&in_mass), of_shapes(&in_stiffness));
        for j in 0..forces.ncols() {
            (0..m).for_each(|k| forces[(k, j)] -= measured.lambda[j] * along[(k, j)]);
        }
        Ok(Some(Self { lambda: ritz.eigenvalues(), along, forces, tau }))
    }

    /// What a shape has of known modes of other clusters, in the norm of M.
    pub(super) fn of_others(&self, claim: usize, cluster: &Range<usize>) -> f64 {
        let others = (0..self.lambda.len()).filter(|mode| !cluster.contains(mode));
        others.map(|mode| self.along[(mode, claim)].powi(2)).sum::<f64>().sqrt()
    }

    /// What a shape has besides the modes of its cluster, in the norm of M.
    pub(super) fn outside(&self, claim: usize, cluster: &Range<usize>) -> f64 {
        let within: f64 = cluster.clone().map(|mode| self.along[(mode, claim)].powi(2)).sum();
        (1.0 - within).max(0.0).sqrt()
    }

    /// The bound by what a shape has of known modes and of others; `of_nearest` is δ/γ.
    fn angle(&self, claim: usize, cluster: &Range<usize>, measured: &Measured, of_nearest: f64) -> Option<Angle> {
        let (sigma, rho, lacking) = (measured.sigma, measured.lambda[claim], measured.lacking[claim]);
        let s = rho - sigma;
        let gap = 1.0 - s / (self.tau - sigma);
        if s.is_nan() || s <= 0.0 || gap.is_nan() || gap <= 0.0 {
            return None;
        }
        let of_rigid = measured.rigid_share(claim);
        let (mut of_others, mut force) = (-sigma * of_rigid / s, rho * rho * of_rigid / (-sigma * s));
        // A component that is held has no rigid-body motion, and σ may be zero.
        if of_rigid == 0.0 {
            (of_others, force) = (0.0, 0.0);
        }
        for (k, lambda) in self.lambda.iter().enumerate() {
            if !cluster.contains(&k) {
                of_others += self.along[(k, claim)].powi(2) * (lambda - sigma) / s;
            }
            force += self.forces[(k, claim)].powi(2) / ((lambda - sigma) * s);
        }
        let rounding = NOISE_FACTOR * f64::EPSILON * lacking * lacking;
        let outside = (lacking * lacking - force).max(rounding).sqrt();
        let of_known = of_others.sqrt();
        let value = of_known + outside / gap * of_nearest.hypot(1.0);
        Some(Angle { value, per_rounding: 1.0 + 1.0 / gap })
    }
}

/// The smaller of both bounds for a pair, with γ of its cluster.
pub(super) fn angle(
    known: Option<&AmongKnown>,
    claim: usize,
    (cluster, gap): (&Range<usize>, f64),
    measured: &Measured,
) -> Angle {
    let of_nearest = measured.lacking[claim] / gap;
    let nearest = Angle { value: of_nearest, per_rounding: 1.0 / gap };
    let among = known.and_then(|known| known.angle(claim, cluster, measured, of_nearest));
    let least = among.filter(|among| among.value < nearest.value).unwrap_or(nearest);
    Angle { value: least.value.min(1.0), ..least }
}
