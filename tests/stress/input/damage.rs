//! Files written in other ways, cut short, or with a bit turned over: I-14.

use std::io::Write;

use supel::cli::ExitCode;
use supel::error::Error;
use supel::job::Job;
use supel::memory_forecast::Resources;
use supel_models::{Material, brick};

use super::{assert_done, assert_refused, chain, chain_job, reduce_chain};
use crate::place::{Ended, Place, supel};

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("compression in memory")
}

/// The stiffness of the chain as text.
fn stiffness() -> String {
    String::from_utf8(chain().bytes("K.mtx")).expect("text")
}

/// The smallest solid: one brick, its job in both notations, its tables in two forms each.
fn cube() -> Place {
    let place = Place::with(&brick([1, 1, 1], [1.1, 1.3, 1.7], &Material::UNIT));
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }
interface = [{ name = "foot", nodes = [1, 2, 3] }]
reduction = { method = "craig-bampton", modes = { count = 2 } }
write     = { superelement = "x.supel" }
"#;
    place.write("job.toml", job.as_bytes());
    place
}

fn reduce_cube(place: &Place) -> Ended {
    supel(&["reduce", &place.text("job.toml"), "--output", &place.text("x.supel"), "--threads", "1"])
}

/// Asserts that a run ended as the contract says: done, a failed check, or an error of the table with something to say.
#[track_caller]
fn assert_named(ended: &Ended, case: &str) {
    if matches!(ended.code, ExitCode::Done | ExitCode::CheckFailed) {
        return;
    }
    let said = ended.err.strip_prefix("supel: error[").and_then(|said| said.split_once("]: "));
    let (code, message) = said.unwrap_or_else(|| panic!("{case}: {:?} {}", ended.code, ended.err));
    let known = code == "E-USAGE" || Error::CODES.iter().any(|entry| entry.code == code);
    assert!(known && ended.code != ExitCode::InternalError, "{case}: {:?} {}", ended.code, ended.err);
    assert!(message.trim().len() > 10, "{case}: {}", ended.err);
}

#[test]
fn i_14_ways_to_write_a_matrix() {
    let (whole, text) = (chain(), stiffness());
    assert_done(&whole, &reduce_chain(&whole), &[]);
    let fortran = text.replace("e0", "D+00");
    let (head, tail) = text.split_at(text.len() / 2);
    for (case, bytes) in [
        ("carriage returns", text.replace('\n', "\r\n").into_bytes()),
        ("a byte order mark", format!("\u{feff}{text}").into_bytes()),
        ("tabs", text.replace(' ', "\t").into_bytes()),
        ("blanks around", text.replace('\n', "  \n\t ").into_bytes()),
        ("exponents of Fortran", fortran.clone().into_bytes()),
        ("small exponents of Fortran", fortran.replace('D', "d").into_bytes()),
        ("no last line end", text.trim_end().as_bytes().to_vec()),
        ("gzip", gzip(text.as_bytes())),
        ("gzip in two members", [gzip(head.as_bytes()), gzip(tail.as_bytes())].concat()),
    ] {
        let place = chain();
        // Banners are words between blanks.
        place.write("K.mtx", &bytes);
        let ended = reduce_chain(&place);
        assert_eq!(ended.code, ExitCode::Done, "{case}: {}", ended.err);
        assert_eq!(place.superelement("x.supel").tensors(), whole.superelement("x.supel").tensors(), "{case}");
    }
}

#[test]
fn i_14_what_no_matrix_is() {
    let refused = |bytes: &[u8], code: &str, parts: &[&str]| {
        let place = chain();
        place.write("K.mtx", bytes);
        assert_refused(&place, &reduce_chain(&place), code, parts);
    };
    let commas = stiffness().replace("-1e0", "-1,5").replace("2e0", "2,5");
    refused(commas.as_bytes(), "E-ENTRY", &["K.mtx:4", "`-1,5`", "a number"]);
    let bomb = [stiffness().as_bytes(), &b"%\n".repeat(4 << 20)].concat();
    refused(&gzip(&bomb), "E-PACKED-BOMB", &["1000 times", "at most 1000 times"]);
    refused(&[0; 4096], "E-BANNER", &["not a matrix"]);
    refused(&[0xff; 1 << 18], "E-LINE", &["check that this is a text file"]);
}

