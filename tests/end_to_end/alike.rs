//! A reduction and both verifications of its file come to one conclusion, with no word of a cause that is not there.

use std::collections::BTreeSet;

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::model::Assembler;
use supel_models::transform::{rounded, translated};
use supel_models::{Inertia, Material, Model, Section, frame};

use crate::place::{Place, steel_brick, supel, warnings_of_reduction};

/// A bent frame of twelve beams, one metre long; node 7 is its corner.
fn bent() -> Model {
    let at = |k: usize| {
        if k < 7 { [k as f64 / 12.0, 0.0, 0.0] } else { [0.5, (k - 6) as f64 / 12.0, 0.02 * (k - 6) as f64] }
    };
    let nodes: Vec<[f64; 3]> = (0..13).map(at).collect();
    let edges: Vec<[usize; 2]> = (0..12).map(|k| [k, k + 1]).collect();
    frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent)
}

/// Its two ends.
const ENDS: &str = "first=1 second=13";

/// The frame with a mass at a node of its own, beyond its last one.
fn with_mass(offset: [f64; 3]) -> Model {
    let model = bent();
    let tip = model.nodes[12];
    let n = model.n as u32;
    let mut nodes = model.nodes.clone();
    nodes.push([tip[0] + offset[0], tip[1] + offset[1], tip[2] + offset[2]]);
    let mut mass = Assembler::default();
    mass.extend(model.mass.iter().copied());
    (0..6).for_each(|direction| mass.add(n + direction, n + direction, [0.2, 1e-4][(direction / 3) as usize]));
    Model::of_entries(nodes, &[0, 1, 2, 3, 4, 5], model.stiffness.clone(), mass.finish())
}

/// That mass tied to the frame by a rigid link of so many times the largest stiffness.
fn linked(penalty: f64) -> Model {
    let r = [0.05, 0.03, 0.02];
    let model = with_mass(r);
    let stiffness = penalty * model.stiffness.iter().fold(0.0f64, |most, entry| most.max(entry.2));
    // u₁₄ − u₁₃ − θ₁₃ × r and θ₁₄ − θ₁₃, each a row over the dofs of both nodes.
    let turned = [[0.0, r[2], -r[1]], [-r[2], 0.0, r[0]], [r[1], -r[0], 0.0]];
    let row = |equation: usize, column: usize| match (column / 6, equation < 3 && column % 6 >= 3) {
        (1, _) => f64::from(u8::from(column - 6 == equation)),
        (_, true) => -turned[equation][column % 6 - 3],
        _ => -f64::from(u8::from(column == equation)),
    };
    let mut sum = Assembler::default();
    sum.extend(model.stiffness.iter().copied());
    for i in 0..12 {
        for j in 0..12 {
            let product: f64 = (0..6).map(|equation| row(equation, i) * row(equation, j)).sum();
            sum.add((72 + i) as u32, (72 + j) as u32, stiffness * product);
        }
    }
    Model { stiffness: sum.finish(), ..model }
}

/// Codes of the warnings of a report.
fn codes(report: &Value) -> BTreeSet<String> {
    warnings_of_reduction(report).into_iter().collect()
}

/// What the run and both verifications of its file end with, and its warnings.
fn ended(place: &Place, flags: &str) -> (Vec<ExitCode>, BTreeSet<String>) {
    let ended = place.reduce(&place.model_flags(), flags);
    let report = place.path("x.report.json");
    assert!(report.exists(), "{flags}: {}", ended.err);
    let mut all = vec![ended.code];
    if ended.code == ExitCode::Done {
        let file = place.text("x.supel");
        place.write("job.json", supel(&["inspect", &file, "--job"]).out.as_bytes());
        let job = place.text("job.json");
        for rest in [&[][..], &["--job", &job]] {
            all.push(supel(&[&["verify", &file, "--quiet"], rest].concat()).code);
        }
    }
    (all, codes(&place.report("x.report.json")))
}

