//! A cache changes no bit: whatever it has, whatever was done to it, and whoever else uses it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};
use supel::cli::ExitCode;
use supel_models::Model;

use crate::place::{Ended, Place, steel_brick, supel};

const RIGID: &str = "--rigid-interface root=1,6,11,16,21,26,31,36,41 --rigid-interface tip=5,10,15,20,25,30,35,40,45";
const DIRECT: &str = "--interface root=1,11,31,41 --interface tip=5,15,35,45";
/// Flags of a reduction with everything that a cache keeps: a factor, counts, modes of its own and of other boundaries.
const PLAIN: &str = "--method craig-bampton --modes 6";

/// Superelement and body of the report.
type Written = (Vec<u8>, String);

fn reduced(place: &Place, rest: &str) -> (Written, Value, Ended) {
    let ended = place.reduce(&place.model_flags(), rest).expect(ExitCode::Done);
    let (written, of_cache) = left(place);
    (written, of_cache, ended)
}

/// What the last reduction has left, and what it had of its cache.
fn left(place: &Place) -> (Written, Value) {
    let written = (place.bytes("x.supel"), place.report_body("x.report.json"));
    (written, place.report("x.report.json")["run"]["cache"].clone())
}

/// The job of the place, without a cache and with one.
fn reduced_job(place: &Place) -> (Written, Value) {
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    left(place)
}

fn cached_job(place: &Place) -> (Written, Value) {
    supel(&["reduce", &place.text("job.toml"), "--cache", &place.text("cache")]).expect(ExitCode::Done);
    left(place)
}

/// A reduction with a cache in a folder of the place.
fn cached(place: &Place, rest: &str) -> (Written, Value, Ended) {
    reduced(place, &format!("{rest} --cache {}", place.text("cache")))
}

fn entries(place: &Place) -> Vec<PathBuf> {
    let files = fs::read_dir(place.path("cache")).expect("a folder").map(|file| file.expect("a file").path());
    let mut entries: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|end| end == "entry")).collect();
    entries.sort();
    entries
}

fn of_kind<'a>(entries: &'a [PathBuf], kind: &str) -> Vec<&'a Path> {
    let is_of = |path: &&PathBuf| path.file_name().and_then(|name| name.to_str()).is_some_and(|n| n.starts_with(kind));
    entries.iter().filter(is_of).map(PathBuf::as_path).collect()
}

fn names_of<P: AsRef<Path>>(paths: &[P]) -> Vec<&str> {
    paths.iter().map(|path| path.as_ref().file_name().and_then(|name| name.to_str()).expect("a name")).collect()
}

#[track_caller]
fn assert_same(found: &Written, expected: &Written, what: &str) {
    assert!(found.0 == expected.0, "the superelement differs: {what}");
    assert_eq!(found.1, expected.1, "the report differs: {what}");
}

/// Parts of what earlier runs found for more are the results of a run without a cache to their error bars, the others to the bit.
#[track_caller]
fn assert_same_or_parts(found: &Written, of_cache: &Value, expected: &Written, what: &str) {
    if of_cache["parts"] == 0 {
        return assert_same(found, expected, what);
    }
    let [found, expected] = [found, expected].map(body_of);
    let verdicts = |body: &Value| -> Vec<(Value, Value)> {
        let checks = body["checks"].as_array().expect("checks").iter();
        checks.map(|check| (check["id"].clone(), check["verdict"].clone())).collect()
    };
    assert_eq!(verdicts(&found), verdicts(&expected), "{what}");
    let [found_numbers, expected_numbers] = [&found, &expected].map(numbers_compared);
    assert_eq!(found_numbers.len(), expected_numbers.len(), "{what}");
    for (a, b) in found_numbers.iter().zip(&expected_numbers) {
        // Frequencies are Rayleigh quotients, the response has residuals below 1e-7 squared: both are far more accurate.
        assert!((a - b).abs() <= 1e-8 * b.abs().max(1e-3), "{what}: {a} and {b}");
    }
}

