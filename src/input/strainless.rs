//! Rows of K̂ that rigid-body motion moves nearly alone, where K̂ holds the rounding of larger numbers.
//!
//! ```text
//! Q    r × n_r    orthonormal basis of Û, rows of rotations times a length
//! D    rows whose sine to rigid-body motion is small, so that Q_D has independent rows
//! Qᵀ f = 0                               forces K̂ u are in equilibrium
//! f_D = W f_I,   W = −(Q_D Q_Dᵀ)⁻¹ Q_D Q_Iᵀ
//! K̂ = [I; W] K̂_II [I, Wᵀ]
//! ```
//! Where rigid-body motion can move one coordinate and leave all others at rest, the column of K̂ is zero: a single node of six dofs or a
//! single rigid patch that holds its component, and three nodes in a plane across it. What stands there was left by the condensation, of
//! either sign, and is more than the last digit of anything next to it. A model made of K̂ has zeros in its place.
//!
//! Where the other coordinates move a little with it, as those of three nodes in a plane that is nearly across an axis, what is left of the
//! column is as small as the square of that, next to the rounding of numbers that are not. Equilibrium has it from the other rows, to the
//! last digits of its own.

use faer::{Mat, MatRef};
use supel_runtime::{Coordinate, Direction, Matrix, Superelement};

use crate::dense;
use crate::dofs::gyration;
use crate::error::Result;

/// Sine between a row and rigid-body motion that moves it alone: two bodies a hundred times their size apart leave 10⁻¹² of rounding. Three
/// nodes that are off a plane across the row by 10⁻⁷ of their distance have a stiffness along it that is a thousand times that rounding.
const ALONE: f64 = 1e-11;

/// K̂ of a superelement, without the rounding that its rows can do without.
pub(crate) struct Condensed {
    pub(crate) stiffness: Matrix,
    /// Rows that follow from the others, ascending.
    pub(crate) following: Vec<usize>,
}

/// K̂ with zeros where it has nothing but rounding, and what follows from equilibrium where it has little else.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(crate) fn condensed_stiffness(superelement: &Superelement) -> Result<Condensed> {
    let tensors = superelement.tensors();
    let [mut stiffness, rigid] = [&tensors.stiffness, &tensors.rigid_body_modes].map(dense::unpacked);
    let lengths = lengths(&places(superelement), &masses(superelement));
    let following = balance(&mut stiffness, rigid.as_ref(), &lengths)?;
    let stiffness = Matrix::from_fn(stiffness.nrows(), stiffness.ncols(), |i, j| stiffness[(i, j)]);
    Ok(Condensed { stiffness, following })
}

/// Puts into the rows and columns of K̂ that rigid-body motion moves nearly alone what the others leave them by equilibrium, zeros where it
/// moves them alone. Each row of Û times its length is a displacement. Returns these rows, ascending.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(crate) fn balance(stiffness: &mut Mat<f64>, rigid: MatRef<'_, f64>, lengths: &[f64]) -> Result<Vec<usize>> {
    /// Squares of the sines of six rows are below a quarter together, which bounds the condition of Q_D Q_Dᵀ by 4/3. The stiffness along a
    /// row is as its square: what this leaves as it is has more than a hundredth of the largest.
    const NEARLY: f64 = 0.2;
    let basis = basis(rigid, lengths)?;
    let along = |a: usize, b: usize| (0..basis.ncols()).map(|j| basis[(a, j)] * basis[(b, j)]).sum::<f64>();
    let sine = |row: usize| {
        // 1 − Σ Q_ij² would be the rounding of one.
        let left = |other: usize| if other == row { 1.0 - along(other, row) } else { along(other, row) };
        (0..basis.nrows()).map(|other| left(other).powi(2)).sum::<f64>().sqrt()
    };
    let sines: Vec<f64> = (0..basis.nrows()).map(sine).collect();
    let (following, others): (Vec<usize>, Vec<usize>) = (0..sines.len()).partition(|row| sines[*row] <= NEARLY);
    if following.is_empty() {
        return Ok(following);
    }
    let own = Mat::from_fn(following.len(), following.len(), |a, b| along(following[a], following[b]));
    let with = Mat::from_fn(following.len(), others.len(), |a, b| along(following[a], others[b]));
    let solved = dense::product(dense::inverse(own.as_ref()).as_ref(), with.as_ref());
    let factors = Mat::from_fn(following.len(), others.len(), |a, b| {
        let is_alone = sines[following[a]] <= ALONE;
        if is_alone { 0.0 } else { -solved[(a, b)] * lengths[following[a]] / lengths[others[b]] }
    });
    let inner = Mat::from_fn(others.len(), others.len(), |a, b| stiffness[(others[a], others[b])]);
    let across = dense::product(factors.as_ref(), inner.as_ref());
    let mut corner = dense::product(across.as_ref(), factors.transpose());
    dense::symmetrise(&mut corner);
    for (a, row) in following.iter().enumerate() {
        for (b, other) in others.iter().enumerate() {
            stiffness[(*row, *other)] = across[(a, b)];
            stiffness[(*other, *row)] = across[(a, b)];
        }
        for (b, other) in following.iter().enumerate() {
            stiffness[(*row, *other)] = corner[(a, b)];
        }
    }
    Ok(following)
}

