//! Superelements joined, exported as one model and reduced again: against the model in one piece, reduced by nobody.

use serde_json::Value;
use supel::assembly::{Assembly, Component};
use supel::cli::ExitCode;
use supel_models::transform::{join, supported, translated};
use supel_models::{Material, Model, brick, spectrum};
use supel_runtime::{Coordinate, Superelement};
use supel_testing::place::{Ended, Place, frequencies_hz, supel};

use crate::{all_modes, assert_enclosed, beams, hertz, line, n_rigid};

/// A folder with left.supel and right.supel.
fn halves([left, right]: [(&Model, &str); 2]) -> Place {
    let place = Place::new();
    for (name, (model, flags)) in [("left", left), ("right", right)] {
        let own = Place::with(model);
        let files = if model.dofs.is_empty() { own.matrix_flags() } else { own.model_flags() };
        own.reduce(&files, flags).expect(ExitCode::Done);
        place.write(&format!("{name}.supel"), &own.bytes("x.supel"));
    }
    place
}

/// The line in two halves, which meet in its seventh node.
fn lines(method: &str) -> Place {
    let (left, right) = (beams(&line()[..7]), beams(&line()[6..]));
    let of_left = format!("--interface end=1 --interface middle=7 {method}");
    let of_right = format!("--interface middle=1 --interface end=7 {method}");
    halves([(&left, &of_left), (&right, &of_right)])
}

/// Exports both as one model, whole.*, with more flags.
pub(super) fn export(place: &Place, flags: &str) -> Ended {
    let [left, right, output] = ["left.supel", "right.supel", "whole"].map(|name| place.text(name));
    let start = ["export", &left, &right, "--to", "matrix-market", "--output", &output];
    supel(&start.into_iter().chain(flags.split_whitespace()).collect::<Vec<_>>())
}

const JOINED: &str = "--join left.middle=right.middle";

/// The exported model reduced again by its own job, verified against it.
#[track_caller]
pub(super) fn again(place: &Place, flags: &str) -> Superelement {
    let exported = export(place, flags).expect(ExitCode::Done);
    let job = place.text("whole.job.toml");
    assert!(place.path("whole.job.toml").exists(), "{}", exported.out);
    let ended = supel(&["reduce", &job]);
    let text = String::from_utf8(place.bytes("whole.job.toml")).expect("text");
    assert_eq!(ended.code, ExitCode::Done, "{}{}\n{text}", ended.out, ended.err);
    let file = place.text("whole.again.supel");
    let verified = supel(&["verify", &file, "--job", &job]);
    assert_eq!(verified.code, ExitCode::Done, "{}{}", verified.out, verified.err);
    place.superelement("whole.again.supel")
}

fn bars_hz(superelement: &Superelement) -> Vec<f64> {
    let bar = |coordinate: &Coordinate| match coordinate {
        Coordinate::ElasticMode { error_bar_hz, .. } | Coordinate::FixedInterfaceMode { error_bar_hz, .. } => {
            Some(error_bar_hz.expect("a bar"))
        }
        _ => None,
    };
    superelement.metadata().coordinates.iter().filter_map(bar).collect()
}

/// The superelements as they are, joined and held.
fn assembly(place: &Place, join: &str, held: &[&str]) -> Assembly {
    let component = |name: &str| {
        Component::new(name.to_owned(), place.superelement(&format!("{name}.supel"))).expect("a component")
    };
    let mut assembly = Assembly::new(vec![component("left"), component("right")]).expect("two names");
    let (a, b) = join.trim_start_matches("--join ").split_once('=').expect("two");
    assembly.join(a, b).expect("one place");
    held.iter().for_each(|held| assembly.fix(held).expect("an interface"));
    assembly
}

/// The modes of the superelement of the whole are those of the assembly, and so not below those of the whole model and not farther from
/// them than the assembly reports.
#[track_caller]
fn assert_modes_of(found: &Superelement, assembly: &Assembly, whole: &[f64]) {
    let expected = all_modes(assembly);
    assert_enclosed(&expected, whole);
    let first = n_rigid(&expected);
    let (found_hz, bars) = (frequencies_hz(found), bars_hz(found));
    assert!(found_hz.len() >= 3 && bars.len() == found_hz.len(), "{found_hz:?}");
    for (k, found) in found_hz.iter().enumerate() {
        let mode = &expected.modes[first + k];
        let allowed = bars[k] + mode.rounding_hz;
        assert!((found - mode.frequency_hz).abs() <= allowed, "mode {k}: {found} and {} Hz", mode.frequency_hz);
        // Bars that say nothing would let anything pass.
        assert!(allowed < 1e-5 * found, "mode {k} of {found} Hz: {allowed:e}");
        let truth = hertz(whole[first + k]);
        let least = mode.at_least_hz.expect("a bound");
        let is_between = least <= truth + allowed && truth <= found + allowed;
        assert!(is_between, "mode {k}: {truth} is not from {least} to {found} ± {allowed:e}");
    }
}

