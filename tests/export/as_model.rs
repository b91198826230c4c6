//! A superelement read as a model without an export: its matrices, map, nodes and loads.

use supel::cli::ExitCode;
use supel_models::{Material, brick};
use supel_runtime::{Flag, Matrix, Metadata, Superelement, Verdict};
use supel_testing::place::{Ended, Place, assert_close, frequencies_hz, supel};

use super::{HELD, assert_same_bits, export, reduced};

/// `supel reduce` of a job whose model is x.supel.
fn reduce_rows(place: &Place, keys: &str, interface: &str) -> Ended {
    let job = format!(
        "interface = [{{ name = \"all\", nodes = {interface} }}]\nreduction = {{ method = \"craig-bampton\", modes = {{ count = 3 }} }}\n\
         write = {{ superelement = \"second.supel\" }}\n\
         [model]\nstiffness = \"x.supel\"\nmass = \"x.supel\"\n{keys}\n"
    );
    place.write("second.toml", job.as_bytes());
    supel(&["reduce", &place.text("second.toml")])
}

const WITH_NODES: &str = "dofs = \"x.supel\"\nnodes = \"x.supel\"";

/// x.supel with other metadata.
fn altered(place: &Place, alter: impl Fn(&mut Metadata)) {
    let file = place.superelement("x.supel");
    let mut metadata = file.metadata().clone();
    alter(&mut metadata);
    let file = Superelement::new(file.tensors().clone(), metadata).expect("a superelement still");
    place.write("x.supel", &file.to_bytes().expect("bytes").bytes);
}

#[track_caller]
fn assert_refused(ended: Ended, words: &[&str]) {
    let told = ended.expect(ExitCode::InputData).err;
    for word in words {
        assert!(told.contains(word), "{word:?} is not in {told}");
    }
}

#[test]
fn matrices_have_their_names_and_their_bits() {
    let place = reduced("herting", "");
    let file = place.superelement("x.supel");
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let target = place.text("one.npz");
        supel(&["convert", &format!("{}:{name}", place.text("x.supel")), &target]).expect(ExitCode::Done);
        let read = supel::input::SingleMatrix { file: target.into(), layout: None, dofs: None };
        let matrix = read.read(&supel::input::Allowance::of(None)).expect("a matrix").input.matrix;
        let n = matrix.rows();
        (0..n).map(|i| (0..n).map(|j| matrix.get(i, j).copied().unwrap_or(0.0)).collect()).collect()
    };
    assert_same_bits(&rows("stiffness"), &file.tensors().stiffness, "stiffness");
    assert_same_bits(&rows("mass"), &file.tensors().mass, "mass");
    let other = format!("{}:damping", place.text("x.supel"));
    assert_refused(supel(&["convert", &other, &place.text("d.npz")]), &["E-NO-SUCH-MATRIX", "stiffness", "mass"]);
}

/// Without a word of the job a condensed stiffness has the digits that rigid-body motion shows; taken for exact, its motions of energy below zero show
/// that they are rounded.
#[test]
fn digits_of_a_condensed_stiffness_are_seen() {
    let place = Place::with(&brick([24, 1, 1], [3.0, 0.05, 0.04], &Material::STEEL_SI));
    let ends = "--rigid-interface left=1,26,51,76 --rigid-interface right=25,50,75,100";
    place.reduce(&place.model_flags(), &format!("{ends} --method craig-bampton --modes 4")).expect(ExitCode::Done);
    reduce_rows(&place, WITH_NODES, "\"group:left\"").expect(ExitCode::Done);
    let report = place.report("second.report.json");
    let stiffness = &report["body"]["model"]["stiffness"];
    assert_eq!(stiffness["digits_by"], "rigid-motion", "{report:#}");
    assert!(stiffness["digits"].as_u64().is_some_and(|digits| (4..16).contains(&digits)), "{stiffness}");
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    let exported = String::from_utf8(place.bytes("x.job.toml")).expect("text");
    assert!(exported.contains(&format!("stiffness_digits = {}\n", stiffness["digits"])), "{stiffness}: {exported}");
    let seen = frequencies_hz(&place.superelement("second.supel"));
    let stated = reduce_rows(&place, &format!("{WITH_NODES}\nstiffness_digits = 17"), "\"group:left\"");
    stated.expect(ExitCode::Done);
    assert_close(&frequencies_hz(&place.superelement("second.supel")), &seen, 1e-9);
}