/// Û with zeros where nodes move by no more than the rounding of their columns.
pub(crate) fn without_rounding(rigid: MatRef<'_, f64>, places: &[Option<Place>], masses: &[f64]) -> Mat<f64> {
    let lengths = lengths(places, masses);
    let size = |i: usize, j: usize| lengths[i] * rigid[(i, j)].abs();
    let largest: Vec<f64> =
        (0..rigid.ncols()).map(|j| (0..rigid.nrows()).map(|i| size(i, j)).fold(0.0, f64::max)).collect();
    Mat::from_fn(rigid.nrows(), rigid.ncols(), |i, j| {
        if places[i].is_some() && size(i, j) <= ALONE * largest[j] { 0.0 } else { rigid[(i, j)] }
    })
}

/// An orthonormal basis of the motions whose rows times their lengths are displacements.
///
/// # Errors
/// [`crate::error::Error::DenseEigen`].
pub(crate) fn basis(motions: MatRef<'_, f64>, lengths: &[f64]) -> Result<Mat<f64>> {
    /// Singular values of unit columns, relative to the largest, that are rounding.
    const NOTHING: f64 = 1e-9;
    let displacements = Mat::from_fn(motions.nrows(), motions.ncols(), |i, j| lengths[i] * motions[(i, j)]);
    let norms: Vec<f64> = (0..motions.ncols()).map(|j| dense::norm(dense::column(displacements.as_ref(), j))).collect();
    let moving: Vec<usize> = (0..norms.len()).filter(|j| norms[*j] > 0.0).collect();
    // No fewer rows than columns.
    let n_rows = motions.nrows().max(moving.len());
    let unit = Mat::from_fn(n_rows, moving.len(), |i, j| {
        if i < motions.nrows() { displacements[(i, moving[j])] / norms[moving[j]] } else { 0.0 }
    });
    let (singular, directions) = dense::right_singular(unit.as_ref())?;
    let kept: Vec<usize> = (0..singular.len()).filter(|j| singular[*j] > NOTHING * singular[0]).collect();
    let scaled = Mat::from_fn(moving.len(), kept.len(), |i, j| directions[(i, kept[j])] / singular[kept[j]]);
    Ok(dense::product(unit.as_ref().subrows(0, motions.nrows()), scaled.as_ref()))
}

/// Direction and position of a row.
pub(crate) type Place = (Direction, [f64; 3]);

/// What turns each row into a displacement: of a rotation the largest distance of the rows' places from their mean, or where they are one
/// place the radius of gyration about it, by the `masses` of the rows, M_ii; one of all else.
pub(crate) fn lengths(places: &[Option<Place>], masses: &[f64]) -> Vec<f64> {
    let positions: Vec<[f64; 3]> = places.iter().flatten().map(|(_, position)| *position).collect();
    let turns = |place: &Option<Place>| place.is_some_and(|(direction, _)| direction.is_rotation());
    let directions = places.iter().map(|place| place.map(|(direction, _)| direction));
    let of_one_place = || gyration(directions.zip(masses.iter().copied()));
    let length = span(&positions).or_else(of_one_place).unwrap_or(1.0);
    places.iter().map(|place| if turns(place) { length } else { 1.0 }).collect()
}

/// The largest distance from the mean; none where all are one place.
fn span(positions: &[[f64; 3]]) -> Option<f64> {
    /// Distances relative to the farthest coordinate that are rounding of the mean.
    const ONE_PLACE: f64 = 1e-12;
    let count = positions.len().max(1) as f64;
    let mean = [0, 1, 2].map(|axis| positions.iter().map(|position| position[axis]).sum::<f64>() / count);
    let distance = |position: &[f64; 3]| dense::norm(&[0, 1, 2].map(|axis| position[axis] - mean[axis]));
    let span = positions.iter().map(distance).fold(0.0, f64::max);
    let far = positions.iter().flatten().fold(0.0f64, |max, x| max.max(x.abs()));
    (span > ONE_PLACE * far).then_some(span)
}

/// M̂; a unit matrix where there is none.
pub(crate) fn mass_or_unit(superelement: &Superelement) -> Mat<f64> {
    let (r, mass) = (superelement.n_coordinates(), &superelement.tensors().mass);
    if mass.rows() > 0 { dense::unpacked(mass) } else { Mat::identity(r, r) }
}

/// M̂_ii; nothing where there is no mass.
pub(crate) fn masses(superelement: &Superelement) -> Vec<f64> {
    let mass = &superelement.tensors().mass;
    (0..mass.rows()).map(|row| mass[(row, row)]).collect()
}

/// Direction and position of each coordinate that is one of an interface node.
pub(crate) fn places(superelement: &Superelement) -> Vec<Option<Place>> {
    let metadata = superelement.metadata();
    let place = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { node, direction } => Some((*direction, metadata.interface_nodes[*node].position)),
        _ => None,
    };
    metadata.coordinates.iter().map(place).collect()
}
