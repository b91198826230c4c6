//! The motions without energy that K has, whatever the coordinates say.

use faer::Mat;

use super::doubt::Doubt;
use super::motions::{Body, Motions};
use crate::cache::recalled;
use crate::dense;
use crate::error::{Error, Result};
use crate::factor::count_below;
use crate::model::Model;
use crate::partition::{DofOrigin, Held, Partition};
use crate::rigid::{ZeroModes, moving_directions, refuse_uncounted, zero_modes};
use crate::sparse::Rounding;

/// A shift just above zero, in units of what rounding of the data can make of a zero eigenvalue: as many as an eigenvalue may
/// be off by rounding of the factorisation before a sign is wrong.
const ROUNDINGS: f64 = 100.0;
/// Share of a motion's square length that may be no rigid-body motion: an angle of a thousandth, which few digits of K and
/// rounded coordinates leave.
const NOT_RIGID: f64 = 1e-6;
/// Squares of lengths relative to the largest below which a zero mode does not move the rows that are looked at.
const AT_REST: f64 = 1e-12;

/// Rows without stiffness in bodies that have some, and scalar dofs without stiffness: each moves by itself and costs nothing.
pub(super) fn n_loose_rows(motions: &Motions<'_>) -> usize {
    let without_mass = motions.model.empty_rows();
    let moves = |row: usize| without_mass.binary_search(&row).is_err();
    let is_empty = |row: &usize| motions.sites[*row].is_some() && motions.scale_of(*row) == 0.0 && moves(*row);
    let of_body =
        |body: &Body| Some(body.rows.iter().filter(|row| is_empty(row)).count()).filter(|n| *n < body.rows.len());
    let stiffness = crate::sparse::diagonal(&motions.model.stiffness);
    let scalars = motions.sites.iter().zip(stiffness).enumerate();
    let scalars = scalars.filter(|(row, (site, stiffness))| site.is_none() && *stiffness == 0.0 && moves(*row));
    motions.bodies.iter().filter_map(of_body).sum::<usize>() + scalars.count()
}

/// K and M whole, in order of elimination, before constraints tie anything. Rows without stiffness and mass say nothing of coordinates.
pub(super) fn whole(motions: &Motions<'_>) -> Result<Partition> {
    let held = Held::of_rows(motions.model.empty_rows());
    Partition::with_held(Model { constraints: None, ..motions.model.clone() }, &[], held)
}

/// Eigenvalues of the pencil that are zero as far as a Sturm count tells, or `None` where the shift meets one; `noise` is
/// what rounding of the data can make of a zero one.
pub(super) fn counted(whole: &Partition, noise: f64) -> Result<Option<usize>> {
    let sigma = ROUNDINGS * noise;
    let key = || whole.key_of_matrices("count").numbers(&[sigma]);
    match recalled(whole.cache(), key, || count_below(&whole.analysis()?, whole.pencil(), sigma)) {
        Ok(count) if count.is_off_clamped() => Ok(Some(count.free)),
        Ok(_) | Err(Error::SturmPivot) => Ok(None),
        Err(error) => Err(error),
    }
}

/// The zero modes of K.
pub(super) struct Zeros {
    /// Their shapes by the rows of the model, n × m, M-orthonormal.
    pub(super) shapes: Mat<f64>,
    /// M times them.
    pub(super) momenta: Mat<f64>,
    /// The first eigenvalues above zero, ascending.
    elastic: Vec<f64>,
    /// Relative error bar that few digits of K leave of the first of them.
    bar_of_digits: f64,
    /// How well the entries of K are known.
    rounding: Rounding,
    /// The angle by which roundings turn them towards elastic modes at most.
    pub(super) turn: f64,
}

impl Zeros {
    /// By inverse iteration on the whole pencil.
    pub(super) fn of(whole: &Partition) -> Result<Self> {
        let ZeroModes { rigid: zero, elastic, bar_of_digits, .. } = zero_modes(whole)?;
        let rounding = whole.precision.stiffness;
        let by_row = |a: &Mat<f64>| {
            let mut rows = Mat::zeros(a.nrows(), a.ncols());
            for (dof, reduced) in whole.dofs.iter().enumerate() {
                let DofOrigin::Row(row) = reduced.origin else { continue };
                (0..a.ncols()).for_each(|j| rows[(row, j)] = a[(dof, j)]);
            }
            rows
        };
        Ok(Self {
            shapes: by_row(&zero.orthonormal),
            momenta: by_row(&zero.mass_orthonormal),
            elastic,
            bar_of_digits,
            rounding,
            turn: zero.energy.angle,
        })
    }

    /// The first eigenvalue that is elastic where some above zero are those of motions that springs hold.
    pub(super) fn first_elastic(&self, n_held: usize) -> Option<f64> {
        self.elastic.get(n_held).or(self.elastic.last()).copied()
    }

    pub(super) fn count(&self) -> usize {
        self.shapes.ncols()
    }

    /// An error where few digits of K leave open which motions are without energy.
    pub(super) fn refuse_uncounted(&self) -> Result<()> {
        refuse_uncounted(self.rounding, self.count(), self.bar_of_digits)
    }

    /// Combinations of the zero modes that are rigid-body motions, body by body, on the rows that no support touches.
    ///
    /// With right coordinates there a motion of the component as a whole is one of them; a mechanism, which moves parts
    /// against each other, is not.
    pub(super) fn n_rigid(&self, motions: &Motions<'_>, doubts: &[Doubt]) -> Result<usize> {
        let m = self.count();
        let (mut all, mut rigid) = (Mat::<f64>::zeros(m, m), Mat::<f64>::zeros(m, m));
        for (number, body) in motions.bodies.iter().enumerate() {
            let rows = doubts.iter().find(|doubt| doubt.body == number).map_or(&body.rows, |doubt| &doubt.untouched);
            // Rotations in the scale of displacements.
            let turns = |row: usize| motions.sites[row].is_some_and(|site| site.direction.is_rotation());
            let weight = |row: usize| if turns(row) { body.frame.size } else { 1.0 };
            let of = |a: &Mat<f64>| Mat::from_fn(rows.len(), a.ncols(), |i, j| weight(rows[i]) * a[(rows[i], j)]);
            let (c, z) = (of(&motions.centred), of(&self.shapes));
            let basis = dense::product(c.as_ref(), moving_directions(c.as_ref())?.as_ref()).qr().compute_thin_Q();
            let along = dense::gram(basis.as_ref(), z.as_ref());
            all += dense::gram(z.as_ref(), z.as_ref());
            rigid += dense::gram(along.as_ref(), along.as_ref());
        }
        let (lengths, directions) = dense::symmetric_eigen(all.as_ref())?;
        let largest = lengths.last().copied().unwrap_or(0.0);
        let moved: Vec<usize> = (0..m).filter(|j| lengths[*j] > AT_REST * largest).collect();
        let unit = Mat::from_fn(m, moved.len(), |i, j| directions[(i, moved[j])] / lengths[moved[j]].sqrt());
        let shares = dense::gram(unit.as_ref(), dense::product(rigid.as_ref(), unit.as_ref()).as_ref());
        let (shares, _) = dense::symmetric_eigen(shares.as_ref())?;
        Ok(shares.into_iter().filter(|share| *share >= 1.0 - NOT_RIGID).count())
    }
}
