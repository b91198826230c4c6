//! Files that are refused, each by its reason.

use supel::error::Error;
use supel::input::read;

use super::{error_of, fixture, job, pair};

/// A file of the fixtures with one piece of its text replaced.
fn altered(name: &str, before: &str, after: &str) -> Error {
    let content = std::fs::read(fixture(name)).expect("a fixture");
    let at = content.windows(before.len()).position(|part| part == before.as_bytes()).expect("the piece");
    let content = [&content[..at], after.as_bytes(), &content[at + before.len()..]].concat();
    error_of(name, content)
}

/// The error names the file, says this code and these words.
fn assert_says(error: &Error, code: &str, words: &[&str]) {
    let text = error.to_string();
    assert_eq!(error.code(), code, "{text}");
    assert!(words.iter().all(|word| text.contains(word)), "{text}");
}

#[test]
fn names_that_are_not_there_or_leave_a_choice() {
    let of = |k: &str| pair(k, "m.mtx").expect_err("an error");
    assert_says(&of("dense_text.op4:KBB"), "E-NO-SUCH-MATRIX", &["dense_text.op4:KBB", "KAA, MAA"]);
    assert_says(&of("k.mtx:K"), "E-NO-SUCH-MATRIX", &["k.mtx:K", "leave the colon"]);
    assert_says(&of("k_csr.npz:K"), "E-NO-SUCH-MATRIX", &["k_csr.npz:K"]);
    assert_says(&of("m_large.pch"), "E-MATRIX-AMBIGUOUS", &["m_large.pch", "stiffness", "MAAX"]);
    assert_says(&of("dense.npz:other"), "E-MATRIX-UNREAD", &["other.npy", "shape [3]", "square"]);
    assert_says(&of("sparse.mat:name"), "E-MATRIX-UNREAD", &["name", "text"]);
    assert_says(&of("absent.op4:KAA"), "E-READ", &["absent.op4:"]);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ab.npz");
    std::fs::write(&path, renamed(&std::fs::read(fixture("dense.npz")).expect("a fixture"))).expect("written");
    let error = read(&job(&path, &fixture("m.mtx"))).expect_err("two that could be meant");
    assert_says(&error, "E-MATRIX-AMBIGUOUS", &["A, B, other", "as in"]);
}

/// An archive whose matrices have names that say nothing.
fn renamed(archive: &[u8]) -> Vec<u8> {
    let mut bytes = archive.to_vec();
    for (before, after) in [(b"K.npy", b"A.npy"), (b"M.npy", b"B.npy")] {
        let starts: Vec<usize> = (0..bytes.len() - 5).filter(|at| bytes[*at..at + 5] == *before).collect();
        starts.into_iter().for_each(|at| bytes[at..at + 5].copy_from_slice(after));
    }
    bytes
}

#[test]
fn dmig_of_other_kinds() {
    for (before, after, words) in [
        ("       6       2       0", "       6       4       0", &["line 1", "complex"][..]),
        ("       6       2       0", "       9       2       0", &["line 1", "form 9"]),
    ] {
        assert_says(&altered("k_large.pch", before, after), "E-MATRIX-UNREAD", words);
    }
    for (before, after, words) in [
        ("2.500000000D+00", "2.5000000x0D+00", &["line 2", "2.5000000x0D+00", "node 1 ux"][..]),
        (
            "*                      1               1 2.5",
            "*                      1               9 2.5",
            &["line 2", "\"9\""],
        ),
        ("2.500000000D+00", "            NaN", &["line 2", "finite"]),
    ] {
        assert_says(&altered("k_large.pch", before, after), "E-MATRIX-FORMAT", words);
    }
    let wide = error_of("a.bdf", "DMIG,K,0,2,2,0,,,1\nDMIG,K,9,1,,1,1,2.5\n");
    assert_says(&wide, "E-MATRIX-UNREAD", &["form 2", "column node 9 ux", "rectangular"]);
    let deck = error_of("a.bdf", "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nENDDATA\n");
    assert_says(&deck, "E-NO-MATRIX", &["a.bdf", "DMIG", "EXTSEOUT"]);
    // A symmetric matrix has one value for each pair.
    let text = std::fs::read_to_string(fixture("free.bdf")).expect("a fixture").replacen("-0.500000", "-0.600000", 1);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("free.bdf");
    std::fs::write(&path, text).expect("written");
    let named = folder.path().join("free.bdf:K");
    let error = read(&job(&named, &named)).expect_err("two values");
    assert_says(&error, "E-DOUBLE-TRIANGLE", &["(2, 1) and (1, 2)", "give one value of both"]);
}

