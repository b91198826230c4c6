//! A foreign superelement on the dofs of a partition, in its units.

use std::collections::{BTreeMap, HashMap};

use faer::{Mat, MatRef};

use super::files::{ForeignSuperelement, ReducedMatrix};
use super::interface::Interface;
use crate::certification::carrier::{Carried, Carrier};
use crate::certification::strayed::Strayed;
use crate::dense;
use crate::error::{Error, Result};
use crate::partition::{DofOrigin, Partition};
use crate::sparse::{SparseMatrix, absolute_energy, product};
use crate::verification::check::Limits;

/// Difference of an entry relative to the diagonal that practice does not see.
const SAME: f64 = 1e-6;
/// Share of its terms that a diagonal entry keeps at least where it is more than what their cancelling leaves.
const CANCELLED: f64 = 1e-10;
/// The most that rounding may excuse of one.
const MOST_EXCUSED: f64 = 1e-2;

/// A foreign superelement in scaled units, its coordinates in the order of the partition: those that are interface dofs first.
#[derive(Clone, Debug)]
pub struct Foreign {
    /// Ψ, n' × r; columns that are no interface dofs are brought to a largest entry in [1, 2).
    pub(super) basis: Mat<f64>,
    /// K̂ with ΨᵀKΨ.
    pub(super) stiffness: Pair,
    /// M̂ with ΨᵀMΨ.
    pub(super) mass: Pair,
    /// The number of each coordinate in the files, from zero.
    pub(super) order: Vec<usize>,
    /// Coordinates that are interface dofs.
    pub(super) n_b: usize,
    /// What coordinates are called that are rows of the model, by their numbers in the files.
    names: BTreeMap<usize, String>,
    /// What the numbers of Ψ may be off by, relative to each.
    pub(super) rounding: f64,
    /// How far rows that are held, or follow others, are from where they have to be in each column.
    pub(super) strayed: Vec<Strayed>,
}

/// A reduced matrix next to what it has to be.
#[derive(Clone, Debug)]
pub(super) struct Pair {
    /// As it was read, r × r.
    pub(super) given: Mat<f64>,
    /// Ψᵀ A Ψ.
    pub(super) projected: Mat<f64>,
    /// |Ψ|ᵀ|A||Ψ| of each coordinate: rounding of an entry is relative to the root of two of these.
    pub(super) terms: Vec<f64>,
    /// max |A − Aᵀ| of what was read, relative to its largest entry.
    pub(super) asymmetry: f64,
    /// What the rounding of each entry is relative to, r × r.
    pub(super) sizes: Mat<f64>,
    /// What an entry may be off by: relative to its size, and whatever it is, relative to the largest.
    pub(super) rounding: [f64; 2],
}

impl Foreign {
    /// Puts a superelement on the dofs of a partition whose interface, where it has one, is that of the superelement.
    ///
    /// # Errors
    /// [`Error::ModesNothing`] for a column of zeros.
    pub fn of(partition: &Partition, foreign: &ForeignSuperelement, interface: &Interface) -> Result<Self> {
        let order = order(partition, foreign.n_coordinates(), interface);
        let (n, r, n_b) = (partition.n_dofs(), order.len(), partition.n_interface());
        let (mut basis, mut units) = (Mat::zeros(n, r), vec![1.0; r]);
        let (mut strayed, mut rounding) = (Vec::with_capacity(r), 0.0f64);
        let carrier = Carrier::of(partition);
        for (at, coordinate) in order.iter().enumerate() {
            let column = dense::column_mut(basis.as_mut(), at);
            let carried = carrier
                .carry(&foreign.basis.columns[*coordinate], foreign.basis.rounding, column)
                .ok_or(Error::ModesNothing { mode: coordinate + 1, found: "zero everywhere" })?;
            let Carried { unit, .. } = carried;
            // An interface dof keeps its unit.
            match at < n_b {
                true => column.iter_mut().for_each(|value| *value *= unit),
                false => units[at] = unit,
            }
            strayed.push(carried.strayed);
            rounding = rounding.max(carried.rounding);
        }
        let scaling = partition.scaling;
        let places = Places { order: &order, units: &units };
        Ok(Self {
            stiffness: places.pair((&partition.stiffness, &basis), &foreign.stiffness, scaling.stiffness_unit()),
            mass: places.pair((&partition.mass, &basis), &foreign.mass, scaling.mass_unit()),
            basis,
            order,
            n_b,
            names: interface.names.clone(),
            rounding,
            strayed,
        })
    }

