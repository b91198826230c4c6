//! One test for each way in which the bytes of a file can be wrong. Each starts from a good file, changes one thing and,
//! where the change would otherwise be caught by the digest, seals the file anew.

use supel_models::superelements::particle as sample;

use serde_json::{Map, Value, json};
use supel_runtime::{FileError, Superelement};

/// A good file taken apart.
struct Parts {
    entries: Map<String, Value>,
    document: Value,
    data: Vec<u8>,
}

fn take_apart(file: &[u8]) -> Parts {
    let length = u64::from_le_bytes(file[..8].try_into().unwrap()) as usize;
    let mut entries: Map<String, Value> = serde_json::from_slice(&file[8..8 + length]).unwrap();
    let metadata = entries.remove("__metadata__").unwrap();
    let document = serde_json::from_str(metadata["supel"].as_str().unwrap()).unwrap();
    Parts { entries, document, data: file[8 + length..].to_vec() }
}

fn good() -> Parts {
    take_apart(&sample::complete().to_bytes().unwrap().bytes)
}

/// Prefix, header and data.
fn file_of(header: &str, data: &[u8]) -> Vec<u8> {
    [&(header.len() as u64).to_le_bytes(), header.as_bytes(), data].concat()
}

/// A file of given metadata text, without a valid digest.
fn unsealed(parts: &Parts, metadata: &Value) -> Vec<u8> {
    let mut entries = parts.entries.clone();
    entries.insert("__metadata__".into(), metadata.clone());
    file_of(&Value::Object(entries).to_string(), &parts.data)
}

/// Puts the parts together with a digest that holds.
fn seal(mut parts: Parts) -> Vec<u8> {
    let zeros = "0".repeat(64);
    parts.document["blake3"] = json!(zeros);
    let mut file = unsealed(&parts, &json!({ "supel": parts.document.to_string() }));
    let digest = blake3::hash(&file).to_hex();
    let place = file.windows(64).position(|window| window == zeros.as_bytes()).unwrap();
    file[place..place + 64].copy_from_slice(digest.as_bytes());
    file
}

/// The error for a good file after a change.
fn refusal(change: impl FnOnce(&mut Parts)) -> FileError {
    let mut parts = good();
    change(&mut parts);
    Superelement::from_bytes(&seal(parts)).unwrap_err()
}

/// Changes the description of a tensor.
fn set(parts: &mut Parts, tensor: &str, part: &str, value: Value) {
    parts.entries[tensor][part] = value;
}

macro_rules! assert_refused {
    ($error:expr, $pattern:pat $(if $guard:expr)?) => {
        match $error {
            $pattern $(if $guard)? => {}
            other => panic!("{other:?}"),
        }
    };
}

#[test]
fn unchanged_parts_make_a_good_file() {
    assert_eq!(Superelement::from_bytes(&seal(good())).unwrap(), sample::complete());
}

#[test]
fn too_short_for_the_prefix() {
    assert_refused!(Superelement::from_bytes(&[1; 7]).unwrap_err(), FileError::TooShort { found: 7 });
}

#[test]
fn header_longer_than_any_reader_accepts() {
    let file = [u64::MAX.to_le_bytes(), [b' '; 8]].concat();
    assert_refused!(Superelement::from_bytes(&file).unwrap_err(), FileError::HeaderTooLarge { found: u64::MAX, .. });
    let file = 100_000_001_u64.to_le_bytes();
    assert_refused!(Superelement::from_bytes(&file).unwrap_err(), FileError::HeaderTooLarge { found: 100_000_001, .. });
}

#[test]
fn header_cut_off() {
    let file = [&100_000_000_u64.to_le_bytes(), b"{}".as_slice()].concat();
    let error = Superelement::from_bytes(&file).unwrap_err();
    assert_refused!(error, FileError::HeaderTruncated { found: 2, expected: 100_000_000 });
}