#[test]
fn op4_of_other_kinds() {
    let head = "       6       6       6       2";
    for (after, code, words) in [
        ("       6       6       6       4", "E-MATRIX-UNREAD", &["KAA", "complex"][..]),
        ("       6       6       4       2", "E-MATRIX-UNREAD", &["form 4"]),
        ("       6       7       6       2", "E-MATRIX-SIZE", &["7 × 6"]),
    ] {
        assert_says(&altered("dense_text.op4", head, after), code, words);
    }
    let beyond = altered("dense_text.op4", "       1       1       4", "       1       4       4");
    assert_says(&beyond, "E-MATRIX-FORMAT", &["line 2", "rows up to 6"]);
    let content = std::fs::read_to_string(fixture("dense_text.op4")).expect("a fixture");
    let number = content.lines().nth(2).expect("numbers").to_owned();
    let damaged = content.replacen(&number[1..9], "1.66x666", 1);
    assert_says(&error_of("a.op4", damaged), "E-MATRIX-FORMAT", &["line 3", "a number in field 1"]);
}

/// `%23.16E` needs 24 characters for a negative number with an exponent of three digits: what it is cut to is another number.
#[test]
fn numbers_wider_than_their_fields() {
    let op4 = |number: &str| {
        format!(
            "       3      -3       6       2KAA     1P,3E23.16\n       1       0       8\n       3       1\n\
             2.0000000000000000E+00\n       3       3\n{number}\n       2       0       4\n       3       2\n\
             3.0000000000000000E+00\n       3       0       4\n       3       3\n4.0000000000000000E+00\n       4       1       1\n1.0\n"
        )
    };
    assert_says(
        &error_of("a.op4", op4("-1.4999999999999999E-110")),
        "E-MATRIX-FORMAT",
        &["line 6", "23 characters", "E-110"],
    );
    let kept = error_of("a.op4", op4("-1.4999999999999999E-99"));
    assert!(kept.code() != "E-MATRIX-FORMAT", "{kept}");
    let boeing = "a\n 3 1 1 1\nRSA           2 2 2 0\n(3I4)           (2I4)           (2E12.5)            \n   1   2   3\n   1   2\n";
    let error = error_of("a.rsa", format!("{boeing}-1.50000E+00-1.50000E-110\n"));
    assert_says(&error, "E-MATRIX-FORMAT", &["line 7", "nothing behind"]);
}

