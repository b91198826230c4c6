//! What could not be judged, and which fields no comparison confirms.

use serde::Serialize;
use supel_runtime::{Flag, MOTIONS, MatrixKind, Method, RigidBodyModes, Superelement};

use super::content::Content;
use super::recovery;

/// What was not judged of this file, besides the fields that no file can confirm.
pub(super) fn notes(content: &Content<'_>) -> Vec<String> {
    let metadata = content.superelement.metadata();
    let mut notes = Vec::new();
    if content.plan.is_none() {
        notes.push("the job kept in the file is none of this version; what it expects was not compared".to_owned());
    }
    if metadata.model.rigid_body_modes == RigidBodyModes::Algebraic && content.n_rigid() > 0 {
        notes.push("the rigid-body modes are not the six unit motions of one body: the file alone does not tell its mass and centre".to_owned());
    }
    if content.n_rigid() == 0 {
        notes.push("the component is held: no rigid-body motion ties its stiffness and mass together".to_owned());
    }
    notes
}

/// A field whose content no comparison of this run confirms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Unvouched {
    /// A tensor, or a field of the metadata with all below it; `[]` stands for each element of a list.
    pub field: &'static str,
    /// Why not.
    pub reason: &'static str,
}

const fn unvouched(field: &'static str, reason: &'static str) -> Unvouched {
    Unvouched { field, reason }
}

const PARTS: Unvouched =
    unvouched("generator.parts_of_earlier_runs", "what a cache held is known to the run alone that took it");
const RECOVERY: &str = "recovery";
const UNTIED_RECOVERY: Unvouched = unvouched(
    RECOVERY,
    "rigid-body motion ties its rows where it is the six unit motions, and here it is not: nothing in the file does",
);
const UNTIED_POSITION: &str = "the six unit motions are the only other place; motions without geometry, or that supports leave, tell no positions";
const NOT_AT_HAND: &str = "names things of a model that is not at hand";

/// Fields that the file alone cannot confirm.
const ALONE: [Unvouched; 36] = [
    PARTS,
    unvouched("generator", "a file has no other sign of who made it"),
    unvouched("units", "the job kept in it is the only other place, and may be changed too"),
    unvouched("interface_nodes[].name", "the job kept in it is the only other place, and may be changed too"),
    unvouched("interface_nodes[].label", NOT_AT_HAND),
    unvouched("interface_nodes[].position", UNTIED_POSITION),
    unvouched("interface_positions", UNTIED_POSITION),
    unvouched("interface_frames", "axes along a hole are those of a mesh that is not at hand"),
    unvouched("coordinates[].row", NOT_AT_HAND),
    unvouched(
        "coordinates[].error_bar_hz",
        "comes from the digits and terms of K and M; only the largest is tied to M-09",
    ),
    unvouched("dropped", "how many modes their file had is known from that file only"),
    unvouched("dropped[].column", "a column that was left out is in no matrix"),
    unvouched("dropped[].reason", "words for people"),
    unvouched("dropped[].cause", "what starts a mode that is in no matrix is known from the model only"),
    unvouched("model.n_dofs", NOT_AT_HAND),
    unvouched(
        "model.rigid_body_modes",
        "without interface nodes, or motions that supports leave, nothing else tells unit motions from others",
    ),
    unvouched(
        "model.mass_properties",
        "a component whose rigid-body modes are not six unit motions has no other place for them",
    ),
    unvouched("validity.band_hz", "the job kept in it is the only other place, and may be changed too"),
    unvouched("inputs", "digests of files that are not at hand"),
    unvouched("job", "what was asked for is known from the file itself only"),
    unvouched(
        "verification",
        "values are the rounding of one run, a check may stand there more than once, and warnings of its report are not in the file",
    ),
    unvouched("frequencies", "modes left out everywhere leave a file that agrees with itself"),
    unvouched("stiffness", "a change that keeps rigid-body motion and frequencies agrees with the rest"),
    unvouched("mass", "a change that keeps rigid-body inertia, gravity and frequencies agrees with the rest"),
    unvouched("gravity", "of a component whose rigid-body modes are not six unit motions nothing else has it"),
    unvouched("load_vectors", "names and order are those of the job kept in it; the loads themselves are not at hand"),
    unvouched("mixing", "the length of a named column is in no other place"),
    unvouched("rigid_body_mass", "of a held component there is none"),
    unvouched(
        RECOVERY,
        "rigid-body motion and the positions of its nodes tie its interface columns, nothing its modal ones",
    ),
    unvouched("recovery_dofs", NOT_AT_HAND),
    unvouched("quantities", "names, units and rows of a recovery matrix that is not at hand"),
    unvouched("matrices", "matrices of a model that is not at hand"),
    unvouched("damping", "with its matrices, which are those of a model that is not at hand"),
    unvouched("recovery_faces", "cells of a mesh that is not at hand"),
    unvouched("recovery_face_offsets", "cells of a mesh that is not at hand"),
    unvouched(
        "recovery_positions",
        "rows that move with them may be changed too; motions that are not six units tell none",
    ),
];