#[test]
fn interfaces_are_groups_and_rows_may_stand_alone() {
    let place = reduced("herting", "");
    reduce_rows(&place, WITH_NODES, "\"group:hub\"").expect(ExitCode::Done);
    let second = place.superelement("second.supel");
    let first = place.superelement("x.supel");
    let hub = &first.metadata().interface_nodes[3];
    assert_eq!(second.metadata().interface_nodes[0].position, hub.position);
    reduce_rows(&place, "", "{ rows = [0, 1, 2, 9, 10, 11, 12, 13, 14] }").expect(ExitCode::Done);
}

#[test]
fn what_was_made_of_a_superelement_is_verified_against_it() {
    let place = reduced("craig-bampton", "");
    let file = place.text("x.supel");
    supel(&["reduce", &file, "--modes", "2"]).expect(ExitCode::Done);
    let made = place.text("x.again.supel");
    supel(&["verify", &made, "--reproduce"]).expect(ExitCode::Done);
    supel(&["plan", &file]).expect(ExitCode::Done);
    // The job of the file keeps five modes, and the one that made it two.
    assert!(supel(&["verify", &made, "--job", &file]).expect(ExitCode::CheckFailed).out.contains("modes"));
    supel(&["reduce", &file]).expect(ExitCode::Done);
    supel(&["verify", &made, "--job", &file]).expect(ExitCode::Done);
    // Another superelement under the same name is another model.
    place.write("x.supel", &reduced("herting", "").bytes("x.supel"));
    let told = supel(&["verify", &made, "--reproduce"]).expect(ExitCode::CheckFailed).out;
    assert!(told.lines().any(|line| line.contains("M-26") && line.contains("fail")), "{told}");
}

#[test]
fn what_is_no_model_is_refused_by_its_reason() {
    let place = reduced("herting", "");
    altered(&place, |metadata| metadata.verification.verdict = Verdict::Fail);
    assert_refused(reduce_rows(&place, WITH_NODES, "[1]"), &["E-NO-MODEL", "failed a check", "--allow-unverified"]);
    let place = reduced("herting", "");
    altered(&place, |metadata| metadata.flags.extend([Flag::Preloaded]));
    for ended in [supel(&["reduce", &place.text("x.supel")]), reduce_rows(&place, WITH_NODES, "[1]")] {
        assert_refused(ended, &["E-NO-MODEL", "preloaded"]);
    }
    let place = reduced("macneal", "");
    for ended in [supel(&["reduce", &place.text("x.supel")]), reduce_rows(&place, WITH_NODES, "[1]")] {
        assert_refused(ended, &["E-NO-MODEL", "singular mass"]);
    }
    // Rubin's coordinates, in which amplitudes of rigid-body motion stand next to the interface.
    let place = Place::with_brick();
    place.reduce(&place.model_flags(), "--interface pin=1 --method rubin --modes 4").expect(ExitCode::Done);
    assert_refused(reduce_rows(&place, WITH_NODES, "[1]"), &["E-NO-MODEL", "no dof map can say"]);
    let place = Place::with_brick();
    let rows = "--interface ends=rows:0,1,2,30,31,32,120,121,122,132,133,134 --method guyan";
    place.reduce(&place.matrix_flags(), rows).expect(ExitCode::Done);
    assert_refused(reduce_rows(&place, WITH_NODES, "[1]"), &["E-NO-MODEL", "rows without nodes"]);
}

