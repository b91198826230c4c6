//! Loads that the job names.
//!
//! ```text
//! f      n × 1      force on every row of the model, held ones among them
//! Tᵀf    n' × 1     on the dofs that move: rows of a rigid patch load its interface node
//! f_p    n × 1      pressure p: −p ∫ N n dA over the faces of the mesh between some nodes
//! f_ω    n × 1      centrifugal load per ω²: M p, p = (I − aaᵀ)(x − c) at the translations of a node at x, a the axis through c
//! Δf, Δt 3 × 1      of an added mass m with its centre at x + r and the inertia J: m (I − aaᵀ) r, and r × Δf − a × J a about its node
//! ```
//! The mass that couples dofs that move with held ones takes part in M p, as it does in gravity. Each f is kept with its largest entry
//! in [1, 2). Works are products of two loads over a stiffness, so that sizes are limited to [`EXPONENTS`].

use faer::Mat;

use super::distortions::NO_ENTRY;
use super::interface::row_of_model;
use super::node_catalogue::NodeCatalogue;
use super::pressure::pressed;
use super::transformation::{DofOrigin, Transformation};
use super::transformation_row::TransformationRow;
use crate::dense;
use crate::dofs::{Direction, Dof, cross};
use crate::error::{Error, Result};
use crate::input::{LoadColumn, PatchFaces};
use crate::job::{AddedMassJob, LoadJob, LoadPattern, NodeSelection, RotationJob};
use crate::model::{Model, Site, inertia_tensor};
use crate::sparse::product;

/// Exponents of the largest entry of a load, in the user's units and relative to that of the stiffness: squares, and sums of them, are
/// numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -400..=400;

/// Loads on the dofs of a partition.
#[derive(Clone, Debug)]
pub struct Loads {
    /// What each load is.
    pub facts: Vec<LoadFacts>,
    /// TᵀF, n' × n_l, each column in its unit.
    pub vectors: Mat<f64>,
    /// n_I.
    n_internal: usize,
}

/// What is remembered of a load.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadFacts {
    /// Its name in the job.
    pub name: String,
    /// What it is made from, in words.
    pub source: String,
    /// The force in the user's units that an entry of one stands for, a power of two.
    pub unit: f64,
    /// Whether the job asks for its residual vector.
    pub has_residual_vector: bool,
    /// Its total force along x, y and z in the user's units, held rows included; none without a dof map.
    pub resultant: Option<[f64; 3]>,
}

/// A load on all rows of a model.
#[derive(Clone, Debug)]
pub struct RowLoad {
    facts: LoadFacts,
    /// n values, the largest in [1, 2).
    values: Vec<f64>,
}

impl RowLoad {
    /// The force on a dof, and the sum of the sizes of its terms.
    pub(super) fn force_on(&self, dof: u32, transformation: &Transformation) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (row, value) in transformation.rows.iter().zip(&self.values).filter(|(_, value)| **value != 0.0) {
            for (_, factor) in row.entries().filter(|(other, _)| *other == dof) {
                sums = [sums[0] + factor * value, sums[1] + (factor * value).abs()];
            }
        }
        sums
    }
}

impl Loads {
    /// Residual vectors at most: the constraint modes have the answer to what acts on the interface alone.
    pub fn n_residual_vectors(&self) -> usize {
        let acts_inside = |load: usize| {
            dense::column(self.vectors.as_ref(), load)[..self.n_internal].iter().any(|force| *force != 0.0)
        };
        (0..self.facts.len()).filter(|load| self.facts[*load].has_residual_vector && acts_inside(*load)).count()
    }

    /// None.
    pub fn none(n_dofs: usize) -> Self {
        Self { facts: Vec::new(), vectors: Mat::zeros(n_dofs, 0), n_internal: 0 }
    }

    /// n_l.
    pub fn count(&self) -> usize {
        self.facts.len()
    }

    /// Whether a load acts on internal dofs, which come first.
    pub fn acts_inside(&self, load: usize) -> bool {
        dense::column(self.vectors.as_ref(), load)[..self.n_internal].iter().any(|value| *value != 0.0)
    }

    /// TᵀF.
    ///
    /// # Errors
    /// [`Error::LoadNothing`] where held dofs take all of a load.
    pub fn carried(loads: Vec<RowLoad>, transformation: &Transformation) -> Result<Self> {
        let mut vectors = Mat::zeros(transformation.dofs.len(), loads.len());
        for (at, load) in loads.iter().enumerate() {
            let vector = dense::column_mut(vectors.as_mut(), at);
            for (row, value) in transformation.rows.iter().zip(&load.values) {
                row.entries().for_each(|(dof, factor)| vector[dof as usize] += factor * value);
            }
            if vector.iter().all(|value| *value == 0.0) {
                return Err(Error::LoadNothing { load: load.facts.name.clone(), found: "all of it on held dofs" });
            }
            clear_distortions(transformation, &load.values, vector);
        }
        let facts = loads.into_iter().map(|load| load.facts).collect();
        Ok(Self { facts, vectors, n_internal: transformation.n_internal() })
    }
}

