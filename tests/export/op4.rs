//! OUTPUT4, read word by word as the layout says.

use std::collections::BTreeMap;

use supel::cli::ExitCode;
use supel::error::Error;
use supel::export::{FORMATS, Names};
use supel_runtime::{Direction, Matrix, Precision, RecoveredDof, Recovery, Superelement, Tensors};

use super::{HELD, assert_same_bits, export, reduced, tensors};

/// A matrix as it was read, with its form.
struct Read {
    form: usize,
    rows: Vec<Vec<f64>>,
}

fn empty(n_rows: usize, n_columns: usize) -> Vec<Vec<f64>> {
    vec![vec![0.0; n_columns]; n_rows]
}

/// Fields of eight characters.
fn fields(line: &str, n: usize) -> Vec<usize> {
    (0..n).map(|k| line[8 * k..8 * k + 8].trim().parse().unwrap_or_else(|_| panic!("{line}"))).collect()
}

fn read_text(text: &str) -> BTreeMap<String, Read> {
    let mut found = BTreeMap::new();
    let mut lines = text.lines();
    while let Some(head) = lines.next() {
        let [n_columns, n_rows, form, kind] = fields(head, 4)[..] else { panic!("{head}") };
        assert_eq!((kind, &head[40..]), (2, "1P,3E24.16"), "{head}");
        let mut rows = empty(n_rows, n_columns);
        loop {
            let [column, first, n] = fields(lines.next().expect("a column"), 3)[..] else { panic!("three fields") };
            let values: String = (0..n.div_ceil(3)).map(|_| lines.next().expect("values")).collect();
            let value = |k: usize| values[24 * k..24 * k + 24].trim().parse::<f64>().expect("a number");
            assert_eq!(values.len(), 24 * n);
            if column > n_columns {
                assert_eq!((column, first, n), (n_columns + 1, 1, 1));
                break;
            }
            (0..n).for_each(|k| rows[first - 1 + k][column - 1] = value(k));
        }
        found.insert(head[32..40].trim().to_owned(), Read { form, rows });
    }
    found
}

/// The content of the record that bytes start with, and what follows it.
fn record(bytes: &[u8]) -> (&[u8], &[u8]) {
    let n = word(bytes, 0);
    assert_eq!(word(bytes, 1 + n / 4), n, "the length behind a record");
    (&bytes[4..4 + n], &bytes[8 + n..])
}

fn word(bytes: &[u8], k: usize) -> usize {
    u32::from_le_bytes(bytes[4 * k..4 * k + 4].try_into().expect("a word")) as usize
}

fn read_binary(mut bytes: &[u8]) -> BTreeMap<String, Read> {
    let mut found = BTreeMap::new();
    while !bytes.is_empty() {
        let (head, rest) = record(bytes);
        assert_eq!((head.len(), word(head, 3)), (24, 2));
        let (n_columns, n_rows, form) = (word(head, 0), word(head, 1), word(head, 2));
        let mut rows = empty(n_rows, n_columns);
        bytes = rest;
        loop {
            let (content, rest) = record(bytes);
            bytes = rest;
            let (column, first, n) = (word(content, 0), word(content, 1), word(content, 2) / 2);
            assert_eq!(content.len(), 12 + 8 * n);
            if column > n_columns {
                assert_eq!((column, first, n), (n_columns + 1, 1, 1));
                break;
            }
            for (k, value) in content[12..].chunks_exact(8).enumerate() {
                rows[first - 1 + k][column - 1] = f64::from_le_bytes(value.try_into().expect("eight bytes"));
            }
        }
        found.insert(String::from_utf8_lossy(&head[16..24]).trim().to_owned(), Read { form, rows });
    }
    found
}

