//! Rounded coordinates, or axes of nodes: the six motions of every row with the motions without energy replaced by those that K has.

use std::ops::Range;

use faer::{Mat, MatRef};

use super::free::Free;
use super::motions::{Body, Motions, SIX_DIGITS};
use super::nodes::FIRST_ROTATION;
use super::zeros::Zeros;
use crate::dense;
use crate::error::Result;
use crate::model::{Frame, Misfit, RoundedCoordinates, recentred};

/// Cosine of the angle between a motion by the coordinates and a zero mode of K above which they are the same motion but for
/// rounding: coordinates that are off by a tenth of the body are not rounded.
const SAME_MOTION: f64 = 0.99;

/// What is mended.
pub(super) struct Mended {
    /// The motions C′ of every row about the centre of all.
    pub(super) coordinates: RoundedCoordinates,
    /// How far the worst node is out of place, in units of the size of its body, when the body is laid on its place as a whole.
    pub(super) out_of_place: f64,
    /// Its row.
    pub(super) worst: usize,
}

/// The first of the motions that rounding makes costly. Translations do not depend on coordinates, so that rotations alone are mended; on axes
/// they depend as rotations do.
pub(super) fn first_rounded(motions: &Motions<'_>) -> usize {
    if motions.has_rounded_axes() { 0 } else { FIRST_ROTATION }
}

/// The motions C′ with C′X = Z W, where Q P = C X are the combinations of the coordinates' motions and Z W those of the zero
/// modes that are nearest to each other: on the rows of `interface` as far as these tell, in the mass of all otherwise. An interface node
/// is where the coordinates have it, whatever part is out of place. Motions before `first` are right as they are.
pub(super) fn mended(
    motions: &Motions<'_>,
    free: &[Free],
    zeros: &Zeros,
    (misfit, interface, first): (Option<Misfit>, &dyn Fn(usize) -> bool, usize),
) -> Result<Mended> {
    let every: Vec<usize> = (0..motions.sites.len()).collect();
    let centre = Frame::of(motions.sites, &every).centre;
    let mut mended = motions.centred.clone();
    let mut worst = (0.0, 0);
    for (body, free) in motions.bodies.iter().zip(free) {
        let nearest = Nearest::of(motions, body, free, zeros)?;
        let back = right_inverse(nearest.combined.as_ref().subrows(first, 6 - first))?;
        let change = |w: &Mat<f64>| dense::product(nearest.gap(w).as_ref(), back.as_ref());
        let pinned = change(&nearest.on(interface)?);
        for (i, row) in body.rows.iter().enumerate() {
            (first..6).for_each(|j| mended[(*row, j)] += pinned[(i, j - first)]);
        }
        let laid = change(&nearest.on(&|_| true)?);
        for place in &nearest.displacements {
            let off = (0..6 - first).map(|j| laid[(*place, j)].abs()).fold(0.0, f64::max);
            if dense::worse(off, worst.0) {
                worst = (off, body.rows[*place]);
            }
        }
        for row in &body.rows {
            let scaled = std::array::from_fn(|j| mended[(*row, j)] * if j < 3 { 1.0 } else { body.frame.size });
            let about = recentred(scaled, body.frame.centre, centre);
            about.into_iter().enumerate().for_each(|(j, value)| mended[(*row, j)] = value);
        }
    }
    let coordinates = RoundedCoordinates { misfit, centre, motions: mended };
    Ok(Mended { coordinates, out_of_place: worst.0, worst: worst.1 })
}

/// How far the zero modes move the worst row otherwise than some of the six motions do that they are nearest to, in units of the size of its
/// body, and that row. A row that no zero mode moves is none.
pub(super) fn apart(
    motions: &Motions<'_>,
    (free, zeros): (&[Free], &Zeros),
    looked_at: &Range<usize>,
) -> Result<(f64, usize)> {
    let mut worst = (0.0, 0);
    for (body, free) in motions.bodies.iter().zip(free) {
        let nearest = Nearest::of(motions, body, free, zeros)?;
        let back = right_inverse(nearest.combined.as_ref())?;
        let apart = dense::product(nearest.gap(&nearest.on(&|_| true)?).as_ref(), back.as_ref());
        for place in &nearest.displacements {
            let row = body.rows[*place];
            let largest = |of: &dyn Fn(usize) -> f64| looked_at.clone().map(|j| of(j).abs()).fold(0.0, f64::max);
            let off = largest(&|j| apart[(*place, j)]);
            // What a support holds stays behind.
            let is_at_rest = largest(&|j| motions.centred[(row, j)] + apart[(*place, j)]) <= SIX_DIGITS;
            if !is_at_rest && dense::worse(off, worst.0) {
                worst = (off, row);
            }
        }
    }
    Ok(worst)
}

fn is_displacement(motions: &Motions<'_>, row: usize) -> bool {
    motions.sites[row].is_some_and(|site| !site.direction.is_rotation())
}

/// The combinations of a body's motions and of the zero modes that are nearest in the mass of all.
struct Nearest<'a> {
    rows: &'a [usize],
    /// Which of them are displacements, by their place.
    displacements: Vec<usize>,
    /// Z on the rows.
    zeros: Mat<f64>,
    /// W.
    weights: Mat<f64>,
    /// X, of six.
    combined: Mat<f64>,
    /// C X on the rows.
    by_coordinates: Mat<f64>,
}