#[test]
fn header_not_text() {
    let file = [&3_u64.to_le_bytes(), b"{\xff}".as_slice()].concat();
    assert_refused!(Superelement::from_bytes(&file).unwrap_err(), FileError::HeaderNotUtf8 { offset: 9 });
}

#[test]
fn header_not_json() {
    for header in ["{", "{\"a\":1}\0\0", "{} x", "{\"a\":}"] {
        assert_refused!(Superelement::from_bytes(&file_of(header, &[])).unwrap_err(), FileError::HeaderNotJson { .. });
    }
}

#[test]
fn header_nested_beyond_reason() {
    let header = format!("{{\"a\":{}", "[".repeat(1_000_000));
    assert_refused!(Superelement::from_bytes(&file_of(&header, &[])).unwrap_err(), FileError::HeaderNotJson { .. });
}

#[test]
fn header_not_an_object() {
    for header in ["", "[]", " {}", "7"] {
        assert_refused!(Superelement::from_bytes(&file_of(header, &[])).unwrap_err(), FileError::HeaderNotObject);
    }
}

#[test]
fn key_twice_in_the_header() {
    let error = Superelement::from_bytes(&file_of("{\"mass\":{},\"mass\":{}}", &[])).unwrap_err();
    assert_refused!(error, FileError::DuplicateKey { key, place: "header" } if key == "mass");
    let escaped = "{\"a\":{\"shape\":[],\"\\u0073hape\":[]}}";
    let error = Superelement::from_bytes(&file_of(escaped, &[])).unwrap_err();
    assert_refused!(error, FileError::DuplicateKey { key, place: "header" } if key == "shape");
}

#[test]
fn no_metadata() {
    let parts = good();
    for metadata in [json!({}), json!({ "supel": 1 }), json!("supel"), Value::Null] {
        let error = Superelement::from_bytes(&unsealed(&parts, &metadata)).unwrap_err();
        assert_refused!(error, FileError::MetadataMissing);
    }
    assert_refused!(Superelement::from_bytes(&file_of("{}", &[])).unwrap_err(), FileError::MetadataMissing);
}

#[test]
fn foreign_key_next_to_ours() {
    let parts = good();
    let metadata = json!({ "supel": parts.document.to_string(), "format": "pt" });
    let error = Superelement::from_bytes(&unsealed(&parts, &metadata)).unwrap_err();
    assert_refused!(error, FileError::MetadataForeignKey { key } if key == "format");
}

#[test]
fn description_of_a_tensor_malformed() {
    let cases = [
        ("dtype", json!(64)),
        ("dtype", Value::Null),
        ("shape", json!(9)),
        ("shape", json!([9, -9])),
        ("shape", json!([9, 9.5])),
        ("data_offsets", json!([0])),
        ("data_offsets", json!([0, 8, 16])),
        ("data_offsets", json!(["0", 8])),
        ("strides", json!([9, 1])),
    ];
    for (part, value) in cases {
        let error = refusal(|parts| set(parts, "mass", part, value));
        assert_refused!(error, FileError::TensorEntry { tensor, part: found } if tensor == "mass" && found == part);
    }
    let error = refusal(|parts| parts.entries["mass"] = json!([]));
    assert_refused!(error, FileError::TensorEntry { part, .. } if part == "description");
}

#[test]
fn number_type_unknown() {
    for dtype in ["F16", "BF16", "f64", "Q99", ""] {
        let error = refusal(|parts| set(parts, "mass", "dtype", json!(dtype)));
        assert_refused!(error, FileError::UnknownDtype { tensor, found } if tensor == "mass" && found == dtype);
    }
}

#[test]
fn tensor_unknown() {
    let error = refusal(|parts| {
        let end = parts.data.len();
        let entry = json!({ "dtype": "F64", "shape": [1], "data_offsets": [end, end + 8] });
        parts.entries.insert("inertia_couplings".into(), entry);
        parts.data.extend([0; 8]);
    });
    assert_refused!(error, FileError::UnknownTensor { tensor } if tensor == "inertia_couplings");
}

