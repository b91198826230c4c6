//! Supports that a component cannot have.

use supel::cli::ExitCode;
use supel_models::random::SplitMix64;
use supel_models::{Inertia, Material, Section, frame};
use supel_testing::place::{Place, steel_brick, supel};

use crate::{Case, elbow};

fn refused(interface: &'static str, fixed: &'static str) -> (ExitCode, String) {
    let case = Case { name: "refused", model: steel_brick(), interface, fixed, has_nodes: true };
    let (_, ended) = case.run("herting", 3);
    (ended.code, ended.err)
}

#[track_caller]
fn assert_says((code, said): &(ExitCode, String), expected: ExitCode, words: &[&str]) {
    assert_eq!(*code, expected, "{said}");
    words.iter().for_each(|word| assert!(said.contains(word), "{word:?} is not in {said}"));
}

const TIP: &str = r#"{ name = "tip", nodes = [5, 15, 45] }"#;
const PATCH: &str =
    r#"{ name = "tip", coupling = "rigid", nodes = { within = { box = { min = [0.9, 0, 0], max = [1, 1, 1] } } } }"#;

/// E-FIXED-INTERFACE: an own dof of a node, and a member of a patch.
#[test]
fn held_dof_of_an_interface() {
    let words = ["E-FIXED-INTERFACE", "node 15 uy", "fixed \"wall\"", "interface \"tip\"", "take it out of one"];
    let wall = r#"{ name = "foot", nodes = [1] }, { name = "wall", nodes = [2, 15], dofs = ["uy"] }"#;
    assert_says(&refused(TIP, wall), ExitCode::InputData, &words);
    assert_says(&refused(PATCH, wall), ExitCode::InputData, &words);
    // Other directions of an interface node may be held.
    let interface = r#"{ name = "tip", nodes = [5, 15, 45], dofs = ["ux", "uz"] }"#;
    let case = Case { name: "slide", model: steel_brick(), interface, fixed: wall, has_nodes: true };
    case.made("herting", 3);
}

