//! The formats that shapes and frequencies come in: whichever it is, the answer is the same.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_testing::place::{Place, supel};

use super::{Pairs, bar, lowest, place_of};
#[cfg(feature = "hdf5")]
use {
    super::pairs_of,
    supel_models::{Material, brick},
    supel_testing::pencil::{eigen, matrices},
};

/// What is said of a result, without the digest of its file and what its numbers are called.
fn answer(place: &Place, result: &str, values: [&str; 2]) -> Value {
    let [k, m] = ["K.mtx", "M.mtx"].map(|name| place.text(name));
    let [flag, values] = values;
    let mut args = vec!["certify", &k, &m, result, "--json"];
    if !flag.is_empty() {
        args.extend([flag, values]);
    }
    let ended = supel(&args).expect(ExitCode::Done);
    let mut document: Value = serde_json::from_str(&ended.out).expect("JSON");
    document["result"] = Value::Null;
    document
}

fn pairs() -> Pairs {
    lowest(&bar(), 12)
}

#[test]
fn frequencies_in_every_unit_and_form() {
    let pairs = pairs();
    let place = place_of(&bar(), &pairs);
    let shapes = place.text("V.mtx");
    let expected = answer(&place, &shapes, ["--hz", &place.text("f.txt")]);
    let list: Vec<String> = pairs.hertz.iter().map(f64::to_string).collect();
    assert_eq!(answer(&place, &shapes, ["--hz", &list.join(",")]), expected);
    // Comments, blanks and a line of all of them.
    place.write("line.txt", format!("# Hz\n\n{}\n", list.join(" ; ")).as_bytes());
    assert_eq!(answer(&place, &shapes, ["--hz", &place.text("line.txt")]), expected);
    let array = format!("%%MatrixMarket matrix array real general\n{} 1\n{}\n", list.len(), list.join("\n"));
    place.write("f.mtx", array.as_bytes());
    assert_eq!(answer(&place, &shapes, ["--hz", &place.text("f.mtx")]), expected);
    // Other units are the same numbers but for rounding.
    let same = |values: [&str; 2]| {
        let found = answer(&place, &shapes, values);
        let kinds = |document: &Value| -> Vec<String> {
            document["pairs"].as_array().expect("pairs").iter().map(|pair| pair["kind"].to_string()).collect()
        };
        assert_eq!((&found["verdict"], kinds(&found)), (&expected["verdict"], kinds(&expected)));
    };
    let omega: Vec<String> = pairs.hertz.iter().map(|f| (f * std::f64::consts::TAU).to_string()).collect();
    let lambda: Vec<String> = pairs.hertz.iter().map(|f| (f * std::f64::consts::TAU).powi(2).to_string()).collect();
    same(["--rad-per-s", &omega.join(",")]);
    same(["--eigenvalues", &lambda.join(",")]);
    // Without frequencies those of the shapes are shown.
    let found = answer(&place, &shapes, ["", ""]);
    assert!(found["notes"].to_string().contains("the result has no frequencies"), "{found}");
    assert_eq!(found["pairs"][7]["stated_hz"], Value::Null);
}

#[cfg(feature = "hdf5")]
#[test]
fn shapes_and_frequencies_in_one_hdf5_file() {
    let pairs = pairs();
    let place = place_of(&bar(), &pairs);
    let expected = answer(&place, &place.text("V.mtx"), ["--hz", &place.text("f.txt")]);
    let file = hdf5_metno::File::create(place.path("modes.h5")).expect("a file");
    let (n, k) = (pairs.shapes[0].len(), pairs.shapes.len());
    let values: Vec<f64> = (0..n).flat_map(|row| pairs.shapes.iter().map(move |shape| shape[row])).collect();
    file.new_dataset::<f64>().shape([n, k]).create("V").expect("a dataset").write_raw(&values).expect("written");
    file.new_dataset::<f64>().shape([k]).create("f").expect("a dataset").write_raw(&pairs.hertz).expect("written");
    drop(file);
    let place_in = |name: &str| format!("{}:/{name}", place.text("modes.h5"));
    assert_eq!(answer(&place, &place_in("V"), ["--hz", &place_in("f")]), expected);
}

