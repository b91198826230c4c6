//! Names, labels and paths of other people that act on a terminal, a page or a reader's eye: shown, never obeyed, in every output.

use supel::cli::ExitCode;
use supel_runtime::{Metadata, Superelement};

use crate::place::{Ended, Place, supel};

/// Clears the screen and claims success, hides what follows, by both sets of control characters, turns the direction of writing, ends
/// lines and texts, and is not shown at all.
const HOSTILE: &str = "\u{1b}[2J\u{1b}[H✓ verified: 99 checks passed\u{1b}[8m\u{9b}8m\u{202e}\u{2066}\n\r\t\u{7f}\u{200b}\u{2028}\u{feff}\u{e0041}";

/// Whether a character acts; line ends of our own are left out before.
fn acts(character: char) -> bool {
    character.is_control() || "\u{202e}\u{2066}\u{200b}\u{2028}\u{feff}\u{e0041}".contains(character)
}

/// Asserts that a text holds the name, and nothing that acts but its own line ends.
#[track_caller]
fn assert_harmless(text: &str, what: &str) {
    let found = text.chars().find(|character| *character != '\n' && acts(*character));
    assert!(found.is_none(), "{what}: {:?} in {text:?}", found.map(u32::from));
    assert!(text.contains("✓ verified: 99 checks passed"), "{what}: the name is not shown: {text}");
    let forged = text.lines().any(|line| line.trim_start().starts_with("✓ verified: 99"));
    assert!(!forged, "{what}: the name has a line of its own: {text}");
}

/// What a command said on both streams, of which one at least holds the name.
#[track_caller]
fn assert_harmless_end(ended: &Ended, what: &str) {
    assert_harmless(&format!("{}{}", ended.out, ended.err), what);
}

fn job(place: &Place, interface: &str, units: &str) -> String {
    let job = serde_json::json!({
        "model": {
            "stiffness": place.path("K.mtx"), "mass": place.path("M.mtx"),
            "dofs": place.path("dofs.txt"), "nodes": place.path("nodes.csv"), "units": units,
        },
        "interface": [{ "name": interface, "nodes": [1, 11, 31, 41] }],
        "reduction": { "method": "herting", "modes": { "count": 4 } },
        "scene": { "boundaries": [format!("fix:{interface}")] },
        "write": { "superelement": "x.supel", "html": "x.html", "junit": "x.xml" },
    });
    job.to_string()
}

/// From the job to every output of a run, and from the superelement to every look at it.
#[test]
fn names_of_a_job_are_shown_and_not_obeyed() {
    let place = Place::with_brick();
    place.write("job.json", job(&place, HOSTILE, HOSTILE).as_bytes());
    let path = place.text("job.json");
    assert_harmless_end(&supel(&["reduce", &path]).expect(ExitCode::Done), "summary");
    for name in ["x.report.json", "x.html", "x.xml"] {
        let text = String::from_utf8(place.bytes(name)).expect("UTF-8");
        if name != "x.xml" {
            assert_harmless(&text, name);
        }
        assert!(!text.contains(|character| character != '\n' && acts(character)), "{name}");
    }
    assert_harmless_end(&supel(&["reduce", &path, "--json"]).expect(ExitCode::Done), "JSON");
    let file = place.text("x.supel");
    for args in [["inspect", &file, "--json"], ["inspect", &file, "--job"]] {
        assert_harmless_end(&supel(&args).expect(ExitCode::Done), &args.concat());
    }
    assert_harmless_end(&supel(&["inspect", &file]).expect(ExitCode::Done), "inspect");
    let compared = supel(&["verify", &file, "--job", &path]);
    assert!(!format!("{}{}", compared.out, compared.err).contains(|c: char| c != '\n' && acts(c)), "{}", compared.out);
}