/// Sets forces on distortions of patches to zero that are rounding: D has entries of order one that are known to [`NO_ENTRY`], so that DᵀF is
/// known to as much of Σ|F| over the rows of patches. A force that the node of a patch takes, shared out by the weights, has nothing
/// else there, and its residual vector would be the answer to rounding.
fn clear_distortions(transformation: &Transformation, values: &[f64], vector: &mut [f64]) {
    let is_tied = |row: &TransformationRow| matches!(row, TransformationRow::Tied(_));
    let on_patches = transformation.rows.iter().zip(values).filter(|(row, _)| is_tied(row));
    let terms: f64 = on_patches.map(|(_, value)| value.abs()).sum();
    for (dof, force) in transformation.dofs.iter().zip(vector) {
        if matches!(dof.origin, DofOrigin::Distortion(..)) && force.abs() <= NO_ENTRY * terms {
            *force = 0.0;
        }
    }
}

/// The loads of a job on all rows of a model, whose mass has that of `added` already; `columns` are those of its files, one for each load that
/// has one, and `faces` what the mesh tells of faces.
///
/// # Errors
/// Nodes that do not exist or lack a direction of the force, a selection without nodes; a rotation without coordinates; a pressure without
/// faces; a force on a row that was dropped; a load of nothing.
pub fn loads(
    model: &Model,
    (jobs, added): (&[LoadJob], &[AddedMassJob]),
    columns: &[Option<LoadColumn>],
    faces: &[PatchFaces],
) -> Result<Vec<RowLoad>> {
    if jobs.is_empty() {
        return Ok(Vec::new());
    }
    let catalogue = NodeCatalogue::new(model);
    let load = |(job, column): (&LoadJob, &Option<LoadColumn>)| {
        let (values, unit, source) = match (job.pattern()?, column) {
            (LoadPattern::Force(nodes, force), _) => {
                let (values, n_nodes) = shared_out(model, &catalogue, job, (nodes, force))?;
                (values, 1.0, format!("force on {}", crate::number::counted(n_nodes, "node", "nodes")))
            }
            (LoadPattern::Pressure(nodes, pressure), _) => {
                let (values, n_faces) = pressed(model, &catalogue, (job, nodes, pressure), faces)?;
                (values, 1.0, format!("pressure on {}", crate::number::counted(n_faces, "face", "faces")))
            }
            (LoadPattern::File(..), Some(column)) => (of_file(model, job, column)?, 1.0, "file".to_owned()),
            (LoadPattern::File(..), None) => (vec![0.0; model.n_dofs()], 1.0, "file".to_owned()),
            (LoadPattern::Rotation(rotation), _) => {
                (centrifugal(model, job, (rotation, added))?, model.scaling.mass_unit(), "rotation, per ω²".to_owned())
            }
        };
        in_own_unit(model, (job, source), (values, unit))
    };
    jobs.iter().zip(columns).map(load).collect()
}

/// A load with its largest entry in [1, 2).
fn in_own_unit(
    model: &Model,
    (job, source): (&LoadJob, String),
    (mut values, unit): (Vec<f64>, f64),
) -> Result<RowLoad> {
    let largest = values.iter().fold(0.0f64, |max, value| max.max(value.abs()));
    if largest == 0.0 {
        return Err(Error::LoadNothing { load: job.name.clone(), found: "zero everywhere" });
    }
    refuse_out_of_range(model, job, [largest, unit])?;
    let own = largest.log2().floor().exp2();
    values.iter_mut().for_each(|value| *value /= own);
    let unit = unit * own;
    let total = |dofs: &[Option<Dof>]| {
        let mut sum = [0.0; 3];
        let of_nodes = dofs.iter().zip(&values).filter_map(|(dof, value)| Some((dof.as_ref()?.direction, value)));
        for (direction, value) in of_nodes.filter(|(direction, _)| !direction.is_rotation()) {
            sum[direction.axis()] += value;
        }
        sum.map(|value| value * unit)
    };
    let resultant = model.dofs.as_deref().map(total);
    let facts = LoadFacts { name: job.name.clone(), source, unit, has_residual_vector: job.residual, resultant };
    Ok(RowLoad { facts, values })
}