fn flags(coupling: &str, interfaces: &str, method: &str) -> String {
    let interfaces: Vec<String> = interfaces.split(' ').map(|one| format!("--{coupling} {one}")).collect();
    format!("{} --method {method} --modes 6", interfaces.join(" "))
}

#[test]
fn of_rigid_links_of_any_size() {
    let mut n_verified = 0;
    for exponent in 2..9 {
        let place = Place::with(&linked(10f64.powi(exponent)));
        for method in ["herting", "craig-bampton"] {
            for interfaces in ["first=1", "first=1 mass=14"] {
                let flags = flags("interface", interfaces, method);
                let refused = place.reduce(&place.model_flags(), &flags);
                if refused.code != ExitCode::Done && refused.code != ExitCode::CheckFailed {
                    assert!(exponent >= 7 && refused.err.contains("penalty"), "1e{exponent}, {flags}: {}", refused.err);
                    continue;
                }
                let (codes, warnings) = ended(&place, &flags);
                let at = format!("1e{exponent}, {method}, {interfaces}: {codes:?} {warnings:?}");
                assert!(codes.iter().all(|code| *code == codes[0]), "{at}");
                n_verified += usize::from(codes[0] == ExitCode::Done);
                // What fails has its cause named.
                assert!(codes[0] == ExitCode::Done || warnings.contains("W-PENALTY"), "{at}");
            }
        }
    }
    // Up to ten thousand times the stiffness of the frame nothing is lost that a check asks for.
    assert!(n_verified >= 12, "{n_verified} verified");
}

#[test]
fn of_few_digits() {
    for digits in 6..10 {
        let place = Place::with(&rounded(&bent(), digits));
        for method in ["herting", "craig-bampton"] {
            let run = place.reduce(&place.model_flags(), &flags("interface", ENDS, method));
            if run.code == ExitCode::Done {
                let (codes, warnings) = ended(&place, &flags("interface", ENDS, method));
                assert_eq!(codes, [ExitCode::Done; 3], "{digits} digits, {method}: {warnings:?}");
            }
        }
    }
}

/// Levers about a far origin cancel; what is left is known to what they leave, and nothing is wrong with the coordinates.
#[test]
fn of_a_part_far_from_the_origin() {
    for distance in [1e2, 1e4, 1e6] {
        let place = Place::with(&translated(&steel_brick(), [distance, distance, 0.0]));
        for method in ["herting", "craig-bampton"] {
            for coupling in ["interface", "rigid-interface"] {
                let (codes, warnings) = ended(&place, &flags(coupling, "first=1,6,11,16 second=5,10,15,20", method));
                let at = format!("{distance:e}, {coupling}, {method}");
                assert!(codes == [ExitCode::Done; 3] && warnings.is_empty(), "{at}: {codes:?} {warnings:?}");
                assert_inertia_is_known_to_what_levers_leave(&place, distance);
            }
        }
    }
}

/// Another program, or another order of sums, states an inertia that differs in the digits which the levers of a far origin take.
#[track_caller]
fn assert_inertia_is_known_to_what_levers_leave(place: &Place, distance: f64) {
    let file = place.superelement("x.supel");
    let (tensors, mut metadata) = (file.tensors().clone(), file.metadata().clone());
    let stated = metadata.model.mass_properties.as_mut().expect("mass properties");
    // The part is some units long: ε of the lever's square.
    stated.inertia[0][0] *= 1.0 + f64::EPSILON * distance * distance;
    supel_runtime::Superelement::new(tensors, metadata)
        .expect("sound")
        .write(&place.path("other.supel"))
        .expect("written");
    supel(&["verify", &place.text("other.supel"), "--job", &place.text("job.json"), "--quiet"]).expect(ExitCode::Done);
}

