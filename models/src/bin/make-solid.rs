//! Writes the files of a part of any size: `make-solid --family bulky|slender|lattice --dofs N --out FOLDER [--modes N]`.

use std::error::Error;
use std::path::{Path, PathBuf};

use supel_models::{Family, Part};

const USAGE: &str = "make-solid --family bulky|slender|lattice --dofs N --out FOLDER [--modes N]";

fn main() -> Result<(), Box<dyn Error>> {
    let Request { family, dofs, folder, modes } = Request::typed()?;
    let part = Part::new(family, dofs);
    part.write(&folder, modes)?;
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
