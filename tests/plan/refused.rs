//! Scenes that cannot be heeded.

use supel::cli::ExitCode;

use crate::{CRAIG_BAMPTON, Case, PATCH_AND_NODES, PATCHES};

#[track_caller]
fn refused(scene: &'static str, code: ExitCode, words: &[&str]) {
    let (place, ended) = Case::new(PATCHES, CRAIG_BAMPTON, scene).run(&[]);
    let ended = ended.expect(code);
    words.iter().for_each(|words| assert!(ended.err.contains(words), "{}", ended.err));
    assert!(!place.path("x.supel").exists());
}

#[test]
fn all_dofs_at_rest_leave_a_component_without_interface() {
    // Held at both ends, it has modes of its own; that nothing holds it and nothing drives it is another matter.
    let (place, ended) = Case::new(PATCHES, CRAIG_BAMPTON, "grounded = [\"root\", \"tip\"]").run(&[]);
    ended.expect(ExitCode::Done);
    assert_eq!(place.superelement("x.supel").n_interface(), 0);
}

#[test]
fn names_and_contradictions() {
    refused("grounded = [\"foot\"]", ExitCode::Usage, &["E-SCENE-PART", "`foot`"]);
    refused("grounded = [\"root\"]\nunloaded = [\"root.rx\"]", ExitCode::Usage, &["E-SCENE-CONFLICT", "`root`"]);
    refused("grounded = [\"root\"]\nboundaries = [\"fix:root\"]", ExitCode::Usage, &["E-SCENE-LEFT-OUT", "grounded"]);
    refused("analysis = \"static\"\nband_hz = [0, 100]", ExitCode::Usage, &["E-SCENE-STATIC", "band_hz"]);
}

/// Modes cannot be computed with that held which the superelement does not have.
#[test]
fn what_is_held_for_modes_must_be_left() {
    const MIXED: &str = "method = \"mixed-interface\", modes = { count = 4 }, held = [\"root\", \"tip.ux\"]";
    for scene in ["grounded = [\"root\"]", "unloaded = [\"tip.ux\"]"] {
        let (_, ended) = Case::new(PATCHES, MIXED, scene).run(&[]);
        let ended = ended.expect(ExitCode::Usage);
        assert!(ended.err.contains("E-SCENE-LEFT-OUT") && ended.err.contains("reduction.held"), "{}", ended.err);
    }
    let carried = "method = \"mixed-interface\", modes = { count = 4 }, held = [\"table\"]";
    let scene = "prescribed = [{ name = \"table\", interfaces = [\"tip\"] }]";
    let made = Case::new(PATCH_AND_NODES, carried, scene).made();
    assert_eq!(made.file.metadata().modes_held, (6..12).collect::<Vec<usize>>());
}

/// One node of three dofs does not tell the rotations of a carrier.
#[test]
fn a_carrier_that_its_nodes_do_not_determine() {
    let one_node = "[[interface]]\nname = \"tip\"\nnodes = [7]\n";
    let scene = "prescribed = [{ name = \"table\", interfaces = [\"tip\"] }]";
    let (_, ended) = Case::new(one_node, CRAIG_BAMPTON, scene).run(&[]);
    let ended = ended.expect(ExitCode::InputData);
    assert!(ended.err.contains("E-PATCH") && ended.err.contains("table"), "{}", ended.err);
}

