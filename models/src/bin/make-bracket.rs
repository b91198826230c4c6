//! Writes the bundled example: `make-bracket [folder]`, by default `examples/bracket` of the workspace.
//!
//! It writes the same bytes every time, up to the version of the libraries that pack them.

use std::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::PathBuf;

use supel_models::{bracket, bracket_mesh, med, write};

fn main() -> Result<(), Box<dyn Error>> {
    let bundled = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/bracket");
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from(bundled), PathBuf::from);
    fs::create_dir_all(&folder)?;
    let model = bracket();
    for (name, entries, what) in [
        ("stiffness.mtx.gz", &model.stiffness, "stiffness of the example bracket, N/mm; rows node by node: ux, uy, uz"),
        ("mass.mtx.gz", &model.mass, "mass of the example bracket, tonnes; rows node by node: ux, uy, uz"),
    ] {
        let file = BufWriter::new(File::create(folder.join(name))?);
        write::matrix_market_gz(file, model.n, entries, what)?;
    }
    med::write(&folder.join("bracket.med"), &bracket_mesh(), "lug bracket, millimetres")?;
    println!("{}: {} nodes, {} dofs, mass {:e} t", folder.display(), model.nodes.len(), model.n, model.total_mass(0));
    for (name, members) in &model.groups {
        println!("group {name}: {} nodes", members.len());
    }
    Ok(())
}
