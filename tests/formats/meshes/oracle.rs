//! Every mesh of the corpus and of the fixtures against meshio: the points, the cells, and the points of every set.
//!
//! Needs a Python with meshio and h5py (`SUPEL_MESH_PYTHON`, or `python3`); skipped with a message where there is none.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use supel::dofs::Nodes;
use supel::input::{Allowance, MeshInput};

use super::{Folder, fixture, read};

/// Extensions of meshes, packed ones without the packing.
const MESHES: [&str; 15] =
    ["inp", "msh", "frd", "vtk", "vtu", "med", "rmed", "hmf", "xdmf", "h5m", "e", "exo", "cgns", "hdf", "vtkhdf"];

fn python() -> Option<String> {
    let python = std::env::var("SUPEL_MESH_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has =
        Command::new(&python).args(["-c", "import meshio, h5py"]).output().is_ok_and(|output| output.status.success());
    if !has {
        println!("skipped: {python} has no meshio and h5py (SUPEL_MESH_PYTHON names another)");
    }
    has.then_some(python)
}

/// All meshes below a folder; packed ones are unpacked into another folder.
fn meshes_below(folder: &Path, unpacked: &Folder, found: &mut Vec<(String, PathBuf)>) {
    let entries = std::fs::read_dir(folder).map(|entries| entries.flatten().map(|entry| entry.path()).collect());
    let mut entries: Vec<PathBuf> = entries.unwrap_or_default();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            meshes_below(&path, unpacked, found);
            continue;
        }
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
        let plain = name.strip_suffix(".gz").unwrap_or(&name);
        let Some((_, extension)) = plain.rsplit_once('.') else { continue };
        if !MESHES.contains(&extension) {
            continue;
        }
        let shown = format!("{}/{name}", folder.file_name().and_then(|name| name.to_str()).unwrap_or_default());
        if plain == name {
            found.push((shown, path));
        } else {
            use std::io::Read;
            let mut bytes = Vec::new();
            let file = std::fs::File::open(&path).expect("a mesh");
            flate2::read::MultiGzDecoder::new(file).read_to_end(&mut bytes).expect("a packed mesh");
            found.push((shown.clone(), unpacked.write(&format!("{}/{plain}", found.len()), bytes)));
        }
    }
}

/// What differs between a mesh as it is read here and as meshio reads it.
fn difference(nodes: &Nodes, meshio: &Value) -> Option<String> {
    let points: Vec<Vec<f64>> = serde_json::from_value(meshio["points"].clone()).expect("points");
    if points.len() != nodes.coordinates.len() {
        return Some(format!("{} nodes, meshio has {}", nodes.coordinates.len(), points.len()));
    }
    for (node, (ours, theirs)) in nodes.coordinates.iter().zip(&points).enumerate() {
        if ours.as_slice() != theirs.as_slice() {
            return Some(format!("node {node} at {ours:?}, meshio has {theirs:?}"));
        }
    }
    for kind in ["point_sets", "cell_sets"] {
        let sets: BTreeMap<String, Vec<usize>> = serde_json::from_value(meshio[kind].clone()).expect("sets");
        // Gmsh's own bookkeeping.
        for (name, theirs) in sets.iter().filter(|(name, set)| !set.is_empty() && *name != "gmsh:bounding_entities") {
            let of_elements = format!("{name} (elements)");
            let ours =
                nodes.groups.get(&of_elements).filter(|_| kind == "cell_sets").or_else(|| nodes.groups.get(name));
            match ours {
                Some(ours) if ours == theirs => {}
                Some(ours) => return Some(format!("{name} has {} nodes, meshio has {}", ours.len(), theirs.len())),
                None => return Some(format!("no group {name}: {:?}", nodes.groups.keys())),
            }
        }
    }
    None
}

/// The number of a kind of VTK that meshio calls so, and its nodes at corners and on edges, which are kept.
fn of_meshio(kind: &str) -> (u8, usize) {
    match kind {
        "triangle" => (5, 3),
        "quad" => (9, 4),
        "tetra" => (10, 4),
        "hexahedron" => (12, 8),
        "wedge" => (13, 6),
        "pyramid" => (14, 5),
        "triangle6" | "triangle7" => (22, 6),
        "quad8" | "quad9" => (23, 8),
        "tetra10" => (24, 10),
        "hexahedron20" | "hexahedron27" => (25, 20),
        "wedge15" | "wedge18" => (26, 15),
        "pyramid13" | "pyramid14" => (27, 13),
        other => panic!("{other}"),
    }
}

/// Cells by their kind, each with its nodes in the order of VTK, sorted: blocks may come in another order.
type CellTable = BTreeMap<u8, Vec<Vec<u32>>>;