/// Takes a tensor out of the file and closes the gap.
fn remove(parts: &mut Parts, tensor: &str) {
    let offsets = |entry: &Value| [0, 1].map(|k| entry["data_offsets"][k].as_u64().unwrap());
    let [begin, end] = offsets(&parts.entries.remove(tensor).unwrap());
    parts.data.drain(begin as usize..end as usize);
    for entry in parts.entries.values_mut() {
        let shifted = offsets(entry).map(|offset| if offset >= end { offset - (end - begin) } else { offset });
        entry["data_offsets"] = json!(shifted);
    }
}

#[test]
fn tensor_missing() {
    let required = [
        "stiffness",
        "mass",
        "rigid_body_modes",
        "rigid_body_mass",
        "interface_positions",
        "interface_frames",
        "frequencies",
    ];
    for name in required {
        let error = refusal(|parts| remove(parts, name));
        assert_refused!(error, FileError::MissingTensor { tensor } if tensor == name);
    }
}

#[test]
fn optional_tensors_are_optional() {
    let mut parts = good();
    for name in ["damping", "mixing", "gravity", "recovery", "recovery_dofs"] {
        remove(&mut parts, name);
    }
    let read = Superelement::from_bytes(&seal(parts)).unwrap();
    assert!(read.tensors().damping.is_none() && read.tensors().recovery.is_none());
}

#[test]
fn number_type_of_another_tensor() {
    for (name, dtype) in [("mass", "I64"), ("frequencies", "I64"), ("recovery_dofs", "F64")] {
        let error = refusal(|parts| set(parts, name, "dtype", json!(dtype)));
        assert_refused!(error, FileError::WrongDtype { tensor, found, .. } if tensor == name && found == dtype);
    }
    // 27 numbers of four bytes do not make 27 of eight: give half as many.
    let error = refusal(|parts| {
        remove(parts, "recovery");
        let end = parts.data.len();
        let entry = json!({ "dtype": "I64", "shape": [3, 9], "data_offsets": [end, end + 216] });
        parts.entries.insert("recovery".into(), entry);
        parts.data.extend([0; 216]);
    });
    assert_refused!(error, FileError::WrongDtype { tensor: "recovery", found: "I64", .. });
}

#[test]
fn hole_between_tensors() {
    let error = refusal(|parts| {
        remove(parts, "recovery");
        let end = parts.data.len();
        let entry = json!({ "dtype": "F32", "shape": [3, 9], "data_offsets": [end + 4, end + 112] });
        parts.entries.insert("recovery".into(), entry);
        parts.data.extend([0; 112]);
    });
    assert_refused!(error, FileError::TensorOffset { tensor, .. } if tensor == "recovery");
}

#[test]
fn tensors_overlap() {
    let error = refusal(|parts| {
        let stiffness = parts.entries["stiffness"]["data_offsets"].clone();
        set(parts, "mass", "data_offsets", stiffness);
    });
    assert_refused!(error, FileError::TensorOffset { .. });
}

#[test]
fn product_of_a_shape_overflows() {
    let cases =
        [json!([4_294_967_296_u64, 4_294_967_296_u64]), json!([u64::MAX]), json!([2_305_843_009_213_693_952_u64])];
    for shape in cases {
        let error = refusal(|parts| set(parts, "mass", "shape", shape));
        assert_refused!(error, FileError::TensorOverflow { tensor } if tensor == "mass");
    }
}

#[test]
fn bytes_of_a_tensor_do_not_fit_its_shape() {
    let error = refusal(|parts| set(parts, "mass", "shape", json!([9, 8])));
    assert_refused!(error, FileError::TensorSize { found: 648, expected: 576, .. });
    let error = refusal(|parts| {
        let begin = parts.entries["mass"]["data_offsets"][0].clone();
        set(parts, "mass", "data_offsets", json!([begin, 0]));
    });
    assert_refused!(error, FileError::TensorSize { found, .. } if found < 0);
}