/// The body of a report, which ends before the facts of the run.
fn body_of(written: &Written) -> Value {
    let text = format!("{}}}", written.1.trim_end().trim_end_matches(','));
    serde_json::from_str::<Value>(&text).expect("a report without facts of its run")["body"].take()
}

/// Frequencies of the full and the reduced model, kept and under every boundary, and the error of the response.
fn numbers_compared(body: &Value) -> Vec<f64> {
    let preservation = &body["preservation"];
    let of = |list: &Value, key: &str| -> Vec<f64> {
        list.as_array().expect("a list").iter().map(|entry| entry[key].as_f64().expect("a number")).collect()
    };
    let mut numbers = of(&preservation["modes"], "full_hz");
    for boundary in preservation["boundaries"].as_array().expect("boundaries") {
        numbers.extend(of(&boundary["frequencies"], "full_hz"));
        numbers.extend(of(&boundary["frequencies"], "reduced_hz"));
    }
    numbers.extend(preservation["response"]["worst_db"].as_f64());
    numbers
}

/// Without a cache, with an empty one, and with what that run has left.
#[test]
fn a_cache_changes_no_bit_of_any_method() {
    for interfaces in [RIGID, DIRECT] {
        for method in [
            PLAIN,
            "--method craig-bampton --up-to-hz 9000 --inertia-relief",
            "--method craig-bampton --modes 6 --certify full",
            "--method craig-bampton --modes 6 --precision mixed",
            "--method herting --modes 6",
            "--method herting --up-to-hz 9000 --precision mixed",
            "--method rubin --modes 6",
            "--method macneal --modes 6",
            "--method mixed-interface --held root --modes 6",
            "--method guyan",
        ] {
            let what = format!("{interfaces} {method}");
            let place = Place::with_brick();
            let (plain, none, _) = reduced(&place, &what);
            assert_eq!(none, Value::Null, "{what}");
            let (cold, of_cold, _) = cached(&place, &what);
            assert_same(&cold, &plain, &format!("{what}, empty"));
            assert_eq!((&of_cold["taken"], &of_cold["kept"]["factor"]), (&json!({}), &json!(1)), "{what}");
            let (warm, of_warm, _) = cached(&place, &what);
            assert_same(&warm, &plain, &format!("{what}, warm"));
            // The space of a response serves other bands and bases alone.
            let mut for_this_job = of_cold["kept"].clone();
            for_this_job.as_object_mut().expect("kinds").remove("space");
            assert_eq!((&of_warm["taken"], &of_warm["kept"]), (&for_this_job, &json!({})), "{what}");
            assert_eq!(of_warm["parts"], 0, "{what}");
            assert_eq!(of_warm["damaged"], json!([]), "{what}");
        }
    }
}

/// What another job needs is what it gets, and not what is nearly it.
#[test]
fn other_jobs_take_what_is_theirs() {
    let place = Place::with_brick();
    let first = format!("{RIGID} {PLAIN}");
    let (_, of_first, _) = cached(&place, &first);
    assert!(of_first["kept"]["modes"].as_u64() > Some(1), "its own modes and those of boundaries: {of_first}");
    for (rest, is_of_one_factor) in [
        (format!("{RIGID} --method craig-bampton --modes 7"), true),
        (format!("{RIGID} --method craig-bampton --up-to-hz 9000"), true),
        (format!("{RIGID} --method craig-bampton --up-to-hz 8000"), true),
        (format!("{RIGID} --method herting --modes 6"), true),
        (format!("{RIGID} --method mixed-interface --held root --modes 6"), true),
        (format!("{RIGID} --method mixed-interface --held tip --modes 6"), true),
        (format!("{RIGID} --method guyan"), true),
        (format!("{DIRECT} {PLAIN}"), false),
        (format!("{RIGID} {PLAIN} --fix foot=23"), false),
    ] {
        let (plain, _, _) = reduced(&place, &rest);
        let (found, of_cache, _) = cached(&place, &rest);
        assert_same_or_parts(&found, &of_cache, &plain, &rest);
        match is_of_one_factor {
            true => assert_eq!(of_cache["taken"]["factor"], 1, "{rest}"),
            false => assert_eq!((&of_cache["taken"], &of_cache["parts"]), (&json!({}), &json!(0)), "{rest}"),
        }
    }
    // What no factor is needed for is that of either precision.
    let mixed = format!("{RIGID} {PLAIN} --precision mixed");
    let (plain, _, _) = reduced(&place, &mixed);
    let (found, of_cache, _) = cached(&place, &mixed);
    assert_same(&found, &plain, &mixed);
    assert_eq!(of_cache["taken"], json!({ "statics": 1 }));
}

