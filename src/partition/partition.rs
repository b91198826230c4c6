//! The matrices in the order internal, interface.

use std::sync::OnceLock;

use faer::{Mat, MatRef};

use crate::dofs::FileRows;
use crate::error::{Error, Result};
use crate::factor::Analysis;
use crate::job::{InterfaceJob, SceneJob};
use crate::model::{Bodies, CoordinateFit, Finding, Model, ModelFacts, Scaling, Site};
use crate::plan::Parting;
use crate::sparse::{Leading, Pencil, Precision, SparseMatrix, couples, is_empty_row};

use super::earlier::Earlier;
use super::expansion::Expansion;
use super::far_masses::far_masses;
use super::follower::Follower;
use super::further_matrices::CarriedMatrix;
use super::gravity::Gravity;
use super::held::Held;
use super::interface::{Output, RecoveredRows};
use super::interface_node::{InterfaceNode, NodeNames};
use super::load::Loads;
use super::mixed_interface::MixedInterface;
use super::patch_bodies::over_bodies;
use super::quantities::Quantities;
use super::roundings::{PatchEntries, Roundings};
use super::transformation::{DofOrigin, ReducedDof, Transformation};
use super::transformation_row::TransformationRow;
use super::turned_forces::TurnedForces;
use super::unloaded::Unloaded;
use super::{congruence, constraints, follower, gravity, interface, missing_directions, ordering, origin, statements};

/// Most interface dofs: the two reduced matrices alone take 6.4 GB then, and decomposing them days.
pub const LARGEST_INTERFACE: usize = 20_000;

/// The matrices in the order internal, interface, with what is known of each degree of freedom.
#[derive(Debug)]
pub struct Partition {
    /// TᵀKT, n' × n'.
    pub stiffness: SparseMatrix,
    /// TᵀMT, n' × n'.
    pub mass: SparseMatrix,
    /// Number of internal dofs n_I; the rest are interface dofs.
    pub n_internal: usize,
    /// Where each connected part of the interior ends; the interface separates them.
    pub part_ends: Vec<usize>,
    /// What each dof of the partition is.
    pub dofs: Vec<ReducedDof>,
    /// The interface nodes in the order of their dofs.
    pub interface: Vec<InterfaceNode>,
    /// Interface nodes that the scene leaves without dofs of the interface; their patches are as they are with them.
    pub left_out: Vec<InterfaceNode>,
    /// What the scene says that no load acts on.
    pub(super) unloaded: Unloaded,
    /// Row of T for each row of the model.
    pub transformation: Transformation,
    /// Rows of the model that are no dof: held ones, and those that follow others.
    pub followers: Vec<Follower>,
    /// What the job holds; its rows are at rest.
    pub held: Held,
    /// Loads of gravity, where dofs are held or the state is preloaded, and directions are known.
    pub gravity: Option<Gravity>,
    /// Loads that the superelement carries by name; none unless the caller adds them.
    pub loads: Loads,
    /// Expansion modes of a file; none unless the caller adds them.
    pub expansion: Expansion,
    /// What is held of the interface while modes with mixed boundaries are computed; none unless the caller adds it.
    pub mixed: Option<MixedInterface>,
    /// Rows of the model whose displacements the superelement recovers; none unless the caller adds them.
    pub recovered: RecoveredRows,
    /// Dofs inside at which the scene looks.
    pub outputs: Vec<Output>,
    /// Quantities that the superelement gives; none unless the caller adds them.
    pub quantities: Quantities,
    /// Further matrices of the job; none unless the caller adds them.
    pub matrices: Vec<CarriedMatrix>,
    /// Powers of two taken out of K and M.
    pub scaling: Scaling,
    /// How well the entries of K and M of the model are known.
    pub precision: Precision,
    /// How coordinates and dof map fit K.
    pub fit: CoordinateFit,
    /// What the model was.
    pub model: ModelFacts,
    /// What was found of the interface that is not an error.
    pub findings: Vec<Finding>,
    /// How much rigid patches and constraints enlarge rounding of the data of K; one without them.
    pub cancellation: f64,
    /// Entries of the model's K that rigid patches and constraints have taken up.
    pub(super) patches: PatchEntries,
    /// The entries of K by their sizes, once somebody asks.
    pub(super) roundings: OnceLock<Roundings>,
    /// Entries of the model's M that they have taken up.
    pub(super) mass_patches: PatchEntries,
    /// The entries of M by their sizes, once somebody asks.
    pub(super) mass_roundings: OnceLock<Roundings>,
    /// What earlier runs have computed of the same matrices; none where the model has no cache.
    pub(super) earlier: Option<Earlier>,
}

