//! `cargo run --release -p validation -- all`: the examples of the paper, their curves, figures and a page.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use validation::Result;
use validation::claims::claims;
use validation::examples::Example;
use validation::page::{figures, page};
use validation::pendulum::Pendulum;
use validation::study::Study;
use validation::summary::{summary, totals};

const USAGE: &str = "usage: validation all|bend|rotating|spherical|crank|elbow|bracket [FOLDER]";

fn main() -> ExitCode {
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("validation: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<()> {
    let (which, folder) = match arguments {
        [which] => (which, PathBuf::from("target/validation")),
        [which, folder] => (which, PathBuf::from(folder)),
        _ => return Err(USAGE.into()),
    };
    let is_chosen = |name: &str| which == "all" || which == name;
    let chosen: Vec<Example> = Example::ALL.into_iter().filter(|example| is_chosen(example.name())).collect();
    let pendulum = is_chosen("bracket").then(|| solid(&folder.join("bracket"))).transpose()?;
    if chosen.is_empty() && pendulum.is_none() {
        return Err(format!("no example {which}; {USAGE}").into());
    }
    let program = std::env::current_exe()?.with_file_name("supel");
    let program = program.exists().then_some(program);
    let mut studies = Vec::new();
    for example in chosen {
        let own = folder.join(example.name());
        let study = Study::new(example, &own, program.as_deref())?;
        written(&study, &own)?;
        println!("{}", example.title());
        if study.same_by_command == Some(false) {
            println!("  superelements of the program supel are not those of the library: is it of another build?");
        }
        for claim in claims(&study) {
            println!("  {:?}: {}\n    {}", claim.verdict, claim.paper, claim.found);
        }
        studies.push(study);
    }
    // A run of one example leaves the page of all alone.
    let name = if which == "all" { "index" } else { which };
    let path = folder.join(format!("{name}.html"));
    fs::write(&path, page(&studies, pendulum.as_ref()))?;
    if !studies.is_empty() {
        println!("{}Claims: {}.", summary(&studies), totals(&studies));
    }
    println!("{}", path.display());
    Ok(())
}

/// The curves and figures of a study.
fn written(study: &Study, folder: &Path) -> Result<()> {
    for (variant, run) in &study.runs {
        fs::write(folder.join(variant.slug() + ".csv"), run.curves.to_csv())?;
    }
    for (name, svg) in figures(study)? {
        fs::write(folder.join(name), svg)?;
    }
    Ok(())
}

/// The bracket on its hinge: curves, film strip and, where HDF5 is built in, the series for ParaView.
fn solid(folder: &Path) -> Result<Pendulum> {
    let pendulum = Pendulum::new(folder)?;
    for (n_modes, swing) in &pendulum.swings {
        fs::write(folder.join(format!("modes-{n_modes}.csv")), swing.curves.to_csv())?;
    }
    fs::write(folder.join("film.svg"), pendulum.film())?;
    #[cfg(feature = "vtkhdf")]
    validation::vtkhdf::write(
        &folder.join("swing.vtkhdf"),
        &supel_models::bracket_mesh(),
        &pendulum.swings[1].1.frames,
    )?;
    println!("A solid in large rotation");
    for f in pendulum.figures() {
        println!(
            "  {} modes: energy changes by {:.1e} of the largest kinetic and {:.1e} of the largest strain energy, base {:.1e} from \
             the finest, {:.2} iterations",
            f.n_modes, f.of_kinetic, f.of_strain, f.away, f.iterations
        );
    }
    #[cfg(not(feature = "vtkhdf"))]
    println!("  no series for ParaView: it needs --features vtkhdf");
    Ok(pendulum)
}