/// Each tensor is possible for itself; together they would end beyond the last number of 64 bits.
#[test]
fn offsets_close_to_the_end_of_the_numbers() {
    let huge = 1_u64 << 60;
    let names =
        ["damping", "gravity", "mass", "mixing", "load_vectors", "stiffness", "rigid_body_mass", "rigid_body_modes"];
    let mut entries = Map::new();
    let mut begin = 0;
    for name in names {
        let entry = json!({ "dtype": "F64", "shape": [huge / 8], "data_offsets": [begin, begin + huge] });
        entries.insert(name.into(), entry);
        begin += huge;
    }
    let parts = Parts { entries, ..good() };
    assert_refused!(
        Superelement::from_bytes(&seal(parts)).unwrap_err(),
        FileError::DataLength { expected, .. } if expected == 8 * huge
    );
}

#[test]
fn data_not_as_long_as_described() {
    assert_refused!(refusal(|parts| parts.data.extend([0; 8])), FileError::DataLength { .. });
    let shorter = refusal(|parts| parts.data.truncate(parts.data.len() - 1));
    assert_refused!(shorter, FileError::DataLength { .. });
}

#[test]
fn metadata_not_json() {
    let parts = good();
    for text in ["", "not json", "{\"a\":NaN}"] {
        let error = Superelement::from_bytes(&unsealed(&parts, &json!({ "supel": text }))).unwrap_err();
        assert_refused!(error, FileError::MetadataNotJson { .. });
    }
}

#[test]
fn key_twice_in_the_metadata() {
    let parts = good();
    let text = parts.document.to_string().replacen('{', "{\"method\":\"guyan\",", 1);
    let error = Superelement::from_bytes(&unsealed(&parts, &json!({ "supel": text }))).unwrap_err();
    assert_refused!(error, FileError::DuplicateKey { key, place: "metadata" } if key == "method");
}

#[test]
fn metadata_against_the_schema() {
    let changes: [(&str, Value); 7] = [
        ("color", json!("red")),
        ("method", json!("magic")),
        ("flags", json!(["unknown_flag"])),
        ("model", json!({})),
        ("generator", json!({ "name": "x", "version": "1", "host": "y" })),
        ("coordinates", json!([{ "kind": "interface_row", "row": -1 }])),
        ("coordinates", json!([{ "kind": "interface_row", "row": 1, "column": 2 }])),
    ];
    for (field, value) in changes {
        let error = refusal(|parts| parts.document[field] = value);
        assert_refused!(error, FileError::MetadataSchema { .. });
    }
    let error = refusal(|parts| drop(parts.document.as_object_mut().unwrap().remove("generator")));
    assert_refused!(error, FileError::MetadataSchema { .. });
}

#[test]
fn format_version_unknown() {
    for version in [json!("2"), json!(1), Value::Null] {
        let error = refusal(|parts| parts.document["format_version"] = version);
        assert_refused!(error, FileError::UnknownVersion { expected: "1", .. });
    }
    let parts = good();
    for text in ["{}", "[]", "7"] {
        let error = Superelement::from_bytes(&unsealed(&parts, &json!({ "supel": text }))).unwrap_err();
        assert_refused!(error, FileError::UnknownVersion { found, .. } if found == "none");
    }
}

#[test]
fn digest_malformed() {
    let mut parts = good();
    for digest in [json!("AB".repeat(32)), json!("ab".repeat(31)), json!(5), Value::Null] {
        parts.document["blake3"] = digest;
        let file = unsealed(&parts, &json!({ "supel": parts.document.to_string() }));
        assert_refused!(Superelement::from_bytes(&file).unwrap_err(), FileError::DigestMalformed);
    }
}

/// Two places would leave open which one is taken as zeros.
#[test]
fn digest_twice_in_the_header() {
    let mut parts = good();
    parts.document["blake3"] = json!("cd".repeat(32));
    parts.document["units"] = json!("cd".repeat(32));
    let file = unsealed(&parts, &json!({ "supel": parts.document.to_string() }));
    assert_refused!(Superelement::from_bytes(&file).unwrap_err(), FileError::DigestMalformed);
}