#[test]
fn halves_reduced_again_are_the_whole_within_the_reported_error() {
    let whole = beams(&line());
    for (method, ends) in [
        ("--method herting --modes 8", &[][..]),
        ("--method craig-bampton --modes 8", &["left.end", "right.end"]),
        ("--method craig-bampton --up-to-hz 1500 --inertia-relief", &["left.end", "right.end"]),
    ] {
        let place = lines(method);
        let free = again(&place, JOINED);
        assert_eq!(free.n_rigid(), 6, "{method}");
        let names: Vec<&str> = free.metadata().interface_nodes.iter().map(|node| node.name.as_str()).collect();
        assert_eq!(names, ["left.end", "right.end"], "{method}");
        let is_held = |label: i64| !ends.is_empty() && [1, 13].contains(&label);
        let truth = spectrum(&supported(&whole, |(label, _)| is_held(label)));
        assert_modes_of(&free, &assembly(&place, JOINED, ends), &truth);
        // Held at one end: what leaves the matrices there are rows of the job's `[[fixed]]`.
        let held = again(&place, &format!("{JOINED} --fix left.end"));
        assert_eq!((held.n_rigid(), held.n_interface()), (0, 6), "{method}");
        let ends: &[&str] = if ends.is_empty() { &["left.end"] } else { &["left.end", "right.end"] };
        let truth = spectrum(&supported(&whole, |(label, _)| label == 1 || (label == 13 && ends.len() == 2)));
        assert_modes_of(&held, &assembly(&place, JOINED, ends), &truth);
    }
}

/// Mass, centre and inertia of the whole are those of the whole model: Mᵢⱼ of rigid-body motion at the nodes of the superelement.
#[test]
fn mass_properties_are_those_of_the_whole() {
    let properties = |s: &Superelement| s.metadata().model.mass_properties.expect("of a free component");
    let whole = Place::with(&beams(&line()));
    whole.reduce(&whole.model_flags(), "--interface ends=1,13 --method herting --modes 3").expect(ExitCode::Done);
    let expected = properties(&whole.superelement("x.supel"));
    let found = properties(&again(&lines("--method herting --modes 8"), JOINED));
    // Constraint modes of either half carry rigid-body motion to the digits that the check M-12 leaves, nine and more.
    let bound = 1e-9;
    assert!((found.mass / expected.mass - 1.0).abs() <= bound, "{} and {}", found.mass, expected.mass);
    for (found, expected) in found.center_of_mass.iter().zip(&expected.center_of_mass) {
        assert!((found - expected).abs() <= bound, "{found} and {expected}");
    }
    let size = expected.inertia.as_flattened().iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    for (found, expected) in found.inertia.as_flattened().iter().zip(expected.inertia.as_flattened()) {
        assert!((found - expected).abs() <= bound * size, "{found} and {expected}");
    }
}

/// Nodes of a face: nine pairs at the same places, in another order, and interfaces of several nodes at the far ends.
fn blocks(method: &str) -> (Place, Model) {
    let left = brick([2, 2, 2], [2.0, 1.2, 0.7], &Material::UNIT);
    let right = translated(&brick([3, 2, 2], [2.5, 1.2, 0.7], &Material::UNIT), [2.0, 0.0, 0.0]);
    let at = |model: &Model, x: f64| -> Vec<i64> {
        let nodes = model.labels.iter().zip(&model.nodes).filter(|(_, node)| (node[0] - x).abs() < 1e-9);
        nodes.map(|(label, _)| *label).collect()
    };
    let (of_left, mut of_right) = (at(&left, 2.0), at(&right, 2.0));
    let pairs: Vec<(i64, i64)> = of_left.iter().copied().zip(of_right.iter().copied()).collect();
    let whole = join(&left, &right, &pairs);
    of_right.reverse();
    let list = |labels: &[i64]| labels.iter().map(i64::to_string).collect::<Vec<_>>().join(",");
    let flags = |face: &[i64], far: &[i64]| {
        format!("--interface middle={} --interface far={} {method}", list(face), list(&far[..4]))
    };
    let of_left = flags(&of_left, &at(&left, 0.0));
    let of_right = flags(&of_right, &at(&right, 4.5));
    (halves([(&left, &of_left), (&right, &of_right)]), whole)
}

#[test]
fn faces_become_interior_and_other_interfaces_keep_their_nodes() {
    let (place, whole) = blocks("--method herting --modes 14");
    let free = again(&place, JOINED);
    assert_eq!((free.n_rigid(), free.n_interface()), (6, 24));
    let assembly = assembly(&place, JOINED, &[]);
    assert_modes_of(&free, &assembly, &spectrum(&whole));
    let band = all_modes(&assembly).band_hz.expect("a band");
    assert!(frequencies_hz(&free).iter().all(|hz| *hz <= 1.000_001 * band), "no mode above what the components have");
    // The next one would be above the band: all that are there below it were kept.
    assert!(all_modes(&assembly).modes[6 + frequencies_hz(&free).len()].frequency_hz > band);
}