/// All modes of a model are a square dataset, which looks alike as MATLAB stores it and as h5py does: the residual tells.
#[cfg(feature = "hdf5")]
#[test]
fn a_square_dataset_is_turned_by_its_residual() {
    let model = brick([2, 1, 1], [1.0, 0.4, 0.3], &Material::STEEL_SI);
    let [k, m] = matrices(&model);
    // A spectrum of the size of its middle, so that both of its ends are known.
    let (lambda, shapes) = eigen(k.as_ref(), m.as_ref(), 1e9);
    let (n, pairs) = (model.n, pairs_of(&lambda, &shapes));
    let place = place_of(&model, &pairs);
    let file = hdf5_metno::File::create(place.path("modes.h5")).expect("a file");
    let by_rows: Vec<f64> = (0..n).flat_map(|row| pairs.shapes.iter().map(move |shape| shape[row])).collect();
    for (name, values) in [("h5py", by_rows), ("matlab", pairs.shapes.concat())] {
        file.new_dataset::<f64>().shape([n, n]).create(name).expect("a dataset").write_raw(&values).expect("written");
    }
    drop(file);
    let place_in = |name: &str| format!("{}:/{name}", place.text("modes.h5"));
    let [right, turned] =
        ["h5py", "matlab"].map(|name| answer(&place, &place_in(name), ["--hz", &place.text("f.txt")]));
    assert_eq!((&right["checks"], &right["pairs"]), (&turned["checks"], &turned["pairs"]));
    assert!(!right["notes"].to_string().contains("square"), "{right}");
    assert!(turned["notes"].to_string().contains("the dataset is square"), "{turned}");
}

/// Shapes in single precision are the same shapes, whatever file has them.
#[test]
fn shapes_in_single_precision() {
    let pairs = pairs();
    let place = place_of(&bar(), &pairs);
    let (n, k) = (pairs.shapes[0].len(), pairs.shapes.len());
    let values: Vec<f32> = (0..n).flat_map(|row| pairs.shapes.iter().map(move |shape| shape[row] as f32)).collect();
    let array = |descr: &str, bytes: Vec<u8>| {
        let head = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({n}, {k}), }}\n");
        let length = u16::try_from(head.len()).expect("short").to_le_bytes();
        [b"\x93NUMPY\x01\x00".as_slice(), &length, head.as_bytes(), &bytes].concat()
    };
    place.write("little.npy", &array("<f4", values.iter().flat_map(|value| value.to_le_bytes()).collect()));
    place.write("big.npy", &array(">f4", values.iter().flat_map(|value| value.to_be_bytes()).collect()));
    let [little, big] =
        ["little.npy", "big.npy"].map(|name| answer(&place, &place.text(name), ["--hz", &place.text("f.txt")]));
    assert_eq!(little, big);
    #[cfg(feature = "hdf5")]
    {
        let file = hdf5_metno::File::create(place.path("single.h5")).expect("a file");
        file.new_dataset::<f32>().shape([n, k]).create("V").expect("a dataset").write_raw(&values).expect("written");
        drop(file);
        let in_file = answer(&place, &format!("{}:/V", place.text("single.h5")), ["--hz", &place.text("f.txt")]);
        assert_eq!(little, in_file);
    }
}

/// A dense matrix of OUTPUT4 as text. A column of zeros is left out.
fn output4(name: &str, columns: &[Vec<f64>]) -> String {
    let (n, k) = (columns[0].len(), columns.len());
    let mut text = format!("{k:8}{n:8}{:8}{:8}{name:<8}1P,3E24.16\n", 2, 2);
    for (at, column) in columns.iter().enumerate().filter(|(_, column)| column.iter().any(|value| *value != 0.0)) {
        text += &format!("{:8}{:8}{n:8}\n", at + 1, 1);
        for line in column.chunks(3) {
            line.iter().for_each(|value| text += &format!("{:>24}", format!("{value:.16E}")));
            text += "\n";
        }
    }
    text + &format!("{:8}{:8}{:8}\n{:>24}\n", k + 1, 1, 1, "1.0E0")
}