#[test]
fn digest_of_other_bytes() {
    let mut parts = good();
    parts.document["blake3"] = json!("cd".repeat(32));
    let file = unsealed(&parts, &json!({ "supel": parts.document.to_string() }));
    let error = Superelement::from_bytes(&file).unwrap_err();
    assert_refused!(error, FileError::DigestMismatch { expected, .. } if expected == "cd".repeat(32));
}

#[test]
fn wrong_number_of_dimensions() {
    let cases = [("frequencies", json!([3, 1]), 1), ("mass", json!([81]), 2), ("interface_frames", json!([3, 3]), 3)];
    for (name, shape, rank) in cases {
        let error = refusal(|parts| set(parts, name, "shape", shape));
        assert_refused!(error, FileError::WrongRank { tensor, expected, .. } if tensor == name && expected == rank);
    }
}

#[test]
fn wrong_inner_dimension() {
    let cases = [
        ("interface_positions", json!([3, 1])),
        ("interface_frames", json!([1, 9, 1])),
        ("recovery_dofs", json!([2, 3])),
        ("mass", json!([27, 3])),
    ];
    for (name, shape) in cases {
        let error = refusal(|parts| set(parts, name, "shape", shape));
        assert_refused!(error, FileError::WrongShape { tensor, .. } if tensor == name);
    }
}

/// Matrices without entries take no bytes: any number of them could be promised.
#[test]
fn matrices_of_nothing() {
    for shape in [json!([1_000_000_000_000_000_u64, 0, 9]), json!([0, 9, 9])] {
        let error = refusal(|parts| {
            let end = parts.data.len();
            let entry = json!({ "dtype": "F64", "shape": shape, "data_offsets": [end, end] });
            parts.entries.insert("matrices".into(), entry);
        });
        assert_refused!(error, FileError::WrongShape { tensor: "matrices", .. });
    }
}

#[test]
fn recovery_without_its_dofs() {
    let error = refusal(|parts| remove(parts, "recovery_dofs"));
    assert_refused!(error, FileError::RecoveryIncomplete { missing: "recovery_dofs" });
    let error = refusal(|parts| remove(parts, "recovery"));
    assert_refused!(error, FileError::RecoveryIncomplete { missing: "recovery" });
}

/// Adds a tensor of 64-bit numbers behind the others.
fn add(parts: &mut Parts, name: &str, (dtype, shape): (&str, Value), numbers: &[[u8; 8]]) {
    // In single precision the recovery leaves what follows unaligned.
    remove(parts, "recovery");
    let end = parts.data.len();
    let rows = vec![0_u8; 8 * 27];
    let entry = json!({ "dtype": "F64", "shape": [3, 9], "data_offsets": [end, end + rows.len()] });
    parts.entries.insert("recovery".into(), entry);
    parts.data.extend(rows);
    let begin = parts.data.len();
    parts.data.extend(numbers.as_flattened());
    let entry = json!({ "dtype": dtype, "shape": shape, "data_offsets": [begin, parts.data.len()] });
    parts.entries.insert(name.into(), entry);
}

fn add_integers(parts: &mut Parts, name: &str, numbers: &[i64]) {
    add(
        parts,
        name,
        ("I64", json!([numbers.len()])),
        &numbers.iter().map(|number| number.to_le_bytes()).collect::<Vec<_>>(),
    );
}

fn add_position(parts: &mut Parts) {
    add(parts, "recovery_positions", ("F64", json!([1, 3])), &[[0; 8]; 3]);
}

/// A good file with one recovered node and these faces.
fn with_faces(nodes: &[i64], offsets: &[i64]) -> FileError {
    refusal(|parts| {
        add_position(parts);
        add_integers(parts, "recovery_faces", nodes);
        add_integers(parts, "recovery_face_offsets", offsets);
    })
}

