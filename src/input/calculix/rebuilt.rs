//! Nodes and dof map of a model whose shells or beams CalculiX has made into solids.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};

use super::expanded_map::{ExpandedMap, expanded_map};
use super::expansion::Expansion;
use crate::dofs::{Dof, DofMap, Nodes};
use crate::error::Result;
use crate::input::format::{NodeFormat, ReadNodes};
use crate::input::mesh::FRD;
use crate::input::mesh::deck::n_incompatible;
use crate::input::{Allowance, InputNote};
use crate::regular_file::{digest, digest_of_list, unchanged};

/// A dof map without repeated labels, and the nodes that it names.
pub(in crate::input) struct Rebuilt {
    pub(in crate::input) dofs: DofMap,
    pub(in crate::input) nodes: Nodes,
    pub(in crate::input) notes: Vec<InputNote>,
    /// BLAKE3 of the files that told them, one below the other; of nothing where the deck alone did.
    pub(in crate::input) digest: String,
}

/// Rebuilds nodes and map of a model from what CalculiX wrote next to the map; none where there is no need or the files do not tell.
///
/// # Errors
/// Those of reading files that are there.
pub(in crate::input) fn rebuilt(
    (map_path, dofs): (&Path, &[Option<Dof>]),
    (nodes_path, nodes): (&Path, &Nodes),
    allowance: &Allowance,
) -> Result<Option<Rebuilt>> {
    let known: BTreeSet<i64> = nodes.labels.iter().copied().collect();
    let has_repeated = {
        let mut seen = BTreeSet::new();
        dofs.iter().flatten().any(|dof| !seen.insert((dof.node, dof.direction)))
    };
    let unknown: BTreeSet<i64> =
        dofs.iter().flatten().map(|dof| dof.node).filter(|node| !known.contains(node)).collect();
    if !has_repeated && unknown.is_empty() {
        return Ok(None);
    }
    let (topology, positions) = (beside(map_path, "12d"), beside(map_path, "frd"));
    let mut digests = Vec::new();
    let expansion = match &topology {
        Some(path) => {
            let (expansion, of_file) = unchanged(path, || Ok((Expansion::read(path, allowance)?, digest(path)?)))?;
            digests.push(of_file);
            expansion
        }
        None => Expansion::default(),
    };
    let mut rebuilt = Rebuilt { dofs: dofs.to_vec(), nodes: nodes.clone(), notes: Vec::new(), digest: String::new() };
    if has_repeated {
        let (Some(_), Some(positions)) = (&topology, &positions) else { return Ok(None) };
        let Some(map) = expanded_map(dofs, &expansion) else { return Ok(None) };
        let (ReadNodes { nodes: made, .. }, of_file) =
            unchanged(positions, || Ok((FRD.read(positions, allowance)?, digest(positions)?)))?;
        digests.push(of_file);
        if !rebuilt.expand(map, &expansion, &made, (map_path, positions)) {
            return Ok(None);
        }
    }
    if !unknown.is_empty() && !rebuilt.take_amplitudes(&unknown, &expansion, (map_path, nodes_path), allowance)? {
        return Ok(None);
    }
    rebuilt.digest = digest_of_list(&digests);
    Ok(Some(rebuilt))
}

/// The digests that [`rebuilt`] may record of the files that lie next to a map now: one where it reads the first of them, another where it reads
/// both. Which it reads depends on the map and the nodes alone.
///
/// # Errors
/// A file that is there and cannot be read.
pub(in crate::input) fn digests_next_to(map_path: &Path) -> Result<Vec<String>> {
    let Some(topology) = beside(map_path, "12d") else { return Ok(vec![digest_of_list(&[])]) };
    let topology = digest(&topology)?;
    let mut possible = vec![topology.clone()];
    if let Some(positions) = beside(map_path, "frd") {
        possible.push(digest_of_list(&[topology, digest(&positions)?]));
    }
    Ok(possible)
}

