//! Nodes of patches whose coordinates and axes supports hide: it is said of each way to hide them, and never of sound parts.

use supel::cli::ExitCode;
use supel_models::transform::{grounded, in_local_frames, join, supported, translated};
use supel_models::{Inertia, Material, Model, Section, brick, frame};

use crate::frames::{axes_turned_by, lumped};
use crate::place::{Ended, Place, supel};
use crate::told::{by_job, warnings};

const UNTESTED: &str = "W-COORD-UNTESTED";

/// A bar of 9 × 2 × 2 bricks along x with a lumped mass, which tells no axes.
fn bar() -> Model {
    lumped(&brick([9, 2, 2], [1.8, 0.35, 0.27], &Material::STEEL_SI))
}

/// Without all rows of the nodes at its first end.
fn clamped(model: &Model) -> Model {
    let wall = model.groups["XMIN"].clone();
    supported(model, |(label, _)| wall.contains(&label))
}

/// Half of a bar: its plane of symmetry has no rows along y.
fn half(model: &Model) -> Model {
    let plane = model.groups["YMIN"].clone();
    supported(model, |(label, direction)| direction == 1 && plane.contains(&label))
}

/// The other half of its motions: what is along the plane is held in it.
fn antisymmetric_half(model: &Model) -> Model {
    let plane = model.groups["YMIN"].clone();
    supported(model, |(label, direction)| direction != 1 && plane.contains(&label))
}

/// Labels of nodes by where they are.
fn within(model: &Model, is_within: impl Fn([f64; 3]) -> bool) -> Vec<i64> {
    let nodes = model.nodes.iter().zip(1..);
    nodes.filter(|(place, _)| is_within(**place)).map(|(_, label)| label).collect()
}

/// Reduces a model with a patch at its last end.
fn reduced(model: &Model, coupling: &str) -> (Place, Ended) {
    let patch = &model.groups["XMAX"];
    by_job(model, "", &format!("nodes = {patch:?}\ncoupling = \"{coupling}\""))
}

/// Whether a run that was not refused says that coordinates were not tested.
fn is_untested(model: &Model, coupling: &str) -> bool {
    let (place, ended) = reduced(model, coupling);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    warnings(&place).contains(&UNTESTED.to_owned())
}

/// The nodes of a model with the coordinates of two of them exchanged.
fn exchanged(model: &Model, a: i64, b: i64) -> Model {
    let mut nodes = model.nodes.clone();
    nodes.swap(a as usize - 1, b as usize - 1);
    Model { nodes, ..model.clone() }
}

#[test]
fn sound_parts_are_told_nothing() {
    for coupling in ["rigid", "average"] {
        for model in [
            clamped(&bar()),
            antisymmetric_half(&bar()),
            half(&bar()),
            clamped(&half(&bar())),
            half(&brick([6, 3, 2], [0.8, 0.5, 0.3], &Material::STEEL_SI)),
        ] {
            assert!(!is_untested(&model, coupling), "{coupling}");
        }
    }
}

/// Each node of the chain is near the one before it, and the first is near the support.
#[test]
fn a_chain_of_local_frames_from_a_support_to_a_patch_is_told() {
    let edge = within(&bar(), |[_, y, z]| y == 0.0 && z == 0.0);
    let model = in_local_frames(&clamped(&bar()), &axes_turned_by(0.3), |label| edge.contains(&label));
    for coupling in ["rigid", "average"] {
        let (place, ended) = reduced(&model, coupling);
        assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
        assert_eq!(warnings(&place), [UNTESTED], "{coupling}");
        let named = format!(
            "around 1 of 9 nodes that patches tie, so that the stiffness does not confirm their coordinates and axes: nodes {}",
            edge[9]
        );
        assert!(place.report_body("x.report.json").contains(&named), "{}", ended.out);
        // The comparison with the full model is made of the same coordinates.
        let verified = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml"), "--threads", "1"]);
        assert!(verified.out.contains("1 check past its limit (M-05)"), "{}{}", verified.out, verified.err);
    }
}

#[test]
fn springs_around_a_patch_are_told() {
    let (bar, mut model) = (bar(), bar());
    let last = within(&bar, |[x, _, _]| x > 1.5);
    for row in (0..bar.dofs.len()).filter(|row| last.contains(&bar.dofs[*row].0)) {
        model = grounded(&model, row, 1e8);
    }
    assert!(is_untested(&model, "rigid"));
    let patch = &bar.groups["XMAX"];
    assert!(is_untested(&exchanged(&model, patch[1], patch[5]), "rigid"));
    // One more plane of nodes without springs bears witness.
    let near = within(&bar, |[x, _, _]| x > 1.5 && x < 1.7);
    let mut model = bar.clone();
    for row in (0..bar.dofs.len()).filter(|row| near.contains(&bar.dofs[*row].0)) {
        model = grounded(&model, row, 1e8);
    }
    assert!(!is_untested(&model, "rigid"));
}