#[test]
fn a_joined_interface_is_kept_on_request() {
    let place = lines("--method herting --modes 6");
    let ended = export(&place, &format!("{JOINED} --keep right.middle")).expect(ExitCode::Done);
    let nodes = String::from_utf8(place.bytes("whole.nodes.csv")).expect("text");
    assert_eq!(nodes.lines().count(), 4, "{nodes}{}", ended.out);
    assert!(nodes.contains("left.middle + right.middle"), "{nodes}");
    let kept = again(&place, &format!("{JOINED} --keep right.middle"));
    let names: Vec<&str> = kept.metadata().interface_nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["left.end", "right.middle", "right.end"]);
    assert_eq!(kept.metadata().interface_nodes[1].position, line()[6]);
    // One direction of an end is held: the others are those of its interface.
    let partly = again(&place, &format!("{JOINED} --fix left.end.uy"));
    assert_eq!((partly.n_interface(), partly.n_rigid()), (11, 5));
}

/// The ball joint turns without energy: the parts of the whole do, too.
#[test]
fn a_ball_joint_stays_one() {
    let place = lines("--method craig-bampton --modes 6");
    let ball = "--join left.middle.ux=right.middle.ux --join left.middle.uy=right.middle.uy \
                --join left.middle.uz=right.middle.uz";
    let superelement = again(&place, ball);
    let job = || String::from_utf8(place.bytes("whole.job.toml")).expect("text");
    assert!(job().contains("mechanisms = \"accept\""), "{}", job());
    let component = Component::new("whole".to_owned(), superelement).expect("a component");
    let modes = all_modes(&Assembly::new(vec![component]).expect("one name"));
    // Six motions of the whole and three rotations of one part against the other.
    assert_eq!(modes.modes.iter().filter(|mode| mode.frequency_hz == 0.0).count(), 9, "{:?}", &modes.modes[..10]);
    export(&place, JOINED).expect(ExitCode::Done);
    assert!(!job().contains("mechanisms"), "{}", job());
}

/// A held part carries a free one: three rotations of that one are left, which leave everything inside the held part at rest.
#[test]
fn a_ball_joint_on_a_held_part_stays_one() {
    for method in ["craig-bampton", "herting"] {
        let place = lines(&format!("--method {method} --modes 6"));
        let ball = "--join left.middle.ux=right.middle.ux --join left.middle.uy=right.middle.uy \
                    --join left.middle.uz=right.middle.uz --fix left.end";
        assert_eq!(again(&place, ball).n_rigid(), 3, "{method}");
    }
}

/// Loads come along under the name of their component, whatever else does not is named.
#[test]
fn loads_come_along_and_notes_say_what_does_not() {
    let [left, right] = [Place::with(&beams(&line()[..7])), Place::with(&beams(&line()[6..]))];
    let job = |more: &str, ends: [i64; 2]| {
        format!(
            "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n\
             [[interface]]\nname = \"end\"\nnodes = [{}]\n[[interface]]\nname = \"middle\"\nnodes = [{}]\n{more}\
             [reduction]\nmethod = \"herting\"\nmodes = {{ count = 6 }}\n[write]\nsuperelement = \"x.supel\"\n",
            ends[0], ends[1]
        )
    };
    let push = "[[load]]\nname = \"push\"\nnodes = [3]\nforce = [0, 1, 2]\n";
    left.write("job.toml", job(push, [1, 7]).as_bytes());
    let recovery = "recovery = { nodes = [2, 3] }\n";
    right.write("job.toml", (job("", [7, 1]) + recovery).as_bytes());
    let place = Place::new();
    for (name, own) in [("left", &left), ("right", &right)] {
        supel(&["reduce", &own.text("job.toml")]).expect(ExitCode::Done);
        place.write(&format!("{name}.supel"), &own.bytes("x.supel"));
    }
    let found = again(&place, JOINED);
    assert_eq!(found.metadata().load_names, ["left.push"]);
    let (u, f) = (&found.tensors().rigid_body_modes, found.tensors().load_vectors.as_ref().expect("a load"));
    let work = |motion: usize| (0..f.rows()).map(|i| u[(i, motion)] * f[(i, 0)]).sum::<f64>();
    for (motion, force) in [0.0, 1.0, 2.0].into_iter().enumerate() {
        assert!((work(motion) - force).abs() < 1e-9, "translation {motion}: {}", work(motion));
    }
    let told = export(&place, JOINED).expect(ExitCode::Done).out;
    assert!(told.contains("note: right has recovery, which the model of the whole does not have"), "{told}");
    // An export without a job does not go beside the job of another.
    export(&place, &format!("{JOINED} --fix left.end --fix right.end")).expect(ExitCode::Usage);
    std::fs::remove_file(place.path("whole.job.toml")).expect("the job of the export before");
    std::fs::remove_file(place.path("whole.loads.mtx")).unwrap_or_default();
    let nothing = export(&place, &format!("{JOINED} --fix left.end --fix right.end")).expect(ExitCode::Done).out;
    assert!(nothing.contains("note: there is no job that reduces it: no interface is left"), "{nothing}");
}

