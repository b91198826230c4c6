//! The mass of the whole model as its map and its coordinates see it, whether supports hold it or not.

use std::collections::HashMap;

use faer::Mat;

use super::{Bodies, Model, Site, node_of_row};
use crate::dense;
use crate::dofs::{Direction, Dof};
use crate::sparse::{couples, is_empty_row, product};

/// What M says of the six unit motions of all rows together, in scaled units.
#[derive(Clone, Debug)]
pub struct Weight {
    /// Axes along which the map has translations, ascending: all of a model in space.
    pub axes: Vec<usize>,
    /// tᵀMt of the unit translations along x, y and z; zero in a direction that the model does not have.
    pub translations: [f64; 3],
    /// tᵀM(x_t t) of these, x_t the coordinate along the translation at each row: m times that of the centre. Zero where coordinates are not
    /// known.
    pub along_themselves: [f64; 3],
    /// UᵀMU of the six unit motions about the origin, 6 × 6, where coordinates are known.
    pub motions: Option<Mat<f64>>,
    /// UᵀMU of each part of several nodes that M couples, where M leaves several parts uncoupled: springs between them have no mass.
    pub parts: Vec<PartWeight>,
    /// Largest distance along an axis between nodes that M gives mass to a translation, where coordinates are known: zero of a point.
    pub extent: f64,
    /// Whether every node has all translations of the model or none, and all of its rotations or none where M couples them with translations,
    /// so that no direction lacks mass that others have. A model in space has three of each, and one in a plane those along it.
    pub has_whole_nodes: bool,
    /// Whether supports may have taken mass out of the matrices before they were read.
    pub supports: Supports,
}

/// What M says of the six unit motions of a part that it couples with no other.
#[derive(Clone, Debug)]
pub struct PartWeight {
    /// UᵀMU about the origin, 6 × 6.
    pub motions: Mat<f64>,
    /// Label of the first of its nodes.
    pub first_node: i64,
}

/// What is known of supports that the matrices had before they were read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Supports {
    /// There were none: the coordinates show that nothing holds the model.
    None,
    /// There may have been some.
    Perhaps,
}

impl Model {
    /// The model, of which a job says that supports hold these rotations. Where they let it move along every axis its coordinates show no support, and
    /// rows may have been taken out of its mass all the same.
    pub fn knowing_supports(self, held_rotations: &[Direction]) -> Self {
        let supports = if held_rotations.is_empty() { self.supports } else { Supports::Perhaps };
        Self { supports, ..self }
    }

    /// The mass of the model, or nothing without a dof map. One product with M.
    pub fn weight(&self) -> Option<Weight> {
        let dofs = self.dofs.as_ref()?;
        let sites = self.sites();
        let mut motions = Mat::zeros(self.n_dofs(), if sites.is_some() { 6 } else { 3 });
        for (row, dof) in dofs.iter().enumerate() {
            match (sites.as_ref().and_then(|sites| sites[row]), dof) {
                (Some(site), _) => {
                    let motion = site.rigid_motion();
                    motion.into_iter().enumerate().for_each(|(j, value)| motions[(row, j)] = value);
                }
                (None, Some(dof)) if !dof.direction.is_rotation() => motions[(row, dof.direction.axis())] = 1.0,
                (None, _) => {}
            }
        }
        let momenta = product(&self.mass, motions.as_ref());
        let mut masses = dense::gram(motions.as_ref(), momenta.as_ref());
        dense::symmetrise(&mut masses);
        let translations = std::array::from_fn(|axis| masses[(axis, axis)]);
        let along_themselves = first_moments(sites.as_deref(), &momenta);
        let directions = directions_of(dofs.iter().flatten());
        let axes = (0..3).filter(|axis| directions[*axis]).collect();
        let has_whole_nodes = is_of_space_or_a_plane(directions) && self.has_whole_nodes(dofs, directions);
        let parts = if sites.is_some() { self.weighed_parts(dofs, (&motions, &momenta)) } else { Vec::new() };
        let motions = sites.is_some().then_some(masses);
        let extent = sites.map_or(0.0, |sites| self.extent_of_mass(&sites));
        Some(Weight {
            axes,
            translations,
            along_themselves,
            motions,
            parts,
            extent,
            has_whole_nodes,
            supports: self.supports,
        })
    }