/// E-INTERFACE-RANK where supports leave one motion and the interface lies on its axis: all that moves it is rounding, and there is no
/// other motion to compare that with.
#[test]
fn interface_on_the_axis_that_supports_leave() {
    let nodes = [0.0, 1.0, 2.0].map(|t| [0.7 * t, 0.31 * t, 0.23 * t]);
    let nodes = [nodes[0], nodes[1], nodes[2], [1.5, 1.2, 0.1], [0.9, 1.4, 0.6]];
    let model = frame(
        &nodes,
        &[[0, 1], [1, 2], [2, 3], [3, 4]],
        &Section::round(0.05),
        &Material::STEEL_SI,
        Inertia::Consistent,
    );
    let fixed = r#"{ nodes = [1], dofs = ["ux", "uy", "uz"] }, { nodes = [3], dofs = ["uy", "uz"] }"#;
    for interface in
        [r#"{ name = "a", nodes = [2], dofs = ["ux"] }"#, r#"{ name = "a", nodes = [2], dofs = ["ux", "uz"] }"#]
    {
        let case = Case { name: "axis", model: model.clone(), interface, fixed, has_nodes: true };
        for method in ["herting", "craig-bampton"] {
            let (_, ended) = case.run(method, 3);
            let words = ["E-INTERFACE-RANK", "only 0 of the 1 rigid-body motion", "rotation about the axis"];
            assert_says(&(ended.code, ended.err), ExitCode::ModelPhysics, &words);
        }
    }
}

/// A line along no axis: what the interface moves there by the rotation that supports leave is rounding, and no share of itself makes it more.
#[test]
fn interface_on_a_line_that_supports_leave() {
    let mut random = SplitMix64::new(5);
    for _ in 0..8 {
        let [origin, along] = [0.3, 1.0].map(|size| [0; 3].map(|_| size * random.normal()));
        let at = |t: f64| [0, 1, 2].map(|axis| origin[axis] + t * along[axis]);
        let [middle, end] = [0.2 + 1.8 * random.uniform(), 2.0 + 1.8 * random.uniform()];
        let off = [[1.5, 1.2, 0.1], [0.9, 1.4, 0.6]].map(|by| [0, 1, 2].map(|axis| origin[axis] + by[axis]));
        let model = frame(
            &[at(0.0), at(middle), at(end), off[0], off[1]],
            &[[0, 1], [1, 2], [2, 3], [3, 4]],
            &Section::round(0.05),
            &Material::STEEL_SI,
            Inertia::Consistent,
        );
        let fixed = r#"{ nodes = [1], dofs = ["ux", "uy", "uz"] }, { nodes = [3], dofs = ["uy", "uz"] }"#;
        for interface in [
            r#"{ name = "a", nodes = [2], dofs = ["ux"] }"#,
            r#"{ name = "a", nodes = [2], dofs = ["ux", "uy", "uz"] }"#,
        ] {
            let case = Case { name: "line", model: model.clone(), interface, fixed, has_nodes: true };
            let (_, ended) = case.run("herting", 3);
            let words = ["E-INTERFACE-RANK", "only 0 of the 1 rigid-body motion", "rotation about the axis"];
            assert_says(&(ended.code, ended.err), ExitCode::ModelPhysics, &words);
            // An amplitude of the rotation needs no interface that reacts it, and what rounding leaves of its energy is no force.
            let (place, ended) = case.run("rubin", 3);
            assert!(ended.code == ExitCode::Done && !ended.out.contains("! warn"), "{}{}", ended.out, ended.err);
            for job in [&[][..], &["--job", &place.text("job.toml")]] {
                let verified = supel(&[&["verify", &place.text("x.supel")], job].concat());
                assert!(verified.code == ExitCode::Done && !verified.out.contains("! warn"), "{}", verified.out);
            }
        }
    }
}

#[test]
fn selections_of_nothing() {
    let nowhere = "{ nodes = { within = { sphere = { center = [9, 9, 9], radius = 1 } } } }";
    for (fixed, words) in [
        (nowhere, ["E-INTERFACE-EMPTY", "fixed \"fixed[0]\" selects no node"]),
        (r#"{ name = "foot", nodes = "group:FOOT" }"#, ["E-GROUP", "fixed \"foot\": no group \"FOOT\""]),
        ("{ nodes = [1] }, { nodes = [999] }", ["E-CONSTRAINED-INTERFACE", "fixed \"fixed[1]\": node 999"]),
        (r#"{ nodes = [1], dofs = ["ux", "rx"] }"#, ["E-DOF-MISSING", "node 1 rx does not exist"]),
        ("{ nodes = { rows = [0, 135] } }", ["E-INTERFACE-ROW", "row 135 does not exist"]),
    ] {
        assert_says(&refused(TIP, fixed), ExitCode::InputData, &words);
    }
}

#[test]
fn mistakes_in_the_job() {
    for (fixed, words) in [
        ("{ nodes = [1, 2, 1] }", ["E-DUP-INTERFACE", "node 1 is listed twice"]),
        (r#"{ nodes = [1], dofs = ["ux", "ux"] }"#, ["E-DUP-INTERFACE", "direction ux is listed twice"]),
        (r#"{ nodes = [1], dofs = [] }"#, ["E-JOB-EMPTY", "fixed[0].dofs"]),
        (r#"{ nodes = [1], name = " " }"#, ["E-JOB-EMPTY", "fixed[0].name"]),
        (r#"{ nodes = "FOOT" }"#, ["E-INTERFACE-NODES", "group:NAME"]),
        (r#"{ nodes = { rows = [1] }, dofs = ["ux"] }"#, ["E-INTERFACE-KEY", "`dofs` has no meaning for rows"]),
        (r#"{ name = "a", nodes = [1] }, { name = "a", nodes = [2] }"#, ["E-FIXED-NAME", "`a` is defined twice"]),
        ("{ node = [1] }", ["E-JOB-KEY", "did you mean `nodes`"]),
    ] {
        assert_says(&refused(TIP, fixed), ExitCode::Usage, &words);
    }
}

/// E-FIXED-ALL: every dof, and every dof with mass.
#[test]
fn nothing_left_to_move() {
    let everything = "{ nodes = { within = { sphere = { center = [0, 0, 0], radius = 9 } } } }";
    let said = refused("", everything);
    assert_says(&said, ExitCode::InputData, &["E-FIXED-ALL", "holds 135 dofs of 135", "no dof is left"]);
    let model = supel_models::Model { mass: vec![(0, 0, 1.0), (1, 1, 1.0), (2, 2, 1.0)], ..elbow() };
    let case = Case { name: "massless", model, interface: "", fixed: "{ nodes = [1] }", has_nodes: true };
    let (_, ended) = case.run("herting", 3);
    assert_says(&(ended.code, ended.err), ExitCode::InputData, &["E-FIXED-ALL", "no dof with mass is left"]);
}

/// A dof that two selections name is held once.
#[test]
fn a_dof_held_twice_is_held_once() {
    let fixed = r#"{ nodes = [1, 6] }, { nodes = [6, 11], dofs = ["ux"] }"#;
    let case = Case { name: "twice", model: steel_brick(), interface: TIP, fixed, has_nodes: true };
    let held = &case.made("herting", 3).report["body"]["model"]["held"];
    assert_eq!(held["n_dofs"], 7);
    assert_eq!([&held["selections"][0]["n_dofs"], &held["selections"][1]["n_dofs"]], [6, 2]);
}

#[test]
fn flags_that_cannot_be_read() {
    let place = Place::with_brick();
    for (flag, words) in [
        ("foot", "NAME=NODES[:DOFS]"),
        ("foot=1,x", "node labels, group:NAME or rows:0,1,2"),
        ("foot=1,2:up", "node labels, group:NAME or rows:0,1,2"),
        ("foot=rows:a", "row numbers from zero"),
        ("foot=rows:1:ux", "`dofs` has no meaning for rows"),
    ] {
        let ended = place
            .reduce(&place.model_flags(), &format!("--interface tip=5,15 --method herting --modes 2 --fix {flag}"));
        assert_says(&(ended.code, ended.err), ExitCode::Usage, &[words]);
    }
    let twice = "--interface tip=5,15,45 --method herting --modes 2 --fix foot=1 --fix foot=6";
    let ended = place.reduce(&place.model_flags(), twice);
    assert_says(&(ended.code, ended.err), ExitCode::Usage, &["E-FIXED-NAME"]);
    assert_eq!(supel(&["reduce", "--fix"]).code, ExitCode::Usage);
}