    /// r.
    pub(super) fn n_reduced(&self) -> usize {
        self.order.len()
    }

    /// What the digits of K̂ and M̂ may make of an eigenvalue, relative to it; `q` is its mode at unit modal mass.
    pub(super) fn changed_by_digits(&self, lambda: f64, q: &[f64]) -> f64 {
        let share = (self.stiffness.changed_by_digits(q) / lambda).abs() + self.mass.changed_by_digits(q);
        if share.is_nan() { f64::INFINITY } else { share }
    }

    /// What the digits of the basis leave of a motion.
    pub(super) fn of_digits(&self) -> f64 {
        if self.rounding > f64::EPSILON { dense::NOISE_FACTOR * self.rounding } else { 0.0 }
    }

    /// Whether K̂ or M̂ has fewer digits than double precision.
    pub(super) fn has_few_digits(&self) -> bool {
        [&self.stiffness, &self.mass].iter().any(|pair| pair.rounding[0].max(pair.rounding[1]) > f64::EPSILON)
    }

    /// What a message calls a coordinate: its number in the files, from one, and its dof where it is one.
    pub(super) fn name(&self, at: usize) -> String {
        let coordinate = self.order[at];
        let number = format!("coordinate {}", coordinate + 1);
        self.names.get(&coordinate).map_or(number.clone(), |name| format!("{number} ({name})"))
    }
}

/// Numbers of the coordinates: those that are interface dofs in their order, then the others in that of the files.
fn order(partition: &Partition, r: usize, interface: &Interface) -> Vec<usize> {
    let of_row: HashMap<usize, usize> = interface.coordinates.iter().map(|(row, at)| (*row, *at)).collect();
    let kept = partition.dofs[partition.n_internal..].iter().filter_map(|dof| match dof.origin {
        DofOrigin::Row(row) => of_row.get(&row).copied(),
        _ => None,
    });
    let mut order: Vec<usize> = kept.collect();
    let others: Vec<usize> = (0..r).filter(|coordinate| !order.contains(coordinate)).collect();
    order.extend(others);
    order
}

struct Places<'a> {
    order: &'a [usize],
    /// Of each coordinate.
    units: &'a [f64],
}

impl Places<'_> {
    fn pair(&self, (full, basis): (&SparseMatrix, &Mat<f64>), given: &ReducedMatrix, unit: f64) -> Pair {
        let r = self.order.len();
        let scaled_of = |matrix: &Mat<f64>| {
            let entry =
                |i: usize, j: usize| matrix[(self.order[i], self.order[j])] / (unit * self.units[i] * self.units[j]);
            Mat::from_fn(r, r, entry)
        };
        let mut scaled = scaled_of(&given.values);
        let asymmetry = dense::symmetrise(&mut scaled);
        let mut projected = dense::gram(basis.as_ref(), product(full, basis.as_ref()).as_ref());
        dense::symmetrise(&mut projected);
        let [relative, absolute] = given.rounding;
        let largest = given.values.norm_max().max(f64::MIN_POSITIVE);
        Pair {
            given: scaled,
            sizes: scaled_of(&given.sizes),
            projected,
            terms: absolute_energy(full, basis.as_ref()),
            asymmetry,
            rounding: [relative, absolute / largest],
        }
    }
}

impl Pair {
    /// The root of a diagonal entry of one of the two: what entries of its row are relative to. That of rigid-body motion in K̂ is rounding,
    /// and so are the entries next to it.
    fn size_of(&self, matrix: MatRef<'_, f64>, i: usize) -> f64 {
        matrix[(i, i)].max(CANCELLED * self.terms[i]).sqrt()
    }

