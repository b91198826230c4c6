//! What a superelement takes for granted, reduced again or exported: the new file says it, too.

use supel::cli::ExitCode;
use supel_runtime::Superelement;
use supel_testing::place::{Place, supel};

use crate::{CRAIG_BAMPTON, Case, PATCHES};

const RELIEVED: &str = "method = \"craig-bampton\", modes = { count = 6 }, inertia_relief = true";

/// Every way from one file to the next.
fn made_again(place: &Place) -> Vec<Superelement> {
    let file = place.text("x.supel");
    supel(&["reduce", &file, "--modes", "4", "--output", &place.text("again.supel")]).expect(ExitCode::Done);
    let exported =
        supel(&["export", &file, "--to", "matrix-market", "--output", &place.text("m")]).expect(ExitCode::Done);
    assert!(exported.out.contains("takes for granted"), "{}", exported.out);
    supel(&["reduce", &place.text("m.job.toml")]).expect(ExitCode::Done);
    supel(&["verify", &place.text("again.supel")]).expect(ExitCode::Done);
    let first = place.superelement("again.supel");
    supel(&["reduce", &place.text("again.supel"), "--output", &place.text("third.supel")]).expect(ExitCode::Done);
    vec![first, place.superelement("m.again.supel"), place.superelement("third.supel")]
}

#[test]
fn what_is_taken_for_granted_stays_so() {
    let of_scene = [
        (RELIEVED, "gravity = false"),
        (RELIEVED, "gravity = [0, 0, -2]"),
        (CRAIG_BAMPTON, "unloaded = [\"tip.ux\"]"),
        (CRAIG_BAMPTON, "grounded = [\"tip.ux\"]"),
        (CRAIG_BAMPTON, "prescribed = [{ name = \"table\", interfaces = [\"tip\"] }]"),
        (CRAIG_BAMPTON, "outputs = { nodes = [14] }"),
    ];
    for (reduction, scene) in of_scene {
        let made = Case::new(PATCHES, reduction, scene).made();
        let own = &made.file.metadata().validity;
        assert!(!own.assumptions.is_empty(), "{scene}");
        for again in made_again(&made.place) {
            let validity = &again.metadata().validity;
            assert_eq!((&validity.assumptions, validity.gravity), (&own.assumptions, own.gravity), "{scene}");
        }
    }
}

/// Masses and joints of the second file know why directions are not there.
#[test]
fn directions_that_are_not_there_stay_known() {
    for (scene, code, said) in [
        ("unloaded = [\"tip.ux\"]", ExitCode::ModelPhysics, "expected ux"),
        ("grounded = [\"tip.ux\"]", ExitCode::Done, "mass"),
    ] {
        let made = Case::new(PATCHES, CRAIG_BAMPTON, scene).made();
        made_again(&made.place);
        for file in ["x.supel", "again.supel", "m.again.supel", "third.supel"] {
            let ended = supel(&["modes", &made.place.text(file), "--mass", "tip=1"]);
            assert_eq!(ended.code, code, "{file}: {}{}", ended.out, ended.err);
            assert!(format!("{}{}", ended.out, ended.err).contains(said), "{file}: {}{}", ended.out, ended.err);
        }
    }
}

/// An assembly takes for granted what its components do, each under its name.
#[test]
fn assemblies_take_for_granted_what_their_components_do() {
    let made = Case::new(PATCHES, RELIEVED, "gravity = false\nunloaded = [\"tip.ux\"]").made();
    let place = &made.place;
    let files = ["a", "b"].map(|name| format!("{name}={}", place.text("x.supel")));
    let flags = ["--join", "a.root=b.root", "--keep", "a.root", "--to", "matrix-market", "--output", &place.text("m")];
    supel(&[&["export", &files[0], &files[1]], flags.as_slice()].concat()).expect(ExitCode::Done);
    supel(&["reduce", &place.text("m.job.toml")]).expect(ExitCode::Done);
    let again = place.superelement("m.again.supel");
    let validity = &again.metadata().validity;
    let expected: Vec<String> =
        ["a", "b"].iter().flat_map(|name| made.assumptions().iter().map(move |own| format!("{name}: {own}"))).collect();
    assert_eq!((&validity.assumptions, validity.gravity), (&expected, Some([0.0; 3])));
}

/// Another direction of gravity, and a job that keeps silent.
#[test]
fn contradictions_are_refused() {
    let made = Case::new(PATCHES, RELIEVED, "gravity = [0, 0, 1]").made();
    let place = &made.place;
    supel(&["export", &place.text("x.supel"), "--to", "matrix-market", "--output", &place.text("m")])
        .expect(ExitCode::Done);
    let job = std::fs::read_to_string(place.path("m.job.toml")).expect("a job");
    for (gravity, code) in [
        ("[0, 1, 0]", ExitCode::Usage),
        ("true", ExitCode::Usage),
        ("[0, 0, -3]", ExitCode::Done),
        ("false", ExitCode::Done),
    ] {
        place.write("n.toml", format!("{job}\n[scene]\ngravity = {gravity}\n").as_bytes());
        let ended = supel(&["reduce", &place.text("n.toml")]).expect(code);
        assert_eq!(ended.err.contains("E-ASSUMED-GRAVITY"), code == ExitCode::Usage, "{}", ended.err);
    }
    let of_file = job.replace("m.stiffness.mtx", "x.supel").replace("m.mass.mtx", "x.supel");
    let of_file = of_file.replace("m.dofs.csv", "x.supel").replace("m.nodes.csv", "x.supel");
    place.write("n.toml", of_file.as_bytes());
    supel(&["reduce", &place.text("n.toml")]).expect(ExitCode::Done);
    let silent: String =
        of_file.lines().filter(|line| !line.starts_with("assumes")).map(|line| format!("{line}\n")).collect();
    place.write("n.toml", silent.as_bytes());
    let ended = supel(&["reduce", &place.text("n.toml")]).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-ASSUMED:") || ended.err.contains("E-ASSUMED"), "{}", ended.err);
    assert!(ended.err.contains("gravity and acceleration of the whole act along"), "{}", ended.err);
}