/// Modes in the columns of a matrix of OUTPUT4, as a PHG or PHA of Nastran: the only one of its file, or the one that is named.
#[test]
fn shapes_in_output4() {
    let pairs = pairs();
    let place = place_of(&bar(), &pairs);
    let expected = answer(&place, &place.text("V.mtx"), ["--hz", &place.text("f.txt")]);
    let shapes = output4("PHG", &pairs.shapes);
    place.write("one.op4", shapes.as_bytes());
    place.write("two.op4", (output4("OTHER", &pairs.shapes[..2]) + &shapes).as_bytes());
    for name in ["one.op4", "one.op4:PHG", "two.op4:PHG"] {
        assert_eq!(answer(&place, &place.text(name), ["--hz", &place.text("f.txt")]), expected, "{name}");
    }
    let [k, m] = ["K.mtx", "M.mtx"].map(|name| place.text(name));
    let ended = supel(&["certify", &k, &m, &place.text("two.op4")]).expect(ExitCode::InputData);
    assert!(ended.err.contains("E-MATRIX-AMBIGUOUS") && ended.err.contains("OTHER, PHG"), "{}", ended.err);
    place.write("short.op4", output4("PHG", &[vec![1.0; 4]]).as_bytes());
    let ended = supel(&["certify", &k, &m, &place.text("short.op4")]).expect(ExitCode::InputData);
    assert!(ended.err.contains("E-MODES-ROWS") && ended.err.contains("4 rows"), "{}", ended.err);
}

/// An array of MATLAB level 5 in doubles, column by column.
fn matlab_array(name: &str, columns: &[Vec<f64>]) -> Vec<u8> {
    let element = |kind: u32, content: &[u8]| {
        let mut bytes = [kind.to_le_bytes(), (content.len() as u32).to_le_bytes()].concat();
        bytes.extend(content);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    };
    let sizes = [columns[0].len(), columns.len()].map(|size| (size as u32).to_le_bytes()).concat();
    let values: Vec<u8> = columns.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let parts =
        [element(6, &[6, 0, 0, 0, 0, 0, 0, 0]), element(5, &sizes), element(1, name.as_bytes()), element(9, &values)];
    element(14, &parts.concat())
}

/// Modes in the columns of a variable of MATLAB level 5: the only one that is no single number, or the one that is named.
#[test]
fn shapes_in_matlab_level_5() {
    let pairs = pairs();
    let place = place_of(&bar(), &pairs);
    let expected = answer(&place, &place.text("V.mtx"), ["--hz", &place.text("f.txt")]);
    let head = [&[b' '; 124][..], &[0, 1, b'I', b'M']].concat();
    let number = matlab_array("n", &[vec![12.0]]);
    let shapes = matlab_array("psi", &pairs.shapes);
    place.write("one.mat", &[&head[..], &number, &shapes].concat());
    place.write("two.mat", &[&head[..], &matlab_array("other", &pairs.shapes[..2]), &shapes].concat());
    for name in ["one.mat", "one.mat:psi", "two.mat:psi"] {
        assert_eq!(answer(&place, &place.text(name), ["--hz", &place.text("f.txt")]), expected, "{name}");
    }
    let [k, m] = ["K.mtx", "M.mtx"].map(|name| place.text(name));
    for (name, code, told) in [
        ("two.mat", "E-MATRIX-AMBIGUOUS", "other, psi"),
        ("two.mat:phi", "E-NO-SUCH-MATRIX", "other, psi"),
        ("one.mat:n", "E-MODES-ROWS", "1 row"),
    ] {
        let ended = supel(&["certify", &k, &m, &place.text(name)]).expect(ExitCode::InputData);
        assert!(ended.err.contains(code) && ended.err.contains(told), "{name}: {}", ended.err);
    }
    let mut not_finite = pairs.shapes.clone();
    not_finite[1][2] = f64::NAN;
    place.write("nan.mat", &[&head[..], &matlab_array("psi", &not_finite)].concat());
    let ended = supel(&["certify", &k, &m, &place.text("nan.mat")]).expect(ExitCode::InputData);
    assert!(ended.err.contains("row 3, column 2"), "{}", ended.err);
}