/// What differs between the cells of a mesh and those that meshio reads; none where a kind is read by one of both alone, which is said.
fn difference_of_cells(path: &Path, meshio: &Value) -> Result<Option<String>, String> {
    let others = meshio["others"].to_string();
    if others != "[]" {
        return Err(format!("cells not compared, there are {others}"));
    }
    let mesh = match MeshInput::read(path, &Allowance::of(None)) {
        Ok(MeshInput { unread: Some(unread), .. }) => return Err(format!("cells not compared, not read: {unread}")),
        Ok(mesh) => mesh,
        Err(error) => return Ok(Some(format!("its cells: {error}"))),
    };
    let (mut ours, mut theirs) = (CellTable::new(), CellTable::new());
    for cells in &mesh.cells {
        ours.entry(cells.number).or_default().extend(cells.nodes.chunks(cells.n_nodes).map(<[u32]>::to_vec));
    }
    let blocks: Vec<(String, Vec<Vec<u32>>)> = serde_json::from_value(meshio["cells"].clone()).expect("cells");
    for (kind, cells) in blocks {
        let (number, n_nodes) = of_meshio(&kind);
        theirs.entry(number).or_default().extend(cells.into_iter().map(|cell| cell[..n_nodes].to_vec()));
    }
    for table in [&mut ours, &mut theirs] {
        table.retain(|_, cells| !cells.is_empty());
        table.values_mut().for_each(|cells| cells.sort());
    }
    let numbers = |table: &CellTable| table.iter().map(|(number, cells)| (*number, cells.len())).collect::<Vec<_>>();
    if numbers(&ours) != numbers(&theirs) {
        return Ok(Some(format!("cells {:?} by kind of VTK, meshio has {:?}", numbers(&ours), numbers(&theirs))));
    }
    let differing = ours.iter().find_map(|(number, cells)| {
        let at = cells.iter().zip(&theirs[number]).position(|(own, other)| own != other)?;
        Some(format!("cell {:?} of kind {number}, meshio has {:?}", cells[at], theirs[number][at]))
    });
    Ok(differing)
}

/// What meshio is known to read otherwise, and why.
const MESHIO_IS_WRONG: [(&str, &str); 1] =
    [("ccx_rotor3/model.inp.gz", "of a set that several *ELEMENT name it keeps the last elements")];

#[test]
fn meshes_are_read_as_meshio_reads_them() {
    let Some(python) = python() else { return };
    let unpacked = Folder::new();
    let mut meshes = Vec::new();
    meshes_below(&fixture("mesh"), &unpacked, &mut meshes);
    meshes_below(&fixture("calculix"), &unpacked, &mut meshes);
    if let Some(pairs) = supel_testing::corpus::corpus() {
        let corpus = pairs.parent().expect("the corpus").to_owned();
        meshes_below(&corpus.join("meshes"), &unpacked, &mut meshes);
        meshes_below(&pairs, &unpacked, &mut meshes);
    }
    let script = super::root().join("tests/formats/meshes/oracle.py");
    let output = Command::new(python).arg(script).args(meshes.iter().map(|(_, path)| path)).output().expect("Python");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let lines: Vec<Value> =
        String::from_utf8_lossy(&output.stdout).lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(lines.len(), meshes.len());
    let (mut n_compared, mut wrong) = (0, Vec::new());
    for ((name, path), meshio) in meshes.iter().zip(&lines) {
        let told = match (read(path), &meshio["error"]) {
            (Ok(nodes), Value::Null) => match difference(&nodes, meshio) {
                None => match difference_of_cells(path, meshio) {
                    Ok(None) => {
                        n_compared += 1;
                        "alike".to_owned()
                    }
                    Ok(Some(what)) => {
                        wrong.push(format!("{name}: {what}"));
                        format!("DIFFERENT: {what}")
                    }
                    Err(reason) => format!("nodes and groups alike; {reason}"),
                },
                Some(what) => match MESHIO_IS_WRONG.iter().find(|(known, _)| known == name) {
                    Some((_, reason)) => format!("meshio is wrong: {reason}"),
                    None => {
                        wrong.push(format!("{name}: {what}"));
                        format!("DIFFERENT: {what}")
                    }
                },
            },
            (Ok(nodes), reason) => format!("read here alone ({} nodes), meshio: {reason}", nodes.labels.len()),
            (Err(error), Value::Null) => {
                wrong.push(format!("{name}: meshio reads it, {error}"));
                format!("READ BY MESHIO ALONE: {error}")
            }
            (Err(error), _) => format!("read by neither: {error}"),
        };
        println!("{name}: {told}");
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(n_compared >= 4, "{n_compared}");
}