    /// Whether each node has all translations of the model or none, and likewise its rotations where M couples them with translations.
    fn has_whole_nodes(&self, dofs: &[Option<Dof>], of_model: [bool; 6]) -> bool {
        let translates = |row: usize| dofs[row].is_some_and(|dof| !dof.direction.is_rotation());
        // Directions, and whether mass moves with a rotation.
        let mut nodes: HashMap<i64, ([bool; 6], bool)> = HashMap::new();
        for (row, dof) in dofs.iter().enumerate().filter_map(|(row, dof)| dof.map(|dof| (row, dof))) {
            let (has, moves_mass) = nodes.entry(dof.node).or_default();
            has[dof.direction as usize] = true;
            *moves_mass |= dof.direction.is_rotation() && couples(&self.mass, row, translates);
        }
        let are_all_or_none = |has: &[bool], of_model: &[bool]| has == of_model || !has.contains(&true);
        nodes.values().all(|(has, moves_mass)| {
            are_all_or_none(&has[..3], &of_model[..3]) && (are_all_or_none(&has[3..], &of_model[3..]) || !moves_mass)
        })
    }

    fn extent_of_mass(&self, sites: &[Option<Site>]) -> f64 {
        let has_mass = |site: &Site, row: usize| !site.direction.is_rotation() && !is_empty_row(&self.mass, row);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (row, site) in sites.iter().enumerate() {
            for site in site.iter().filter(|site| has_mass(site, row)) {
                for (axis, x) in site.position.into_iter().enumerate() {
                    low[axis] = low[axis].min(x);
                    high[axis] = high[axis].max(x);
                }
            }
        }
        (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max)
    }

    fn weighed_parts(&self, dofs: &[Option<Dof>], (motions, momenta): (&Mat<f64>, &Mat<f64>)) -> Vec<PartWeight> {
        let nodes = node_of_row(self.n_dofs(), Some(dofs));
        let coupled = Bodies::of(&self.mass, &nodes);
        let mut rows_of: Vec<Vec<usize>> = vec![Vec::new(); coupled.n_bodies];
        coupled.of_row.iter().enumerate().for_each(|(row, part)| rows_of[*part as usize].push(row));
        let weighed = |rows: &Vec<usize>| {
            let first = dofs[*rows.first()?]?.node;
            if rows.iter().all(|row| dofs[*row].is_none_or(|dof| dof.node == first)) {
                return None;
            }
            let of_part = |a: &Mat<f64>| Mat::from_fn(rows.len(), a.ncols(), |i, j| a[(rows[i], j)]);
            let mut masses = dense::gram(of_part(motions).as_ref(), of_part(momenta).as_ref());
            dense::symmetrise(&mut masses);
            Some(PartWeight { motions: masses, first_node: first })
        };
        if rows_of.len() < 2 { Vec::new() } else { rows_of.iter().filter_map(weighed).collect() }
    }
}

/// tᵀM(x_t t) of the unit translations, from M t in the columns of `momenta`.
fn first_moments(sites: Option<&[Option<Site>]>, momenta: &Mat<f64>) -> [f64; 3] {
    let mut moments = [0.0; 3];
    for (row, site) in sites.into_iter().flatten().enumerate() {
        if let Some(Site { position, direction }) = site.filter(|site| !site.direction.is_rotation()) {
            let axis = direction.axis();
            moments[axis] += position[axis] * momenta[(row, axis)];
        }
    }
    moments
}

/// Which of the six directions any dof has.
pub(super) fn directions_of<'a>(dofs: impl Iterator<Item = &'a Dof>) -> [bool; 6] {
    let mut directions = [false; 6];
    dofs.for_each(|dof| directions[dof.direction as usize] = true);
    directions
}

/// Whether a model has the directions of one in space, or of one that moves in a plane: those along it, and the rotation across it or none.
/// Supports of a model in space leave others.
fn is_of_space_or_a_plane(has: [bool; 6]) -> bool {
    let (translations, rotations) = has.split_at(3);
    let turns = rotations.contains(&true);
    match translations.iter().filter(|has| **has).count() {
        3 => !turns || !rotations.contains(&false),
        2 => (0..3).all(|axis| !turns || rotations[axis] != translations[axis]),
        _ => !turns,
    }
}
