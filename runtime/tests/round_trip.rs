//! What is written is read back, here and by the reference implementation of the container.

use supel_models::superelements::particle as sample;

use safetensors::SafeTensors;
use safetensors::tensor::{Dtype, TensorView};
use supel_runtime::{
    Direction, Matrix, Method, Precision, RecoveredDof, RecoveredFaces, Recovery, Superelement, mass_properties,
};

fn samples() -> Vec<Superelement> {
    let by_method = [Method::CraigBampton, Method::Herting].map(sample::component);
    by_method.into_iter().chain([sample::complete(), sample::two_particles(), with_faces()]).collect()
}

/// Five recovered nodes with a triangle and a quadrilateral between them.
fn with_faces() -> Superelement {
    let (mut tensors, metadata) = sample::complete_parts();
    let rows = Matrix::from_fn(5, 9, |i, j| (i * 9 + j) as f64);
    let dofs = (0..5).map(|node| RecoveredDof { node: 10 - node, direction: Direction::Ux }).collect();
    let faces: [&[usize]; 2] = [&[4, 0, 1], &[0, 1, 2, 3]];
    let recovery = Recovery::new(rows, dofs, Precision::Double).unwrap();
    let recovery = recovery.with_positions((0..5).map(|x| [f64::from(x), 0.0, 1.0]).collect()).unwrap();
    tensors.recovery = Some(recovery.with_faces(RecoveredFaces::new(faces, 5).unwrap()).unwrap());
    Superelement::new(tensors, metadata).unwrap()
}

#[test]
fn faces_are_lists_of_nodes_and_where_each_begins() {
    let bytes = with_faces().to_bytes().unwrap().bytes;
    let read = SafeTensors::deserialize(&bytes).unwrap();
    let numbers = |name: &str| -> Vec<i64> {
        let tensor = read.tensor(name).unwrap();
        assert_eq!((tensor.dtype(), tensor.shape().len()), (Dtype::I64, 1));
        tensor.data().as_chunks().0.iter().map(|bytes| i64::from_le_bytes(*bytes)).collect()
    };
    assert_eq!(numbers("recovery_faces"), [4, 0, 1, 0, 1, 2, 3]);
    assert_eq!(numbers("recovery_face_offsets"), [0, 3, 7]);
    let file = Superelement::from_bytes(&bytes).unwrap();
    let faces = file.tensors().recovery.as_ref().unwrap().faces().unwrap();
    assert_eq!(faces.iter().collect::<Vec<_>>(), [&[4, 0, 1][..], &[0, 1, 2, 3][..]]);
}

#[test]
fn what_is_written_is_read_back() {
    for superelement in samples() {
        let sealed = superelement.to_bytes().unwrap();
        let read = Superelement::from_bytes(&sealed.bytes).unwrap();
        assert_eq!(read, superelement);
        assert_eq!(read.to_bytes().unwrap(), sealed, "same superelement, same bytes");
    }
}

#[test]
fn sizes_follow_from_the_coordinates() {
    let superelement = sample::complete();
    assert_eq!((superelement.n_coordinates(), superelement.n_interface(), superelement.n_modal()), (9, 6, 3));
    assert_eq!(superelement.n_rigid(), 6);
    assert_eq!(sample::two_particles().n_interface(), 1);
}

#[test]
fn threads_may_share_a_superelement() {
    fn shared<T: Send + Sync + 'static>() {}
    shared::<Superelement>();
}

/// A JSON reader that is not exact loses the last bit of about one number in twenty.
#[test]
fn numbers_of_the_metadata_keep_their_last_bit() {
    let (tensors, mut metadata) = sample::complete_parts();
    let mut value = 1.0_f64 / 3.0;
    for _ in 0..500 {
        value = f64::from_bits(value.to_bits() + 0x0000_0123_4567_89ab);
        metadata.verification.checks[0].value = Some(value);
        let superelement = Superelement::new(tensors.clone(), metadata.clone()).unwrap();
        let read = Superelement::from_bytes(&superelement.to_bytes().unwrap().bytes).unwrap();
        assert_eq!(read.metadata().verification.checks[0].value, Some(value));
    }
}

