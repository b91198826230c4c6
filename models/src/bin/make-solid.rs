//! Writes a part of any size: `make-solid --family bulky|slender|lattice --dofs N --out FOLDER [--modes N]`.
//!
//! The folder gets stiffness.mtx, mass.mtx, nodes.csv, model.dof, a job for supel, for solids a CalculiX deck without steps
//! (model.inp), and model.json, which tells scripts what the job tells supel.

use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use supel_models::part::{FACES, MATERIAL};
use supel_models::{Family, Part, write};

const USAGE: &str = "make-solid --family bulky|slender|lattice --dofs N --out FOLDER [--modes N]";
/// Distance from the plane of a face up to which a node belongs to it, mm; they lie on it.
const TOLERANCE: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let Request { family, dofs, folder, modes } = Request::typed()?;
    fs::create_dir_all(&folder)?;
    let part = Part::new(family, dofs);
    let model = &part.model;
    let text =
        |name: &str| -> std::io::Result<_> { Ok(BufWriter::with_capacity(1 << 20, File::create(folder.join(name))?)) };
    let matrix = |name: &str, entries: &[_]| -> std::io::Result<()> {
        let mut out = text(name)?;
        write::matrix_market(&mut out, model.n, entries, &format!("{} part; N, mm, tonne, s", family.name()))?;
        out.flush()
    };
    std::thread::scope(|scope| {
        let mass = scope.spawn(|| matrix("mass.mtx", &model.mass));
        matrix("stiffness.mtx", &model.stiffness)?;
        mass.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })?;
    write::nodes_csv(&mut text("nodes.csv")?, model)?;
    write::dof_map(&mut text("model.dof")?, model)?;
    if let Some(mesh) = &part.solid {
        write::calculix(&mut text("model.inp")?, mesh, &MATERIAL, model)?;
    }
    fs::write(folder.join("job.toml"), job(&part, modes))?;
    fs::write(folder.join("model.json"), facts(&part, modes))?;
    report(&part, &folder);
    Ok(())
}

struct Request {
    family: Family,
    dofs: usize,
    folder: PathBuf,
    modes: usize,
}

impl Request {
    fn typed() -> Result<Self, Box<dyn Error>> {
        let (mut family, mut dofs, mut folder, mut modes) = (None, None, None, 50);
        let mut words = std::env::args().skip(1);
        while let Some(flag) = words.next() {
            let value = words.next().ok_or(USAGE)?;
            match flag.as_str() {
                "--family" => family = Some(value.parse()?),
                "--dofs" => dofs = Some(value.parse()?),
                "--out" => folder = Some(PathBuf::from(value)),
                "--modes" => modes = value.parse()?,
                _ => return Err(USAGE.into()),
            }
        }
        Ok(Self { family: family.ok_or(USAGE)?, dofs: dofs.ok_or(USAGE)?, folder: folder.ok_or(USAGE)?, modes })
    }
}

/// The job: both faces as rigid patches.
fn job(part: &Part, modes: usize) -> String {
    let mut job = String::from(
        "[model]\nstiffness = \"stiffness.mtx\"\nmass      = \"mass.mtx\"\nnodes     = \"nodes.csv\"\n\
         dofs      = \"model.dof\"\nunits     = \"mm-t-s\"\n",
    );
    for (name, at) in FACES.iter().zip(part.faces) {
        let along = |value: f64| {
            let mut vector = [0.0; 3];
            vector[part.family.axis()] = value;
            vector
        };
        job += &format!(
            "\n[[interface]]\nname     = \"{}\"\nnodes    = {{ within = {{ plane = {{ point = {:?}, normal = {:?}, tolerance = \
             {TOLERANCE:?} }} }} }}\ncoupling = \"rigid\"\n",
            name.to_lowercase(),
            along(at),
            along(1.0),
        );
    }
    job + &format!(
        "\n[reduction]\nmethod = \"herting\"\nmodes  = {{ count = {modes} }}\n\n[write]\nsuperelement = \"part.supel\"\n"
    )
}

/// What scripts need beside the matrices.
fn facts(part: &Part, modes: usize) -> String {
    let Part { family, model, faces, .. } = part;
    let directions = model.n / model.nodes.len();
    format!(
        "{{\"family\": \"{}\", \"n\": {}, \"directions\": {directions}, \"axis\": {}, \"faces\": {faces:?}, \
         \"tolerance\": {TOLERANCE:?}, \"modes\": {modes}}}\n",
        family.name(),
        model.n,
        family.axis(),
    )
}

fn report(part: &Part, folder: &Path) {
    let Part { family, model, .. } = part;
    let sizes: Vec<String> = model.groups.iter().map(|(name, members)| format!("{name} {}", members.len())).collect();
    println!(
        "{}: {}, {} nodes, {} dofs, {} and {} entries in K and M, mass {:e} t, nodes of {}",
        folder.display(),
        family.name(),
        model.nodes.len(),
        model.n,
        model.stiffness.len(),
        model.mass.len(),
        model.total_mass(0),
        sizes.join(" and "),
    );
}