/// Fields that a comparison with the job cannot confirm either.
const WITH_JOB: [Unvouched; 7] = [
    PARTS,
    unvouched("generator", "another version that makes the same leaves no other sign; a warning says so"),
    unvouched(
        "coordinates[].error_bar_hz",
        "what the residual of another eigensolver adds to a bar may be anything up to a bound; within it bars are not told apart",
    ),
    unvouched("dropped[].reason", "words for people"),
    unvouched("job", "files may move, and repeated entries are added or refused: the matrices are compared"),
    unvouched("verification", "values are the rounding of one run; each property was measured anew"),
    unvouched("inputs", "other files may hold the same matrices; a warning says so"),
];

/// The fields of a superelement that a comparison does not confirm.
pub(super) fn fields(superelement: &Superelement, compared: Compared) -> Vec<Unvouched> {
    let (metadata, tensors) = (superelement.metadata(), superelement.tensors());
    let list: &[Unvouched] = match compared {
        Compared::Alone => &ALONE,
        Compared::WithJob => &WITH_JOB,
    };
    let is_algebraic = metadata.model.rigid_body_modes == RigidBodyModes::Algebraic;
    let is_there = |unvouched: &&Unvouched| match unvouched.field {
        "generator.parts_of_earlier_runs" => metadata.generator.parts_of_earlier_runs.is_some(),
        "units" => metadata.units.is_some(),
        "interface_nodes[].label" => metadata.interface_nodes.iter().any(|node| node.label.is_some()),
        "interface_nodes[].position" | "interface_positions" => {
            (is_algebraic || superelement.n_rigid() < MOTIONS.len()) && !metadata.interface_nodes.is_empty()
        }
        "interface_frames" => metadata.job["interface"].as_array().is_some_and(|all| all.iter().any(is_along_hole)),
        "coordinates[].row" => superelement.n_interface() > 0 && metadata.interface_nodes.is_empty(),
        "coordinates[].error_bar_hz" => !tensors.frequencies.is_empty(),
        "dropped" => metadata.method == Method::ModeAcceleration,
        "dropped[].column" | "dropped[].reason" => !metadata.dropped.is_empty(),
        "dropped[].cause" => metadata.unseen_modes().next().is_some(),
        "model.rigid_body_modes" => metadata.interface_nodes.is_empty() || superelement.n_rigid() == 0,
        "mixing" => tensors.mixing.is_some(),
        "model.mass_properties" => is_algebraic && metadata.model.mass_properties.is_some(),
        // Of a preloaded component it is the inertia of translations, which the interface tells.
        "gravity" => {
            let is_told =
                metadata.flags.contains(&Flag::Preloaded) && superelement.n_interface() >= superelement.n_rigid();
            let is_held = !metadata.interface_nodes.is_empty() && superelement.n_rigid() < MOTIONS.len();
            let may_have = tensors.gravity.is_some() || is_held;
            is_algebraic && may_have && !(is_told && superelement.n_rigid() > 0)
        }
        "load_vectors" => tensors.load_vectors.is_some(),
        "rigid_body_mass" => superelement.n_rigid() == 0,
        "quantities" => tensors.quantities.is_some(),
        "matrices" => !tensors.matrices.is_empty(),
        "damping" => metadata.matrices.iter().any(|matrix| matrix.kind == MatrixKind::Damping),
        // Faces may have been taken out.
        RECOVERY | "recovery_dofs" | "recovery_faces" => tensors.recovery.is_some(),
        "recovery_face_offsets" => tensors.recovery.as_ref().is_some_and(|recovery| recovery.faces().is_some()),
        "recovery_positions" => tensors.recovery.as_ref().is_some_and(|recovery| recovery.positions().is_some()),
        _ => true,
    };
    let of_file = |unvouched: &Unvouched| match unvouched.field {
        RECOVERY if compared == Compared::Alone && !recovery::is_tied(superelement) => UNTIED_RECOVERY,
        _ => *unvouched,
    };
    list.iter().filter(is_there).map(of_file).collect()
}

/// Whether an interface of a kept job has axes along a hole.
fn is_along_hole(interface: &serde_json::Value) -> bool {
    interface["axes"] == "hole"
}

/// What a superelement was compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compared {
    Alone,
    WithJob,
}