/// The matrices of a partition, made from those of the model, which are gone then.
struct Carried {
    stiffness: SparseMatrix,
    mass: SparseMatrix,
    cancellation: f64,
    patches: PatchEntries,
    mass_patches: PatchEntries,
}

impl Carried {
    /// `turned` adds to the stiffness what internal forces make of patches that turn.
    fn of(
        [stiffness, mass]: [SparseMatrix; 2],
        transformation: &Transformation,
        precision: Precision,
        turned: impl FnOnce(SparseMatrix) -> Result<SparseMatrix>,
    ) -> Result<Self> {
        let terms = congruence::terms(&stiffness, transformation);
        let of_partition = turned(congruence::congruence(&stiffness, transformation))?;
        let of_partition = congruence::without_rounding(of_partition, &terms);
        let cancellation = congruence::cancellation(&of_partition, &terms);
        let patches = PatchEntries::of(&stiffness, transformation, precision.stiffness);
        drop(stiffness);
        let mass_patches = PatchEntries::of(&mass, transformation, precision.mass);
        let mass = congruence::congruence(&mass, transformation);
        Ok(Self { stiffness: of_partition, mass, cancellation, patches, mass_patches })
    }
}

impl Partition {
    /// Resolves the interfaces, applies the rigid patches and the constraints by congruence and orders the internal dofs for elimination. The
    /// matrices of the model go as those of the partition come.
    ///
    /// # Errors
    /// Interface nodes that do not exist, repeat, or lack the dofs asked for; a patch that cannot carry a rotation, or whose origin is
    /// far outside of the part; constraints that cannot be eliminated.
    ///
    /// # Panics
    /// Where the pattern of K or M is not symmetric, which that of a checked model is.
    pub fn new(model: Model, interfaces: &[InterfaceJob]) -> Result<Self> {
        Self::with_held(model, interfaces, Held::default())
    }

    /// The partition of a model of which some dofs are at rest: what [`Self::new`] makes of one without their rows.
    ///
    /// # Errors
    /// What [`Self::new`] refuses; an interface that moves a held dof.
    ///
    /// # Panics
    /// As [`Self::new`].
    pub fn with_held(model: Model, interfaces: &[InterfaceJob], held: Held) -> Result<Self> {
        Self::in_scene(model, interfaces, held, (None, Parting::Apart))
    }

    /// The partition of a model of whose interface a scene asks less.
    ///
    /// # Errors
    /// What [`Self::with_held`] refuses; a rigid body that moves interfaces of unknown coordinates, or whose motions they do not tell apart.
    ///
    /// # Panics
    /// As [`Self::new`].
    pub fn in_scene(
        model: Model,
        interfaces: &[InterfaceJob],
        mut held: Held,
        (scene, parting): (Option<&SceneJob>, Parting),
    ) -> Result<Self> {
        let resolved = interface::resolve(&model, interfaces)?;
        held.refuse_interface(&model, &resolved)?;
        let far_origins = origin::far_origins(&model, &resolved)?;
        let resolved = statements::heeded(&model, resolved, (scene, interfaces), &mut held)?;
        let transformation = Transformation::new(&model, &resolved, &held)?;
        let turned = TurnedForces::of(&model, &resolved, &transformation)?;
        refuse_all_fixed(&model, &transformation, &held)?;
        let n_held = transformation.n_at_rest();
        let (transformation, n_dependent, constrained) = constraints::applied(&model, transformation)?;
        let order = ordering::elimination_order(&model, &transformation, parting)?;
        let transformation = transformation.permuted(&order.dofs);
        let n_internal = transformation.n_internal();
        refuse_larger(transformation.dofs.len() - n_internal)?;
        let mut findings = missing_directions::constrained_nodes(&model, &resolved);
        let mut facts = ModelFacts { n_dependent, n_held, ..facts(&model, &transformation, &held) };
        facts.findings.extend(constrained.into_iter().chain(over_bodies(&model, &resolved)));
        let gravity = gravity::gravity(&model, &transformation, &held);
        let followers = follower::followers(&model, &transformation);
        let ([interface, left_out], unloaded) = resolved.into_nodes();
        let names = NodeNames([&interface, &left_out]);
        let turned = |stiffness| turned.added_to(stiffness, &transformation, names);
        let carried = Carried::of([model.stiffness, model.mass], &transformation, model.precision, turned)?;
        let Carried { stiffness, mass, .. } = &carried;
        if model.constraints.is_some() {
            refuse_loose([stiffness, mass], &transformation, (names, &facts.rows))?;
            facts.n_bodies = n_bodies(stiffness, &transformation);
        }
        findings.extend(of_interface(far_origins, [stiffness, mass], &transformation, (names, &facts.rows)));
        Ok(Self {
            loads: Loads::none(carried.stiffness.rows()),
            expansion: Expansion::none(carried.stiffness.rows()),
            cancellation: carried.cancellation,
            fit: model.fit,
            model: facts,
            findings,
            stiffness: carried.stiffness,
            mass: carried.mass,
            n_internal,
            part_ends: order.part_ends,
            dofs: transformation.dofs.clone(),
            interface,
            left_out,
            unloaded,
            transformation,
            followers,
            held,
            gravity,
            mixed: None,
            recovered: RecoveredRows::default(),
            outputs: Vec::new(),
            quantities: Quantities::default(),
            matrices: Vec::new(),
            scaling: model.scaling,
            precision: model.precision,
            patches: carried.patches,
            roundings: OnceLock::new(),
            mass_patches: carried.mass_patches,
            mass_roundings: OnceLock::new(),
            earlier: model.cache.as_ref().map(Earlier::new),
        })
    }

