//! What `supel verify` prints.

use serde_json::Value;
use supel::cli::ExitCode;

use crate::place::{Place, supel};

fn violations(document: &Value) -> Vec<String> {
    let schema: Value =
        serde_json::from_str(include_str!("../../schemas/verification.schema.json")).expect("schema is JSON");
    let validator = jsonschema::validator_for(&schema).expect("schema is a schema");
    validator.iter_errors(document).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

fn reduced() -> Place {
    let place = Place::with_brick();
    place.reduce(&place.model_flags(), "--interface foot=1,11,31,41 --method herting --modes 5").expect(ExitCode::Done);
    let job = supel(&["inspect", &place.text("x.supel"), "--job"]).expect(ExitCode::Done).out;
    place.write("kept.json", job.as_bytes());
    place
}

#[test]
fn json_follows_its_schema_and_is_the_same_for_any_thread_count() {
    let place = reduced();
    let (file, job) = (place.text("x.supel"), place.text("kept.json"));
    for more in [vec![], vec!["--job", &job], vec!["--reproduce"]] {
        let args = [vec!["verify", &file, "--json"], more].concat();
        let by = |threads: &str| supel(&[args.as_slice(), &["--threads", threads]].concat()).expect(ExitCode::Done).out;
        let one = by("1");
        let document: Value = serde_json::from_str(&one).expect("JSON");
        assert_eq!(violations(&document), Vec::<String>::new());
        assert_eq!(document["verdict"], "pass");
        assert_eq!(document["subject"]["n_modes"], 5);
        for threads in ["2", "3", "8"] {
            assert_eq!(by(threads), one, "{threads} threads");
        }
        let mut more = document.clone();
        more["surplus"] = 1.into();
        assert_ne!(violations(&more), Vec::<String>::new());
        let mut less = document;
        less["subject"].as_object_mut().expect("object").remove("digest");
        assert_ne!(violations(&less), Vec::<String>::new());
    }
}

#[test]
fn text_fits_the_page_and_says_what_was_compared() {
    let place = reduced();
    let alone = supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
    assert!(alone.out.contains("the file alone; give the job with --job"), "{}", alone.out);
    assert!(alone.out.lines().all(|line| line.chars().count() <= 100), "{}", alone.out);
    assert!(alone.out.trim_end().lines().last().is_some_and(|line| line.starts_with("✓ verified: ")), "{}", alone.out);
    let quiet = supel(&["verify", &place.text("x.supel"), "--quiet"]).expect(ExitCode::Done);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
}

/// Rigid-body motion ties recovered rows of a free component alone, and a file that has nothing else says so.
#[test]
fn recovered_rows_of_a_held_component_are_not_said_to_be_tied() {
    let place = Place::with_brick();
    for (fixed, words) in [
        ("", "tie its interface columns"),
        ("fixed = [{ nodes = [25], dofs = [\"uz\"] }]\n", "nothing in the file does"),
    ] {
        let job = format!(
            "{fixed}interface = [{{ name = \"foot\", nodes = [1, 11, 31, 41] }}]\n\
             model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
             reduction = {{ method = \"herting\", modes = {{ count = 5 }} }}\n[write]\nsuperelement = \"x.supel\"\nrecovery = {{ nodes = [3, 7] }}\n"
        );
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        let found = supel(&["verify", &place.text("x.supel"), "--json"]).expect(ExitCode::Done).out;
        let document: Value = serde_json::from_str(&found).expect("JSON");
        let mut unvouched = document["unvouched"].as_array().expect("a list").iter();
        let of_recovery = unvouched.find(|unvouched| unvouched["field"] == "recovery").expect("recovery");
        assert!(of_recovery["reason"].as_str().is_some_and(|reason| reason.contains(words)), "{of_recovery}");
    }
}

#[test]
fn a_file_or_a_job_that_is_not_there_is_an_error() {
    let place = reduced();
    supel(&["verify", &place.text("missing.supel")]).expect(ExitCode::Io);
    supel(&["verify", &place.text("x.supel"), "--job", &place.text("missing.toml")]).expect(ExitCode::Io);
    let both = supel(&["verify", &place.text("x.supel"), "--json", "--quiet"]).expect(ExitCode::Done);
    assert!(both.out.starts_with('{') && both.err.is_empty(), "{}", both.err);
    place.write("wrong.toml", b"[model]\n");
    supel(&["verify", &place.text("x.supel"), "--job", &place.text("wrong.toml")]).expect(ExitCode::Usage);
}
