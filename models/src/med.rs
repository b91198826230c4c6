//! Meshes in MED, the HDF5 format of Salome and code_aster, with named node groups.
//!
//! The layout is that of MED 3.0 as meshio reads and writes it: coordinates and connectivity flat in Fortran order,
//! connectivity from one, every node in one family, a family naming the groups it belongs to.

use std::collections::BTreeMap;
use std::path::Path;

use hdf5_metno::types::FixedAscii;
use hdf5_metno::{Dataset, File, Group, H5Type, Location, Result};

use crate::hexahedra::HexMesh;

const MESH: &str = "mesh";
/// MED's name of a mesh that is no time step: NDT and NOR are −1, nineteen digits each.
const NO_STEP: &str = "-0000000000000000001-0000000000000000001";
const NO_PROFILE: &str = "MED_NO_PROFILE_INTERNAL";
/// Bytes of a group name in MED.
const GROUP_NAME: usize = 80;

/// Writes a mesh with its node groups.
///
/// # Errors
/// The errors of the HDF5 library.
pub fn write(path: &Path, mesh: &HexMesh, description: &str) -> Result<()> {
    let file = File::create(path)?;
    let info = file.create_group("INFOS_GENERALES")?;
    for (name, value) in [("MAJ", 3_i64), ("MIN", 0), ("REL", 0)] {
        attribute(&info, name, value)?;
    }
    let (family_of_node, families) = families(mesh);
    let head = file.create_group("ENS_MAA")?.create_group(MESH)?;
    for (name, value) in [("DIM", 3_i64), ("ESP", 3), ("REP", 0), ("SRT", 1), ("TYP", 0)] {
        attribute(&head, name, value)?;
    }
    text::<16>(&head, "UNT", "")?;
    text::<48>(&head, "UNI", &"mm              ".repeat(3))?;
    text::<48>(&head, "NOM", "X               Y               Z               ")?;
    text::<200>(&head, "DES", description)?;
    let step = head.create_group(NO_STEP)?;
    for (name, value) in [("CGT", 1_i64), ("NDT", -1), ("NOR", -1)] {
        attribute(&step, name, value)?;
    }
    attribute(&step, "PDT", -1.0)?;

    let nodes = step.create_group("NOE")?;
    mark(&nodes)?;
    let coordinates: Vec<f64> = (0..3).flat_map(|d| mesh.nodes.iter().map(move |x| x[d])).collect();
    counted(&nodes, "COO", &coordinates, mesh.nodes.len())?;
    counted(&nodes, "FAM", &family_of_node, mesh.nodes.len())?;

    let cells = step.create_group("MAI")?;
    attribute(&cells, "CGT", 1_i64)?;
    let hexahedra = cells.create_group("HE8")?;
    mark(&hexahedra)?;
    let corners: Vec<i64> =
        (0..8).flat_map(|corner| mesh.elements.iter().map(move |element| i64::from(element[corner]) + 1)).collect();
    counted(&hexahedra, "NOD", &corners, mesh.elements.len())?;

    write_families(&file.create_group("FAS")?.create_group(MESH)?, &families)
}

/// The family of each node, and the groups of each family; a node in no group is in family zero.
fn families(mesh: &HexMesh) -> (Vec<i64>, Vec<Vec<String>>) {
    let mut groups_of_node: Vec<Vec<String>> = vec![Vec::new(); mesh.nodes.len()];
    for (name, members) in &mesh.groups {
        members.iter().for_each(|&node| groups_of_node[node as usize].push(name.clone()));
    }
    let mut number_of: BTreeMap<Vec<String>, i64> =
        groups_of_node.iter().filter(|groups| !groups.is_empty()).map(|groups| (groups.clone(), 0)).collect();
    (1..).zip(number_of.values_mut()).for_each(|(number, value)| *value = number);
    let family_of_node = groups_of_node.iter().map(|groups| number_of.get(groups).copied().unwrap_or(0)).collect();
    (family_of_node, number_of.into_keys().collect())
}

fn write_families(parent: &Group, families: &[Vec<String>]) -> Result<()> {
    let zero = parent.create_group("FAMILLE_ZERO")?;
    attribute(&zero, "NUM", 0_i64)?;
    let of_nodes = parent.create_group("NOEUD")?;
    for (number, groups) in (1_i64..).zip(families) {
        let family = of_nodes.create_group(&format!("FAM_{number}_{}", groups.join("_")))?;
        attribute(&family, "NUM", number)?;
        let list = family.create_group("GRO")?;
        attribute(&list, "NBR", groups.len() as i64)?;
        let names: Vec<[i8; GROUP_NAME]> = groups
            .iter()
            .map(|group| {
                let mut bytes = group.bytes().take(GROUP_NAME - 1).map(|byte| byte as i8);
                std::array::from_fn(|_| bytes.next().unwrap_or(0))
            })
            .collect();
        dataset(&list, "NOM", &names)?;
    }
    Ok(())
}

/// A dataset without times of creation, so that equal input gives equal bytes.
fn dataset<T: H5Type>(parent: &Group, name: &str, values: &[T]) -> Result<Dataset> {
    parent.new_dataset_builder().obj_track_times(false).with_data(values).create(name)
}

/// A dataset with MED's profile flag and count of entities.
fn counted<T: H5Type>(parent: &Group, name: &str, values: &[T], count: usize) -> Result<()> {
    let written = dataset(parent, name, values)?;
    attribute(&written, "CGT", 1_i64)?;
    attribute(&written, "NBR", count as i64)
}

/// The attributes shared by nodes and each kind of cell.
fn mark(group: &Group) -> Result<()> {
    attribute(group, "CGT", 1_i64)?;
    attribute(group, "CGS", 1_i64)?;
    text::<23>(group, "PFL", NO_PROFILE)
}

fn attribute<T: H5Type>(owner: &Location, name: &str, value: T) -> Result<()> {
    owner.new_attr::<T>().create(name)?.write_scalar(&value)
}

fn text<const N: usize>(owner: &Location, name: &str, value: &str) -> Result<()> {
    attribute(owner, name, FixedAscii::<N>::from_ascii(value).unwrap_or_default())
}
