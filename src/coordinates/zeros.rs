//! The motions without energy that K has, whatever the coordinates say.

use std::cell::OnceCell;

use faer::Mat;

use super::doubt::Doubt;
use super::motions::{Body, Motions};
use crate::cache::{Digest, Key, Kind, Reader, Recorded, Writer, recalled};
use crate::dense;
use crate::dofs::Dof;
use crate::error::{Error, Result};
use crate::factor::{count_below, whole_count};
use crate::model::Model;
use crate::partition::{DofOrigin, Held, Partition};
use crate::rigid::{ZeroModes, found_zero_modes, moving_directions, refuse_uncounted};

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

/// K and M whole, before constraints tie anything. They are laid out in order of elimination once something has to be computed that no
/// earlier run has kept.
pub(super) struct Whole<'a> {
    model: &'a Model,
    laid_out: OnceCell<Partition>,
    digest: OnceCell<Digest>,
}

impl<'a> Whole<'a> {
    pub(super) fn of(motions: &Motions<'a>) -> Self {
        Self { model: motions.model, laid_out: OnceCell::new(), digest: OnceCell::new() }
    }

    /// Rows without stiffness and mass are left out: they say nothing of coordinates.
    fn partition(&self) -> Result<&Partition> {
        if let Some(laid_out) = self.laid_out.get() {
            return Ok(laid_out);
        }
        let held = Held::of_rows(self.model.empty_rows());
        let laid_out = Partition::with_held(Model { constraints: None, ..self.model.clone() }, &[], held)?;
        Ok(self.laid_out.get_or_init(|| laid_out))
    }

    /// The key of what a function makes of them. Which rows are of one node decides the order of elimination.
    fn key(&self, function: &str) -> Key {
        let Model { stiffness, mass, scaling, precision, dofs, axes, .. } = self.model;
        let digest = || {
            let key = Key::of("whole model").matrix(stiffness).matrix(mass).shown(scaling).shown(precision).shown(axes);
            let of_dof = |dof: &Option<Dof>| dof.map_or([0, -1], |dof| [dof.node, dof.direction as i64]);
            let dofs: Vec<[i64; 2]> = dofs.iter().flatten().map(of_dof).collect();
            key.numbers(&dofs).digest()
        };
        Key::of(function).numbers(self.digest.get_or_init(digest))
    }

    /// Eigenvalues of the pencil that are zero as far as a Sturm count tells, or `None` where the shift meets one; `noise` is
    /// what rounding of the data can make of a zero one.
    pub(super) fn counted(&self, noise: f64) -> Result<Option<usize>> {
        let sigma = ROUNDINGS * noise;
        let key = || self.key("count of zero eigenvalues").numbers(&[sigma]);
        let found = || self.partition().and_then(|whole| count_below(&whole.analysis()?, whole.pencil(), sigma));
        match recalled(self.model.cache.as_ref(), key, found) {
            Ok(count) if count.is_off_clamped() => Ok(Some(count.free)),
            Ok(_) | Err(Error::SturmPivot) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Eigenvalues of the pencil below a shift, which lies where there are none but those that are counted.
    pub(super) fn counted_below(&self, sigma: f64) -> Result<usize> {
        let whole = self.partition()?;
        Ok(whole_count(&whole.analysis()?, whole.pencil(), sigma)?.below)
    }

    /// The zero modes of K, by inverse iteration.
    pub(super) fn zeros(&self) -> Result<Zeros> {
        let key = || self.key("zero modes of the rows");
        recalled(self.model.cache.as_ref(), key, || Zeros::of(self.partition()?))
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
    /// The angle by which roundings turn them towards elastic modes at most.
    pub(super) turn: f64,
}

impl Zeros {
    fn of(whole: &Partition) -> Result<Self> {
        let ZeroModes { rigid: zero, elastic, bar_of_digits, .. } = found_zero_modes(whole)?;
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
    pub(super) fn refuse_uncounted(&self, motions: &Motions<'_>) -> Result<()> {
        refuse_uncounted(motions.model.precision.stiffness, self.count(), self.bar_of_digits)
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

impl Recorded for Zeros {
    const KIND: Kind = Kind::Modes;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { shapes, momenta, elastic, bar_of_digits, turn } = self;
        to.columns(shapes.as_ref())?;
        to.columns(momenta.as_ref())?;
        to.array(elastic)?;
        to.array(&[*bar_of_digits, *turn])
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let (shapes, momenta, elastic) = (from.columns()?, from.columns()?, from.array()?);
        let [bar_of_digits, turn] = from.array()?[..] else { return None };
        Some(Self { shapes, momenta, elastic, bar_of_digits, turn })
    }
}
