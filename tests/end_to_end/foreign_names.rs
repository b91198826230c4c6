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
        for args in [&["inspect", &file][..], &["inspect", &file, "--json"]] {
            let ended = supel(args).expect(ExitCode::Done);
            assert!(!ended.out.contains(|c: char| c != '\n' && acts(c)), "{args:?}: {:?}", ended.out);
        }
        let no_job = supel(&["inspect", &file, "--job"]).expect(ExitCode::Usage);
        assert!(no_job.out.is_empty() && no_job.err.contains("E-KEPT-JOB"), "{}{}", no_job.out, no_job.err);
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
    let flag = format!("--{HOSTILE}");
    for args in
        [&["reduce", "--method", HOSTILE][..], &["reduce", "job.toml", &flag], &["reduce", "--json", &flag], &[HOSTILE]]
    {
        let ended = supel(args).expect(ExitCode::Usage);
        assert_harmless_end(&ended, "a flag");
        assert!(ended.err.contains("\\u{1b}[2J") && ended.err.contains("\\n"), "left out: {}", ended.err);
    }
}

/// A folder and files whose names are not UTF-8, as an old archive unpacks them: what would have to keep such a name is refused before
/// anything is read, and what need not works.
#[cfg(unix)]
#[test]
fn names_that_are_not_utf8_are_refused_before_anything_is_read() {
    use std::ffi::{OsStr, OsString};
    use std::os::unix::ffi::OsStrExt;

    let place = Place::with_brick();
    place.write("job.json", job(&place, "foot", "mm").as_bytes());
    supel(&["reduce", &place.text("job.json")]).expect(ExitCode::Done);
    let latin = place.path("").join(OsStr::from_bytes(b"b\xff"));
    std::fs::create_dir(&latin).expect("a folder");
    // The job names files of its own folder.
    let text = String::from_utf8(place.bytes("job.json")).expect("UTF-8").replace(&place.text(""), "");
    std::fs::write(latin.join("job.json"), text).expect("written");
    for name in ["K.mtx", "M.mtx", "dofs.txt", "nodes.csv", "x.supel"] {
        std::fs::copy(place.path(name), latin.join(name)).expect("copied");
    }
    let odd = |name: &[u8]| place.path("").join(OsStr::from_bytes(name)).into_os_string();
    std::fs::copy(place.path("K.mtx"), odd(b"K\xff.mtx")).expect("copied");
    let plain = |name: &str| OsString::from(place.text(name));
    let inside = |name: &str| latin.join(name).into_os_string();
    let count = |folder: &std::path::Path| std::fs::read_dir(folder).expect("a folder").count();
    let before = (count(&place.path("")), count(&latin));
    let run = |args: Vec<OsString>| {
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let args = std::iter::once("supel".into()).chain(args);
        let pipeline = supel::PIPELINE;
        let code = supel::cli::run(args, pipeline, &mut supel::cli::Terminal::plain(&mut out, &mut err));
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Ended { code, out: text(out), err: text(err) }
    };
    for (args, part) in [
        (vec!["reduce".into(), inside("job.json")], "\"b\\xFF\""),
        (vec!["reduce".into(), plain("job.json"), "--stiffness".into(), odd(b"K\xff.mtx")], "\"K\\xFF.mtx\""),
        (vec!["reduce".into(), plain("job.json"), "-o".into(), odd(b"x\xff.supel")], "\"x\\xFF.supel\""),
        (vec!["reduce".into(), plain("job.json"), "--junit".into(), odd(b"x\xff.xml")], "`write.junit`"),
        (vec!["verify".into(), inside("x.supel"), "--job".into(), inside("job.json")], "`model.stiffness`"),
        (vec!["verify".into(), inside("x.supel"), "--reproduce".into()], "`model.stiffness`"),
        (vec!["inspect".into(), inside("x.supel"), "--job".into()], "`model.stiffness`"),
    ] {
        let said = run(args.clone()).expect(ExitCode::Usage);
        assert!(said.err.starts_with("supel: error[E-NAME]: ") && said.err.contains(part), "{args:?}: {}", said.err);
        assert!(said.out.is_empty() && said.err.lines().count() == 1, "{args:?}: {}{}", said.out, said.err);
        assert_eq!((count(&place.path("")), count(&latin)), before, "{args:?} wrote something");
        if args[0] != "inspect" {
            let said = run([args, vec!["--json".into()]].concat()).expect(ExitCode::Usage);
            let document: serde_json::Value = serde_json::from_str(&said.out).expect("JSON");
            assert_eq!(document["error"]["code"], "E-NAME");
        }
    }
    // What is read alone has no name that a document keeps.
    std::fs::copy(place.path("x.supel"), odd(b"x\xff.supel")).expect("copied");
    for file in [inside("x.supel"), odd(b"x\xff.supel")] {
        for more in [&["verify", "--json"][..], &["inspect", "--json"], &["verify"], &["inspect"]] {
            let args: Vec<OsString> = std::iter::once(more[0].into())
                .chain([file.clone()])
                .chain(more[1..].iter().map(OsString::from))
                .collect();
            let ended = run(args).expect(ExitCode::Done);
            if more.contains(&"--json") {
                serde_json::from_str::<serde_json::Value>(&ended.out).expect("JSON");
            }
        }
    }
}
