//! Models in which CalculiX made solids of shells, and elements of incompatible modes: files that CalculiX wrote.

use std::path::{Path, PathBuf};

use supel::error::{Error, Result};
use supel::input::{Input, InputNote, read};
use supel::job::{Job, ModelJob};
use supel::memory_forecast::Resources;
use supel::verification::check::Verdict;

use super::{Folder, fixture, group, read_text, refused};

fn model(folder: &Path, name: &str, nodes: &str) -> ModelJob {
    let file = |kind: &str| folder.join(format!("{name}.{kind}"));
    let matrices = |kind: &str| fixture(&format!("calculix/{name}.{kind}.gz"));
    let (dofs, nodes) = (Some(file("dof")), Some(folder.join(nodes)));
    ModelJob { stiffness: matrices("sti"), mass: Some(matrices("mas")), dofs, nodes, ..ModelJob::default() }
}

fn folder_of_fixtures() -> PathBuf {
    fixture("calculix")
}

fn read_model(name: &str) -> Result<Input> {
    read(&model(&folder_of_fixtures(), name, &format!("{name}.inp")))
}

/// Sets of the deck hold the nodes that were made of theirs, each where CalculiX put it.
#[test]
fn nodes_of_shells_are_rebuilt() {
    let input = read_model("plate").expect("a model");
    let nodes = input.nodes.expect("nodes");
    let expanded = input.notes.iter().find_map(|note| match note {
        InputNote::Expanded { n_nodes, n_made, .. } => Some((*n_nodes, *n_made)),
        _ => None,
    });
    // Sixteen corners became three nodes each, 24 middles of edges two.
    assert_eq!(expanded, Some((40, 96)), "{:?}", input.notes);
    assert_eq!(input.dofs.expect("a map").len(), 3 * 96);
    let left = group(&nodes, "LEFT");
    assert_eq!(left.len(), 4 * 3 + 3 * 2);
    for index in &nodes.groups["LEFT"] {
        let [x, _, z] = nodes.coordinates[*index];
        // The plate is 3 thick, and its normal there leans by the slope of a parabola, at most 1 : 3.
        assert!(x.abs() < 0.5 && (z - 9.0).abs() < 1.6, "{x} {z}");
    }
}

/// The free plate has six rigid-body modes, which geometry explains: the nodes are where the stiffness has them.
#[test]
fn a_free_plate_of_shells_reduces() {
    let folder = Folder::new();
    let at = |kind: &str| fixture(&format!("calculix/plate.{kind}")).display().to_string();
    let text = format!(
        "model = {{ stiffness = \"{}\", mass = \"{}\", dofs = \"{}\", nodes = \"{}\" }}\n\
         interface = [{{ name = \"left\", nodes = \"group:LEFT\", coupling = \"rigid\" }}, \
         {{ name = \"right\", nodes = \"group:RIGHT\", coupling = \"rigid\" }}]\n\
         reduction = {{ method = \"herting\", modes = {{ count = 4 }} }}\n[write]\nsuperelement = \"plate.supel\"\n",
        at("sti.gz"),
        at("mas.gz"),
        at("dof"),
        at("inp")
    );
    let job = Job::read(&folder.write("job.toml", text)).expect("a job");
    let outcome = supel::reduce(&job, Resources::default(), &mut ()).expect("a reduction");
    for check in &outcome.report.body.checks {
        assert_ne!(check.verdict(), Verdict::Fail, "{} {}", check.id, check.name);
    }
    assert_eq!(outcome.superelement.tensors().rigid_body_modes.cols(), 6);
}