/// A banner may name the type of the numbers as programs do.
#[test]
fn shapes_of_double_numbers() {
    let place = place_of(&bar(), &pairs());
    let expected = answer(&place, &place.text("V.mtx"), ["--hz", &place.text("f.txt")]);
    let text = String::from_utf8(place.bytes("V.mtx")).expect("text");
    place.write("double.mtx", text.replacen(" real ", " double ", 1).as_bytes());
    assert_eq!(answer(&place, &place.text("double.mtx"), ["--hz", &place.text("f.txt")]), expected);
}

/// Frequencies in a column or in a row of the files that shapes are in, next to them or by themselves; zeros are those of rigid-body motion.
#[test]
fn frequencies_in_the_files_of_shapes() {
    let mut pairs = pairs();
    pairs.hertz[..6].fill(0.0);
    let place = place_of(&bar(), &pairs);
    let shapes = place.text("V.mtx");
    let expected = answer(&place, &shapes, ["--hz", &place.text("f.txt")]);
    let row: Vec<Vec<f64>> = pairs.hertz.iter().map(|hertz| vec![*hertz]).collect();
    let column = vec![pairs.hertz.clone()];
    let k = pairs.hertz.len();
    let bytes: Vec<u8> = pairs.hertz.iter().flat_map(|value| value.to_le_bytes()).collect();
    let npy = |shape: &str| {
        let head = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}\n");
        let length = u16::try_from(head.len()).expect("short").to_le_bytes();
        [b"\x93NUMPY\x01\x00".as_slice(), &length, head.as_bytes(), &bytes].concat()
    };
    let arrays = [format!("{k},"), format!("{k}, 1"), format!("1, {k}")].map(|shape| npy(&shape));
    let mut files: Vec<(String, Vec<u8>)> =
        arrays.iter().enumerate().map(|(at, array)| (format!("f{at}.npy"), array.clone())).collect();
    let head = [&[b' '; 124][..], &[0, 1, b'I', b'M']].concat();
    let [of_shapes, f, g] =
        [("V", &pairs.shapes), ("f", &column), ("g", &row)].map(|(name, of)| matlab_array(name, of));
    files.push(("se.mat".to_owned(), [&head[..], &of_shapes, &f, &g].concat()));
    files.push(("f.mat".to_owned(), [&head[..], &g].concat()));
    let market = |rows: usize, columns: usize, form: &str, lines: String| {
        let sizes = if form == "array" { format!("{rows} {columns}") } else { format!("{rows} {columns} {}", k - 6) };
        format!("%%MatrixMarket matrix {form} real general\n{sizes}\n{lines}").into_bytes()
    };
    let numbers: String = pairs.hertz.iter().map(|hertz| format!("{hertz:e}\n")).collect();
    files.push(("row.mtx".to_owned(), market(1, k, "array", numbers)));
    let entries = (6..k).map(|at| format!("1 {} {:e}\n", at + 1, pairs.hertz[at])).collect();
    files.push(("entries.mtx".to_owned(), market(1, k, "coordinate", entries)));
    files.push(("f.op4".to_owned(), output4("FRQ", &row).into_bytes()));
    files.iter().for_each(|(name, bytes)| place.write(name, bytes));
    let members = ["se.mat:f", "se.mat:g", "f.op4:FRQ"].map(str::to_owned);
    let whole = files.into_iter().map(|(name, _)| name).filter(|name| name != "se.mat");
    for name in whole.chain(members) {
        assert_eq!(answer(&place, &shapes, ["--hz", &place.text(&name)]), expected, "{name}");
    }
    let [k, m] = ["K.mtx", "M.mtx"].map(|name| place.text(name));
    for (name, code, told) in [("se.mat:V", "E-VALUES-COUNT", "12"), ("se.mat:h", "E-NO-SUCH-MATRIX", "V, f, g")] {
        let ended = supel(&["certify", &k, &m, &shapes, "--hz", &place.text(name)]).expect(ExitCode::InputData);
        assert!(ended.err.contains(code) && ended.err.contains(told), "{name}: {}", ended.err);
    }
}