/// Without a point or an exponent Fortran reads a number by the decimals and the scale of its format, and other programs as it stands. What
/// both read alike is taken.
#[test]
fn numbers_of_output4_that_lack_point_or_exponent() {
    let content = std::fs::read_to_string(fixture("dense_text.op4")).expect("a fixture");
    let with = |number: &str| {
        let mut lines: Vec<String> = content.lines().map(str::to_owned).collect();
        lines[2].replace_range(..23, &format!("{number:>23}"));
        lines.join("\n") + "\n"
    };
    for number in ["1234E-3", "-7", "1.5"] {
        let error = error_of("a.op4", with(number));
        assert_says(&error, "E-MATRIX-FORMAT", &["line 3", "field 1", "as Fortran reads it", number]);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.op4");
    for number in ["0", "0.", "1.5-3", "15.E-1"] {
        std::fs::write(&path, with(number)).expect("written");
        let file = format!("{}:KAA", path.display()).into();
        let matrix = supel::input::SingleMatrix { file, layout: None, dofs: None };
        assert!(matrix.read(&supel::input::Allowance::of(None)).is_ok(), "{number}");
    }
}

#[test]
fn harwell_boeing_of_other_kinds() {
    for (letters, words) in
        [("PSA", &["pattern"][..]), ("CSA", &["complex"]), ("RSE", &["elements"]), ("RZA", &["skew"])]
    {
        assert_says(&altered("k.rsa", "RSA", letters), "E-MATRIX-UNREAD", &[&[letters], words].concat());
    }
    // Without values there is no format of them.
    let lines = ["a pattern", "2 1 1 0", "PSA           3 3 5 0", "(16I4)          (16I4)", "   1   3   5   6"];
    let pattern = format!("{}\n   1   2   2   3   3\n", lines.join("\n"));
    assert_says(&error_of("p.psa", pattern), "E-MATRIX-UNREAD", &["PSA", "pattern"]);
    assert_says(&altered("k.rsa", "1.6666666666666", "1.66666x6666666"), "E-MATRIX-FORMAT", &["line 9", "field 1"]);
    assert_says(&altered("k.rsa", "        12        14", "        14        12"), "E-MATRIX-POINTER", &[]);
}

/// Matrices that no model has are called what they are, whether one is named or not.
#[test]
fn complex_matrices_and_marks_are_named() {
    let dense = std::fs::read(fixture("dense.mat")).expect("a fixture");
    let flags = [6, 0, 0, 0, 8, 0, 0, 0, 6, 0];
    let mut complex = dense.clone();
    let places: Vec<usize> = (0..dense.len() - flags.len()).filter(|at| dense[*at..].starts_with(&flags)).collect();
    assert_eq!(places.len(), 2, "stiffness and mass");
    places.iter().for_each(|at| complex[at + 9] |= 8);
    assert_says(
        &error_of("c.mat", complex),
        "E-NO-MATRIX",
        &["stiffness (a complex matrix)", "mass (a complex matrix)"],
    );
    let header = "{'descr': '|b1', 'fortran_order': False, 'shape': (2, 2), }";
    let mut marks = [b"\x93NUMPY\x01\x00".as_slice(), &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat();
    marks.extend([1, 0, 0, 1]);
    assert_says(&error_of("b.npy", marks), "E-MATRIX-UNREAD", &["b1"]);
}

/// Whole numbers of files that declare them are kept to the last digit, or refused.
#[test]
fn whole_numbers_that_no_double_equals() {
    let (kept, lost) = ("9007199254740994", "-9007199254740993");
    let of_market = |kind: &str, number: &str, field: &str| {
        let (head, lines) = match kind {
            "array" => ("3 3", format!("{number}\n0\n0\n0\n1\n0\n0\n0\n1\n")),
            _ => ("3 3 3", format!("1 1 {number}\n2 2 1\n3 3 1\n")),
        };
        format!("%%MatrixMarket matrix {kind} {field} general\n{head}\n{lines}")
    };
    let of_boeing = |number: &str, field: &str| {
        let letters = if field == "integer" { "ISA" } else { "RSA" };
        let formats = "(4I20)          (4I20)          (3I20)              ";
        let line = |numbers: &[&str]| numbers.iter().map(|number| format!("{number:>20}")).collect::<String>() + "\n";
        let [pointers, rows, values] = [&["1", "2", "3", "4"][..], &["1", "2", "3"], &[number, "1", "1"]].map(line);
        format!("a\n 3 1 1 1\n{letters}           3 3 3 0\n{formats}\n{pointers}{rows}{values}")
    };
    let read = |content: String| {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("k");
        std::fs::write(&path, content).expect("written");
        let matrix = supel::input::SingleMatrix { file: path, layout: None, dofs: None };
        matrix.read(&supel::input::Allowance::of(None)).map(|read| read.input.matrix.get(0, 0).copied())
    };
    for kind in ["coordinate", "array"] {
        for field in ["integer", "unsigned-integer"] {
            assert_eq!(read(of_market(kind, kept, field)).expect("kept"), Some(9_007_199_254_740_994.0), "{kind}");
            let error = read(of_market(kind, lost, field)).expect_err("no double");
            assert_says(&error, "E-ENTRY", &[lost, "up to 2^53"]);
        }
        // A real number is the nearest double.
        for field in ["real", "double"] {
            assert_eq!(read(of_market(kind, lost, field)).expect("real"), Some(-9_007_199_254_740_992.0), "{kind}");
        }
    }
    assert_eq!(read(of_boeing(kept, "integer")).expect("kept"), Some(9_007_199_254_740_994.0));
    assert_says(&read(of_boeing(lost, "integer")).expect_err("no double"), "E-MATRIX-FORMAT", &[lost, "up to 2^53"]);
    assert_eq!(read(of_boeing(lost, "real")).expect("real"), Some(-9_007_199_254_740_992.0));
}

/// MATLAB level 4, single numbers of level 5, and what is packed twice.
#[test]
fn arrays_of_matlab_and_archives() {
    let level4 = |order: [u8; 4], one: [u8; 4]| {
        [&order[..], &one, &one, &[0; 4], &one.map(|byte| 2 * byte), b"K\0", &[0; 8]].concat()
    };
    for content in [level4([0; 4], [1, 0, 0, 0]), level4([0, 0, 3, 232], [0, 0, 0, 1])] {
        assert_says(&error_of("a.mat", content), "E-FORMAT", &["a.mat", "MATLAB file of level 4", "-v7"]);
    }
    let archive = std::fs::read(fixture("k_csr.npz")).expect("a fixture");
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    let packed = std::io::Write::write_all(&mut encoder, &archive).and_then(|()| encoder.finish()).expect("packed");
    assert_says(&error_of("a.npz.gz", packed), "E-FORMAT", &["a packed archive", "unpack it"]);
    let array = |name: u8, numbers: &[f64]| {
        let n = (numbers.len() as f64).sqrt() as u32;
        let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
        let values: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let parts =
            [words(&[6, 8, 6, 0, 5, 8, n, n, 0x1_0001]), vec![name, 0, 0, 0], words(&[9, values.len() as u32]), values];
        let content = parts.concat();
        [words(&[14, content.len() as u32]), content].concat()
    };
    let head = [&[b' '; 124][..], &[0, 1, b'I', b'M']].concat();
    let folder = tempfile::tempdir().expect("a folder");
    let read = |arrays: &[Vec<u8>], member: &str| {
        let path = folder.path().join("a.mat");
        std::fs::write(&path, [head.clone(), arrays.concat()].concat()).expect("written");
        let file = folder.path().join(format!("a.mat{member}"));
        let matrix = supel::input::SingleMatrix { file, layout: None, dofs: None };
        matrix.read(&supel::input::Allowance::of(None)).map(|read| read.input.matrix.get(0, 0).copied())
    };
    let (one, four) = (array(b'K', &[5.0]), array(b'M', &[1.0, 0.0, 0.0, 1.0]));
    assert_eq!(read(std::slice::from_ref(&one), ":K").expect("one row"), Some(5.0));
    assert_eq!(read(&[array(b'A', &[5.0])], "").expect("one row"), Some(5.0));
    assert_says(&read(&[one.clone(), four.clone()], "").expect_err("two"), "E-MATRIX-AMBIGUOUS", &["K, M"]);
    // A number next to a matrix is none, unless it is asked for.
    assert_eq!(read(&[array(b't', &[5.0]), four.clone()], "").expect("the only matrix"), Some(1.0));
    assert_eq!(read(&[array(b't', &[5.0]), four], ":t").expect("the number"), Some(5.0));
}

/// The largest numbers of 64 bits that doubles equal, and one that none does.
#[test]
fn whole_numbers_of_arrays() {
    let npy = |descr: &str, number: [u8; 8]| {
        let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (1, 1), }}");
        [&b"\x93NUMPY\x01\0"[..], &(header.len() as u16).to_le_bytes(), header.as_bytes(), &number].concat()
    };
    let read = |content: Vec<u8>| {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("k.npy");
        std::fs::write(&path, content).expect("written");
        let matrix = supel::input::SingleMatrix { file: path, layout: None, dofs: None };
        matrix.read(&supel::input::Allowance::of(None)).map(|read| read.input.matrix.get(0, 0).copied())
    };
    let error = read(npy("<c8", [0; 8])).expect_err("complex");
    assert_says(&error, "E-MATRIX-UNREAD", &["<c8", "or whole ones"]);
    let large = (1_u64 << 63) + 4096;
    assert_eq!(read(npy("<u8", large.to_le_bytes())).expect("a double"), Some(9_223_372_036_854_779_904.0));
    assert_eq!(read(npy("<i8", i64::MIN.to_le_bytes())).expect("a double"), Some(-9_223_372_036_854_775_808.0));
    for number in [large + 1, u64::MAX] {
        let error = read(npy("<u8", number.to_le_bytes())).expect_err("no double");
        assert_says(&error, "E-MATRIX-FORMAT", &["cannot be kept as it is", "that a double equals"]);
    }
}