/// Without the file of positions, or with one of another mesh, labels that repeat are refused with what to do.
#[test]
fn without_positions_labels_that_repeat_are_refused() {
    let folder = Folder::new();
    for kind in ["dof", "inp", "12d"] {
        folder.write(
            &format!("plate.{kind}"),
            std::fs::read(fixture(&format!("calculix/plate.{kind}"))).expect("a fixture"),
        );
    }
    let refused = read(&model(folder.0.path(), "plate", "plate.inp")).expect_err("a refusal");
    assert!(matches!(refused, Error::DofRepeated { .. }), "{refused:?}");
    assert!(refused.to_string().contains("*NODE OUTPUT, OUTPUT=3D"), "{refused}");
    folder.write("plate.frd", "    1C\n    2C     1     0\n -1    1 0.00000E+00 0.00000E+00 0.00000E+00\n -3\n");
    assert!(matches!(read(&model(folder.0.path(), "plate", "plate.inp")), Err(Error::DofRepeated { .. })));
}

/// Amplitudes of incompatible modes belong to no node.
#[test]
fn amplitudes_of_incompatible_modes_are_scalar_dofs() {
    let input = read_model("block").expect("a model");
    let dofs = input.dofs.expect("a map");
    assert_eq!((dofs.len(), dofs.iter().filter(|dof| dof.is_none()).count()), (96, 4 * 3 * 3));
    assert!(input.notes.iter().any(|note| matches!(note, InputNote::Amplitudes { n_nodes: 12, n_elements: 4, .. })));
    // A node that is missing for another reason is not taken for one.
    let folder = Folder::new();
    let deck = std::fs::read_to_string(fixture("calculix/block.inp")).expect("a fixture");
    folder.write("block.inp", deck.replace("C3D8I", "C3D8"));
    folder.write("block.dof", std::fs::read(fixture("calculix/block.dof")).expect("a fixture"));
    let refused = read(&model(folder.0.path(), "block", "block.inp")).expect_err("a refusal");
    assert!(matches!(refused, Error::DofNodeMissing { node: 21, .. }), "{refused:?}");
}

/// CalculiX writes rows along the global axes whatever a deck says; Abaqus does not, and nothing in a deck tells which one it was.
#[test]
fn local_directions_of_a_deck_are_told() {
    let folder = Folder::new();
    let text = std::fs::read_to_string(fixture("calculix/block.inp")).expect("a fixture");
    let deck = folder.write("block.inp", format!("{text}*TRANSFORM, NSET=TOP\n1, 1, 0, -1, 1, 0\n"));
    let with =
        |deck: PathBuf| read(&ModelJob { nodes: Some(deck), ..model(&folder_of_fixtures(), "block", "block.inp") });
    let told = |input: Input| -> Vec<String> {
        let notes = input.notes.iter().filter(|note| note.warning_code() == Some("W-LOCAL-DIRECTIONS"));
        notes.map(ToString::to_string).collect()
    };
    let warnings = told(with(deck).expect("a model"));
    let place = format!("block.inp:{}: *TRANSFORM", text.lines().count() + 1);
    assert!(warnings.len() == 1 && warnings[0].starts_with(&place), "{warnings:?}");
    assert!(warnings[0].contains("give the axes of these nodes with `model.frames`"), "{warnings:?}");
    assert_eq!(told(with(fixture("calculix/block.inp")).expect("a model")), Vec::<String>::new());
}

/// Behind the head of the elements come as many as it says.
#[test]
fn elements_of_a_result_file_are_as_many_as_it_says() {
    let points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let nodes: String =
        points.iter().zip(1..).map(|([x, y, z], label)| format!(" -1{label:5}{x:>12}{y:>12}{z:>12}\n")).collect();
    let with = |stated: u32| {
        format!(
            "    1C\n    2C     4     0\n{nodes} -3\n    3C     {stated}     0\n -1    1    3    0    1\n -2    1    2    3    4\n -3\n 9999\n"
        )
    };
    assert_eq!(read_text("one.frd", with(1)).expect("a mesh").labels, [1, 2, 3, 4]);
    let said = refused("two.frd", with(2)).to_string();
    assert!(said.contains("1 elements") && said.contains("2, as the head of the block says"), "{said}");
}