impl Rebuilt {
    /// Adds the nodes that were made; false where the file of positions has not all of them.
    fn expand(
        &mut self,
        map: ExpandedMap,
        expansion: &Expansion,
        made: &Nodes,
        (map_path, positions): (&Path, &Path),
    ) -> bool {
        let ExpandedMap { dofs, unsure } = map;
        let place_of: HashMap<i64, [f64; 3]> =
            made.labels.iter().copied().zip(made.coordinates.iter().copied()).collect();
        let in_deck: BTreeSet<i64> = self.nodes.labels.iter().copied().collect();
        let has_rows: BTreeSet<i64> = dofs.iter().flatten().map(|dof| dof.node).collect();
        let mut index_of = HashMap::new();
        for node in expansion.made_of.values().flatten() {
            let Some(place) = place_of.get(node).filter(|_| !in_deck.contains(node)) else { return false };
            index_of.entry(*node).or_insert_with(|| {
                self.nodes.labels.push(*node);
                self.nodes.coordinates.push(*place);
                self.nodes.labels.len() - 1
            });
        }
        // A set of the deck has the nodes that were made of its own, and these where they have rows.
        let labels = &self.nodes.labels;
        for members in self.nodes.groups.values_mut() {
            let grown = members.iter().flat_map(|member| {
                let made = expansion.made_of.get(&labels[*member]);
                let stays = made.is_none() || has_rows.contains(&labels[*member]);
                let made = made.into_iter().flatten().map(|node| index_of[node]);
                made.chain(stays.then_some(*member))
            });
            let grown: BTreeSet<usize> = grown.collect();
            *members = grown.into_iter().collect();
        }
        self.notes.push(InputNote::Expanded {
            path: map_path.to_owned(),
            positions: positions.to_owned(),
            n_nodes: expansion.made_of.len(),
            n_made: index_of.len(),
        });
        if let Some(first) = unsure.first() {
            let (path, count) = (map_path.to_owned(), unsure.len());
            self.notes.push(InputNote::ExpandedUnsure { path, count, first: *first });
        }
        self.dofs = dofs;
        true
    }

    /// Makes rows of nodes that no deck lists into scalar dofs, where they are as many as elements of incompatible modes have; false where
    /// they are not.
    fn take_amplitudes(
        &mut self,
        unknown: &BTreeSet<i64>,
        expansion: &Expansion,
        (map_path, nodes_path): (&Path, &Path),
        allowance: &Allowance,
    ) -> Result<bool> {
        let n_elements = n_incompatible(nodes_path, allowance).unwrap_or(0) + expansion.n_incompatible;
        let (Some(first), Some(last)) = (unknown.first(), unknown.last()) else { return Ok(false) };
        let is_run = unknown.len() == 3 * n_elements && last - first == unknown.len() as i64 - 1;
        let is_last = self.nodes.labels.iter().all(|label| label < first);
        if !is_run || !is_last {
            return Ok(false);
        }
        self.dofs
            .iter_mut()
            .filter(|dof| dof.is_some_and(|dof| unknown.contains(&dof.node)))
            .for_each(|dof| *dof = None);
        self.notes.push(InputNote::Amplitudes { path: map_path.to_owned(), n_nodes: unknown.len(), n_elements });
        Ok(true)
    }
}

/// The file of the job with another extension, where it is there; packed maps lie next to files that are not.
fn beside(map: &Path, extension: &str) -> Option<PathBuf> {
    let is_packed = map.extension().is_some_and(|last| ["gz", "bz2", "zst"].iter().any(|packed| last == *packed));
    let plain = if is_packed { map.with_extension("") } else { map.to_owned() };
    let file = plain.with_extension(extension);
    let packed: BTreeMap<&str, PathBuf> = ["gz", "bz2", "zst"]
        .iter()
        .map(|packing| (*packing, plain.with_extension(format!("{extension}.{packing}"))))
        .collect();
    std::iter::once(file).chain(packed.into_values()).find(|file| file.is_file())
}
