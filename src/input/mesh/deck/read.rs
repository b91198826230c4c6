//! Reads a deck, keyword by keyword, and puts its scopes together to one mesh.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::assembly::Scopes;
use super::keyword::Keyword;
use super::lines::{DeckLines, included_by, is_keyword};
use super::resolved::Resolved;
use super::scope::{NodeList, Scope, SetKind, name_in_assembly, of_assembly};
use super::sections;
use super::transforms;
use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::allowance::Claim;
use crate::input::file_start::FileStart;
use crate::input::format::Sureness;
use crate::input::mesh::cell_mesh::{CellMesh, named_apart};
use crate::input::mesh::labels::{LABEL, Labels};

/// Whether a file is a deck: a keyword after one asterisk, below comments of two.
pub(in crate::input::mesh) fn sureness(start: &FileStart<'_>) -> Sureness {
    let line = start.lines().find(|line| !line.starts_with(b"**"));
    let begins_as_deck = line.is_some_and(|line| line.len() > 1 && line[0] == b'*' && line[1].is_ascii_alphabetic());
    let is_commented = line.is_none() && start.lines().next().is_some();
    match () {
        () if begins_as_deck => Sureness::Certain,
        () if is_commented && start.has_extension(&["inp"]) => Sureness::Named,
        () => Sureness::Unlikely,
    }
}

/// Reads the mesh of a deck.
pub(in crate::input::mesh) fn read(path: &Path, allowance: &Allowance) -> Result<CellMesh> {
    let claim = allowance.claim(path);
    let (lines, scopes) = scopes(path, &claim)?;
    if scopes.instances.is_empty() && scopes.outer.nodes.labels.is_empty() {
        return Err(Error::NoData { path: path.to_owned(), expected: "nodes below *NODE" });
    }
    let mut mesh = merged(&lines, &scopes, &claim)?;
    mesh.data_digest = lines.digest_of_included();
    let nodes = Some(&mesh.nodes).filter(|_| scopes.instances.is_empty());
    mesh.frames = transforms::frames(&lines, &scopes.transforms, nodes)?;
    Ok(mesh)
}

/// What a deck says, line by line.
fn scopes(path: &Path, claim: &Claim<'_>) -> Result<(DeckLines, Scopes)> {
    let mut lines = DeckLines::open(path)?;
    let mut scopes = Scopes::default();
    while let Some(line) = lines.next()? {
        if is_keyword(line) {
            let keyword = Keyword::of(line);
            section(&mut lines, &keyword, &mut scopes, claim)?;
        }
    }
    scopes.hand_down();
    Ok((lines, scopes))
}

/// The lines below one keyword.
fn section(lines: &mut DeckLines, keyword: &Keyword, scopes: &mut Scopes, claim: &Claim<'_>) -> Result<()> {
    const FLAT: &str = "have the program write the mesh out node by node and element by element";
    if let Some(file) = included_by(keyword) {
        lines.include(file)?;
    }
    match keyword.name.as_str() {
        "NODE" => sections::nodes(lines, keyword, scopes.of(keyword, lines)?, claim),
        "ELEMENT" => sections::elements(lines, keyword, scopes.of(keyword, lines)?, claim),
        "NSET" => set(lines, keyword, (SetKind::Nodes, scopes), claim),
        "ELSET" => set(lines, keyword, (SetKind::Elements, scopes), claim),
        "SURFACE" => sections::surface(lines, keyword, scopes.of(keyword, lines)?, claim),
        "PART" => scopes.start_part(keyword, lines),
        "INSTANCE" => scopes.start_instance(lines, keyword, claim),
        "TRANSFORM" => scopes.transform(lines, keyword),
        "ENDPART" | "ENDINSTANCE" => {
            scopes.end();
            Ok(())
        }
        "NGEN" | "NFILL" | "NCOPY" | "NMAP" | "ELGEN" | "ELCOPY" | "SYSTEM" => {
            Err(lines
                .unsupported(format!("{} makes nodes or elements by rule, which is not read", keyword.shown()), FLAT))
        }
        // The lines below other keywords say nothing of the mesh.
        _ => Ok(()),
    }
}

/// `*NSET` and `*ELSET`; what the assembly has of an instance has a name there that no set of the part has.
fn set(
    lines: &mut DeckLines,
    keyword: &Keyword,
    (kind, scopes): (SetKind, &mut Scopes),
    claim: &Claim<'_>,
) -> Result<()> {
    let is_of_assembly = scopes.names_instance(keyword);
    let scope = scopes.of(keyword, lines)?;
    let first = scope.sets(kind).len();
    sections::set(lines, keyword, (kind, &mut *scope), claim)?;
    if is_of_assembly {
        scope.sets_mut(kind)[first..].iter_mut().for_each(|line| line.set = of_assembly(&line.set));
    }
    Ok(())
}

