//! Held in the job or left out of the matrices by hand: one superelement.

use supel::cli::ExitCode;
use supel_models::transform::{join, supported};
use supel_models::{Ends, Inertia, Material, Model, Section, frame, spring};
use supel_runtime::Tensors;
use supel_testing::place::{Place, steel_brick, supel, warnings_of_reduction};

use crate::{Case, METHODS, elbow, n_rigid};

type Dof = (i64, u8);
/// Whether a dof is held.
type Holds = fn(Dof) -> bool;

/// A case, which dofs it holds, and how many rigid-body modes are left.
fn cases() -> Vec<(Case, Holds, u64)> {
    let tip = r#"{ name = "tip", nodes = [5, 15, 45] }"#;
    let patch = r#"{ name = "tip", coupling = "rigid", nodes = { within = { box = { min = [0.9, 0, 0], max = [1, 1, 1] } } } }"#;
    let foot = r#"{ nodes = { within = { plane = { point = [0, 0, 0], normal = [1, 0, 0], tolerance = 0.01 } } }, name = "foot" }"#;
    let case = |name, model, interface, fixed| Case { name, model, interface, fixed, has_nodes: true };
    vec![
        (case("clamped face, nodes", steel_brick(), tip, foot), |(node, _)| node % 5 == 1, 0),
        (case("clamped face, patch", steel_brick(), patch, foot), |(node, _)| node % 5 == 1, 0),
        (case("one point of a solid", steel_brick(), tip, "{ nodes = [1] }"), |(node, _)| node == 1, 3),
        (case("clamped face, no interface", steel_brick(), "", foot), |(node, _)| node % 5 == 1, 0),
        (
            case("a hinge along z", elbow(), r#"{ name = "tip", nodes = [6] }"#, HINGE),
            |(node, direction)| node == 1 && direction != 5,
            1,
        ),
        (
            case("two parts on one foot", elbow(), r#"{ name = "ends", nodes = [1, 6] }"#, "{ nodes = [3] }"),
            |(node, _)| node == 3,
            0,
        ),
        (
            case(
                "in a plane",
                steel_brick(),
                r#"{ name = "tip", nodes = [5, 15, 45], dofs = ["ux", "uy"] }"#,
                r#"{ nodes = { within = { sphere = { center = [0, 0, 0], radius = 9 } } }, dofs = ["uz"] }"#,
            ),
            |(_, direction)| direction == 2,
            3,
        ),
    ]
}

const HINGE: &str = r#"{ name = "hinge", nodes = [1], dofs = ["uz", "ux", "uy", "rx", "ry"] }"#;

/// Everything but the loads of gravity, which rows that are not there have no part in.
fn without_gravity(tensors: &Tensors) -> Tensors {
    Tensors { gravity: None, recovery: None, ..tensors.clone() }
}

/// Bit by bit: T has empty rows, so that TᵀKT and TᵀMT are the matrices without them, and everything after is told no more.
#[test]
fn held_dofs_are_rows_left_out_of_both_matrices() {
    for (case, is_held, n_r) in cases() {
        let by_hand = Case { model: supported(&case.model, is_held), fixed: "", name: case.name, ..case };
        for method in METHODS {
            let (held, left_out) = (case_of(&case).made(method, 6), by_hand.made(method, 6));
            let name = format!("{}, {method}", case.name);
            assert_eq!(without_gravity(held.file.tensors()), without_gravity(left_out.file.tensors()), "{name}");
            assert_eq!(held.file.metadata().coordinates, left_out.file.metadata().coordinates, "{name}");
            assert_eq!(held.file.metadata().model.n_dofs, left_out.file.metadata().model.n_dofs, "{name}");
            assert_eq!([n_rigid(&held.report), n_rigid(&left_out.report)], [n_r; 2], "{name}");
            // As much work: where nothing is rigid, nothing rigid is factored.
            assert_eq!(held.report["run"]["work"], left_out.report["run"]["work"], "{name}");
            assert_eq!(held.report["body"]["completeness"]["is_certified"], true, "{name}");
            assert_eq!(
                held.report["body"]["model"]["n_bodies"], left_out.report["body"]["model"]["n_bodies"],
                "{name}"
            );
            let warnings = warnings_of_reduction(&held.report);
            assert!(warnings.is_empty(), "{name}: a support of the job is no weak spring: {warnings:?}");
        }
    }
}

/// A stiff frame on a leg that gives way a million times more easily: standing on the ground by the matrices alone it seems free but
/// for a weak spring, which is a warning. Where the job holds the foot, the leg is meant.
#[test]
fn a_soft_leg_is_no_weak_spring() {
    let stiff = |nodes: &[[f64; 3]], edges: &[[usize; 2]], radius| {
        frame(nodes, edges, &Section::round(radius), &Material::STEEL_SI, Inertia::Consistent)
    };
    let body =
        stiff(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.9, 0.0], [0.2, 0.8, 0.7]], &[[0, 1], [1, 2], [2, 3], [3, 0]], 0.1);
    let leg = stiff(&[[0.0; 3], [0.0, 0.0, -0.5]], &[[0, 1]], 0.002);
    let model = join(&body, &leg, &[(1, 1)]);
    let foot = 6;
    assert!(model.dofs.iter().any(|dof| dof.0 == foot));
    let case = Case {
        name: "leg",
        model,
        interface: r#"{ name = "top", nodes = [3] }"#,
        fixed: "{ nodes = [6] }",
        has_nodes: true,
    };
    let by_hand = Case { model: supported(&case.model, |(node, _)| node == foot), fixed: "", ..case_of(&case) };
    let codes = |case: &Case| {
        let report = case.made("herting", 6).report;
        let warnings = report["body"]["warnings"].as_array().expect("a list").clone();
        warnings.iter().map(|warning| warning["code"].as_str().expect("a code").to_owned()).collect::<Vec<_>>()
    };
    assert!(codes(&by_hand).contains(&"W-GROUNDED".to_owned()), "{:?}", codes(&by_hand));
    assert!(!codes(&case).contains(&"W-GROUNDED".to_owned()), "{:?}", codes(&case));
}