    /// n' = n_I + n_B.
    pub fn n_dofs(&self) -> usize {
        self.dofs.len()
    }

    /// n_B.
    pub fn n_interface(&self) -> usize {
        self.dofs.len() - self.n_internal
    }

    /// Position and direction of every dof, none for a scalar one; nothing where coordinates are unknown.
    pub fn sites(&self) -> Option<Vec<Option<Site>>> {
        let sites: Vec<Option<Site>> = self.dofs.iter().map(|dof| dof.site).collect();
        sites.iter().any(Option::is_some).then_some(sites)
    }

    /// UᵀMU of the six unit motions about the origin, 6 × 6 in scaled units, of one preloaded body that nothing holds. Its rigid-body modes
    /// lack rotations, and its mass properties are those of all rows; none of any other component.
    pub fn mass_of_preloaded_body(&self) -> Option<MatRef<'_, f64>> {
        let is_free = self.fit.is_preloaded() && self.held.count() == 0 && self.model.n_bodies == 1;
        let weight = self.model.weight.as_ref().filter(|_| is_free)?;
        weight.motions.as_ref().map(Mat::as_ref)
    }

    /// The six unit motions of dofs about a point, as rows of n' × 6 with zeros elsewhere: by the coordinates or, where those
    /// are rounded, as K knows them. A scalar dof stays at rest.
    pub fn rigid_motions(&self, dofs: &[usize], centre: [f64; 3]) -> Mat<f64> {
        let mut motions = Mat::zeros(self.n_dofs(), 6);
        for dof in dofs {
            let ReducedDof { origin, site, .. } = self.dofs[*dof];
            let motion = match (origin, self.fit.rounded()) {
                (DofOrigin::Row(row), Some(rounded)) => rounded.motion(row, centre),
                _ => site.map_or([0.0; 6], |site| site.rigid_motion_about(centre)),
            };
            motion.into_iter().enumerate().for_each(|(j, value)| motions[(*dof, j)] = value);
        }
        motions
    }

    /// What a dof is called in messages.
    pub fn name_of(&self, dof: usize) -> String {
        self.dofs[dof].name(NodeNames([&self.interface, &self.left_out]), &self.model.rows)
    }

    /// K and M.
    pub fn pencil(&self) -> Pencil<'_> {
        Pencil::new(&self.stiffness, &self.mass)
    }

    /// Analyses the pattern of the matrices for their factorisation; the interface is the border.
    ///
    /// # Errors
    /// The factor has more entries than can be counted, or there is no memory for its structure.
    pub fn analysis(&self) -> Result<Analysis> {
        Analysis::with_border(self.pencil(), self.n_interface())
    }

    /// K_II and M_II.
    pub fn internal(&self) -> Pencil<'_> {
        let block = |matrix| Leading::new(matrix, self.n_internal);
        Pencil::new(block(&self.stiffness), block(&self.mass))
    }
}

fn refuse_all_fixed(model: &Model, transformation: &Transformation, held: &Held) -> Result<()> {
    match transformation.dofs.is_empty() && held.count() > 0 {
        true => Err(Error::AllFixed { n_held: held.count(), n_dofs: model.n_dofs(), left: "no dof is left" }),
        false => Ok(()),
    }
}

/// Refuses an interface whose matrices would be too large.
fn refuse_larger(n_interface: usize) -> Result<()> {
    match n_interface > LARGEST_INTERFACE {
        true => Err(Error::InterfaceTooLarge { n_interface, limit: LARGEST_INTERFACE }),
        false => Ok(()),
    }
}

