//! Files that readers of ours have to survive, each handed to the fuzz target of its folder in `fuzz/regressions`: what a fuzzer finds is put
//! there, next to files that promise more than they have. The seeds that are made for the targets are handed to them, too.

#[path = "../fuzz/src/lib.rs"]
#[allow(unreachable_pub, reason = "the library of the fuzz targets")]
mod targets;

use std::path::{Path, PathBuf};

use supel::job::Layout;

/// What the target of this name is given.
fn target(name: &str) -> fn(&[u8]) {
    match name {
        "matrix_market" => |content| targets::read_matrix(content, Some(Layout::MatrixMarket)),
        "coordinate" => |content| targets::read_matrix(content, Some(Layout::Coordinate)),
        "abaqus_labels" => |content| targets::read_matrix(content, Some(Layout::AbaqusLabels)),
        "user_element" => |content| targets::read_matrix(content, Some(Layout::UserElement)),
        "dmig" => |content| targets::read_matrix(content, Some(Layout::Dmig)),
        "op4" => |content| targets::read_matrix(content, Some(Layout::Op4)),
        "harwell_boeing" => |content| targets::read_matrix(content, Some(Layout::HarwellBoeing)),
        "npz" => |content| targets::read_matrix(content, Some(Layout::Npz)),
        "npy" => |content| targets::read_matrix(content, Some(Layout::Npy)),
        "matlab5" => |content| targets::read_matrix(content, Some(Layout::Matlab5)),
        "any_matrix" => |content| targets::read_matrix(content, None),
        "dof_map" => targets::read_dof_map,
        "node_table" => targets::read_nodes,
        "mesh" => targets::read_mesh,
        "modes" => targets::read_modes,
        "superelement" => targets::read_superelement,
        "job" => targets::read_job,
        "assembly" => targets::read_assembly,
        "states" => targets::read_states,
        "values" => targets::read_values,
        "expansion" => targets::read_expansion,
        other => panic!("{other} is no target"),
    }
}

fn fuzz() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz")
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> =
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    found.sort();
    found
}

fn name(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).expect("a name")
}

#[test]
fn every_regression_ends_in_a_value_or_an_error() {
    let mut n_files = 0;
    for folder in ["regressions", "seeds_own"].iter().flat_map(|kind| files_below(&fuzz().join(kind))) {
        for file in files_below(&folder) {
            println!("{}", file.display());
            target(name(&folder))(&std::fs::read(&file).expect("a file"));
            n_files += 1;
        }
    }
    assert!(n_files >= 20, "{n_files}");
}

/// A target that nobody runs finds nothing: each has a program and seeds, and a function here.
#[test]
fn every_target_is_run() {
    let script = std::fs::read_to_string(fuzz().join("run.sh")).expect("the script");
    let manifest = std::fs::read_to_string(fuzz().join("Cargo.toml")).expect("the manifest");
    for program in files_below(&fuzz().join("fuzz_targets")) {
        let name = name(&program).trim_end_matches(".rs");
        target(name);
        assert!(manifest.contains(&format!("name = \"{name}\"")), "{name} is not built");
        let has_seeds = script.contains(&format!("seeds {name} ")) || script.contains(&format!("seeds/{name} "));
        assert!(has_seeds, "{name} has no seeds");
    }
}

/// Each small file cut at every byte.
#[test]
fn what_is_cut_ends_in_a_value_or_an_error() {
    let fixtures = fuzz().join("../fixtures");
    let of_fixtures =
        [("dof_map", "text/truss.dof"), ("node_table", "text/truss.csv"), ("job", "../examples/bracket/job.toml")];
    let mut files: Vec<(String, PathBuf)> =
        of_fixtures.map(|(target, file)| (target.to_owned(), fixtures.join(file))).to_vec();
    for folder in files_below(&fuzz().join("seeds_own")) {
        files.extend(files_below(&folder).into_iter().map(|file| (name(&folder).to_owned(), file)));
    }
    for (of, file) in files {
        let content = std::fs::read(&file).expect("a file");
        (0..content.len().min(2000)).for_each(|end| target(&of)(&content[..end]));
    }
}
