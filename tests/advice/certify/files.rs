//! The formats that shapes and frequencies come in: whichever it is, the answer is the same.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_testing::place::{Place, supel};

use super::{Pairs, bar, lowest, place_of};

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