#[test]
fn both_kinds_hold_the_tensors_to_the_bit() {
    for (method, fixed) in [("craig-bampton", HELD), ("herting", "")] {
        let place = reduced(method, fixed);
        let superelement = place.superelement("x.supel");
        export(&place, "op4", &[]).expect(ExitCode::Done);
        let text = read_text(&String::from_utf8(place.bytes("x.op4")).expect("text"));
        export(&place, "op4-binary", &[]).expect(ExitCode::Done);
        let binary = read_binary(&place.bytes("x.op4"));
        for found in [text, binary] {
            let expected = ["KAA", "MAA", "GRAVITY", "RECOVERY"].into_iter().zip(tensors(&superelement));
            for (name, expected) in expected {
                assert_same_bits(&found[name].rows, expected.unwrap_or_else(|| panic!("{name} is there")), name);
            }
            assert_eq!((found["KAA"].form, found["MAA"].form, found["GRAVITY"].form), (6, 6, 2));
            let dofs = superelement.tensors().recovery.as_ref().expect("recovery").dofs();
            let expected: Vec<Vec<f64>> =
                dofs.iter().map(|dof| vec![dof.node as f64, dof.direction as usize as f64 + 1.0]).collect();
            assert_eq!(found["RECDOFS"].rows, expected);
            // Four load transformation matrices, and the acceleration of the centre of a free component.
            let n_derived = if fixed.is_empty() { 5 } else { 4 };
            assert_eq!(found.len(), 5 + n_derived, "{:?}", found.keys());
            let [mass, stiffness] = [&superelement.tensors().mass, &superelement.tensors().stiffness];
            for (name, of) in [("IFLTMA", mass), ("IFLTMD", stiffness)] {
                let rows = Matrix::from_fn(superelement.n_interface(), of.cols(), |i, j| of[(i, j)]);
                assert_same_bits(&found[name].rows, &rows, name);
            }
            assert_eq!((found["NETLTMA"].rows.len(), found["NETLTMA"].form), (6, 2));
        }
    }
}

/// Zeros before the first and after the last entry of a column, columns without any, numbers at the ends of the range.
#[test]
fn columns_with_zeros_and_extreme_numbers() {
    let place = reduced("craig-bampton", "");
    let superelement = place.superelement("x.supel");
    let n = superelement.n_coordinates();
    let entries = [((3, 1), 5e-324), ((5, 1), -f64::MAX), ((4, 2), -1e-300), ((n - 1, 2), 0.1)];
    let at = |i: usize, j: usize| entries.iter().find(|(at, _)| *at == (i, j)).map_or(0.0, |(_, value)| *value);
    let loads = Matrix::from_fn(n, 4, at);
    let mut metadata = superelement.metadata().clone();
    metadata.load_names = ["a", "b", "c", "d"].map(str::to_owned).into();
    let tensors = Tensors { load_vectors: Some(loads.clone()), ..superelement.tensors().clone() };
    let superelement = Superelement::new(tensors, metadata).expect("a superelement");
    superelement.write(&place.path("x.supel")).expect("written");
    export(&place, "op4", &[]).expect(ExitCode::Done);
    let text = String::from_utf8(place.bytes("x.op4")).expect("text");
    assert_same_bits(&read_text(&text)["LOADS"].rows, &loads, "LOADS");
    export(&place, "op4-binary", &[]).expect(ExitCode::Done);
    assert_same_bits(&read_binary(&place.bytes("x.op4"))["LOADS"].rows, &loads, "LOADS");
}

/// Labels are doubles in OUTPUT4, of which not every large whole number is one.
#[test]
fn a_label_that_no_double_holds() {
    let place = reduced("craig-bampton", "");
    let superelement = place.superelement("x.supel");
    let recovering = |node: i64| {
        let rows = Matrix::from_fn(1, superelement.n_coordinates(), |_, _| 0.5);
        let dof = RecoveredDof { node, direction: Direction::Uy };
        let recovery = Recovery::new(rows, vec![dof], Precision::Double).expect("recovery");
        let tensors = Tensors { recovery: Some(recovery), ..superelement.tensors().clone() };
        Superelement::new(tensors, superelement.metadata().clone()).expect("a superelement")
    };
    let names = Names::starting_with(&place.path("y"));
    for format in FORMATS.into_iter().filter(|format| format.name().starts_with("op4")) {
        let files = |node: i64| format.files(&recovering(node), &names);
        assert!(files(1 << 53).is_ok() && files(-(1 << 53)).is_ok());
        for node in [(1 << 53) + 1, i64::MIN] {
            assert!(matches!(files(node), Err(Error::ExportLabel { node: found }) if found == node));
        }
    }
}
