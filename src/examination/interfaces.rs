//! Node groups of the mesh that can be interfaces.

use std::collections::{HashMap, HashSet};

use serde::Serialize;

use super::fitted_surface::{self, Surface};
use crate::dense;
use crate::dofs::Nodes;
use crate::number::counted;
use crate::partition::Partition;

/// Dofs of an interface whose nodes keep their own: more make a superelement large.
const MOST_DIRECT: usize = 100;
/// Share of the model's nodes from which on a group is the model and no interface.
const MOST_OF_MODEL: f64 = 0.5;
/// Singular values of the six motions of a patch, relative to the largest, from which on it can carry all of them.
const CARRIES: f64 = 1e-6;

/// A node group that may be an interface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Candidate {
    /// Its name.
    pub group: String,
    /// Its nodes that have rows.
    pub n_nodes: usize,
    /// Its dofs.
    pub n_dofs: usize,
    /// How it can be coupled: `direct`, `rigid` and `average`; none where it cannot.
    pub couplings: Vec<&'static str>,
    /// Why it is less than good, or what it is.
    pub remark: Option<String>,
    /// The surface that its nodes lie on, where that is a cylinder or a sphere.
    pub surface: Option<Surface>,
    /// Labels of its nodes that have rows, ascending.
    #[serde(skip)]
    pub labels: Vec<i64>,
}

impl Candidate {
    /// Whether it can react all six rigid-body motions by itself.
    pub(super) fn holds_all(&self) -> bool {
        !self.couplings.is_empty() && self.remark.is_none()
    }
}

/// What the groups of a mesh are good for.
pub(super) fn candidates(partition: &Partition, nodes: &Nodes, held: &[[f64; 3]]) -> Vec<Candidate> {
    let mut of_label = HashMap::new();
    for (at, dof) in partition.dofs.iter().enumerate() {
        if let Some(dof) = dof.dof {
            of_label.entry(dof.node).or_insert_with(Vec::new).push(at);
        }
    }
    let n_nodes = of_label.len();
    let bits = |position: [f64; 3]| position.map(f64::to_bits);
    let held: HashSet<[u64; 3]> = held.iter().copied().map(bits).collect();
    let of_group = |(name, members): (&String, &Vec<usize>)| {
        let n_held = members.iter().filter(|member| held.contains(&bits(nodes.coordinates[**member]))).count();
        if n_held > 0 {
            let n_dofs = members.iter().filter_map(|member| of_label.get(&nodes.labels[*member])).map(Vec::len).sum();
            return of_held(name.clone(), [members.len(), n_held], n_dofs);
        }
        let mut labels: Vec<i64> = members.iter().map(|member| nodes.labels[*member]).collect();
        labels.retain(|label| of_label.contains_key(label));
        labels.sort_unstable();
        let dofs: Vec<usize> = labels.iter().flat_map(|label| of_label[label].iter().copied()).collect();
        candidate(partition, name.clone(), (labels, n_nodes), &dofs)
    };
    nodes.groups.iter().map(of_group).collect()
}

/// A group that no interface can be, as nodes of it are held, and the dofs that are left to it.
fn of_held(group: String, [n_nodes, n_held]: [usize; 2], n_dofs: usize) -> Candidate {
    let remark = match n_nodes - n_held {
        0 if n_dofs == 0 => "it is held".to_owned(),
        0 => "dofs of it are held".to_owned(),
        _ => format!(
            "{} held: list the others, if they are to be an interface",
            counted(n_held, "node of it is", "nodes of it are")
        ),
    };
    let (couplings, labels) = (Vec::new(), Vec::new());
    Candidate { group, n_nodes, n_dofs, couplings, remark: Some(remark), surface: None, labels }
}

fn candidate(partition: &Partition, group: String, (labels, of_model): (Vec<i64>, usize), dofs: &[usize]) -> Candidate {
    let n_nodes = labels.len();
    let nothing =
        Candidate { group, n_nodes, n_dofs: dofs.len(), couplings: Vec::new(), remark: None, surface: None, labels };
    let because = |remark: &str| Candidate { remark: Some(remark.to_owned()), ..nothing.clone() };
    if dofs.is_empty() {
        return because("none of its nodes has rows: supports took them out, or they belong to no element");
    }
    if n_nodes as f64 > MOST_OF_MODEL * of_model as f64 {
        return because("it is most of the model");
    }
    let rank = rank(partition, dofs);
    let mut couplings = Vec::new();
    if dofs.len() <= MOST_DIRECT {
        couplings.push("direct");
    }
    if rank == 6 && n_nodes > 1 {
        couplings.extend(["rigid", "average"]);
    }
    let surface = (rank == 6).then(|| fitted_surface::of(&positions(partition, dofs))).flatten();
    let remark = match (rank, n_nodes) {
        (6, _) => None,
        (_, 1) => Some("one node without rotations: it holds no rotation".to_owned()),
        (rank, _) => Some(format!("it can react {rank} of six rigid-body motions: nodes in line, or too few of them")),
    };
    Candidate { couplings, remark, surface, ..nothing }
}

/// Where the nodes of some dofs are, each once.
fn positions(partition: &Partition, dofs: &[usize]) -> Vec<[f64; 3]> {
    let mut found: Vec<(u32, [f64; 3])> = Vec::new();
    for dof in dofs.iter().map(|dof| &partition.dofs[*dof]) {
        match dof.site {
            Some(site) if found.last().is_none_or(|(node, _)| *node != dof.node) => {
                found.push((dof.node, site.position))
            }
            _ => {}
        }
    }
    found.into_iter().map(|(_, position)| position).collect()
}

/// How many of the six unit motions some dofs tell apart.
pub(super) fn rank(partition: &Partition, dofs: &[usize]) -> usize {
    let sites: Vec<_> = dofs.iter().filter_map(|dof| partition.dofs[*dof].site).collect();
    if sites.is_empty() {
        return 0;
    }
    let n = sites.len() as f64;
    let centre = [0, 1, 2].map(|axis| sites.iter().map(|site| site.position[axis]).sum::<f64>() / n);
    let rows: Vec<[f64; 6]> = sites.iter().map(|site| site.rigid_motion_about(centre)).collect();
    dense::rank_of_rows(&rows, CARRIES)
}