/// A patch of all nodes makes the part rigid, whatever its inertia: that is said, and no dof of it blamed.
#[test]
fn of_a_patch_of_all_nodes() {
    let model = steel_brick();
    let all: Vec<String> = model.labels.iter().map(ToString::to_string).collect();
    let place = Place::with(&model);
    for method in ["herting", "craig-bampton"] {
        let ended =
            place.reduce(&place.model_flags(), &flags("rigid-interface", &format!("all={}", all.join(",")), method));
        assert!(ended.err.contains("error[E-WHOLLY-RIGID]"), "{method}: {}", ended.err);
        // One node less is a part that can deform.
        let but_one = format!("all={}", all[1..].join(","));
        place.reduce(&place.model_flags(), &flags("rigid-interface", &but_one, method)).expect(ExitCode::Done);
    }
}

/// A mass without stiffness is no free particle where a rigid patch ties it to the part.
#[test]
fn of_a_mass_tied_by_a_rigid_patch() {
    let place = Place::with(&with_mass([0.05, 0.03, 0.02]));
    for method in ["herting", "craig-bampton"] {
        let (codes, warnings) = ended(&place, &flags("rigid-interface", "tip=13,14 root=1,2", method));
        assert!(codes == [ExitCode::Done; 3] && warnings.is_empty(), "{method}: {codes:?} {warnings:?}");
    }
    // A particle outside of the patch is one still.
    let (_, warnings) = ended(&place, &flags("interface", "root=1 mass=14", "craig-bampton"));
    assert!(warnings.contains("W-FREE-PARTICLE"), "{warnings:?}");
}

/// Springs against the rotations of one node, which hold the frame at a millionth of its first elastic frequency or at a thousandth.
#[test]
fn of_soft_springs_against_rotation() {
    let model = bent();
    for stiffness in [1e-6, 1e-4, 1e-3] {
        let springs = (0..3u32).map(|axis| (39 + axis, 39 + axis, stiffness));
        let mut sum = Assembler::default();
        sum.extend(model.stiffness.iter().copied().chain(springs));
        let place = Place::with(&Model { stiffness: sum.finish(), ..model.clone() });
        let run = place.reduce(&place.model_flags(), &flags("interface", ENDS, "herting"));
        assert!(place.path("x.report.json").exists(), "{stiffness}: {}", run.err);
        let warnings = codes(&place.report("x.report.json"));
        assert!(run.code == ExitCode::Done || warnings.contains("W-GROUNDED"), "{stiffness}: {warnings:?} {}", run.err);
    }
}

/// An origin typed in another unit is what is named first, and one that is merely far is warned of.
#[test]
fn of_an_origin_in_another_unit() {
    let place = Place::with_brick();
    let job = |origin: &str| {
        let text = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [
    {{ name = "a", nodes = [1, 6, 11, 16], coupling = "rigid" }},
    {{ name = "b", nodes = [5, 10, 15, 20], coupling = "rigid", origin = {origin} }},
]
reduction = {{ method = "herting", modes = {{ count = 5 }} }}
write     = {{ superelement = "x.supel" }}
"#
        );
        place.write("job.toml", text.as_bytes());
        supel(&["reduce", &place.text("job.toml")])
    };
    for origin in ["[1000.0, 0.0, 0.0]", "[1e5, 0.0, 0.0]", "[1e7, 0.0, 0.0]"] {
        let ended = job(origin);
        assert!(ended.err.contains("error[E-ORIGIN-FAR]"), "{origin}: {}", ended.err);
        assert!(ended.err.contains("interface \"b\""), "{origin}: {}", ended.err);
    }
    assert_eq!(job("[20.0, 0.0, 0.0]").code, ExitCode::Done);
    assert!(codes(&place.report("x.report.json")).contains("W-ORIGIN-FAR"));
    assert_eq!(job("[2.0, 0.0, 0.0]").code, ExitCode::Done);
    assert!(!codes(&place.report("x.report.json")).contains("W-ORIGIN-FAR"));
}