fn case_of(case: &Case) -> Case {
    Case { model: case.model.clone(), ..*case }
}

/// Without nodes and map, by the rows of the files.
#[test]
fn rows_of_a_chain() {
    let case = |model: Model, interface, fixed| Case { name: "chain", model, interface, fixed, has_nodes: false };
    let held =
        case(spring(12, Ends::Free), r#"{ name = "end", nodes = { rows = [11] } }"#, "{ nodes = { rows = [0] } }");
    // Row 0 held leaves a chain of eleven, its first mass tied to the ground.
    let by_hand = case(
        supported(&spring(12, Ends::Free), |(node, _)| node == 1),
        r#"{ name = "end", nodes = { rows = [10] } }"#,
        "",
    );
    for method in METHODS {
        let (held, by_hand) = (held.made(method, 4), by_hand.made(method, 4));
        assert_eq!(held.file.tensors(), by_hand.file.tensors(), "{method}");
        assert_eq!(n_rigid(&held.report), 0);
    }
}

/// What `supel verify` makes of it: alone, against the model, and made again.
#[test]
fn verification_holds_the_same_dofs() {
    let (case, ..) = cases().into_iter().find(|(case, ..)| case.name == "a hinge along z").expect("a case");
    let made = case.made("herting", 6);
    let (file, job) = (made.place.text("x.supel"), made.place.text("job.toml"));
    for args in [&["verify", &file] as &[&str], &["verify", &file, "--job", &job], &["verify", &file, "--reproduce"]] {
        let ended = supel(&[args, &["--strict"]].concat());
        assert_eq!(ended.code, ExitCode::Done, "{args:?}: {}{}", ended.out, ended.err);
    }
    // A job that holds other dofs, or none, made another component.
    for fixed in ["", "{ name = \"hinge\", nodes = [1] }"] {
        made.place.write("other.toml", case.job("herting", 6, &format!("fixed = [{fixed}]")).as_bytes());
        let ended = supel(&["verify", &file, "--job", &made.place.text("other.toml")]);
        assert_eq!(ended.code, ExitCode::CheckFailed, "{fixed}: {}{}", ended.out, ended.err);
    }
}

/// The free component is compared with its coordinates before anything is held: a map in another order is found, as without supports.
#[test]
fn supports_of_the_job_hide_no_wrong_map() {
    let mut model = steel_brick();
    // uy of two nodes along x: a rotation about z moves them differently.
    model.dofs.swap(61, 64);
    let place = Place::with(&model);
    let fixed = "--interface tip=5,15,45 --method herting --modes 3 --fix foot=1,6,11";
    let ended = place.reduce(&place.model_flags(), fixed);
    assert_eq!(ended.code, ExitCode::InputData, "{}{}", ended.out, ended.err);
    assert!(ended.err.contains("E-COORD"), "{}", ended.err);
}