/// Twice K and M are the same numbers once they are scaled, and their modes are others; numbers of fewer digits have other bars.
#[test]
fn what_is_known_of_equal_numbers_is_part_of_the_key() {
    let model = steel_brick();
    let twice =
        |entries: &[(u32, u32, f64)]| entries.iter().map(|(row, col, value)| (*row, *col, 2.0 * value)).collect();
    let (stiffness, mass) = (twice(&model.stiffness), twice(&model.mass));
    let doubled = Place::with(&Model { stiffness, mass, ..model });
    let place = Place::with_brick();
    let job = |digits: &str| {
        let text = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\"{digits} }}\n\
             interface = [{{ name = \"root\", nodes = [1, 6, 11, 16], coupling = \"rigid\" }}]\n\
             reduction = {{ method = \"craig-bampton\", modes = {{ count = 4 }} }}\n\
             write = {{ superelement = \"x.supel\" }}\n"
        );
        place.write("job.toml", text.as_bytes());
    };
    job("");
    cached_job(&place);
    job(", stiffness_digits = 9");
    let (plain, _) = reduced_job(&place);
    let (found, of_cache) = cached_job(&place);
    assert_same(&found, &plain, "nine digits");
    assert_eq!((&of_cache["taken"]["factor"], &of_cache["taken"]["modes"]), (&json!(1), &Value::Null));
    job("");
    ["K.mtx", "M.mtx"].iter().for_each(|name| place.write(name, &doubled.bytes(name)));
    let (plain, _) = reduced_job(&place);
    let (found, of_cache) = cached_job(&place);
    assert_same(&found, &plain, "twice the numbers");
    assert_eq!((&of_cache["taken"]["factor"], &of_cache["taken"]["modes"]), (&json!(1), &Value::Null));
}