#[test]
fn a_superelement_without_a_second_job_says_why() {
    let place = Place::with_brick();
    for (flags, why) in [
        ("--rigid-interface foot=1,11,31,41 --method guyan", "just holds it"),
        ("--method rubin --modes 5", "no interface"),
    ] {
        place.reduce(&place.model_flags(), flags).expect(ExitCode::Done);
        assert_refused(supel(&["reduce", &place.text("x.supel")]), &["E-NO-MODEL", why, "docs/export.md"]);
    }
    // A stiffness that rounding may have left, at a dof that rigid-body motion does not move alone.
    let place = reduced("herting", "");
    let file = place.superelement("x.supel");
    let mut tensors = file.tensors().clone();
    let stiffness = &file.tensors().stiffness;
    let factor = |row: usize| if row == 0 { 1e-6 } else { 1.0 };
    tensors.stiffness =
        Matrix::from_fn(stiffness.rows(), stiffness.cols(), |i, j| factor(i) * factor(j) * stiffness[(i, j)]);
    let file = Superelement::new(tensors, file.metadata().clone()).expect("a superelement still");
    place.write("x.supel", &file.to_bytes().expect("bytes").bytes);
    let why = "no stiffness but rounding at a dof";
    for ended in [supel(&["reduce", &place.text("x.supel")]), reduce_rows(&place, WITH_NODES, "[1]")] {
        assert_refused(ended, &["E-NO-MODEL", why]);
    }
    place.write("x.supel", &place.bytes("x.supel")[..5000]);
    assert_refused(supel(&["reduce", &place.text("x.supel")]), &["E-SUPERELEMENT"]);
    assert_refused(supel(&["plan", &place.text("x.supel")]), &["E-SUPERELEMENT"]);
    export(&place, "matrix-market", &[]).expect(ExitCode::InputData);
}

/// `gzip x.supel`, as people pack what they send.
#[test]
fn a_packed_superelement_is_to_be_unpacked() {
    let place = reduced("herting", "");
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    std::io::Write::write_all(&mut packed, &place.bytes("x.supel")).expect("packed");
    place.write("x.supel.gz", &packed.finish().expect("packed"));
    let file = place.text("x.supel.gz");
    let output = place.text("y.supel");
    let model = ["reduce", "--stiffness", &file, "--mass", &file, "--method", "guyan", "--output", &output];
    for args in [["reduce", file.as_str()].as_slice(), &["inspect", &file], &["verify", &file], &model] {
        assert_refused(supel(args), &["E-FORMAT", "a packed superelement", "unpack it"]);
    }
}

/// The rows of a matrix of a superelement are those of its coordinates.
#[test]
fn rows_of_a_superelement_have_names() {
    let place = reduced("herting", "");
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    let (mass, table) = (format!("{}:mass", place.text("x.supel")), place.text("rows.csv"));
    supel(&["convert", &mass, &place.text("mass.npz"), "--write-dofs", &table]).expect(ExitCode::Done);
    assert_eq!(place.bytes("rows.csv"), place.bytes("x.dofs.csv"));
    // Rows of no node, and amplitudes that move.
    for (model, rest) in [
        (place.matrix_flags(), "--interface ends=rows:0,1,2,30,31,32,120,121,122,132,133,134 --method guyan"),
        (place.model_flags(), "--interface pin=1 --method rubin --modes 4"),
    ] {
        place.reduce(&model, rest).expect(ExitCode::Done);
        let unnamed = supel(&["convert", &mass, &place.text("mass.npz"), "--write-dofs", &table]);
        assert_refused(unnamed, &["E-ROWS-UNNAMED"]);
    }
}

/// What is read of a superelement counts, whatever it is read for.
#[test]
fn all_parts_of_a_superelement_take_memory() {
    use supel::input::{Allowance, WantedColumn, WantedColumns, columns_of_file, nodes};
    let place = reduced("herting", "");
    let (path, size) = (place.path("x.supel"), place.bytes("x.supel").len() as u64);
    let columns = [WantedColumn { load: "push", column: Some(0) }];
    let wanted = WantedColumns { path: &path, columns: &columns, n_rows: 1 };
    let too_little = Allowance::of(Some(size / 2));
    for error in [columns_of_file(wanted, &too_little).map(drop), nodes(&path, &too_little).map(drop)] {
        assert_eq!(error.expect_err("too little").code(), "E-MEM-READ");
    }
}