/// A mass and springs act along every translation; where one moves and is no dof of the interface, nothing can act on it.
#[test]
fn boundaries_that_could_act_in_some_directions_alone() {
    const ALONG: &str =
        "[[interface]]\nname = \"root\"\nnodes = [1, 22, 57]\n[[interface]]\nname = \"tip\"\nnodes = [7, 28, 63]\n";
    let with_dofs = Box::leak(format!("{ALONG}dofs = [\"uy\", \"uz\"]\n").into_boxed_str());
    let of_job: [(&'static str, &'static str); 4] = [
        (PATCHES, "unloaded = [\"tip.ux\"]"),
        (ALONG, "unloaded = [\"tip.ux\"]"),
        (PATCHES, "connected = [\"root\", \"tip.uy\", \"tip.uz\"]"),
        (with_dofs, ""),
    ];
    for (interfaces, scene) in of_job {
        for boundary in ["mass:tip=1", "mass:tip", "spring:tip=1e6"] {
            let scene = Box::leak(format!("{scene}\nboundaries = [\"free\", \"{boundary}\"]").into_boxed_str());
            let (place, ended) = Case::new(interfaces, CRAIG_BAMPTON, scene).run(&[]);
            let ended = ended.expect(ExitCode::Usage);
            let words = ["E-BOUNDARY-DOFS", "of tip – found ux left out"];
            words.iter().for_each(|words| assert!(ended.err.contains(words), "{}", ended.err));
            assert!(!place.path("x.supel").exists());
        }
    }
    // At rest it needs no force, a ball joint passes no moment, and the masses of the default say what they leave out.
    for scene in ["grounded = [\"tip.ux\"]", "unloaded = [\"tip.rx\"]"] {
        let scene = Box::leak(format!("{scene}\nboundaries = [\"mass:tip=1\", \"spring:tip=1e6\"]").into_boxed_str());
        Case::new(PATCHES, CRAIG_BAMPTON, scene).made();
    }
    let made =
        Case { rest: "[run]\ncertify = \"full\"", ..Case::new(PATCHES, CRAIG_BAMPTON, "unloaded = [\"tip.ux\"]") }
            .made();
    let text = made.report["body"]["preservation"]["boundaries"].to_string();
    assert!(text.contains("but not along ux"), "{text}");
}

/// A load on what the scene says is unloaded would make its file say two things.
#[test]
fn loads_on_what_is_unloaded() {
    let of = |interfaces: &'static str, scene: &'static str, load: &str| {
        let rest: &'static str = Box::leak(format!("[[load]]\nname = \"pull\"\n{load}\n").into_boxed_str());
        Case { rest, ..Case::new(interfaces, CRAIG_BAMPTON, scene) }
    };
    const TIP: &str = "nodes = [7, 28, 63]\nforce = [1, 0, 0]";
    let refused = [
        (PATCHES, "unloaded = [\"tip.ux\"]", TIP, "on tip.ux –"),
        (PATCHES, "unloaded = [\"tip\"]", TIP, "on tip.ux,"),
        // Its three nodes have one name.
        (PATCH_AND_NODES, "unloaded = [\"tip.ux\"]", TIP, "on tip.ux –"),
        (PATCH_AND_NODES, "connected = [\"root\"]", "nodes = [28]\nforce = [0, 2, 0]", "on tip.uy –"),
    ];
    for (interfaces, scene, load, words) in refused {
        let case = of(interfaces, scene, load);
        let (place, ended) = case.run(&[]);
        let ended = ended.expect(ExitCode::Usage);
        let words = ["E-SCENE-LOAD", "load pull", words];
        // The moment of three nodes about the mean of the patch is there as well, where rotations are unloaded.
        words.iter().for_each(|words| assert!(ended.err.contains(words), "{scene}: {}", ended.err));
        assert!(!place.path("x.supel").exists());
        // Where nothing is left out they are coordinates, and the file claims nothing of them.
        case.made_with(&["--no-skip"]);
    }
    let heeded = [
        (PATCHES, "unloaded = [\"tip.uz\"]", TIP),
        (PATCH_AND_NODES, "unloaded = [\"tip.uy\"]", TIP),
        (PATCHES, "unloaded = [\"tip.ux\"]", "rotation = { axis = [0, 0, 1] }"),
        (PATCHES, "unloaded = [\"tip.ux\"]", "nodes = [4]\nforce = [1, 0, 0]"),
    ];
    for (interfaces, scene, load) in heeded {
        of(interfaces, scene, load).made();
    }
}
