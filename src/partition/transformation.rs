//! The transformation T between the rows of the model and the dofs of the partition.
//!
//! A row of an ordinary dof holds a single one. A row of a patch holds how it follows the dofs of the interface node and, where these
//! are those of its mean motion, what it deviates by. A row that constraints make dependent holds the dofs that it follows. To follow a node is the motion of its point, u = t + θ × r for a translation, θ for a rotation; where coordinates are
//! rounded, the motion that K knows instead of the one by the coordinates.

use std::collections::BTreeMap;

use super::distortions::Owner;
use super::elimination::{Terms, summed};
use super::held::Held;
use super::interface_node::{InterfaceNode, Interfaces, NodeNames, Resolved, Rows};
use super::sites::Sites;
use super::transformation_row::TransformationRow;
use super::{average_patch, rigid_patch};
use crate::dofs::{Direction, Dof, FileRows};
use crate::error::Result;
use crate::model::{Model, Site};

/// A dof of the partition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReducedDof {
    /// What it is in the model.
    pub origin: DofOrigin,
    /// True for an interface dof.
    pub is_interface: bool,
    /// Position and direction, where known; none for a scalar dof.
    pub site: Option<Site>,
    /// Number of the node it belongs to, shared by the dofs of one node.
    pub node: u32,
    /// Node and direction in the model, where a map tells them.
    pub dof: Option<Dof>,
}

/// Where a dof of the partition comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DofOrigin {
    /// A row of the model.
    Row(usize),
    /// A direction of the interface node of a patch (its index in the job's order).
    PatchNode(usize, Direction),
    /// A motion of the patch of an interface node besides its mean motion, by its number.
    Distortion(usize, u32),
}

impl ReducedDof {
    /// What the dof is called in messages.
    pub(super) fn name(&self, nodes: NodeNames<'_>, rows: &FileRows) -> String {
        match (self.origin, self.dof) {
            (DofOrigin::PatchNode(node, direction), _) => format!("interface {} {direction}", nodes.of(node)),
            (DofOrigin::Distortion(node, _), Some(dof)) => format!("{dof} in the patch of {}", nodes.of(node)),
            (DofOrigin::Distortion(node, number), None) => {
                format!("interface {} distortion {}", nodes.of(node), number + 1)
            }
            (DofOrigin::Row(_), Some(dof)) => dof.to_string(),
            (DofOrigin::Row(row), None) => format!("row {}", rows.of(row) + 1),
        }
    }
}

/// T by rows: for each row of the model the dofs that move it, with their factors.
#[derive(Clone, Debug)]
pub struct Transformation {
    /// The dofs of the partition, its columns.
    pub dofs: Vec<ReducedDof>,
    /// The entries of each row.
    pub rows: Vec<TransformationRow>,
}

impl Transformation {
    /// Lays out the dofs that move: internal ones in the model's order, then the interface in the job's order.
    pub(super) fn new(model: &Model, interfaces: &Interfaces, held: &Held) -> Result<Self> {
        let n = model.n_dofs();
        let mut taken: Vec<bool> = (0..n).map(|row| held.holds(row)).collect();
        for Resolved { rows, .. } in &interfaces.list {
            for row in rows.all() {
                taken[*row] = true;
            }
        }
        let sites = Sites::new(model);
        let n_nodes = sites.n_nodes + interfaces.list.len() as u32;
        let mut builder =
            Builder { dofs: Vec::with_capacity(n), rows: vec![TransformationRow::Dof(u32::MAX); n], sites, n_nodes };
        for row in (0..n).filter(|row| held.holds(*row)) {
            builder.rows[row] = TransformationRow::Held;
        }
        for row in (0..n).filter(|row| !taken[*row]) {
            builder.own_row(row, Part::Internal);
        }
        let distorted = builder.distort_patches(interfaces)?;
        for part in [Part::Internal, Part::Interface] {
            for (index, resolved) in interfaces.list.iter().enumerate() {
                match (&resolved.rows, part) {
                    (Rows::Own(rows), Part::Interface) if resolved.carrier.is_none() => {
                        rows.iter().for_each(|row| builder.own_row(*row, part));
                    }
                    (Rows::Own(_), _) => {}
                    (Rows::Patch(rows) | Rows::Average { rows, .. }, _) => {
                        builder.patch_node(index, resolved, rows, part)
                    }
                }
            }
        }
        for (index, resolved) in interfaces.list.iter().enumerate() {
            let carrier = resolved.carrier.map(|carrier| (carrier, &interfaces.list[carrier].node));
            match (&resolved.rows, carrier) {
                (Rows::Own(_), None) => {}
                // The node of a carrier: its rows are those of the interfaces that it moves.
                (Rows::Patch(rows), None) if rows.is_empty() => {}
                (Rows::Own(rows), Some(carrier)) => builder.tie_own(resolved, rows, carrier),
                (Rows::Patch(rows) | Rows::Average { rows, .. }, carrier) => {
                    builder.tie_patch(index, (resolved, rows), carrier)?;
                }
            }
        }
        for (row, own) in distorted {
            builder.rows[row].extend(&own);
        }
        Ok(Self { dofs: builder.dofs, rows: builder.rows })
    }

