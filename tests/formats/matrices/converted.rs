//! `supel convert`: what is written in every format is what was read, to the bit.

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use serde_json::Value;
use supel::input::{Allowance, SingleMatrix};

use super::fixture;

pub(crate) fn supel(words: &[&str]) -> std::process::Output {
    Command::cargo_bin("supel").expect("the program").args(words).output().expect("it ran")
}

pub(crate) fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

fn single(path: &Path) -> supel::input::ReadSingle {
    let matrix = SingleMatrix { file: path.to_owned(), layout: None, dofs: None };
    matrix.read(&Allowance::of(None)).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Endings, and formats where the ending does not say it.
const TARGETS: [(&str, Option<&str>); 5] =
    [("mtx", None), ("npz", None), ("op4", None), ("op4", Some("op4-binary")), ("mat", None)];

/// A matrix that is not symmetric, with strings of several rows, numbers of every size and an empty column.
pub(crate) fn unsymmetric(folder: &Path) -> PathBuf {
    let path = folder.join("u.mtx");
    let text = "%%MatrixMarket matrix coordinate real general\n5 5 7\n1 1 0.1\n2 1 -3.0000000000000004e-300\n3 1 1e300\n5 1 7\n\
        2 3 4.9406564584124654e-324\n1 5 -0.333333333333333314829616256247\n5 5 1.7976931348623157e308\n";
    std::fs::write(&path, text).expect("written");
    path
}

#[test]
fn bits_survive_every_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let skew = folder.path().join("skew.mtx");
    let of_skew = "%%MatrixMarket matrix coordinate real skew-symmetric\n3 3 2\n2 1 0.1\n3 2 -1e-5\n";
    std::fs::write(&skew, of_skew).expect("written");
    for (source, shape) in
        [(fixture("k_csc.npz"), "symmetric"), (unsymmetric(folder.path()), "general"), (skew, "skew-symmetric")]
    {
        let reference = single(&source).input.matrix;
        for (ending, to) in TARGETS {
            let output = folder.path().join(format!("out.{ending}"));
            let mut words = vec!["convert", text(&source), text(&output), "--json"];
            words.extend(to.into_iter().flat_map(|to| ["--to", to]));
            let ended = supel(&words);
            assert!(ended.status.success(), "{words:?}: {}", String::from_utf8_lossy(&ended.stderr));
            let answer: Value = serde_json::from_slice(&ended.stdout).expect("JSON");
            assert_eq!(answer["matrix"]["shape"], shape, "{answer}");
            let schema =
                std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas/conversion.schema.json"));
            let schema: Value = serde_json::from_str(&schema.expect("a schema")).expect("JSON");
            assert!(jsonschema::validator_for(&schema).expect("a schema").is_valid(&answer), "{answer}");
            let matrix = single(&output).input.matrix;
            let bits = |matrix: &supel::sparse::SparseMatrix| -> Vec<(usize, usize, u64)> {
                matrix.iter().map(|(value, (row, col))| (row as usize, col as usize, value.to_bits())).collect()
            };
            assert_eq!(bits(&matrix), bits(&reference), "{} as {ending} {to:?}", source.display());
            let bytes = std::fs::read(&output).expect("written");
            supel(&words);
            assert!(std::fs::read(&output).expect("written") == bytes, "the same bytes again, {ending}");
        }
    }
}

#[test]
fn names_and_rows_are_carried() {
    let folder = tempfile::tempdir().expect("a folder");
    let (out, map) = (folder.path().join("k.op4"), folder.path().join("dofs.csv"));
    let source = fixture("small.bdf:K2PP");
    let ended = supel(&["convert", text(&source), text(&out), "--write-dofs", text(&map)]);
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    assert!(String::from_utf8_lossy(&ended.stdout).contains("(dmig): 6 rows, 22 entries, symmetric"));
    assert!(std::fs::read_to_string(&out).expect("written").contains("K2PP    1P,3E24.16"));
    assert_eq!(std::fs::read_to_string(&map).expect("written"), "node,dof\n1,ux\n1,uy\n1,uz\n7,ux\n7,uy\n20,scalar\n");
    let bare = folder.path().join("bare.npz");
    let ended = supel(&["convert", text(&out), text(&bare), "--write-dofs", text(&map)]);
    assert_eq!(ended.status.code(), Some(3), "{}", String::from_utf8_lossy(&ended.stderr));
    assert!(!bare.exists(), "nothing is written");
    for (words, code) in [
        (vec!["convert", text(&out), "k.txt"], 2),
        (vec!["convert", text(&out), text(&out)], 2),
        (vec!["convert", text(&out), text(&bare), "--name", "1K"], 2),
        // An OP4 file has room for eight letters.
        (vec!["convert", text(&out), "k.op4", "--name", "KAA123456"], 2),
        (vec!["convert", "absent.op4:K", text(&bare)], 7),
    ] {
        assert_eq!(supel(&words).status.code(), Some(code), "{words:?}");
        assert!(!bare.exists());
    }
}