/// At every byte: what is cut off is missed, or was not needed.
#[test]
fn i_14_a_matrix_cut_at_every_byte() {
    let whole = chain();
    assert_done(&whole, &reduce_chain(&whole), &[]);
    let expected = whole.superelement("x.supel").tensors().clone();
    let text = stiffness();
    let windows = format!("\u{feff}{}", text.replace('\n', "\r\n").replace(' ', "\t").replace("e0", "D0"));
    for (case, bytes) in
        [("plain", text.clone().into_bytes()), ("windows", windows.into_bytes()), ("gzip", gzip(text.as_bytes()))]
    {
        let place = chain();
        for end in 0..bytes.len() {
            place.write("K.mtx", &bytes[..end]);
            let ended = reduce_chain(&place);
            assert_named(&ended, &format!("{case}, {end} bytes"));
            if ended.code == ExitCode::Done {
                assert_eq!(place.superelement("x.supel").tensors(), &expected, "{case}, {end} bytes");
            }
        }
    }
}

/// The tables of a model cut at every byte: an error, a warning, or the same superelement.
#[test]
fn i_14_tables_cut_at_every_byte() {
    let whole = cube();
    assert_done(&whole, &reduce_cube(&whole), &[]);
    let expected = whole.superelement("x.supel").tensors().clone();
    let (map, nodes) = (whole.bytes("dofs.txt"), whole.bytes("nodes.csv"));
    let as_table = format!("node,dof\n{}", String::from_utf8_lossy(&map).replace('.', ","));
    for (name, bytes) in [
        ("dofs.txt", map.clone()),
        ("dofs.txt", as_table.into_bytes()),
        ("dofs.txt", gzip(&map)),
        ("nodes.csv", nodes.clone()),
        ("nodes.csv", gzip(&nodes)),
    ] {
        let place = cube();
        for end in 0..bytes.len() {
            place.write(name, &bytes[..end]);
            let ended = reduce_cube(&place);
            assert_named(&ended, &format!("{name}, {end} bytes"));
            let is_warned = ended.out.contains("W-COORD-ROUNDED");
            if ended.code == ExitCode::Done && !is_warned {
                assert_eq!(place.superelement("x.supel").tensors(), &expected, "{name}, {end} bytes");
            }
        }
    }
}

/// The job cut at every byte, in both notations.
#[test]
fn i_14_a_job_cut_at_every_byte() {
    let whole = cube();
    assert_done(&whole, &reduce_cube(&whole), &[]);
    let json = supel(&["inspect", &whole.text("x.supel"), "--job"]).out;
    let expected = whole.superelement("x.supel").tensors().clone();
    let place = cube();
    for (name, text) in [("job.toml", String::from_utf8(whole.bytes("job.toml")).expect("text")), ("job.json", json)] {
        for end in 0..text.len() {
            place.write(name, &text.as_bytes()[..end]);
            let ended = supel(&["reduce", &place.text(name), "--output", &place.text("x.supel"), "--threads", "1"]);
            assert_named(&ended, &format!("{name}, {end} bytes"));
            if ended.code == ExitCode::Done {
                assert_eq!(place.superelement("x.supel").tensors(), &expected, "{name}, {end} bytes");
            }
        }
    }
}

/// Every bit of a matrix and of its gzipped form. What gzip still accepts is the same matrix: the turned bit is one of the
/// time stamp and the like.
#[test]
fn i_14_every_bit_turned_over() {
    let whole = chain();
    assert_done(&whole, &reduce_chain(&whole), &[]);
    let expected = whole.superelement("x.supel").tensors().clone();
    let text = stiffness().into_bytes();
    let place = chain();
    place.write("job.toml", chain_job().as_bytes());
    let job = Job::read(&place.path("job.toml")).expect("a job");
    for (case, bytes) in [("plain", text.clone()), ("gzip", gzip(&text))] {
        for bit in 0..8 * bytes.len() {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            place.write("K.mtx", &flipped);
            match supel::reduce(&job, Resources::default(), &mut ()) {
                Ok(outcome) if case == "gzip" => assert_eq!(outcome.superelement.tensors(), &expected, "bit {bit}"),
                Ok(_) => {}
                Err(error) => assert!(error.to_string().len() > 10, "{case}, bit {bit}: {error}"),
            }
        }
    }
}