/// Modal amplitudes of two components have as many rows, and not the same meaning.
#[test]
fn parts_of_two_superelements_are_no_model() {
    let place = reduced("craig-bampton", "");
    place.write("other.supel", &reduced("craig-bampton", HELD).bytes("x.supel"));
    for (keys, what) in [
        ("stiffness = \"x.supel\"\nmass = \"other.supel\"", "the mass"),
        (
            "stiffness = \"other.supel\"\nmass = \"other.supel\"\ndofs = \"x.supel\"\nnodes = \"other.supel\"",
            "the dof map",
        ),
        ("stiffness = \"x.supel\"\nmass = \"x.supel\"\ndofs = \"x.supel\"\nnodes = \"other.supel\"", "the nodes"),
    ] {
        let job = format!(
            "interface = [{{ name = \"all\", nodes = {{ rows = [0, 1, 2, 3, 4, 5, 6, 7, 8] }} }}]\n\
             reduction = {{ method = \"guyan\" }}\nwrite = {{ superelement = \"y.supel\" }}\n[model]\n{keys}\n"
        );
        place.write("mixed.toml", job.as_bytes());
        assert_refused(supel(&["reduce", &place.text("mixed.toml")]), &["E-OTHER-SUPERELEMENT", what, "x.supel"]);
    }
    let exchanged = ["doctor", &place.text("x.supel:mass"), &place.text("x.supel:stiffness")];
    let told = supel(&exchanged).expect(ExitCode::CheckFailed);
    assert!(told.out.contains("exchange the two names"), "{}", told.out);
}

/// Loads come by their column, with as many rows as the superelement has.
#[test]
fn loads_are_columns_of_the_superelement() {
    let place = Place::with_brick();
    let load = |name: &str, node: u32| {
        format!("[[load]]\nname = \"{name}\"\nnodes = [{node}]\nforce = [0.0, 1.0, 0.0]\nresidual = false\n")
    };
    let job = format!(
        "reduction = {{ method = \"herting\", modes = {{ count = 4 }} }}\nwrite = {{ superelement = \"x.supel\" }}\n\
         [model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n\
         [[interface]]\nname = \"foot\"\nnodes = [1, 3, 15, 31]\n{}{}",
        load("first", 25),
        load("second", 45)
    );
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    let second = |column: usize| {
        let load = format!(
            "{WITH_NODES}\n[[load]]\nname = \"the other\"\nfile = \"x.supel\"\ncolumn = {column}\nresidual = false"
        );
        reduce_rows(&place, &load, "\"group:foot\"")
    };
    second(1).expect(ExitCode::Done);
    let vectors = |name: &str| place.superelement(name).tensors().load_vectors.clone().expect("load vectors");
    let (given, found) = (vectors("x.supel"), vectors("second.supel"));
    // Both files begin with the same twelve interface dofs. In the second Ψᵀf comes through K̂ and has its digits; they are credited with 10⁻⁹
    // at most.
    let digits = place.report("second.report.json")["body"]["model"]["stiffness"]["digits"].as_u64().expect("a number");
    let tolerance = 0.1f64.powi(digits as i32 - 1).min(1e-9);
    let largest = (0..12).map(|row| given[(row, 1)].abs()).fold(0.0, f64::max);
    for row in 0..12 {
        let off = (found[(row, 0)] - given[(row, 1)]).abs() / largest;
        assert!(off < tolerance, "row {row}: {off:e}, {digits} digits");
    }
    let differ = (0..12).any(|row| (given[(row, 0)] - given[(row, 1)]).abs() > 0.1 * largest);
    assert!(differ, "two columns of one content would not tell which was taken");
    assert_refused(second(2), &["E-LOAD-COLUMN"]);
}