/// The mesh of all instances and of what stands outside of them.
fn merged(lines: &DeckLines, scopes: &Scopes, claim: &Claim<'_>) -> Result<CellMesh> {
    let all: Vec<&Scope> = scopes.instances.iter().chain([&scopes.outer]).collect();
    let mut nodes = NodeList::default();
    let mut first_of_scope = Vec::new();
    for scope in &all {
        first_of_scope.push(nodes.labels.len() as u32);
        let own = own_nodes(lines, &scope.nodes)?;
        claim.add(LABEL * own.labels.len() as u64)?;
        nodes.labels.extend(own.labels);
        nodes.coordinates.extend(own.coordinates);
        nodes.places.extend(own.places);
    }
    if let Err([first, second]) = Labels::new(&nodes.labels) {
        return Err(told_twice(lines, &all, (&nodes, &first_of_scope), [first, second]));
    }
    let mut mesh = CellMesh::default();
    let mut named: [BTreeMap<String, Vec<usize>>; 3] = Default::default();
    let mut n_named: BTreeMap<String, usize> = BTreeMap::new();
    let mut is_of_assembly: BTreeSet<String> = BTreeSet::new();
    let mut resolved = Vec::new();
    for (at, scope) in all.iter().enumerate() {
        let end = first_of_scope.get(at + 1).map_or(nodes.labels.len(), |first| *first as usize);
        let first = first_of_scope[at];
        let of_scope = Resolved::new(lines, scope, (&nodes.labels[first as usize..end], first), &mut mesh)?;
        let names = of_scope.names().filter(|name| scope.instance.is_some() && name_in_assembly(name).is_none());
        let names: BTreeSet<String> = names.map(str::to_ascii_uppercase).collect();
        names.into_iter().for_each(|name| *n_named.entry(name).or_default() += 1);
        let of_assembly = of_scope.names().filter_map(|name| match scope.instance {
            Some(_) => name_in_assembly(name),
            None => Some(name),
        });
        is_of_assembly.extend(of_assembly.map(str::to_ascii_uppercase));
        resolved.push((scope.instance.as_deref(), of_scope));
    }
    // Sets of one name in several instances, or in one and in the assembly, are told apart by the instance.
    let is_alone = |name: &str| {
        let name = name.to_ascii_uppercase();
        n_named.get(&name).is_none_or(|count| *count == 1) && !is_of_assembly.contains(&name)
    };
    for (instance, of_scope) in resolved {
        for (named, groups) in named.iter_mut().zip(of_scope.groups) {
            for (name, members) in groups {
                match (instance, name_in_assembly(&name)) {
                    (Some(_), Some(name)) => join(named, name, members),
                    (Some(instance), None) if !is_alone(&name) => {
                        named.insert(format!("{instance}.{name}"), members);
                    }
                    (_, None) => join(named, &name, members),
                    (None, Some(_)) => {}
                }
            }
        }
    }
    let [of_nodes, of_elements, of_surfaces] = named;
    mesh.nodes.groups = named_apart(of_nodes, [("elements", of_elements), ("surface", of_surfaces)]);
    (mesh.nodes.labels, mesh.nodes.coordinates) = (nodes.labels, nodes.coordinates);
    Ok(mesh)
}

/// Adds nodes to the group of a name, in whatever case.
fn join(named: &mut BTreeMap<String, Vec<usize>>, name: &str, members: Vec<usize>) {
    let known = named.keys().find(|known| known.eq_ignore_ascii_case(name)).cloned();
    let group = named.entry(known.unwrap_or_else(|| name.to_owned())).or_default();
    group.extend(members);
    group.sort_unstable();
    group.dedup();
}

/// The nodes of a scope, each once: programs accept a node that is defined again where it was.
fn own_nodes(lines: &DeckLines, nodes: &NodeList) -> Result<NodeList> {
    if Labels::new(&nodes.labels).is_ok() {
        return Ok(nodes.clone());
    }
    let mut own = NodeList::default();
    let mut known = std::collections::HashMap::new();
    for (at, label) in nodes.labels.iter().enumerate() {
        match known.get(label) {
            Some(first) if nodes.coordinates[*first] == nodes.coordinates[at] => {}
            Some(first) => {
                let (path, line) = lines.at(nodes.places[at]);
                let (_, first_line) = lines.at(nodes.places[*first]);
                return Err(Error::NodeRepeated { path, line, node: *label, first_line });
            }
            None => {
                known.insert(*label, at);
                own.labels.push(*label);
                own.coordinates.push(nodes.coordinates[at]);
                own.places.push(nodes.places[at]);
            }
        }
    }
    Ok(own)
}

/// The error of a label that two instances have.
fn told_twice(
    lines: &DeckLines,
    scopes: &[&Scope],
    (nodes, first_of_scope): (&NodeList, &[u32]),
    both: [usize; 2],
) -> Error {
    let instance_of = |node: usize| {
        let scope = first_of_scope.partition_point(|first| *first as usize <= node) - 1;
        scopes[scope].instance.as_deref().map_or("the assembly".to_owned(), |name| format!("the instance {name}"))
    };
    let [first, second] = both.map(instance_of);
    let (path, line) = lines.at(nodes.places[both[1]]);
    let found = format!(
        "node {} is in {first} and in {second}, and rows of the matrices tell no instance",
        nodes.labels[both[0]]
    );
    let advice = "write a deck without parts and assemblies (in Abaqus/CAE: Edit Attributes of the model), which numbers all nodes";
    Error::DeckUnsupported { path, line, found, advice }
}

/// How many elements of a deck CalculiX gives three nodes of its own, amplitudes of incompatible modes: `C3D8I`.
///
/// # Errors
/// The errors of [`read`].
pub(in crate::input) fn n_incompatible(path: &Path, allowance: &Allowance) -> Result<usize> {
    let scopes = scopes(path, &allowance.claim(path))?.1;
    let all = scopes.instances.iter().chain([&scopes.outer]);
    Ok(all.map(|scope| scope.elements.n_incompatible).sum())
}