    /// This transformation with some dofs following others, T C: `dependent` has the row of C of each.
    pub(super) fn constrained(self, dependent: &BTreeMap<u32, Terms>) -> Self {
        let mut place = vec![0u32; self.dofs.len()];
        let mut dofs = Vec::with_capacity(self.dofs.len() - dependent.len());
        for (old, dof) in self.dofs.iter().enumerate().filter(|(old, _)| !dependent.contains_key(&(*old as u32))) {
            place[old] = dofs.len() as u32;
            dofs.push(*dof);
        }
        let of_row = |row: TransformationRow| {
            let follows = |dof: u32| dependent.contains_key(&dof);
            let expanded = |(dof, factor): (u32, f64)| -> Terms {
                match dependent.get(&dof) {
                    Some(terms) => terms.iter().map(|(other, value)| (*other, factor * value)).collect(),
                    None => vec![(dof, factor)],
                }
            };
            let placed = |(dof, factor): (u32, f64)| (place[dof as usize], factor);
            match row {
                TransformationRow::Dof(dof) if !follows(dof) => TransformationRow::Dof(place[dof as usize]),
                TransformationRow::Tied(entries) if !entries.iter().any(|(dof, _)| follows(*dof)) => {
                    TransformationRow::Tied(entries.into_iter().map(placed).collect())
                }
                row => match summed(row.entries().flat_map(expanded).collect()) {
                    entries if entries.is_empty() => TransformationRow::Held,
                    entries => TransformationRow::Tied(entries.into_iter().map(placed).collect()),
                },
            }
        };
        Self { dofs, rows: self.rows.into_iter().map(of_row).collect() }
    }

    /// Rows that nothing moves.
    pub(super) fn n_at_rest(&self) -> usize {
        self.rows.iter().filter(|row| matches!(row, TransformationRow::Held)).count()
    }

    /// Of each dof whether rows other than its own follow it.
    pub(super) fn followed(&self) -> Vec<bool> {
        let mut followed = vec![false; self.dofs.len()];
        for row in &self.rows {
            if let TransformationRow::Tied(entries) = row {
                entries.iter().for_each(|(dof, _)| followed[*dof as usize] = true);
            }
        }
        followed
    }

    /// Number of internal dofs, which come first.
    pub fn n_internal(&self) -> usize {
        self.dofs.iter().take_while(|dof| !dof.is_interface).count()
    }

    /// |T|.
    pub(super) fn of_moduli(&self) -> Self {
        let mut moduli = self.clone();
        for row in &mut moduli.rows {
            if let TransformationRow::Tied(entries) = row {
                entries.iter_mut().for_each(|(_, factor)| *factor = factor.abs());
            }
        }
        moduli
    }

    /// This transformation with dof `order[k]` moved to place k.
    pub(super) fn permuted(self, order: &[u32]) -> Self {
        let mut place = vec![0u32; order.len()];
        for (new, old) in order.iter().enumerate() {
            place[*old as usize] = new as u32;
        }
        let dofs = order.iter().map(|old| self.dofs[*old as usize]).collect();
        let mut rows = self.rows;
        for row in &mut rows {
            match row {
                TransformationRow::Dof(dof) => *dof = place[*dof as usize],
                TransformationRow::Tied(entries) => {
                    entries.iter_mut().for_each(|(dof, _)| *dof = place[*dof as usize]);
                }
                TransformationRow::Held => {}
            }
        }
        Self { dofs, rows }
    }
}

/// The two parts of the dofs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Internal,
    Interface,
}

/// Dofs and factors in a row.
type Entries = Vec<(u32, f64)>;

struct Builder<'a> {
    dofs: Vec<ReducedDof>,
    rows: Vec<TransformationRow>,
    sites: Sites<'a>,
    /// Numbers of nodes, and of groups of nodes, that are taken.
    n_nodes: u32,
}

