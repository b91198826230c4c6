//! Rounded coordinates, or axes of nodes: the six motions of every row with the motions without energy replaced by those that K has.

use faer::{Mat, MatRef};

use super::free::Free;
use super::motions::Motions;
use super::nodes::FIRST_ROTATION;
use super::zeros::Zeros;
use crate::dense;
use crate::error::Result;
use crate::model::{Frame, Misfit, RoundedCoordinates, recentred};

/// Cosine of the angle between a motion by the coordinates and a zero mode of K above which they are the same motion but for
/// rounding: coordinates that are off by a tenth of the body are not rounded.
const SAME_MOTION: f64 = 0.99;

/// The motions C′ with C′X = Z W, where Q P = C X are the combinations of the coordinates' motions and Z W those of the zero
/// modes that are nearest to each other.
pub(super) fn mended(
    motions: &Motions<'_>,
    free: &[Free],
    zeros: &Zeros,
    misfit: Option<Misfit>,
) -> Result<RoundedCoordinates> {
    // Translations do not depend on coordinates: C′X = Z W is met by the rotations alone. On axes they depend as rotations do.
    let first = if motions.has_rounded_axes() { 0 } else { FIRST_ROTATION };
    let every: Vec<usize> = (0..motions.sites.len()).collect();
    let centre = Frame::of(motions.sites, &every).centre;
    let mut mended = motions.centred.clone();
    for (body, free) in motions.bodies.iter().zip(free) {
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
        let mut change = dense::product(z.as_ref(), w.as_ref());
        dense::add_product(change.as_mut(), -1.0, q.as_ref(), p.as_ref());
        let x = dense::product(free.orthonormal.as_ref(), p.as_ref());
        let change = dense::product(change.as_ref(), right_inverse(x.as_ref().subrows(first, 6 - first))?.as_ref());
        for (i, row) in body.rows.iter().enumerate() {
            (first..6).for_each(|j| mended[(*row, j)] += change[(i, j - first)]);
        }
        for row in &body.rows {
            let scaled = std::array::from_fn(|j| mended[(*row, j)] * if j < 3 { 1.0 } else { body.frame.size });
            let about = recentred(scaled, body.frame.centre, centre);
            about.into_iter().enumerate().for_each(|(j, value)| mended[(*row, j)] = value);
        }
    }
    Ok(RoundedCoordinates { misfit, centre, motions: mended })
}

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