/// A pin that carries its force into all nodes around the middle of a block: turns about it pass, which confirm where its nodes are, but move
/// nothing in the middle, whose axes they do not tell.
#[test]
fn a_pin_inside_a_block_hides_the_axes_of_its_middle() {
    let mut model = lumped(&brick([4, 2, 2], [0.4, 0.22, 0.24], &Material::STEEL_SI));
    let around = within(&model, |[x, _, _]| (x - 0.2).abs() < 0.15);
    let stiffness = 1e9 / (around.len() * around.len()) as f64;
    for (a, b) in around.iter().flat_map(|a| around.iter().map(move |b| (*a as u32 - 1, *b as u32 - 1))) {
        model.stiffness.extend((0..3).map(|axis| (3 * a + axis, 3 * b + axis, stiffness)));
    }
    for coupling in ["rigid", "average"] {
        let (place, ended) = by_job(&model, "", &format!("nodes = [23, 1, 5, 15]\ncoupling = \"{coupling}\""));
        assert_eq!(ended.code, ExitCode::Done, "{coupling}: {}{}", ended.out, ended.err);
        assert!(warnings(&place).contains(&UNTESTED.to_owned()), "{coupling}: {}", ended.out);
    }
}

#[test]
fn nodes_in_a_plane_of_symmetry_are_told_or_refused() {
    let bar = bar();
    let in_plane: Vec<i64> =
        bar.groups["XMAX"].iter().copied().filter(|label| bar.groups["YMIN"].contains(label)).collect();
    for model in [half(&bar), clamped(&half(&bar)), antisymmetric_half(&bar), clamped(&antisymmetric_half(&bar))] {
        let wrong = exchanged(&model, in_plane[0], in_plane[2]);
        for coupling in ["rigid", "average"] {
            let (place, ended) = reduced(&wrong, coupling);
            let is_told = ended.err.contains("E-COORD") || warnings(&place).contains(&UNTESTED.to_owned());
            assert!(is_told, "{coupling}: {}{}", ended.out, ended.err);
        }
    }
}

/// Nodes with uz, rx and ry that lie in no plane: turns about x and y move what they have no rows for.
#[test]
fn bending_alone_out_of_a_plane_is_told() {
    let place = |k: i64| [(k % 6) as f64 * 0.2, (k / 6) as f64 * 0.15, 0.0];
    let nodes: Vec<[f64; 3]> = (0..18).map(place).collect();
    let along = (0..18).filter(|k| k % 6 < 5).map(|k| [k, k + 1]);
    let edges: Vec<[usize; 2]> = along.chain((0..12).map(|k| [k, k + 6])).collect();
    let grillage = frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
    let bending = supported(&grillage, |(label, direction)| label % 6 == 1 || matches!(direction, 0 | 1 | 5));
    let interface = "nodes = [6, 12, 18]\ncoupling = \"rigid\"\ndofs = [\"uz\", \"rx\", \"ry\"]";
    let (place, ended) = by_job(&bending, "", interface);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert_eq!(warnings(&place), [""; 0]);
    let exchanged = bending.nodes.iter().map(|[x, y, z]| [*x, *z, *y]).collect();
    let (place, ended) = by_job(&Model { nodes: exchanged, ..bending }, "", interface);
    assert!(
        ended.err.contains("E-COORD") || warnings(&place).contains(&UNTESTED.to_owned()),
        "{}{}",
        ended.out,
        ended.err
    );
}

/// Each of two bodies agrees with K wherever it lies, and so does what a patch makes of both.
#[test]
fn what_ties_bodies_says_that_their_places_are_not_confirmed() {
    let one = brick([3, 2, 2], [0.6, 0.35, 0.27], &Material::STEEL_SI);
    let two = join(&one, &translated(&one, [0.8, 0.0, 0.0]), &[]);
    let [end, start] = ["XMAX", "B.XMIN"].map(|name| two.groups[name].clone());
    let patch = |nodes: &[i64]| format!("nodes = {nodes:?}\ncoupling = \"rigid\"");
    let both = patch(&[&end[..], &start].concat());
    let each = format!("{}\n[[interface]]\nname = \"other\"\n{}", patch(&end), patch(&start));
    for (interfaces, is_said) in [(both, true), (each, false)] {
        let (place, ended) = by_job(&two, "", &interfaces);
        assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
        let notes = place.report("x.report.json")["body"]["model"]["notes"].to_string();
        assert_eq!(notes.contains("ties 2 bodies that the stiffness does not connect"), is_said, "{notes}");
    }
}