#[test]
fn the_answer_follows_its_schema_and_every_run_writes_the_same_bytes() {
    let place = lines("--method herting --modes 6");
    let flags = format!("{JOINED} --fix left.end --mass right.end=2.5 --json");
    let read = |ended: &Ended| -> Value { serde_json::from_str(&ended.out).expect("JSON") };
    let first = read(&export(&place, &flags).expect(ExitCode::Done));
    let schema: Value = serde_json::from_str(include_str!("../../schemas/export.schema.json")).expect("a schema");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let violations: Vec<String> = validator.iter_errors(&first).map(|error| error.to_string()).collect();
    assert_eq!(violations, Vec::<String>::new());
    assert_eq!(first["assembly"]["joints"][0]["n_dofs"], 6);
    assert_eq!(read(&export(&place, &flags).expect(ExitCode::Done)), first);
    let reduced = |threads: &str| {
        supel(&["reduce", &place.text("whole.job.toml"), "--threads", threads]).expect(ExitCode::Done);
        place.bytes("whole.again.supel")
    };
    assert!(reduced("1") == reduced("2"));
}

/// What cannot be joined is refused with the codes of `supel modes`, and no file is left.
#[test]
fn what_cannot_be_one_model_is_refused() {
    let place = lines("--method herting --modes 6");
    let wrong = [
        ("--join left.middle=right.end", "E-JOIN-POSITION"),
        ("--join left.nowhere=right.middle", "E-ASSEMBLY-NAME"),
        ("--keep left.nowhere", "E-ASSEMBLY-NAME"),
        ("--join left.middle", "E-FLAG-TEXT"),
    ];
    for (flags, code) in wrong {
        let ended = export(&place, flags);
        assert!(ended.err.contains(code) && ended.out.is_empty(), "{flags}: {}{}", ended.out, ended.err);
    }
    let with_units = |units: &str| {
        let superelement = place.superelement("right.supel");
        let mut metadata = superelement.metadata().clone();
        metadata.units = Some(units.to_owned());
        Superelement::new(superelement.tensors().clone(), metadata).expect("a superelement")
    };
    with_units("m-kg-s").write(&place.path("left.supel")).expect("written");
    with_units("mm-t-s").write(&place.path("right.supel")).expect("written");
    // Different units are refused even where nothing is joined: the matrices of one model have one system.
    for flags in ["", "--join left.middle=right.middle"] {
        let ended = export(&place, flags).expect(ExitCode::ModelPhysics);
        assert!(ended.err.contains("E-JOIN-UNITS"), "{}", ended.err);
    }
    assert!(!place.path("whole.stiffness.mtx").exists());
    let place = lines("--method herting --modes 6");
    let [left, right, output] = ["left.supel", "right.supel", "whole"].map(|name| place.text(name));
    let ended = supel(&["export", &left, &right, "--to", "op4", "--output", &output]).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-FLAG-TEXT") && ended.err.contains("matrix-market"), "{}", ended.err);
    let ended = supel(&["export", &left, &right, "--to", "matrix-market"]).expect(ExitCode::Usage);
    assert!(ended.err.contains("--output"), "{}", ended.err);
}

/// Interfaces without nodes are rows of the whole.
#[test]
fn interfaces_of_rows_are_rows_of_the_whole() {
    let (left, right) = (beams(&line()[..7]), beams(&line()[6..]));
    let (rows, whole) = (|model: &Model| Model { dofs: Vec::new(), ..model.clone() }, spectrum(&beams(&line())));
    let method = "--method herting --modes 8";
    let of_left = format!("--interface end=rows:0,1,2,3,4,5 --interface middle=rows:36,37,38,39,40,41 {method}");
    let of_right = format!("--interface middle=rows:0,1,2,3,4,5 --interface end=rows:36,37,38,39,40,41 {method}");
    let place = halves([(&rows(&left), &of_left), (&rows(&right), &of_right)]);
    let join = "--join left.rows:36,37,38,39,40,41=right.rows:0,1,2,3,4,5";
    let found = again(&place, join);
    assert_eq!((found.n_rigid(), found.n_interface()), (6, 12));
    assert_modes_of(&found, &assembly(&place, join, &[]), &whole);
}