/// Both halves of a matrix that is declared skew-symmetric.
#[test]
fn skew_matrices_with_both_halves() {
    let error = error_of_single("%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 2\n2 1 -1\n1 2 1\n");
    assert_says(&error, "E-DOUBLE-TRIANGLE", &["declared skew-symmetric", "declare the matrix general"]);
    assert!(!error.to_string().contains("--symmetric"), "{error}");
}

fn error_of_single(text: &str) -> Error {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("g.mtx");
    std::fs::write(&path, text).expect("written");
    let matrix = supel::input::SingleMatrix { file: path, layout: None, dofs: None };
    matrix.read(&supel::input::Allowance::of(None)).expect_err("refused")
}

/// The diagonal of a skew-symmetric matrix is nothing.
#[test]
fn skew_matrices_with_a_diagonal() {
    let skew = |entry: &str| {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("g.mtx");
        let text = format!("%%MatrixMarket matrix coordinate real skew-symmetric\n3 3 2\n2 1 1\n{entry}\n");
        std::fs::write(&path, text).expect("written");
        let matrix = supel::input::SingleMatrix { file: path, layout: None, dofs: None };
        matrix.read(&supel::input::Allowance::of(None))
    };
    assert_says(&skew("3 3 2.5").expect_err("refused"), "E-SKEW-DIAGONAL", &["g.mtx", "row 3", "2.5"]);
    assert!(skew("3 3 0").is_ok(), "a zero that is written is nothing");
}