#[test]
fn faces_without_what_they_belong_to() {
    let missing = |change: &dyn Fn(&mut Parts)| match refusal(change) {
        FileError::RecoveryIncomplete { missing } => missing,
        other => panic!("{other}"),
    };
    let nodes = |parts: &mut Parts| add_integers(parts, "recovery_faces", &[]);
    let offsets = |parts: &mut Parts| add_integers(parts, "recovery_face_offsets", &[0]);
    let both = |parts: &mut Parts| {
        nodes(parts);
        offsets(parts);
    };
    assert_eq!(missing(&both), "recovery_positions");
    assert_eq!(missing(&nodes), "recovery_face_offsets");
    assert_eq!(missing(&offsets), "recovery_faces");
    let alone = |parts: &mut Parts| {
        both(parts);
        remove(parts, "recovery");
        remove(parts, "recovery_dofs");
    };
    assert_eq!(missing(&alone), "recovery");
}

#[test]
fn faces_that_are_none() {
    for (nodes, offsets, face, said) in [
        (vec![0, 0], vec![0, 2], 0, "2 nodes"),
        (vec![0; 5], vec![0, 5], 0, "5 nodes"),
        (vec![0; 10], vec![0, 10], 0, "10 nodes"),
        (vec![0, 1, 2], vec![0, 3], 0, "node 1; expected 0 to 0"),
        (vec![0, -1, 2], vec![0, 3], 0, "node"),
        (vec![0, 0, 0], vec![0, 3], 0, "node 0 twice"),
        (vec![0, 0, 0], vec![0, 5, 3], 0, "offsets 0 and 5"),
        (vec![0, 0, 0], vec![0, -1, 3], 0, "offsets 0 and -1"),
        (vec![0, 0, 0], vec![0, i64::MAX, 3], 0, "offsets"),
        (vec![0, 0, 0], vec![0, 0, 3], 0, "0 nodes"),
    ] {
        match with_faces(&nodes, &offsets) {
            FileError::RecoveryFace { face: at, found } => {
                assert!(at == face && found.contains(said), "face {at} has {found} for {said}");
            }
            other => panic!("{other}"),
        }
    }
    for (nodes, offsets) in
        [(vec![0, 0, 0], vec![0]), (vec![0, 0, 0], vec![3]), (vec![0, 0, 0], vec![1, 3]), (vec![], vec![])]
    {
        let error = with_faces(&nodes, &offsets);
        assert_refused!(error, FileError::RecoveryFaceOffsets { n_ids } if n_ids == nodes.len());
    }
    let error = refusal(|parts| {
        add_position(parts);
        add(parts, "recovery_faces", ("F64", json!([1])), &[[0; 8]]);
        add_integers(parts, "recovery_face_offsets", &[0]);
    });
    assert_refused!(error, FileError::WrongDtype { tensor: "recovery_faces", .. });
    let error = refusal(|parts| {
        add_position(parts);
        add_integers(parts, "recovery_face_offsets", &[0]);
        add(parts, "recovery_faces", ("I64", json!([1, 1])), &[[0; 8]]);
    });
    assert_refused!(error, FileError::WrongRank { tensor: "recovery_faces", .. });
}

#[test]
fn recovered_direction_is_none_of_the_six() {
    for direction in [6_i64, -1, i64::MIN] {
        let error = refusal(|parts| {
            let begin = parts.entries["recovery_dofs"]["data_offsets"][0].as_u64().unwrap() as usize;
            parts.data[begin + 24..begin + 32].copy_from_slice(&direction.to_le_bytes());
        });
        assert_refused!(error, FileError::RecoveryDirection { row: 1, direction: found } if found == direction);
    }
}

#[test]
fn number_in_a_tensor_not_finite() {
    let error = refusal(|parts| {
        let begin = parts.entries["gravity"]["data_offsets"][0].as_u64().unwrap() as usize;
        parts.data[begin + 16..begin + 24].copy_from_slice(&f64::INFINITY.to_le_bytes());
    });
    assert_refused!(error, FileError::NotFinite { tensor: "gravity", index: 2, value: f64::INFINITY });
}
