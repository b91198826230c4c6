//! The interface for C: the header is that of the source, and C programs build against it and run.

use supel_models::superelements::beam;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use supel_runtime::component::{DeadLoad, FloatingFrame, ModalComponent, State};
use supel_runtime::motion::Motion;
use supel_runtime::{
    CheckSummary, Direction, Flag, Matrix, Precision, RecoveredDof, Recovery, Superelement, Verdict, Verification,
};

fn in_crate(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// What a reader has to know before the first function.
const LIMIT: &str = "
/* The modal component of a superelement file: forces and tangent matrices in large motion with small deformation.
 *
 * Deformation is linear in the floating frame of a component. Inside a component there is therefore no stress stiffening, and
 * its inertia is that of the undeformed shape, whatever the tangent: a slender part that turns fast or carries a large load is
 * divided into several components.
 *
 * Coordinates are material: of each interface node the velocity of the material point that was at the inertial origin, in the
 * node's axes; supel_velocities_to_origin, supel_forces_to_nodes and supel_matrix_to_nodes change to those at the node. */";

fn header() -> String {
    let mut config = cbindgen::Config {
        language: cbindgen::Language::C,
        cpp_compat: true,
        include_guard: Some("SUPEL_H".to_owned()),
        autogen_warning: Some(
            "/* Made from src/capi.rs by `SUPEL_WRITE_HEADER=1 cargo test --test capi`. */".to_owned(),
        ),
        documentation_style: cbindgen::DocumentationStyle::C99,
        line_length: 120,
        after_includes: Some(LIMIT.to_owned()),
        no_includes: true,
        sys_includes: ["stddef.h", "stdint.h"].map(String::from).to_vec(),
        usize_is_size_t: true,
        ..cbindgen::Config::default()
    };
    config.enumeration.rename_variants = cbindgen::RenameRule::QualifiedScreamingSnakeCase;
    let modules = ["opening", "file", "evaluation", "loads", "at_nodes", "recovery", "results"];
    let sources = [vec!["src/capi.rs".to_owned()], modules.map(|name| format!("src/capi/{name}.rs")).to_vec()].concat();
    let builder = cbindgen::Builder::new().with_config(config);
    let bindings = sources.iter().fold(builder, |builder, source| builder.with_src(in_crate(source))).generate();
    let mut text = Vec::new();
    bindings.expect("the source can be parsed").write(&mut text);
    String::from_utf8(text).expect("the source is text")
}

#[test]
fn the_header_is_that_of_the_source() {
    let path = in_crate("capi/supel.h");
    if std::env::var_os("SUPEL_WRITE_HEADER").is_some() {
        std::fs::write(&path, header()).expect("the header can be written");
    }
    assert_eq!(std::fs::read_to_string(path).expect("the header is there"), header());
}

/// Names of the functions that the header declares.
fn functions() -> Vec<String> {
    let header = header();
    let calls = header.match_indices("supel_").filter_map(|(at, _)| {
        let name = header[at..].split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next()?;
        header[at + name.len()..].starts_with('(').then(|| name.to_owned())
    });
    calls.collect()
}

/// Each function has words above it, and a C program of these tests calls it.
#[test]
fn every_function_of_the_header_is_described_and_called() {
    let (header, functions) = (header(), functions());
    assert!(functions.len() > 50, "{functions:?}");
    let programs = ["tests/capi/refusals.c", "tests/capi/results.c", "capi/example.c"];
    let source: String =
        programs.iter().map(|path| std::fs::read_to_string(in_crate(path)).expect("a program")).collect();
    for name in functions {
        assert!(source.contains(&format!("{name}(")), "no program calls {name}");
        let lines: Vec<&str> = header.lines().collect();
        let declared = lines.iter().position(|line| line.contains(&format!("{name}("))).expect("a declaration");
        let words: Vec<&str> =
            lines[..declared].iter().rev().take_while(|line| line.starts_with("//")).copied().collect();
        let first = words.last().map_or("", |line| line.trim_start_matches(['/', ' ']));
        assert!(first.len() > 10 && !first.starts_with('#'), "{name} is not described: {first}");
    }
}

/// The static library, built as the header's users build it.
fn library() -> PathBuf {
    let arguments = ["rustc", "--offline", "--lib", "--features", "capi", "--crate-type", "staticlib"];
    let build = Command::new(env!("CARGO"))
        .args(arguments)
        .args(["--message-format", "json", "--manifest-path"])
        .arg(in_crate("Cargo.toml"))
        .output()
        .expect("cargo runs");
    assert!(build.status.success(), "{}", String::from_utf8_lossy(&build.stderr));
    let messages = String::from_utf8(build.stdout).expect("messages are text");
    let files = messages
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .flat_map(|message| message["filenames"].as_array().cloned().unwrap_or_default());
    let mut archives =
        files.filter_map(|file| file.as_str().filter(|name| name.ends_with("supel_runtime.a")).map(PathBuf::from));
    archives.next().expect("an archive")
}

/// Compiles a C program without warnings and runs it with superelement files.
fn run(source: &str, library: &Path, folder: &Path, files: &[&Path]) -> Output {
    let program = folder.join(Path::new(source).file_stem().expect("a file"));
    let compiled = Command::new("cc")
        .args(["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-I"])
        .args([&in_crate("capi"), &in_crate(source), library])
        .args(["-lpthread", "-ldl", "-lm", "-o"])
        .arg(&program)
        .output()
        .expect("a C compiler");
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    Command::new(program).args(files).output().expect("the program runs")
}

/// Rows of the basis for some directions of one node.
fn recovery(node: i64, directions: &[Direction], rows: Matrix) -> Option<Recovery> {
    let dofs = directions.iter().map(|&direction| RecoveredDof { node, direction }).collect();
    Some(Recovery::new(rows, dofs, Precision::Double).expect("as many dofs as rows"))
}

/// A damped arc that recovers the node in its middle.
fn arc() -> Superelement {
    let (mut tensors, mut metadata, basis) = beam::reduced_parts(&beam::arc_nodes(), &beam::SOFT, &[0, 8], 3);
    tensors.damping = Some(tensors.mass.clone());
    let rows = Matrix::from_fn(6, 15, |i, j| basis[(6 * 4 + i) * 15 + j]);
    let places = vec![[1.5, 2.5, -3.5]];
    tensors.recovery = recovery(4, &Direction::ALL, rows).map(|rows| rows.with_positions(places).expect("one node"));
    let turned = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    tensors.interface_frames[1] = turned;
    metadata.interface_nodes[0].name = "hub \0 à gauche".into();
    metadata.interface_nodes[0].label = Some(7);
    tensors.load_vectors = Some(Matrix::from_fn(15, 1, |i, _| 1.0 + i as f64));
    metadata.load_names = vec!["thrust".into()];
    metadata.units = Some("m-kg-s".into());
    metadata.validity.band_hz = Some([0.0, 250.0]);
    metadata.validity.assumptions = vec!["nobody pulls".into()];
    metadata.flags.insert(Flag::SingularMass);
    let check = |id: &str, value, verdict| CheckSummary { id: id.into(), value, limit: 0.5, verdict };
    let checks = vec![check("M-01", Some(0.25), Verdict::Pass), check("M-05", None, Verdict::Fail)];
    metadata.verification = Verification { verdict: Verdict::Fail, checks };
    Superelement::new(tensors, metadata).expect("the parts fit")
}

/// Another component with fifteen coordinates, which recovers two directions of a node.
fn one_node() -> Superelement {
    let (mut tensors, metadata) = beam::random_parts(1, 9, 1);
    let rows = Matrix::from_fn(2, 15, |i, j| if i == j { 1.0 } else { 0.0 });
    tensors.recovery = recovery(7, &Direction::ALL[..2], rows);
    Superelement::new(tensors, metadata).expect("the parts fit")
}

#[test]
fn c_programs_get_the_same_bits_and_reasons() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("arc.supel");
    arc().write(&file).expect("the file can be written");
    let other = folder.path().join("other.supel");
    one_node().write(&other).expect("the file can be written");
    let library = library();

    let refusals = run("tests/capi/refusals.c", &library, folder.path(), &[&file, &other]);
    assert!(refusals.status.success(), "{}", String::from_utf8_lossy(&refusals.stderr));

    let results = run("tests/capi/results.c", &library, folder.path(), &[&file, &other]);
    assert!(results.status.success(), "{}", String::from_utf8_lossy(&results.stderr));

    let example = run("capi/example.c", &library, folder.path(), &[&file]);
    assert!(example.status.success(), "{}", String::from_utf8_lossy(&example.stderr));
    let text = String::from_utf8(example.stdout).expect("the program prints text");
    let printed: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert_eq!(printed, expected(&file));
}