/// A value is what it was, however it is escaped.
#[test]
fn a_json_report_gives_the_name_back() {
    let place = Place::with_brick();
    place.write("job.json", job(&place, HOSTILE, "mm").as_bytes());
    supel(&["reduce", &place.text("job.json")]).expect(ExitCode::Done);
    assert_eq!(place.report("x.report.json")["body"]["reduction"]["interfaces"][0]["name"], HOSTILE);
    let shown = supel(&["inspect", &place.text("x.supel"), "--json"]).expect(ExitCode::Done).out;
    let shown: serde_json::Value = serde_json::from_str(&shown).expect("JSON");
    assert_eq!(shown["metadata"]["interface_nodes"][0]["name"], HOSTILE);
}

/// A superelement of somebody else whose every text is hostile, failing or not.
#[test]
fn texts_of_a_superelement_are_shown_and_not_obeyed() {
    let place = Place::with_brick();
    place.write("job.json", job(&place, "foot", "mm").as_bytes());
    supel(&["reduce", &place.text("job.json")]).expect(ExitCode::Done);
    let sound = place.superelement("x.supel");
    let mut metadata: Metadata = sound.metadata().clone();
    metadata.generator.name = HOSTILE.to_owned();
    metadata.generator.version = HOSTILE.to_owned();
    metadata.units = Some(HOSTILE.to_owned());
    metadata.interface_nodes.iter_mut().for_each(|node| node.name = HOSTILE.to_owned());
    metadata.validity.assumptions = vec![HOSTILE.to_owned()];
    metadata.inputs.insert(HOSTILE.to_owned(), "0".repeat(64));
    metadata.verification.checks.iter_mut().for_each(|check| check.id = HOSTILE.to_owned());
    metadata.job = serde_json::json!({ "write": { "report": HOSTILE } });
    let mut tensors = sound.tensors().clone();
    for is_failing in [false, true] {
        if is_failing {
            tensors.frequencies.iter_mut().for_each(|omega| *omega *= 2.0);
            for coordinate in &mut metadata.coordinates {
                if let supel_runtime::Coordinate::ElasticMode { frequency_hz, .. } = coordinate {
                    *frequency_hz *= 2.0;
                }
            }
        }
        let hostile = Superelement::new(tensors.clone(), metadata.clone()).expect("well formed");
        hostile.write(&place.path("hostile.supel")).expect("written");
        let file = place.text("hostile.supel");
        for args in [&["inspect", &file][..], &["inspect", &file, "--json"], &["inspect", &file, "--job"]] {
            let ended = supel(args).expect(ExitCode::Done);
            assert!(!ended.out.contains(|c: char| c != '\n' && acts(c)), "{args:?}: {:?}", ended.out);
        }
        for args in [&["verify", &file][..], &["verify", &file, "--json"]] {
            let ended = supel(args).expect(if is_failing { ExitCode::CheckFailed } else { ExitCode::Done });
            assert_harmless_end(&ended, "verify");
        }
    }
}

/// Errors and complaints name files and values of other people, one line each.
#[test]
fn errors_are_one_line_whatever_they_quote() {
    let place = Place::with_brick();
    let named = format!("{HOSTILE}/{}.supel", HOSTILE.replace('/', "-"));
    for args in
        [&["inspect", named.as_str()][..], &["verify", &named], &["reduce", &named], &["reduce", "--json", &named]]
    {
        let ended = supel(args);
        assert_harmless_end(&ended, "a path");
        assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
    }
    let group =
        job(&place, "foot", "mm").replace("[1,11,31,41]", &serde_json::json!(format!("group:{HOSTILE}")).to_string());
    place.write("group.json", group.as_bytes());
    let ended = supel(&["reduce", &place.text("group.json")]).expect(ExitCode::InputData);
    assert_harmless_end(&ended, "a group");
    assert_eq!(ended.err.lines().count(), 1, "{}", ended.err);
    // What clap says of a command line takes several lines.
    assert_harmless_end(&supel(&["reduce", "--method", HOSTILE]).expect(ExitCode::Usage), "a flag");
}