impl Builder<'_> {
    fn own_row(&mut self, row: usize, part: Part) {
        self.rows[row] = TransformationRow::Dof(self.dofs.len() as u32);
        self.dofs.push(ReducedDof {
            origin: DofOrigin::Row(row),
            is_interface: part == Part::Interface,
            site: self.sites.of_row.as_ref().and_then(|sites| sites[row]),
            node: self.sites.node_of_row[row],
            dof: self.sites.dofs.and_then(|dofs| dofs[row]),
        });
    }

    /// Adds the distortions of patches whose mean motion counts as internal dofs, and gives their entries by rows.
    fn distort_patches(&mut self, interfaces: &Interfaces) -> Result<Vec<(usize, Entries)>> {
        let mut entries = Vec::new();
        for (index, Resolved { node, rows, .. }) in interfaces.list.iter().enumerate() {
            let Rows::Average { rows, weights } = rows else { continue };
            let moves = |direction: &Direction| {
                node.directions.contains(direction) || rigid_patch::moves(&self.sites, (node, rows), *direction)
            };
            let n_directions = Direction::ALL.iter().filter(|direction| moves(direction)).count();
            let found = average_patch::distortions(&self.sites, node, (rows, weights), n_directions)?;
            let first = self.dofs.len() as u32;
            let mut n_groups = 0;
            for (number, owner) in (0..).zip(&found.owners) {
                let (node, dof) = match owner {
                    Owner::Row(at) => {
                        (self.sites.node_of_row[rows[*at]], self.sites.dofs.and_then(|dofs| dofs[rows[*at]]))
                    }
                    Owner::Group(group) => {
                        n_groups = n_groups.max(group + 1);
                        (self.n_nodes + group, None)
                    }
                };
                let origin = DofOrigin::Distortion(index, number);
                self.dofs.push(ReducedDof { origin, is_interface: false, site: None, node, dof });
            }
            self.n_nodes += n_groups;
            let placed = |row: Entries| row.into_iter().map(|(dof, factor)| (first + dof, factor)).collect();
            entries.extend(rows.iter().copied().zip(found.rows.into_iter().map(placed)));
        }
        Ok(entries)
    }

    /// Adds the directions of a patch's node that are interface dofs, or those that are not and that its patch can move in.
    fn patch_node(&mut self, index: usize, resolved: &Resolved, rows: &[usize], part: Part) {
        let position = resolved.node.position.unwrap_or_default();
        let listed = &resolved.node.directions;
        let directions: Vec<Direction> = match part {
            Part::Interface if resolved.carrier.is_some() => Vec::new(),
            Part::Interface => listed.clone(),
            Part::Internal => {
                let is_taken =
                    |direction: &Direction| listed.contains(direction) || resolved.grounded.contains(direction);
                let rest = Direction::ALL.into_iter().filter(|direction| !is_taken(direction));
                rest.filter(|direction| rigid_patch::moves(&self.sites, (&resolved.node, rows), *direction)).collect()
            }
        };
        for direction in directions {
            self.dofs.push(ReducedDof {
                origin: DofOrigin::PatchNode(index, direction),
                is_interface: part == Part::Interface,
                site: Some(Site { position, direction }),
                node: self.sites.n_nodes + index as u32,
                dof: None,
            });
        }
    }

    /// The dofs of the node of a patch or of a carrier, by direction; nothing where a direction has none.
    fn dofs_of_node(&self, index: usize) -> [Terms; 6] {
        let mut columns: [Terms; 6] = Default::default();
        for (column, dof) in self.dofs.iter().enumerate() {
            if let DofOrigin::PatchNode(node, direction) = dof.origin
                && node == index
            {
                columns[direction as usize].push((column as u32, 1.0));
            }
        }
        columns
    }

    /// How a lever over the six dofs of a carrier moves.
    fn carried(&self, lever: &[f64; 6], carrier: usize) -> Terms {
        let dofs = self.dofs_of_node(carrier);
        let moved = lever.iter().zip(dofs).filter(|(factor, _)| **factor != 0.0);
        moved.flat_map(|(factor, terms)| terms.into_iter().map(move |(dof, _)| (dof, *factor))).collect()
    }

    /// Lets rows of nodes follow a carrier.
    fn tie_own(&mut self, resolved: &Resolved, rows: &[usize], (carrier, node): (usize, &InterfaceNode)) {
        let levers = resolved.levers(&self.sites, node.position.unwrap_or_default());
        for (row, lever) in rows.iter().zip(&levers) {
            self.rows[*row] = TransformationRow::Tied(self.carried(lever, carrier).into());
        }
    }

    fn tie_patch(
        &mut self,
        index: usize,
        (resolved, rows): (&Resolved, &[usize]),
        carrier: Option<(usize, &InterfaceNode)>,
    ) -> Result<()> {
        let mut columns = self.dofs_of_node(index);
        if let Some((carrier, node)) = carrier {
            let levers = resolved.levers(&self.sites, node.position.unwrap_or_default());
            for (direction, lever) in resolved.node.directions.iter().zip(&levers) {
                columns[*direction as usize] = self.carried(lever, carrier);
            }
        }
        let tied = rigid_patch::tied_rows(&self.sites, (&resolved.node, rows), &columns)?;
        for (row, entries) in rows.iter().zip(tied) {
            self.rows[*row] = entries;
        }
        Ok(())
    }
}