/// What the example prints, by the library itself.
fn expected(file: &Path) -> Vec<f64> {
    let superelement = Superelement::open(file).expect("a superelement");
    let component = ModalComponent::new(&superelement, FloatingFrame::MassWeighted).expect("a free body");
    let (motions, rest) = (vec![Motion::IDENTITY; 2], vec![0.0; component.n_coordinates()]);
    let mut velocities = rest.clone();
    (velocities[5], velocities[11]) = (10.0, 10.0);
    let state = State { motions: &motions, amplitudes: &rest[..3], velocities: &velocities, accelerations: &rest };
    let mut workspace = component.workspace();
    component.evaluate(&state, &mut workspace).expect("no deformation");
    let mut external = component.gravity_forces(&[0.0, 0.0, -9.81], &mut workspace).expect("finite").to_vec();
    let load = DeadLoad { node: 1, force: [0.0, 100.0, 0.0], moment: [0.0; 3] };
    component.add_load(&load, &motions, &mut external).expect("a node of the component");
    let mut values = vec![workspace.kinetic_energy()];
    let forces = workspace.elastic_forces().iter().zip(workspace.inertial_forces()).zip(&external);
    values.extend(forces.flat_map(|((elastic, inertial), external)| [*elastic, *inertial, *external]));
    values
}
