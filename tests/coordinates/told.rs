//! What the messages name, what a job may state, and what an expectation is compared with.

use supel::cli::ExitCode;
use supel_models::transform::supported;
use supel_models::{Inertia, Material, Model, Section, frame};

use crate::faults::{against_rotation, block, clamped};
use crate::place::{Ended, Place, supel};

const FOOT: &str = "nodes = [1, 7, 22, 28]";

/// Reduces a model by a job whose model has one more line.
pub(crate) fn by_job(model: &Model, line: &str, interface: &str) -> (Place, Ended) {
    let place = Place::with(model);
    let job = format!(
        "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n{line}\n\
         [[interface]]\nname = \"foot\"\n{interface}\n\
         [reduction]\nmethod = \"herting\"\nmodes = {{ count = 4 }}\n[write]\nsuperelement = \"x.supel\"\n"
    );
    place.write("job.toml", job.as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml"), "--threads", "1"]);
    (place, ended)
}

/// Codes of the warnings.
pub(crate) fn warnings(place: &Place) -> Vec<String> {
    let report = place.report("x.report.json");
    let warnings = report["body"]["warnings"].as_array().expect("warnings").clone();
    warnings.iter().map(|warning| warning["code"].as_str().expect("a code").to_owned()).collect()
}

/// Verdict and place of the check of what the job expects.
pub(crate) fn expected(place: &Place) -> Option<(String, String)> {
    let report = place.report("x.report.json");
    let checks = report["body"]["checks"].as_array().expect("checks").clone();
    let check = checks.into_iter().find(|check| check["name"] == "mass and centre are those expected")?;
    let text = |key: &str| check[key].as_str().expect("text").to_owned();
    Some((text("verdict"), text("worst")))
}

#[test]
fn nodes_out_of_place_are_named() {
    let mut model = block();
    model.nodes[40][1] += 0.02;
    let (_, ended) = by_job(&model, "", FOOT);
    assert!(ended.err.contains("E-COORD") && ended.err.contains("most of it at node 41 u"), "{}", ended.err);
    assert!(ended.err.contains("6 motions without energy"), "{}", ended.err);
    // Where supports hold the component, too.
    let mut model = clamped();
    model.nodes[47][1] += 0.02;
    let (_, ended) = by_job(&model, "", "nodes = [22, 28]");
    assert!(ended.err.contains("E-COORD") && ended.err.contains("most of it at node 48 u"), "{}", ended.err);
    assert!(ended.err.contains("0 motions without energy"), "{}", ended.err);
}

/// Springs against rotation alone are refused unless the job says that they are meant.
#[test]
fn rotations_that_supports_hold_alone_are_said_in_the_job() {
    let model = against_rotation(&block(), &[0, 1, 2], 1e-3);
    let (_, ended) = by_job(&model, "", FOOT);
    let named = "rotation about x, rotation about y, rotation about z cost up to";
    assert!(ended.err.contains("E-ROTATIONS-HELD") && ended.err.contains(named), "{}", ended.err);
    let (_, ended) = by_job(&model, "held_rotations = [\"rx\"]", FOOT);
    let named = "not turn – rotation about y, rotation about z cost";
    assert!(ended.err.contains("E-ROTATIONS-HELD") && ended.err.contains(named), "{}", ended.err);
    let (place, ended) = by_job(&model, "held_rotations = [\"rx\", \"ry\", \"rz\"]", FOOT);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert_eq!(place.superelement("x.supel").tensors().rigid_body_modes.cols(), 3);
    assert_eq!(warnings(&place), [""; 0]);
    // Springs so soft that they would pass for rounded coordinates are not rounding: K knows three motions without energy.
    let (_, ended) = by_job(&against_rotation(&block(), &[0, 1, 2], 1e-7), "", FOOT);
    assert!(ended.err.contains("E-ROTATIONS-HELD"), "{}{}", ended.out, ended.err);
    // What costs less than a millionth of the first elastic mode is nearly free, as weak springs to the ground are.
    let (place, ended) = by_job(&against_rotation(&block(), &[0, 1, 2], 1e-9), "", FOOT);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert_eq!(warnings(&place), ["W-GROUNDED"]);
}

/// Of two nodes one has no row along x and none about y: it answers for no rotation about y, although nothing touches it.
#[test]
fn a_rotation_that_one_of_two_nodes_lacks_is_held() {
    let ends = [[0.0; 3], [1.0, 0.0, 0.0]];
    let beam = frame(&ends, &[[0, 1]], &Section::round(0.05), &Material::STEEL_SI, Inertia::Consistent);
    let (place, ended) = by_job(&supported(&beam, |dof| dof == (1, 0) || dof == (1, 4)), "", "nodes = [1, 2]");
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert_eq!(place.superelement("x.supel").tensors().rigid_body_modes.cols(), 4);
    // Where both lack it the message names the key that says so.
    let both = supported(&beam, |dof| dof == (1, 0) || dof.1 == 4);
    let (_, ended) = by_job(&both, "", "nodes = [1, 2]");
    assert!(ended.err.contains("E-COORD") && ended.err.contains("`model.held_rotations = [\"ry\"]`"), "{}", ended.err);
    let (_, ended) = by_job(&both, "held_rotations = [\"ry\"]", "nodes = [1, 2]");
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
}

#[test]
fn rotations_that_nothing_holds_are_told() {
    let (place, ended) = by_job(&block(), "held_rotations = [\"rz\"]", FOOT);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert_eq!(warnings(&place), ["W-NOT-HELD"]);
    let (_, ended) = by_job(&block(), "held_rotations = [\"uz\"]", FOOT);
    let named = "`model.held_rotations[0]` is \"uz\" – expected \"rx\", \"ry\" or \"rz\"";
    assert!(ended.err.contains(named), "{}", ended.err);
}

/// A foundation under every node in every direction leaves no row to compare coordinates with.
#[test]
fn supports_at_every_node_leave_coordinates_untested() {
    let mut model = block();
    let largest = model.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2));
    model.stiffness.iter_mut().filter(|(row, col, _)| row == col).for_each(|entry| entry.2 += 1e-3 * largest);
    let (place, ended) = by_job(&model, "", FOOT);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert_eq!(warnings(&place), ["W-COORD-UNTESTED"]);
    assert!(!ended.out.contains("stiffness_digits"), "{}", ended.out);
}