    /// What the matrix is to the one that it has to be: the median over diagonal entries that are more than rounding, and one where there
    /// are none, or where half of them are zero.
    pub(super) fn usual_factor(&self) -> f64 {
        let diagonals = (0..self.given.nrows()).map(|i| (self.given[(i, i)], self.projected[(i, i)], self.terms[i]));
        let sound = diagonals.filter(|(_, projected, terms)| *projected > CANCELLED * terms);
        let mut factors: Vec<f64> = sound.map(|(given, projected, _)| given / projected).collect();
        factors.sort_by(f64::total_cmp);
        factors.get(factors.len() / 2).copied().filter(|factor| *factor > 0.0 && factor.is_finite()).unwrap_or(1.0)
    }

    /// What was read, at unit diagonal where that is more than rounding.
    pub(super) fn at_unit_diagonal(&self) -> Mat<f64> {
        let given = self.given.as_ref();
        let sizes: Vec<f64> = (0..given.nrows()).map(|i| self.size_of(given, i)).collect();
        let scaled = |i: usize, j: usize| given[(i, j)] / (sizes[i] * sizes[j]);
        Mat::from_fn(sizes.len(), sizes.len(), |i, j| if sizes[i] * sizes[j] > 0.0 { scaled(i, j) } else { 0.0 })
    }

    /// The entry that is further than any other from what it has to be, relative to the diagonal and compared with its limits.
    pub(super) fn worst(&self, of_basis: f64) -> Difference {
        let (given, projected) = (self.given.as_ref(), self.projected.as_ref());
        let size = |i: usize| self.size_of(projected, i);
        let mut worst = Difference { value: 0.0, limits: Limits { engineering: SAME, ..Limits::default() }, at: None };
        for j in 0..given.ncols() {
            for i in 0..=j {
                let (scale, difference) = (size(i) * size(j), (given[(i, j)] - projected[(i, j)]).abs());
                let value = if difference == 0.0 { 0.0 } else { difference / scale };
                let arithmetic = dense::NOISE_FACTOR * f64::EPSILON * (self.terms[i] * self.terms[j]).sqrt() / scale;
                let limits = Limits { engineering: SAME, arithmetic, data: self.of_digits((i, j), of_basis) / scale };
                let limits = limits.capped(MOST_EXCUSED, MOST_EXCUSED);
                if dense::worse(value / limits.value(), worst.value / worst.limits.value()) {
                    worst = Difference { value, limits, at: Some((i, j)) };
                }
            }
        }
        worst
    }

    /// What the digits of the matrix as it was read may make of qᵀAq.
    pub(super) fn changed_by_digits(&self, q: &[f64]) -> f64 {
        let [relative, absolute] = self.rounding;
        let absolute = absolute * self.given.norm_max();
        let of_entry = |i: usize, j: usize| relative * self.sizes[(i, j)] + absolute;
        let entries = (0..q.len()).flat_map(|j| (0..q.len()).map(move |i| (i, j)));
        // Roundings of either sign add up like the root of their squares.
        entries.map(|(i, j)| (q[i] * q[j] * of_entry(i, j)).powi(2)).sum::<f64>().sqrt()
    }

    /// What the digits of the basis and of the matrix may make of an entry.
    fn of_digits(&self, (i, j): (usize, usize), of_basis: f64) -> f64 {
        let [relative, absolute] = self.rounding;
        let of_basis = if of_basis > f64::EPSILON { 2.0 * of_basis } else { 0.0 };
        let relative = if relative > f64::EPSILON { relative } else { 0.0 };
        of_basis * (self.terms[i] * self.terms[j]).sqrt()
            + relative * self.sizes[(i, j)]
            + absolute * self.given.norm_max()
    }
}

/// How far a reduced matrix is from what it has to be.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    /// Relative to the diagonal.
    pub(super) value: f64,
    pub(super) limits: Limits,
    /// Where.
    pub(super) at: Option<(usize, usize)>,
}