/// What is remembered of the model.
fn facts(model: &Model, transformation: &Transformation, held: &Held) -> ModelFacts {
    let facts = model.facts();
    let moves = |row: usize| !matches!(transformation.rows[row], TransformationRow::Held);
    let n_bodies = if held.count() > 0 { model.n_bodies_among(moves) } else { facts.n_bodies };
    ModelFacts { n_bodies, findings: untied(facts.findings.clone(), transformation, model), ..facts }
}

/// The findings of a model without the particles that the job holds or that a rigid patch or constraints tie to others. A patch that no stiffness
/// reaches is one of [`hanging_dofs`].
fn untied(findings: Vec<Finding>, transformation: &Transformation, model: &Model) -> Vec<Finding> {
    let followed = transformation.followed();
    let is_free =
        |row: &usize| matches!(transformation.rows[*row], TransformationRow::Dof(dof) if !followed[dof as usize]);
    let of_finding = |finding| match finding {
        Finding::FreeParticles { rows, .. } => {
            Finding::free_particles(rows.into_iter().filter(is_free).collect(), model.names())
        }
        finding => Some(finding),
    };
    findings.into_iter().filter_map(of_finding).collect()
}

/// Refuses dofs that constraints leave without stiffness and mass: those of nodes that have none, where nothing that they are tied to
/// has any or where the constraints say too little of them.
fn refuse_loose(
    matrices: [&SparseMatrix; 2],
    transformation: &Transformation,
    (names, rows): (NodeNames<'_>, &FileRows),
) -> Result<()> {
    if matrices[1].data().iter().all(|value| *value == 0.0) {
        return Err(Error::ConstraintAll { left: "leave no mass that moves".to_owned() });
    }
    let is_row = |dof: &ReducedDof| matches!(dof.origin, DofOrigin::Row(_));
    let dofs = transformation.dofs.iter().enumerate().filter(|(_, dof)| is_row(dof));
    let mut loose = dofs.filter(|(dof, _)| matrices.iter().all(|matrix| is_empty_row(matrix, *dof)));
    match loose.next() {
        None => Ok(()),
        Some((_, first)) => Err(Error::ConstraintLoose { n_dofs: 1 + loose.count(), dof: first.name(names, rows) }),
    }
}

/// Connected parts of the dofs that have a node.
fn n_bodies(stiffness: &SparseMatrix, transformation: &Transformation) -> usize {
    let dofs = &transformation.dofs;
    let nodes: Vec<u32> = dofs.iter().map(|dof| dof.node).collect();
    let is_scalar = scalars(dofs);
    Bodies::count_among(stiffness, &nodes, |dof| !is_scalar(dof))
}

/// Tells the dofs that are rows of no node where a map knows the nodes: amplitudes.
fn scalars(dofs: &[ReducedDof]) -> impl Fn(usize) -> bool {
    let has_map = dofs.iter().any(|dof| dof.dof.is_some());
    move |dof| has_map && dofs[dof].dof.is_none() && matches!(dofs[dof].origin, DofOrigin::Row(_))
}

/// What is to be said of the masses and the stiffness of interface dofs, behind what was found of their origins.
fn of_interface(
    mut findings: Vec<Finding>,
    [stiffness, mass]: [&SparseMatrix; 2],
    transformation: &Transformation,
    (names, rows): (NodeNames<'_>, &FileRows),
) -> Vec<Finding> {
    findings.extend(far_masses(mass, transformation, names));
    findings.extend(hanging_dofs([stiffness, mass], transformation, (names, rows)));
    findings
}

/// Interface dofs that no stiffness reaches; the model has seen to it that they have mass. Those of a superelement that one node holds ride on
/// what is inside by its mass.
fn hanging_dofs(
    [stiffness, mass]: [&SparseMatrix; 2],
    partition: &Transformation,
    (names, rows): (NodeNames<'_>, &FileRows),
) -> Option<Finding> {
    let is_scalar = scalars(&partition.dofs);
    let rides = |dof: usize| couples(mass, dof, |other| is_scalar(other) && !is_empty_row(stiffness, other));
    let hanging =
        (partition.n_internal()..partition.dofs.len()).filter(|dof| is_empty_row(stiffness, *dof) && !rides(*dof));
    let hanging: Vec<usize> = hanging.collect();
    let first = *hanging.first()?;
    Some(Finding::HangingInterface { dof: partition.dofs[first].name(names, rows), n_dofs: hanging.len() })
}