/// Refuses a load of a largest entry in some unit that leaves the range.
fn refuse_out_of_range(model: &Model, job: &LoadJob, factors: [f64; 2]) -> Result<()> {
    let exponent = factors.map(|factor| factor.log2().floor() as i32).iter().sum::<i32>();
    let sizes = [("", exponent), (", relative to the stiffness,", exponent - model.scaling.stiffness)];
    match sizes.into_iter().find(|(_, exponent)| !EXPONENTS.contains(exponent)) {
        Some((relative, exponent)) => {
            let (load, bits) = (job.name.clone(), *EXPONENTS.end());
            Err(Error::LoadRange { load, relative, exponent, bits })
        }
        None => Ok(()),
    }
}

/// An equal share of a force at each of some nodes, and how many these are.
fn shared_out(
    model: &Model,
    catalogue: &NodeCatalogue,
    job: &LoadJob,
    (nodes, force): (&NodeSelection, &[f64; 3]),
) -> Result<(Vec<f64>, usize)> {
    let selection = job.selection(nodes);
    let labels = catalogue.select(model, &selection)?;
    let mut values = vec![0.0; model.n_dofs()];
    for label in &labels {
        let rows = catalogue.rows_of(&selection.selector, *label)?;
        let loaded = Direction::ALL.into_iter().zip(force).filter(|(_, force)| **force != 0.0);
        for (direction, force) in loaded {
            let dof = Dof { node: *label, direction };
            let missing = || Error::DofMissing { selector: selection.selector.clone(), dof };
            values[*rows.get(&direction).ok_or_else(missing)?] += force / labels.len() as f64;
        }
    }
    Ok((values, labels.len()))
}

/// The rows that are left of those of a file.
fn of_file(model: &Model, job: &LoadJob, column: &LoadColumn) -> Result<Vec<f64>> {
    let mut values = vec![0.0; model.n_dofs()];
    let selector = crate::error::Selector::Load(job.name.clone());
    for (row, value) in column.values.iter().enumerate().filter(|(_, value)| **value != 0.0) {
        values[row_of_model(model, &selector, row)?] = *value;
    }
    Ok(values)
}

/// M p, and what the centres of added masses are off their nodes, in the scaled units of M.
fn centrifugal(model: &Model, job: &LoadJob, (rotation, added): (&RotationJob, &[AddedMassJob])) -> Result<Vec<f64>> {
    let sites = model.sites().ok_or_else(|| Error::LoadNeedsCoordinates { load: job.name.clone() })?;
    // Scaled first, so that the square of its length is a number.
    let largest = rotation.axis.iter().fold(0.0f64, |max, value| max.max(value.abs()));
    let scaled = rotation.axis.map(|value| value / largest);
    let length = dense::norm(&scaled);
    let axis = scaled.map(|value| value / length);
    let displacement = Mat::from_fn(sites.len(), 1, |row, _| {
        // What no node has is nowhere.
        let Some(Site { position, direction }) = sites[row] else { return 0.0 };
        let arm = std::array::from_fn(|i| position[i] - rotation.through[i]);
        if direction.is_rotation() { 0.0 } else { across(arm, axis)[direction.axis()] }
    });
    let mut force = dense::column(product(&model.mass, displacement.as_ref()).as_ref(), 0).to_vec();
    for mass in added {
        let at_node = of_offset(mass, axis);
        let of_row = |dof: &Option<Dof>| dof.filter(|dof| dof.node == mass.node).map(|dof| dof.direction);
        for (row, direction) in model.dofs.iter().flatten().map(of_row).enumerate() {
            force[row] += direction.map_or(0.0, |direction| at_node[direction as usize] / model.scaling.mass_unit());
        }
    }
    Ok(force)
}

/// (I − aaᵀ) r.
fn across(arm: [f64; 3], axis: [f64; 3]) -> [f64; 3] {
    let along: f64 = arm.iter().zip(axis).map(|(arm, axis)| arm * axis).sum();
    std::array::from_fn(|i| arm[i] - along * axis[i])
}

/// Force and moment at the node of an added mass beyond those that its mass has at the node itself.
fn of_offset(mass: &AddedMassJob, axis: [f64; 3]) -> [f64; 6] {
    let arm = mass.offset.unwrap_or_default();
    let [fx, fy, fz] = across(arm, axis).map(|way| mass.mass * way);
    let inertia = inertia_tensor(mass.inertia.unwrap_or_default());
    let momentum = std::array::from_fn(|i| (0..3).map(|j| inertia[(i, j)] * axis[j]).sum());
    let (of_force, of_inertia) = (cross(arm, [fx, fy, fz]), cross(axis, momentum));
    let [tx, ty, tz] = std::array::from_fn(|i| of_force[i] - of_inertia[i]);
    [fx, fy, fz, tx, ty, tz]
}