impl<'a> Nearest<'a> {
    fn of(motions: &Motions<'_>, body: &'a Body, free: &Free, zeros: &Zeros) -> Result<Self> {
        let rows = |a: &Mat<f64>| Mat::from_fn(body.rows.len(), a.ncols(), |i, j| a[(body.rows[i], j)]);
        let (c, z) = (rows(&motions.centred), rows(&zeros.shapes));
        let q = dense::product(c.as_ref(), free.orthonormal.as_ref());
        // Both are M-orthonormal, and G = QᵀMZ has the cosines of the angles between them as singular values.
        let g = dense::gram(q.as_ref(), rows(&zeros.momenta).as_ref());
        let (squares, p) = dense::symmetric_eigen(dense::product(g.as_ref(), g.transpose()).as_ref())?;
        let same: Vec<usize> = (0..squares.len()).filter(|k| squares[*k] >= SAME_MOTION * SAME_MOTION).collect();
        let p = dense::columns(p.as_ref(), &same);
        // W = GᵀP has columns of the length of the cosines; a motion that replaces another has its own length.
        let mut w = dense::gram(g.as_ref(), p.as_ref());
        for (k, number) in same.iter().enumerate() {
            w.as_mut().col_mut(k).iter_mut().for_each(|value| *value /= squares[*number].sqrt());
        }
        let combined = dense::product(free.orthonormal.as_ref(), p.as_ref());
        let by_coordinates = dense::product(q.as_ref(), p.as_ref());
        let displacements = (0..body.rows.len()).filter(|i| is_displacement(motions, body.rows[*i])).collect();
        Ok(Self { rows: &body.rows, displacements, zeros: z, weights: w, combined, by_coordinates })
    }

    /// Z W − C X.
    fn gap(&self, weights: &Mat<f64>) -> Mat<f64> {
        dense::product(self.zeros.as_ref(), weights.as_ref()) - &self.by_coordinates
    }

    /// W with which Z W is nearest to C X on some displacements, unweighted, as far as these tell combinations of Z apart: by at least [`LEVER`] of
    /// how the others do.
    fn on(&self, is_one: &dyn Fn(usize) -> bool) -> Result<Mat<f64>> {
        let some: Vec<usize> = self.displacements.iter().copied().filter(|i| is_one(self.rows[*i])).collect();
        if some.is_empty() {
            return Ok(self.weights.clone());
        }
        let at = |places: &[usize], a: &Mat<f64>| Mat::from_fn(places.len(), a.ncols(), |i, j| a[(places[i], j)]);
        let on = |a: &Mat<f64>| at(&some, a);
        let mean = |a: &Mat<f64>| dense::gram(a.as_ref(), a.as_ref()) * faer::Scale(1.0 / a.nrows() as f64);
        let (squares, vectors) = dense::symmetric_eigen(mean(&at(&self.displacements, &self.zeros)).as_ref())?;
        let largest = squares.last().copied().unwrap_or(0.0);
        let moving: Vec<usize> = (0..squares.len()).filter(|k| squares[*k] > NO_MOTION * NO_MOTION * largest).collect();
        let unit =
            Mat::from_fn(vectors.nrows(), moving.len(), |i, k| vectors[(i, moving[k])] / squares[moving[k]].sqrt());
        let z = dense::product(on(&self.zeros).as_ref(), unit.as_ref());
        let (shares, own) = dense::symmetric_eigen(mean(&z).as_ref())?;
        let told: Vec<usize> = (0..shares.len()).filter(|k| shares[*k] >= LEVER * LEVER).collect();
        let own = dense::columns(own.as_ref(), &told);
        let missing =
            dense::gram(dense::product(z.as_ref(), own.as_ref()).as_ref(), on(&self.gap(&self.weights)).as_ref());
        let step =
            Mat::from_fn(told.len(), missing.ncols(), |k, j| -missing[(k, j)] / (shares[told[k]] * some.len() as f64));
        let step = dense::product(unit.as_ref(), dense::product(own.as_ref(), step.as_ref()).as_ref());
        Ok(&self.weights + step)
    }
}

/// Share of its motion elsewhere that some rows must take of a combination to tell how much of it there is: patches that are small next to
/// the body know its rotations less well than all of its nodes do.
const LEVER: f64 = 0.1;
/// Singular values relative to the largest below which a combination is none.
const NO_MOTION: f64 = 1e-9;

/// The pseudo-inverse of a matrix of few rows: of k × m, m × k.
fn right_inverse(x: MatRef<'_, f64>) -> Result<Mat<f64>> {
    let (squares, vectors) = dense::symmetric_eigen(dense::product(x, x.transpose()).as_ref())?;
    let largest = squares.last().copied().unwrap_or(0.0);
    let kept: Vec<usize> = (0..squares.len()).filter(|k| squares[*k] > NO_MOTION * NO_MOTION * largest).collect();
    let u = dense::columns(vectors.as_ref(), &kept);
    let scaled = Mat::from_fn(x.nrows(), kept.len(), |i, k| u[(i, k)] / squares[kept[k]]);
    Ok(dense::product(dense::gram(x, scaled.as_ref()).as_ref(), u.transpose()))
}