/// Single precision in other units looks like doubles, and rounding like supports everywhere.
#[test]
fn rounding_that_the_digits_do_not_show_is_told_by_its_size() {
    let mut model = block();
    let inches = |value: f64| f64::from(value as f32) * 175.126835;
    model.stiffness.iter_mut().for_each(|entry| entry.2 = inches(entry.2));
    let (place, ended) = by_job(&model, "", FOOT);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert_eq!(warnings(&place), ["W-GROUNDED", "W-COORD-UNTESTED"]);
    assert!(place.report_body("x.report.json").contains("state `stiffness_digits` then"), "{}", ended.out);
}

#[test]
fn expected_mass_of_a_held_component_is_compared() {
    let whole = 7850.0 * 1.2 * 0.55 * 0.31;
    let interface = "nodes = [22, 28]";
    // A node on the wall of eight has its share of the mass; without those rows M has less than the body.
    let of = |mass: f64| by_job(&clamped(), &format!("expect = {{ mass = {mass} }}"), interface);
    let (place, ended) = of(whole);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    let (verdict, worst) = expected(&place).expect("a check");
    assert!(verdict == "warn" && worst.contains("rows that supports took out"), "{verdict}: {worst}");
    assert_eq!(warnings(&place), [""; 0]);
    for mass in [1000.0 * whole, whole / 1000.0] {
        let (place, ended) = of(mass);
        assert_eq!((ended.code, expected(&place).expect("a check").0.as_str()), (ExitCode::CheckFailed, "fail"));
    }
}

/// Of a component that the job itself holds the whole mass is known: 1.5 times too much is no part that supports took.
#[test]
fn expected_mass_of_what_the_job_holds_is_the_whole() {
    let whole = 7850.0 * 1.2 * 0.55 * 0.31;
    let held = "nodes = [14, 20]\n[[fixed]]\nname = \"wall\"\nnodes = [1, 7, 22, 28]";
    let of = |mass: f64| by_job(&block(), &format!("expect = {{ mass = {mass} }}"), held);
    let (place, ended) = of(whole);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    let (verdict, worst) = expected(&place).expect("a check");
    assert!(verdict == "pass" && !worst.contains("supports"), "{verdict}: {worst}");
    for mass in [1.5 * whole, 1.02 * whole, whole / 1.5] {
        let (place, ended) = of(mass);
        assert_eq!(ended.code, ExitCode::CheckFailed, "{mass}: {}{}", ended.out, ended.err);
        assert_eq!(expected(&place).expect("a check").0, "fail");
        // So does the check of a file by a job that expects it.
        let job = std::fs::read_to_string(place.path("job.toml")).expect("a job");
        place.write("right.toml", job.replace(&format!("mass = {mass}"), &format!("mass = {whole}")).as_bytes());
        let made = supel(&["reduce", &place.text("right.toml"), "--quiet"]);
        assert_eq!(made.code, ExitCode::Done, "{}{}", made.out, made.err);
        let verified = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml"), "--json"]);
        let document: serde_json::Value = serde_json::from_str(&verified.out).expect("JSON");
        let mut checks = document["checks"].as_array().expect("checks").iter();
        let check = checks.find(|check| check["name"] == "mass and centre are those expected").expect("the check");
        assert_eq!(check["verdict"], "fail", "{mass}");
    }
}

/// The mass needs the dof map, the centre the coordinates as well: what cannot be compared is told, the rest is compared.
#[test]
fn expectations_without_coordinates_are_compared_in_part() {
    let place = Place::with(&block());
    let job = |expect: &str| {
        format!(
            "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nexpect = {{ {expect} }}\n\
             [[interface]]\nname = \"foot\"\n{FOOT}\n[reduction]\nmethod = \"herting\"\nmodes = {{ count = 4 }}\n\
             [write]\nsuperelement = \"x.supel\"\n"
        )
    };
    let whole = 7850.0 * 1.2 * 0.55 * 0.31;
    place.write("job.toml", job(&format!("mass = {whole}, cg = [0, 0, 0]")).as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml")]);
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert_eq!(expected(&place).expect("a check").0, "pass");
    assert_eq!(warnings(&place), ["W-EXPECT-UNCHECKED"]);
    let verified = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
    assert_eq!(verified.code, ExitCode::Done, "{}{}", verified.out, verified.err);
    for words in
        ["mass and centre are those expected", "what is expected can be compared", "centre of mass, which needs"]
    {
        assert!(verified.out.contains(words), "{words:?} is not in {}", verified.out);
    }
    let strict = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml"), "--strict"]);
    assert_eq!(strict.code, ExitCode::CheckFailed, "{}", strict.out);
    assert!(!strict.out.contains("! verified") && strict.out.contains("! not accepted: "), "{}", strict.out);
    let quiet = supel(&["reduce", &place.text("job.toml"), "--strict", "--quiet"]);
    assert_eq!(quiet.code, ExitCode::CheckFailed);
    assert!(quiet.err.contains("supel: W-EXPECT-UNCHECKED: not compared"), "{}", quiet.err);
}
