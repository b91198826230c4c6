//! Mass properties of the reduced model by independent routes: M-16.
//!
//! ```text
//! geometry      UᵀMU         from the coordinates and the full mass
//! stiffness     Û = N N⁺U_B  N the null space of K̂_BB as a dense decomposition finds it
//! eigenvectors  Û = Φ ΦᵀM̂Û   Φ the zero modes of the reduced pencil
//! ```
//! Each gives M_F = ÛᵀM̂Û. The space industry checks Craig-Bampton models in this way; here the checks do not depend on units.

use faer::{Mat, MatRef};

use super::check::{Check, Limits};
use super::evidence::{Evidence, coordinate_scales, rigid_name};
use super::spectrum::{Spectrum, zero_level};
use crate::dense;
use crate::eigen::{NO_MASS, scaled_by};
use crate::error::Result;

/// M_F by each route, in scaled units.
#[derive(Clone, Debug)]
pub struct MassRoutes {
    /// From the coordinates and the full mass.
    pub geometry: Mat<f64>,
    /// From the null space of K̂_BB.
    pub stiffness: Mat<f64>,
    /// From the zero modes of the reduced pencil.
    pub eigenvectors: Mat<f64>,
}

/// The routes, for one free body with coordinates.
pub(super) fn mass_routes(evidence: &Evidence<'_>, spectrum: &Spectrum) -> Result<Option<MassRoutes>> {
    if !evidence.rigid.is_classical || evidence.partition.n_interface() == 0 || !evidence.is_held() {
        return Ok(None);
    }
    let reduction = evidence.reduction;
    let mass = reduction.mass.as_ref();
    let by_stiffness = null_space_motions(evidence)?;
    let n_b = by_stiffness.nrows();
    let phi = spectrum.zero_shapes.as_ref();
    let along = dense::gram(phi, dense::product(mass, reduction.rigid_body_modes.as_ref()).as_ref());
    let by_eigenvectors = dense::product(phi, along.as_ref());
    let m_f = |u: MatRef<'_, f64>, mass: MatRef<'_, f64>| dense::gram(u, dense::product(mass, u).as_ref());
    Ok(Some(MassRoutes {
        geometry: reduction.rigid_body_mass.clone(),
        stiffness: m_f(by_stiffness.as_ref(), mass.submatrix(0, 0, n_b, n_b)),
        eigenvectors: m_f(by_eigenvectors.as_ref(), mass),
    }))
}

/// The motions of the interface that K̂_BB lets pass, nearest to U_B, n_B × n_r.
fn null_space_motions(evidence: &Evidence<'_>) -> Result<Mat<f64>> {
    let n_b = evidence.partition.n_interface();
    let scales = coordinate_scales(evidence);
    let stiffness = evidence.reduction.stiffness.as_ref().submatrix(0, 0, n_b, n_b);
    let (_, vectors) = dense::symmetric_eigen(scaled_by(stiffness, &scales[..n_b]).as_ref())?;
    let n_r = evidence.rigid.count().min(n_b);
    let null = vectors.as_ref().subcols(0, n_r);
    let u_b = &evidence.reduction.rigid_body_modes;
    let scaled = Mat::from_fn(n_b, u_b.ncols(), |i, j| u_b[(i, j)] / scales[i]);
    let projected = dense::product(null, dense::gram(null, scaled.as_ref()).as_ref());
    Ok(Mat::from_fn(n_b, u_b.ncols(), |i, j| projected[(i, j)] * scales[i]))
}

/// The largest |A − B|_ij / √(B_ii B_jj), and its entry.
///
/// A straight beam of lumped masses turns about its axis without inertia: there is nothing to compare then, and any inertia that either
/// matrix has above that share of the largest is a difference without limit.
pub(crate) fn mass_difference(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> (f64, (usize, usize)) {
    let mut worst = (0.0, (0, 0));
    let least = NO_MASS * (0..b.ncols()).fold(0.0f64, |max, i| max.max(b[(i, i)]));
    let has_inertia = |i: usize| b[(i, i)] > least;
    for j in 0..b.ncols() {
        for i in 0..=j {
            // Either triangle: the numbers of a file need not be symmetric.
            let difference = dense::worst([(i, j), (j, i)].map(|at| (a[at] - b[at]).abs()));
            let error = match has_inertia(i) && has_inertia(j) {
                true => difference / (b[(i, i)] * b[(j, j)]).sqrt(),
                false if difference.powi(2) <= b[(i, i)].max(least) * b[(j, j)].max(least) => 0.0,
                false => f64::INFINITY,
            };
            if dense::worse(error, worst.0) {
                worst = (error, (i, j));
            }
        }
    }
    worst
}

/// M-16, three routes.
pub(super) fn routes_agree(evidence: &Evidence<'_>, spectrum: &Spectrum, routes: &MassRoutes) -> Check {
    // What mass properties are refused at when they are compared with those of a finite element code.
    const FAIL: f64 = 1e-2;
    let geometry = routes.geometry.as_ref();
    let by_stiffness = mass_difference(routes.stiffness.as_ref(), geometry);
    let by_vectors = mass_difference(routes.eigenvectors.as_ref(), geometry);
    let (route, (value, (i, j))) = if dense::worse(by_stiffness.0, by_vectors.0) {
        ("stiffness", by_stiffness)
    } else {
        ("eigenvectors", by_vectors)
    };
    // A null space is known to the size of what is zero over what is not.
    let (zero, elastic) = (zero_level(evidence), spectrum.lowest_elastic);
    let limits = Limits { engineering: 1e-10, arithmetic: zero.arithmetic / elastic, data: zero.data / elastic };
    // Where a motion is nearly without energy no decomposition tells the null space: W-GREY has said so.
    let fail_above = if zero.value() > FAIL * elastic { 1.0 } else { FAIL };
    let limits = limits.capped(FAIL, FAIL);
    Check {
        id: "M-16",
        name: "mass properties agree by three routes",
        equation: "max |M_F by K̂, by zero modes − UᵀMU|_ij / √(M_F,ii M_F,jj)",
        value,
        limits,
        fail_above,
        worst: (value > 0.0)
            .then(|| format!("by {route}, {} and {}", rigid_name(evidence, i), rigid_name(evidence, j))),
    }
}