#[test]
fn lines_of_abaqus_that_are_none() {
    let first = "1, 1, 1, 1, 2.0\n";
    for (line, words) in [
        ("1, 1, 1, 2.0", "degree of freedom"),
        ("1, 1, 1, 1", "five numbers"),
        ("1, 1, 1, 1, 2.0, 3", "five numbers"),
        ("1, 300, 1, 1, 2.0", "degree of freedom"),
        ("1, x, 1, 1, 2.0", "degree of freedom"),
        ("1, 1, 1, 1, NaN", "finite"),
    ] {
        let error = error_of("a.mtx", format!("{first}** a comment\n{line}\n"));
        assert_says(&error, "E-MATRIX-FORMAT", &["a.mtx", "line 3", words]);
    }
}

#[test]
fn arrays_of_other_types_and_sizes() {
    let npy = |descr: &str, shape: &str, bytes: usize| {
        let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({shape}), }}");
        let mut content = b"\x93NUMPY\x01\0".to_vec();
        content.extend_from_slice(&(header.len() as u16).to_le_bytes());
        content.extend_from_slice(header.as_bytes());
        content.resize(content.len() + bytes, 0);
        content
    };
    assert_says(&error_of("a.npy", npy("<c16", "2, 2", 64)), "E-MATRIX-UNREAD", &["<c16"]);
    assert_says(&error_of("a.npy", npy("|O", "2, 2", 64)), "E-MATRIX-UNREAD", &["save_npz"]);
    assert_says(&error_of("a.npy", npy("<f8", "2, 3", 48)), "E-MATRIX-SIZE", &["2 × 3"]);
    assert_says(&error_of("a.npy", npy("<f8", "2, 2", 31)), "E-MATRIX-FORMAT", &["the end after 3 numbers"]);
    assert_says(&error_of("a.npy", npy("<f8", "2, 2", 33)), "E-MATRIX-FORMAT", &["behind the last number"]);
    assert_says(&error_of("a.npy", npy("<f8", "99999999, 99999999", 8)), "E-MATRIX-FORMAT", &["after 1 number –"]);
}