#[test]
fn reference_implementation_reads_our_file() {
    let superelement = sample::complete();
    let bytes = superelement.to_bytes().unwrap().bytes;
    let read = SafeTensors::deserialize(&bytes).unwrap();
    assert_eq!(read.len(), 13);
    let stiffness = read.tensor("stiffness").unwrap();
    assert_eq!((stiffness.dtype(), stiffness.shape()), (Dtype::F64, [9, 9].as_slice()));
    let last = stiffness.data().last_chunk().map(|&bytes| f64::from_le_bytes(bytes));
    assert_eq!(last, superelement.tensors().stiffness.get(8, 8));
    assert_eq!(read.tensor("recovery").unwrap().dtype(), Dtype::F32);
    assert_eq!(read.tensor("recovery_dofs").unwrap().dtype(), Dtype::I64);
    let (_, header) = SafeTensors::read_metadata(&bytes).unwrap();
    let metadata = header.metadata().as_ref().unwrap();
    assert_eq!(metadata.keys().collect::<Vec<_>>(), ["supel"]);
    assert!(metadata["supel"].starts_with("{\"format_version\":\"1\",\"blake3\":\""));
}

#[test]
fn file_laid_out_by_the_reference_implementation_is_read() {
    let superelement = sample::complete();
    let sealed = superelement.to_bytes().unwrap();
    let ours = SafeTensors::deserialize(&sealed.bytes).unwrap();
    let (_, header) = SafeTensors::read_metadata(&sealed.bytes).unwrap();
    let zeros = "0".repeat(64);
    let document = header.metadata().as_ref().unwrap()["supel"].replace(&sealed.digest, &zeros);
    let tensors: Vec<(String, TensorView)> = ours.tensors();
    let theirs = safetensors::serialize(tensors, Some([("supel".to_owned(), document)].into())).unwrap();
    let digest = blake3::hash(&theirs).to_hex().to_string();
    let place = theirs.windows(64).position(|window| window == zeros.as_bytes()).unwrap();
    let theirs = [&theirs[..place], digest.as_bytes(), &theirs[place + 64..]].concat();
    assert_eq!(Superelement::from_bytes(&theirs).unwrap(), superelement);
}

#[test]
fn single_precision_takes_half_the_bytes_and_rounds() {
    let (mut tensors, metadata) = sample::complete_parts();
    let single = Superelement::new(tensors.clone(), metadata.clone()).unwrap().to_bytes().unwrap().bytes.len();
    let recovery = tensors.recovery.take().unwrap();
    let (rows, dofs) = (recovery.rows().clone(), recovery.dofs().to_vec());
    tensors.recovery = supel_runtime::Recovery::new(rows, dofs, supel_runtime::Precision::Double).ok();
    let double = Superelement::new(tensors, metadata).unwrap().to_bytes().unwrap().bytes.len();
    // 27 values; the header's padding may differ by up to seven bytes.
    assert!((double - single).abs_diff(27 * 4) <= 7, "{double} against {single}");
    assert!(recovery.rows().as_slice().iter().all(|&value| f64::from(value as f32) == value));
}

/// The sample's numbers are exact in binary, so the only roundings are those of a handful of operations.
#[test]
fn mass_properties_follow_from_the_rigid_body_mass() {
    let (tensors, _) = sample::parts(Method::Herting);
    let found = mass_properties(&tensors.rigid_body_mass).unwrap();
    let expected = sample::MASS_PROPERTIES;
    assert_eq!(found.mass, expected.mass);
    assert_eq!(found.center_of_mass, expected.center_of_mass);
    // Steiner's term m |c|² is 17.25: its rounding bounds the error of the difference.
    let error = |i: usize, j: usize| (found.inertia[i][j] - expected.inertia[i][j]).abs();
    assert!((0..9).all(|k| error(k / 3, k % 3) <= 8.0 * f64::EPSILON * 17.25));
}

#[test]
fn mass_properties_are_refused_to_what_is_not_geometric() {
    use supel_runtime::Matrix;
    let (tensors, _) = sample::parts(Method::Herting);
    let changed = |i: usize, j: usize, value: f64| {
        let entry = |a, b| {
            if (a, b) == (i, j) { value } else { tensors.rigid_body_mass[(a, b)] }
        };
        mass_properties(&Matrix::from_fn(6, 6, entry))
    };
    assert!(changed(0, 0, 4.0).is_some());
    assert!(changed(0, 0, 4.1).is_none(), "directions of different mass");
    assert!(changed(0, 1, 0.1).is_none(), "translations that couple");
    assert!(changed(4, 4, f64::NAN).is_none(), "not a number");
    assert!(mass_properties(&Matrix::from_fn(6, 6, |_, _| 0.0)).is_none(), "no mass");
    assert!(mass_properties(&Matrix::from_fn(5, 5, |i, j| f64::from(u8::from(i == j)))).is_none(), "five columns");
}