/// The response of the full model serves again where outputs change, and not where damping or the band do. These take the space that it was
/// found in.
#[test]
fn a_response_is_that_of_its_damping_and_band() {
    let place = Place::with_brick();
    let job = |band: &str, damping: &str, rest: &str| {
        let text = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
             interface = [{{ name = \"root\", nodes = [1, 6, 11, 16], coupling = \"rigid\" }}]\n\
             reduction = {{ method = \"herting\", modes = {{ count = 4 }} }}\n\
             scene = {{ band_hz = [0, {band}], damping = {{ ratio = {damping} }} }}\n\
             write = {{ superelement = \"x.supel\"{rest} }}\n"
        );
        place.write("job.toml", text.as_bytes());
    };
    job("3000", "0.01", "");
    let (_, of_first) = cached_job(&place);
    assert_eq!(of_first["kept"]["response"], 1, "{of_first}");
    for (band, damping, rest, taken) in [
        ("3000", "0.01", ", recovery = { nodes = [23] }", json!(1)),
        ("3000", "0.02", "", Value::Null),
        ("2900", "0.01", "", Value::Null),
    ] {
        job(band, damping, rest);
        let (plain, _) = reduced_job(&place);
        let (found, of_cache) = cached_job(&place);
        let what = format!("{band} Hz, {damping}{rest}");
        assert_same_or_parts(&found, &of_cache, &plain, &what);
        assert_eq!(of_cache["taken"]["response"], taken, "{what}: {of_cache}");
        // What was found in the space of another response has other last bits, and is not what a run without a cache finds.
        let (again, of_cache) = cached_job(&place);
        assert_same_or_parts(&again, &of_cache, &plain, &format!("{what}, again"));
    }
    let refused = supel(&["verify", &place.text("x.supel"), "--reproduce"]);
    assert_eq!(refused.code, ExitCode::Usage, "{}", refused.err);
    assert!(
        refused.err.contains("error[E-PARTS]: ") && refused.err.contains("parts of what earlier runs had kept"),
        "{}",
        refused.err
    );
    reduced_job(&place);
    let same = supel(&["verify", &place.text("x.supel"), "--reproduce"]);
    assert_eq!(same.code, ExitCode::Done, "{}", same.err);
}

/// A brick whose modes and band end at these frequencies, compared under every boundary.
fn banded(place: &Place, up_to_hz: u32, band_hz: u32) {
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
         interface = [{{ name = \"root\", nodes = [1, 6, 11, 16], coupling = \"rigid\" }},\n\
         {{ name = \"tip\", nodes = [5, 10, 15, 20], coupling = \"rigid\" }}]\n\
         reduction = {{ method = \"herting\", modes = {{ up_to_hz = {up_to_hz} }} }}\n\
         scene = {{ band_hz = [0, {band_hz}], boundaries = [\"free\", \"fix:root\", \"mass:tip\"] }}\n\
         write = {{ superelement = \"x.supel\" }}\n"
    );
    place.write("job.toml", text.as_bytes());
}

/// K-23: half the band, with what the whole one has left, needs no search, no count and no factor of its own.
#[test]
fn half_a_band_is_a_part_of_the_whole_one() {
    let place = Place::with_brick();
    banded(&place, 12_000, 8_000);
    cached_job(&place);
    banded(&place, 6_000, 4_000);
    let (plain, _) = reduced_job(&place);
    let work = |place: &Place| place.report("x.report.json")["run"]["work"].clone();
    let of_plain = work(&place);
    let (found, of_cache) = cached_job(&place);
    assert_same_or_parts(&found, &of_cache, &plain, "half the band");
    // Its own modes, those under three boundaries, and the response.
    assert_eq!(of_cache["parts"], 5, "{of_cache}");
    // What is made of parts has other last bits than the same made anew.
    assert_eq!(of_cache["kept"], json!({}), "{of_cache}");
    let of_cached = work(&place);
    assert_eq!((&of_plain["n_factorisations"], &of_cached["n_factorisations"]), (&json!(2), &json!(1)));
    let solves = |work: &Value| work["n_solves"].as_u64().expect("a count");
    assert!(2 * solves(&of_cached) < solves(&of_plain), "{of_cached} against {of_plain}");
    let body = body_of(&found);
    assert_eq!(body["completeness"]["certificate"], "sturm-count", "{}", body["completeness"]);
    assert_eq!(body["completeness"]["n_counted"], body["completeness"]["n_found"]);
}

/// What a narrower band has left is no answer to a wider one.
#[test]
fn a_wider_band_is_no_part_of_a_narrower_one() {
    let place = Place::with_brick();
    banded(&place, 2_500, 900);
    cached_job(&place);
    banded(&place, 12_000, 8_000);
    let (plain, _) = reduced_job(&place);
    let (found, of_cache) = cached_job(&place);
    assert_same(&found, &plain, "a wider band");
    assert_eq!((&of_cache["parts"], &of_cache["taken"]["factor"]), (&json!(0), &json!(1)), "{of_cache}");
    // And serves the narrower one again, whose own results are still there.
    banded(&place, 2_500, 900);
    let (plain, _) = reduced_job(&place);
    let (found, of_cache) = cached_job(&place);
    assert_same(&found, &plain, "the narrower band again");
    assert_eq!(of_cache["kept"], json!({}), "{of_cache}");
}

/// A certified band names an entry: where that is damaged or gone, the band is searched as if there had been none.
#[test]
fn a_band_without_its_modes_is_searched() {
    let place = Place::with_brick();
    banded(&place, 12_000, 8_000);
    cached_job(&place);
    let all = entries(&place);
    for path in of_kind(&all, "modes") {
        let mut bytes = fs::read(path).expect("an entry");
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(path, bytes).expect("written");
    }
    of_kind(&all, "space").into_iter().for_each(|path| fs::remove_file(path).expect("removed"));
    banded(&place, 6_000, 4_000);
    let (plain, _) = reduced_job(&place);
    let (found, of_cache) = cached_job(&place);
    assert_same(&found, &plain, "half the band");
    assert_eq!((&of_cache["parts"], &of_cache["taken"]["modes"]), (&json!(0), &Value::Null), "{of_cache}");
}

/// A job that looks for its number of modes searches several times; what it finds again is its own.
#[test]
fn a_job_that_looks_for_its_modes_takes_nothing_from_itself() {
    let place = Place::with_brick();
    let text = "model = { stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }\n\
                interface = [{ name = \"root\", nodes = [1, 6, 11, 16], coupling = \"rigid\" }]\n\
                reduction = { method = \"craig-bampton\", modes = { accept = true } }\n\
                scene = { band_hz = [0, 3000], boundaries = [\"free\"], accept = { frequency = 0.01 } }\n\
                write = { superelement = \"x.supel\" }\n";
    place.write("job.toml", text.as_bytes());
    let (plain, _) = reduced_job(&place);
    let (cold, of_cold) = cached_job(&place);
    let (warm, of_warm) = cached_job(&place);
    assert_same(&cold, &plain, "empty");
    assert_same(&warm, &plain, "warm");
    assert_eq!(of_cold["taken"], json!({}));
    assert!(of_warm["taken"]["modes"].as_u64() >= of_cold["kept"]["modes"].as_u64(), "{of_warm} {of_cold}");
}

/// A value of M leaves the factor at shift zero as it is, one of K changes everything.
#[test]
fn a_changed_number_is_noticed() {
    is_noticed(&Place::with_brick(), Some(1));
}

/// Rounded coordinates are mended by the zero modes of K and M, which are kept as well.
#[test]
fn a_changed_number_is_noticed_beside_rounded_coordinates() {
    let place = Place::with_brick();
    let nodes = String::from_utf8(place.bytes("nodes.csv")).expect("text");
    let rounded = |(line, text): (usize, &str)| {
        let fields: Vec<String> = text.split(',').map(str::to_owned).collect();
        let Ok(x) = fields[1].parse::<f64>() else { return format!("{text}\n") };
        format!("{},{},{}\n", fields[0], x + 1e-6 * (1.7 * line as f64).sin(), fields[2..].join(","))
    };
    let nodes: String = nodes.lines().enumerate().map(rounded).collect();
    place.write("nodes.csv", nodes.as_bytes());
    // They move the rows of patches, so that the factor is another one, too.
    is_noticed(&place, None);
    let (_, of_cache, ended) = cached(&place, &format!("{RIGID} {PLAIN}"));
    assert!(
        ended.out.contains("W-COORD-ROUNDED") || ended.err.contains("W-COORD-ROUNDED"),
        "{}{}",
        ended.out,
        ended.err
    );
    assert!(of_cache["taken"]["modes"].as_u64() >= Some(2), "zero modes and others: {of_cache}");
}

#[track_caller]
fn is_noticed(place: &Place, factors: Option<u64>) {
    let words = format!("{RIGID} {PLAIN}");
    cached(place, &words);
    let [stiffness, mass] = ["K.mtx", "M.mtx"].map(|name| place.bytes(name));
    // A late digit of the last entry, which is on the diagonal.
    let changed = |bytes: &[u8]| {
        let mut text = String::from_utf8(bytes.to_vec()).expect("text");
        let end = text.rfind('e').expect("an exponent");
        let at = text[..end].rfind(|c: char| matches!(c, '1'..='8')).expect("a digit");
        assert!(text[..end].ends_with(|c: char| c.is_ascii_digit()) && end - at < 4, "{}", &text[at..]);
        let next = text[at..=at].parse::<u8>().expect("a digit") + 1;
        text.replace_range(at..=at, &next.to_string());
        text.into_bytes()
    };
    for (name, bytes, factors) in [("M.mtx", &mass, factors), ("K.mtx", &stiffness, None)] {
        place.write(name, &changed(bytes));
        let (plain, _, _) = reduced(place, &words);
        let (found, of_cache, _) = cached(place, &words);
        assert_same(&found, &plain, name);
        assert_eq!(of_cache["taken"]["factor"].as_u64(), factors, "{name}: {of_cache}");
        assert_eq!(of_cache["taken"]["modes"], Value::Null, "{name}: {of_cache}");
        assert_eq!(of_cache["taken"]["count"], Value::Null, "{name}: {of_cache}");
        place.write(name, bytes);
    }
    let (_, of_cache, _) = cached(place, &words);
    assert_eq!(of_cache["kept"], json!({}), "the first numbers again");
}

/// All entries at once: emptied, cut, with one bit flipped, with a byte more; and sets of modes exchanged.
#[test]
fn damage_is_noticed_said_and_mended() {
    let words = format!("{RIGID} {PLAIN}");
    let place = Place::with_brick();
    let (plain, of_cold, _) = cached(&place, &words);
    let all = entries(&place);
    let kinds = ["factor", "count", "modes", "response", "band", "space", "statics"];
    let n_kept = kinds.map(|kind| of_cold["kept"][kind].as_u64().expect("kept"));
    assert_eq!(n_kept.iter().sum::<u64>(), all.len() as u64);
    // The space of a response that is found by solves is replaced unread.
    let read: Vec<&PathBuf> = all.iter().filter(|path| !of_kind(&all, "space").contains(&path.as_path())).collect();
    assert_eq!(read.len() + 1, all.len());
    type Harm<'a> = &'a dyn Fn(&mut Vec<u8>);
    let harms: [Harm<'_>; 4] = [
        &|bytes| bytes.clear(),
        &|bytes| bytes.truncate(bytes.len() / 2),
        &|bytes| {
            let middle = bytes.len() / 2;
            bytes[middle] ^= 0x10;
        },
        &|bytes| bytes.push(0),
    ];
    for harm in harms {
        for path in &all {
            let mut bytes = fs::read(path).expect("an entry");
            harm(&mut bytes);
            fs::write(path, bytes).expect("written");
        }
        let (found, of_cache, ended) = cached(&place, &words);
        assert_same(&found, &plain, "damaged");
        assert_eq!((&of_cache["taken"], &of_cache["kept"]), (&json!({}), &of_cold["kept"]));
        assert_eq!(of_cache["damaged"], json!(names_of(&read)));
        assert!(ended.err.contains(&format!("{} entries are damaged", read.len())), "{}", ended.err);
    }
    let modes = of_kind(&all, "modes");
    let contents: Vec<Vec<u8>> = modes.iter().map(|path| fs::read(path).expect("an entry")).collect();
    assert!(modes.len() > 1);
    for (path, bytes) in modes.iter().zip(contents.iter().cycle().skip(1)) {
        fs::write(path, bytes).expect("written");
    }
    let (found, of_cache, _) = cached(&place, &words);
    assert_same(&found, &plain, "exchanged");
    assert_eq!(of_cache["damaged"], json!(names_of(&modes)));
}

#[test]
fn a_small_cache_keeps_what_fits_and_says_so() {
    let words = format!("{RIGID} {PLAIN}");
    let place = Place::with_brick();
    let (plain, _, _) = reduced(&place, &words);
    // Counts have some hundred bytes, a factor of 135 dofs more than ten thousand.
    let (found, of_cache, ended) = cached(&place, &format!("{words} --cache-gib 1e-6"));
    assert_same(&found, &plain, "a cache of a kilobyte");
    assert_eq!(of_cache["kept"]["factor"], Value::Null);
    assert!(of_cache["not_kept"].as_str().is_some_and(|reason| reason.contains("larger than the cache may be")));
    assert!(ended.err.contains("not everything is kept for later runs"), "{}", ended.err);
    let bytes: u64 = entries(&place).iter().map(|path| path.metadata().expect("an entry").len()).sum();
    assert!(bytes <= 1073, "{bytes}");
}

#[test]
fn a_run_that_keeps_nothing_makes_no_folder_and_a_quiet_one_is_quiet() {
    let place = Place::with_brick();
    let words = format!("{RIGID} {PLAIN}");
    let cache = format!("--cache {}", place.text("cache"));
    let missing = format!("--interface root=1000 --method craig-bampton --modes 6 {cache}");
    place.reduce(&place.model_flags(), &missing).expect(ExitCode::InputData);
    assert!(!place.path("cache").exists());
    cached(&place, &words);
    for path in of_kind(&entries(&place), "count") {
        fs::write(path, "").expect("written");
    }
    let quiet = place.reduce(&place.model_flags(), &format!("{words} {cache} --quiet"));
    assert_eq!((quiet.code, quiet.err.as_str()), (ExitCode::Done, ""));
}

#[test]
fn what_can_be_no_cache_is_refused() {
    let place = Place::with_brick();
    place.write("file", b"not a folder");
    for (flags, code, words) in [
        (format!("--cache {}", place.text("file")), ExitCode::Io, "E-WRITE"),
        (format!("--cache {} --cache-gib 0", place.text("cache")), ExitCode::Usage, "--cache-gib"),
        (format!("--cache {} --cache-gib nan", place.text("cache")), ExitCode::Usage, "--cache-gib"),
        ("--cache-gib -5".to_owned(), ExitCode::Usage, "--cache-gib"),
        (format!("--cache {}", place.text("x.supel")), ExitCode::Usage, "E-OUTPUT-TWICE"),
    ] {
        let ended = place.reduce(&place.model_flags(), &format!("{RIGID} {PLAIN} {flags}")).expect(code);
        assert!(ended.err.contains(words), "{}", ended.err);
        assert!(!place.path("x.supel").exists());
    }
    assert_eq!(place.bytes("file"), b"not a folder");
}

fn program(place: &Place, output: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_supel"));
    command.args(["reduce", "--output", &place.text(output), "--json"]).args(place.model_flags());
    command.args(RIGID.split(' ')).args(PLAIN.split(' '));
    command.env_remove("SUPEL_CACHE").env_remove("SUPEL_CACHE_GIB");
    command
}

fn answer(command: &mut Command) -> Value {
    let output = command.output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

#[test]
fn the_environment_names_a_cache() {
    let place = Place::with_brick();
    let run = |folder: &str, gib: &str| {
        let mut command = program(&place, "x.supel");
        command.arg("--force").env("SUPEL_CACHE", folder).env("SUPEL_CACHE_GIB", gib);
        let of_cache = answer(&mut command)["run"]["cache"].clone();
        (of_cache, place.bytes("x.supel"))
    };
    let folder = place.text("cache");
    let (none, plain) = run("", "");
    let (small, of_small) = run(&folder, "1e-6");
    let (cold, of_cold) = run(&folder, "");
    let (warm, of_warm) = run(&folder, "1");
    assert_eq!((none, &small["kept"]["factor"]), (Value::Null, &Value::Null));
    assert_eq!((&cold["kept"]["factor"], &warm["taken"]["factor"]), (&json!(1), &json!(1)));
    assert!([of_small, of_cold, of_warm].iter().all(|bytes| *bytes == plain));
}

/// Eight at a time, twice: with nothing there, and with everything.
#[test]
fn processes_share_a_cache() {
    let place = Place::with_brick();
    // The file keeps its own name, and where its inputs are from there.
    let names: Vec<String> = (0..9).map(|n| format!("{n}/x.supel")).collect();
    (0..9).for_each(|n| fs::create_dir(place.path(&n.to_string())).expect("a folder"));
    let (plain, names) = names.split_last().expect("nine");
    answer(&mut program(&place, plain));
    for round in 0..2 {
        let started: Vec<_> = names
            .iter()
            .map(|name| {
                let mut command = program(&place, name);
                command.args(["--force", "--threads", "1", "--cache", &place.text("cache")]);
                command.stdout(std::process::Stdio::piped()).spawn().expect("it runs")
            })
            .collect();
        for process in started {
            let output = process.wait_with_output().expect("it ends");
            let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
            let cache = &answer["run"]["cache"];
            assert_eq!((&cache["damaged"], &cache["not_kept"]), (&json!([]), &Value::Null), "{cache}");
            // Who comes late to the first round may find everything.
            assert!(round == 0 || cache["kept"] == json!({}), "{cache}");
        }
    }
    assert!(names.iter().all(|name| place.bytes(name) == place.bytes(plain)));
    let parts = fs::read_dir(place.path("cache")).expect("a folder").count();
    assert_eq!(parts, entries(&place).len() + 1, "the tag, and no part is left");
}

/// `reduce --all` hands it to its runs.
#[test]
fn many_jobs_share_a_cache() {
    let place = Place::with_brick();
    for name in ["a", "b"] {
        let job = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
             interface = [{{ name = \"root\", nodes = [1, 6, 11, 16], coupling = \"rigid\" }}]\n\
             reduction = {{ method = \"craig-bampton\", modes = {{ count = 4 }} }}\n\
             write = {{ superelement = \"{name}.supel\" }}\n"
        );
        place.write(&format!("{name}.toml"), job.as_bytes());
    }
    let [folder, cache] = ["", "cache"].map(|name| place.text(name));
    let run = |more: &[&str]| {
        let words = ["reduce", "--all", &folder, "--cache", &cache];
        let output = Command::new(env!("CARGO_BIN_EXE_supel")).args(words).args(more).output().expect("it runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    run(&["--force"]);
    let kept = entries(&place);
    assert_eq!(of_kind(&kept, "factor").len(), 1, "both have one K");
    run(&["--force"]);
    for name in ["a", "b"] {
        let of_cache = place.report(&format!("{name}.report.json"))["run"]["cache"].clone();
        assert_eq!((&of_cache["taken"]["factor"], &of_cache["kept"]), (&json!(1), &json!({})), "{name}");
    }
}

/// What a report says of the cache in words.
#[test]
fn the_summary_says_what_was_taken() {
    let place = Place::with_brick();
    let words = format!("{RIGID} --method guyan");
    let (_, _, cold) = cached(&place, &words);
    let words_of = |ended: &Ended| ended.out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words_of(&cold).contains("cache nothing taken from earlier runs · 1 factor"), "{}", cold.out);
    let (_, _, warm) = cached(&place, &words);
    let warm = words_of(&warm);
    assert!(warm.contains("cache 1 factor") && warm.contains("nothing kept for later ones"), "{warm}");
    let html = place.text("x.html");
    let cache = place.text("cache");
    let output = place.text("x.supel");
    let mut args = vec!["reduce", "--output", &output, "--html", &html, "--cache", &cache];
    let model = place.model_flags();
    args.extend(model.iter().map(String::as_str));
    args.extend(words.split(' '));
    supel(&args).expect(ExitCode::Done);
    let page = String::from_utf8(place.bytes("x.html")).expect("text");
    assert!(page.contains("taken from earlier runs"), "the page names the cache");
}
