//! Modes in result files of CalculiX: those that CalculiX wrote of the crank of the examples, and files with something else in them.

use std::path::Path;

use serde_json::Value;
use supel::cli::ExitCode;
use supel::dofs::{Direction, Dof};
use supel::error::{Error, Result};
use supel::input::{Allowance, ForeignModes, ModeRows, foreign_modes};
use supel_models::Model;
use supel_models::transform::supported;
use supel_testing::place::{Ended, Place, steel_brick, supel};

use super::{Pairs, lowest, missing, of_kind, verdict};

fn root(name: &str) -> String {
    format!("{}/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// `supel certify` of a result of the crank, whose matrices are those without supports.
fn crank(result: &str, flags: &[&str]) -> Ended {
    let [k, m, dofs, nodes] = ["crank.sti.gz", "crank.mas.gz", "crank.dof", "crank.inp"]
        .map(|name| root(&format!("examples/calculix/{name}")));
    supel(&[&["certify", &k, &m, result, "--dofs", &dofs, "--nodes", &nodes], flags].concat())
}

fn json(ended: Ended, code: ExitCode) -> Value {
    serde_json::from_str(&ended.expect(code).out).expect("JSON")
}

/// What the table of CalculiX says, in Hz.
const STATED: [f64; 6] = [681.3101857, 1088.994456, 1838.489322, 2986.750349, 5578.634225, 8706.276265];

/// Supports are rows of zeros here, and the step before has displacements that are no mode.
#[test]
fn modes_that_calculix_wrote_are_certified() {
    for (name, limit) in [("held.frd.gz", 6), ("held_binary.frd.gz", 7)] {
        let result = root(&format!("fixtures/calculix/{name}"));
        let found = json(crank(&result, &["--fix", "shaft=group:SHAFT", "--json", "--strict"]), ExitCode::Done);
        assert_eq!((&found["result"]["program"], &found["result"]["n_pairs"]), (&"CalculiX".into(), &6.into()));
        assert_eq!(found["result"]["frequencies"], "frequencies in Hz", "{found}");
        assert_eq!(of_kind(&found, "mode"), [1, 2, 3, 4, 5, 6], "{found}");
        for (pair, stated) in found["pairs"].as_array().expect("pairs").iter().zip(STATED) {
            assert_eq!(pair["stated_hz"].as_f64(), Some(stated), "{pair}");
            let of_shape = pair["shape_hz"].as_f64().expect("a frequency");
            assert!((of_shape / stated - 1.0).abs() < 1e-6, "{limit} digits: {of_shape} and {stated}");
        }
    }
}

/// The shaft moves in the free crank, so that modes of the held one are none of its own.
#[test]
fn modes_of_other_supports_are_not_certified() {
    let found = json(crank(&root("fixtures/calculix/held.frd.gz"), &["--json"]), ExitCode::CheckFailed);
    assert_eq!(of_kind(&found, "mode"), Vec::<u64>::new(), "{found}");
}

#[test]
fn a_step_is_named_by_its_number() {
    let result = root("fixtures/calculix/held.frd.gz");
    crank(&format!("{result}:2"), &["--fix", "shaft=group:SHAFT"]).expect(ExitCode::Done);
    let ended = crank(&format!("{result}:1"), &["--fix", "shaft=group:SHAFT"]).expect(ExitCode::InputData);
    assert!(ended.err.contains("E-MODES-NODES") && ended.err.contains("no modes of step 1"), "{}", ended.err);
    let ended = crank(&format!("{result}:last"), &[]).expect(ExitCode::InputData);
    assert!(ended.err.contains("\"last\" for the number of a step"), "{}", ended.err);
}

/// A number as C writes it by `%12.5E`.
fn number(value: f64) -> String {
    let text = format!("{value:.5E}");
    let (mantissa, exponent) = text.split_once('E').expect("an exponent");
    let exponent: i32 = exponent.parse().expect("a number");
    format!("{:>12}", format!("{mantissa}E{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs()))
}

/// A block of displacements, of a kind of step, as CalculiX writes one; `of` gives those of a node.
fn block(hertz: f64, (kind, name): (u8, &str), labels: &[i64], of: impl Fn(i64) -> [f64; 3]) -> String {
    let (frequency, n) = (number(hertz), labels.len());
    let mut text =
        format!("  100CL  101{frequency}{n:>12}{:20}{kind:>2}    1MODAL      1\n -4  {name:<8}    4    1\n", "");
    for (at, component) in ["D1", "D2", "D3", "ALL"].iter().enumerate() {
        let is_computed = u8::from(at == 3);
        text += &format!(" -5  {component:<8}    1    2{:>5}    0{is_computed:>5}\n", at + 1);
    }
    for label in labels {
        let values = of(*label).map(number).concat();
        text += &format!(" -1{label:>10}{values}\n");
    }
    text + " -3\n"
}

fn step(number: u8, diameter: i8) -> String {
    format!("    1PSTEP{:>26}{:>12}{number:>12}\n    1PHID{diameter:>27}\n", 1, 1)
}

const HEAD: &str = "    1C\n    1UUSER\n";

/// A result file of pairs of a model, on all nodes of another one.
fn file(model: &Model, pairs: &Pairs, labels: &[i64]) -> String {
    let modes = pairs.hertz.iter().zip(&pairs.shapes).map(|(hertz, shape)| {
        let largest = shape.iter().fold(0.0f64, |max, value| max.max(value.abs()));
        let of_node = |label: i64| {
            let row = |axis: u8| model.dofs.iter().position(|dof| *dof == (label, axis));
            [0, 1, 2].map(|axis| row(axis).map_or(0.0, |row| shape[row] / largest))
        };
        step(1, -1) + &block(*hertz, (2, "DISP"), labels, of_node)
    });
    HEAD.to_owned() + &modes.collect::<String>() + " 9999\n"
}

fn certified(place: &Place, code: ExitCode) -> Value {
    let [k, m, result, dofs] = ["K.mtx", "M.mtx", "job.frd", "dofs.txt"].map(|name| place.text(name));
    json(supel(&["certify", &k, &m, &result, "--dofs", &dofs, "--json"]), code)
}

/// Six digits of shapes and of small frequencies are what the file has, and no reason to doubt it.
#[test]
fn a_mode_that_is_left_out_is_named() {
    let model = steel_brick();
    let mut pairs = lowest(&model, 12);
    pairs.hertz[..6].fill(0.0);
    let lost = pairs.hertz[8];
    let place = Place::with(&model);
    place.write("job.frd", file(&model, &pairs, &model.labels).as_bytes());
    let found = certified(&place, ExitCode::Done);
    assert_eq!((&found["verdict"], missing(&found)), (&"pass".into(), Vec::new()), "{found}");
    assert_eq!(found["notes"].to_string().matches("left out").count(), 0, "{found}");
    place.write("job.frd", file(&model, &pairs.without(8), &model.labels).as_bytes());
    let found = certified(&place, ExitCode::CheckFailed);
    let [missing] = missing(&found)[..] else { panic!("{found}") };
    assert!((missing / lost - 1.0).abs() < 1e-9, "{missing} and {lost}");
    assert_eq!(verdict(&found, "M-01"), Some("pass"), "{found}");
}

/// CalculiX takes the rows of supports out of K and M, and lists their nodes in the results all the same.
#[test]
fn nodes_without_rows_are_left_out_and_told() {
    let free = steel_brick();
    let model = supported(&free, |(label, _)| label % 5 == 1);
    let pairs = lowest(&model, 8);
    let place = Place::with(&model);
    place.write("job.frd", file(&model, &pairs, &free.labels).as_bytes());
    let found = certified(&place, ExitCode::Done);
    let told = format!("{} displacements of a mode in the file, zero, left out", free.n - model.n);
    assert!(found["notes"].to_string().contains(&told), "{found}");
    // What moves without a row follows others by a constraint of the deck.
    let held = free.labels.iter().find(|label| *label % 5 == 1).expect("a held node");
    let moved = file(&model, &pairs, &free.labels)
        .replace(&format!(" -1{held:>10}{}", number(0.0)), &format!(" -1{held:>10}{}", number(0.5)));
    place.write("job.frd", moved.as_bytes());
    let notes = certified(&place, ExitCode::Done)["notes"].to_string();
    assert!(notes.contains("1 displacement of a mode in the file, not zero, left out"), "{notes}");
}

/// Reads a file for two nodes, 4 and 7, of which the second has no row along z.
fn read(path: &Path) -> Result<ForeignModes> {
    let dof = |node, direction| Some(Dof { node, direction });
    let [ux, uy, uz] = [Direction::Ux, Direction::Uy, Direction::Uz];
    let left = [dof(7, ux), dof(7, uy), dof(4, uz), dof(4, ux), dof(4, uy)].into_iter().enumerate().collect();
    foreign_modes(path, &ModeRows { n: 5, left, turning: None }, &Allowance::of(None))
}

fn read_text(text: &[u8]) -> Result<ForeignModes> {
    let place = Place::new();
    place.write("job.frd", text);
    read(&place.path("job.frd"))
}

fn of_two(label: i64) -> [f64; 3] {
    if label == 4 { [0.25, -1.5e-3, 1.0] } else { [1.0 / 3.0, 2.0, 0.0] }
}

fn small() -> String {
    let modes = [(0.0, 1), (12.5, 1)].map(|(hertz, at)| step(at, -1) + &block(hertz, (2, "DISP"), &[4, 7], of_two));
    HEAD.to_owned() + &modes.concat() + " 9999\n"
}

/// A file in binary: 32-bit numbers behind the lines of a block.
fn small_binary() -> Vec<u8> {
    let text = block(12.5, (2, "DISP"), &[], of_two);
    let head = text.trim_end_matches(" -3\n").replacen("MODAL      1", "MODAL      2", 1).replacen(
        &format!("{:>12}{:20}", 0, ""),
        &format!("{:>12}{:20}", 2, ""),
        1,
    );
    let mut bytes = format!("{HEAD}{}{head}", step(1, -1)).into_bytes();
    for label in [4, 7] {
        bytes.extend((label as i32).to_le_bytes());
        of_two(label).iter().for_each(|value| bytes.extend((*value as f32).to_le_bytes()));
    }
    bytes.extend(b" 9999\n");
    bytes
}

/// The numbers of so few nodes do not tell how many digits they have; the format does.
#[test]
fn values_go_to_their_rows_with_the_digits_of_the_format() {
    let text = read_text(small().as_bytes()).expect("modes");
    assert_eq!(text.columns, vec![vec![0.333333, 2.0, 1.0, 0.25, -1.5e-3]; 2]);
    assert_eq!(text.values.expect("frequencies").numbers, [0.0, 12.5]);
    assert_eq!((text.rounding.relative, text.rounding.absolute), (0.5e-5, 0.0));
    let binary = read_text(&small_binary()).expect("modes");
    assert_eq!(
        binary.columns,
        vec![[1.0 / 3.0, 2.0, 1.0, 0.25, -1.5e-3].map(|value: f64| f64::from(value as f32)).to_vec()]
    );
    assert_eq!((binary.rounding.relative, binary.rounding.absolute), (0.5e-6, 0.0));
}

#[test]
fn what_is_no_mode_of_the_rows_is_refused_by_its_reason() {
    let all = [4, 7];
    let one = |labels: &[i64], kind: (u8, &str), diameter: i8| {
        HEAD.to_owned() + &step(1, diameter) + &block(5.0, kind, labels, of_two)
    };
    let twice = |second: u8| one(&all, (2, "DISP"), -1) + &step(second, -1) + &block(6.0, (2, "DISP"), &all, of_two);
    assert_eq!(read_text(twice(1).as_bytes()).expect("modes").columns.len(), 2);
    for (text, told) in [
        (one(&[4], (2, "DISP"), -1), "no displacement of node 7 ux and of 1 row more"),
        (one(&all, (0, "DISP"), -1), "no modes"),
        (one(&all, (2, "STRESS"), -1), "no modes"),
        (one(&all, (2, "DISPI"), -1), "modes as DISPI of 3 components"),
        (one(&all, (2, "DISP"), 2), "modes of a sector, of nodal diameter 2"),
        (twice(3), "modes of the steps 1 and 3"),
        (HEAD.to_owned(), "no modes"),
    ] {
        let error = read_text(text.as_bytes()).expect_err(told);
        assert!(matches!(error, Error::ModesNodes { .. }) && error.to_string().contains(told), "{told}: {error}");
    }
    for (text, told) in [
        (one(&[4, 4, 7], (2, "DISP"), -1), "node 4 twice"),
        (one(&all, (2, "DISP"), -1).replace("-1.50000E-03", "         NaN"), "NaN at node 4"),
        (one(&all, (2, "DISP"), -1).replace(" -3\n", ""), "the end of the file"),
        (one(&all, (2, "DISP"), -1).replace(" -4  ", " -7  "), "the name of a result"),
        (one(&all, (2, "DISP"), -1).replace("MODAL      1", "MODAL      8"), "the head of a block"),
    ] {
        let error = read_text(text.as_bytes()).expect_err(told);
        assert!(matches!(error, Error::MeshText { .. }) && error.to_string().contains(told), "{told}: {error}");
    }
}

/// Blocks with another number of nodes than they say, numbers wider than their columns, and files without their last line.
#[test]
fn what_is_missing_is_noticed() {
    let whole = read_text(small().as_bytes()).expect("two modes");
    assert_eq!(whole.notes.iter().filter(|note| note.contains("9999")).count(), 0, "{:?}", whole.notes);
    let cut = small().replace(" 9999\n", "");
    let cut = read_text(cut.as_bytes()).expect("two modes");
    assert!(cut.notes.iter().any(|note| note.contains("no line 9999")), "{:?}", cut.notes);
    let first = small().rfind("    1PSTEP").map(|at| small()[..at].to_owned()).expect("two modes");
    let first = read_text(first.as_bytes()).expect("one mode");
    assert!(first.notes.iter().any(|note| note.contains("modes be missing")), "{:?}", first.notes);
    let wide = small().replace(&number(1.0), "-1.00000E-110");
    let error = read_text(wide.as_bytes()).expect_err("a number of thirteen characters");
    assert!(matches!(error, Error::MeshText { .. }), "{error}");
    let line = small().lines().find(|line| line.starts_with("  100CL")).expect("a head").to_owned();
    let more = line.replacen("           2", "           7", 1);
    let error = read_text(small().replace(&line, &more).as_bytes()).expect_err("seven nodes");
    assert!(error.to_string().contains("7, as the head of the block says"), "{error}");
}

/// Without a dof map nothing says where a displacement belongs, and a rotation is in no result file.
#[test]
fn rows_that_are_no_displacements_are_refused() {
    let model = steel_brick();
    let place = Place::with(&model);
    place.write("job.frd", file(&model, &lowest(&model, 8), &model.labels).as_bytes());
    let [k, m, result] = ["K.mtx", "M.mtx", "job.frd"].map(|name| place.text(name));
    let ended = supel(&["certify", &k, &m, &result]).expect(ExitCode::InputData);
    assert!(ended.err.contains("E-MODES-NODES") && ended.err.contains("--dofs"), "{}", ended.err);
    for (dof, told) in [
        (Some(Dof { node: 3, direction: Direction::Rz }), "row 2, which is node 3 rz"),
        (None, "row 2, which no node has"),
    ] {
        let first = Some(Dof { node: 3, direction: Direction::Ux });
        let rows = ModeRows { n: 2, left: vec![(0, first), (1, dof)], turning: None };
        let error = foreign_modes(&place.path("job.frd"), &rows, &Allowance::of(None)).expect_err(told);
        assert!(error.to_string().contains(told), "{error}");
    }
}

/// Cut anywhere, and with every byte changed: modes or an error that names the file, never a panic.
#[test]
fn a_damaged_file_is_read_or_refused() {
    let place = Place::new();
    let path = place.path("job.frd");
    let look = |bytes: &[u8]| {
        place.write("job.frd", bytes);
        match read(&path) {
            Ok(_) => 0,
            Err(error) => {
                assert!(error.to_string().contains("job.frd"), "{error}");
                1
            }
        }
    };
    for whole in [small().into_bytes(), small_binary()] {
        let n_refused: usize = (0..whole.len()).map(|length| look(&whole[..length])).sum();
        assert!(n_refused > whole.len() / 4, "{n_refused}");
        for at in 0..whole.len() {
            for byte in [b'9', b'-', 0, 0xff, b'\n'] {
                let mut changed = whole.clone();
                changed[at] = byte;
                look(&changed);
            }
        }
    }
}
