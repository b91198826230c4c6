//! Writers: Matrix Market, node table, dof map, CalculiX deck.

use std::io::{self, Write};

use crate::model::{Entry, Material, Model};
use crate::tetrahedra::TetMesh;

/// Writes a symmetric matrix as Matrix Market coordinates: lower triangle by columns, from one, with the shortest
/// decimals that read back as the same bits.
///
/// # Errors
/// The errors of the writer.
pub fn matrix_market(out: &mut impl Write, n: usize, entries: &[Entry], comment: &str) -> io::Result<()> {
    // By symmetry the upper triangle by rows is the lower one by columns.
    let lower = || entries.iter().filter(|(row, column, _)| row <= column);
    writeln!(out, "%%MatrixMarket matrix coordinate real symmetric")?;
    comment.lines().try_for_each(|line| writeln!(out, "% {line}"))?;
    writeln!(out, "{n} {n} {}", lower().count())?;
    lower().try_for_each(|(row, column, value)| writeln!(out, "{} {} {value:e}", column + 1, row + 1))
}

/// Writes a matrix as [`matrix_market`] does, gzipped without name and time, so that equal input gives equal bytes.
///
/// # Errors
/// The errors of the writer.
pub fn matrix_market_gz(out: impl Write, n: usize, entries: &[Entry], comment: &str) -> io::Result<()> {
    let mut packed = flate2::write::GzEncoder::new(out, flate2::Compression::best());
    matrix_market(&mut io::BufWriter::new(&mut packed), n, entries, comment)?;
    packed.finish().map(drop)
}

/// Writes the node table: `node,x,y,z`.
///
/// # Errors
/// The errors of the writer.
pub fn nodes_csv(out: &mut impl Write, model: &Model) -> io::Result<()> {
    writeln!(out, "node,x,y,z")?;
    let mut rows = model.labels.iter().zip(&model.nodes);
    rows.try_for_each(|(label, [x, y, z])| writeln!(out, "{label},{x:?},{y:?},{z:?}"))
}

/// Writes the dof map, `node.direction` with directions from one to six, a line for each row.
///
/// # Errors
/// The errors of the writer.
pub fn dof_map(out: &mut impl Write, model: &Model) -> io::Result<()> {
    model.dofs.iter().try_for_each(|(label, direction)| writeln!(out, "{label}.{}", direction + 1))
}

/// Writes nodes, quadratic tetrahedra, material and node sets of a solid as a CalculiX or Abaqus deck without steps.
///
/// # Errors
/// The errors of the writer.
pub fn calculix(out: &mut impl Write, mesh: &TetMesh, material: &Material, model: &Model) -> io::Result<()> {
    writeln!(out, "*NODE, NSET=ALL")?;
    let mut nodes = model.labels.iter().zip(&model.nodes);
    nodes.try_for_each(|(label, [x, y, z])| writeln!(out, "{label}, {x:?}, {y:?}, {z:?}"))?;
    writeln!(out, "*ELEMENT, TYPE=C3D10, ELSET=SOLID")?;
    for (number, element) in (1..).zip(&mesh.elements) {
        let labels = element.map(|node| model.labels[node as usize].to_string());
        writeln!(out, "{number}, {}", labels.join(", "))?;
    }
    let Material { young, poisson, density } = material;
    writeln!(out, "*MATERIAL, NAME=MATERIAL")?;
    writeln!(out, "*ELASTIC\n{young:?}, {poisson:?}\n*DENSITY\n{density:e}")?;
    writeln!(out, "*SOLID SECTION, ELSET=SOLID, MATERIAL=MATERIAL")?;
    for (name, members) in &model.groups {
        writeln!(out, "*NSET, NSET={name}")?;
        members.iter().try_for_each(|label| writeln!(out, "{label},"))?;
    }
    Ok(())
}
