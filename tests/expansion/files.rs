//! The formats that modes come in: whichever it is, the superelement has the same numbers.

use std::io::Write;

use supel::cli::ExitCode;
use supel_models::Model;
use supel_testing::pencil::unpacked;
use supel_testing::place::{Place, steel_brick, supel};

use crate::{Case, TIP, array};

fn modes(model: &Model) -> Vec<Vec<f64>> {
    (0..3).map(|mode| (0..model.n).map(|row| (0.3 + (1.7 + mode as f64) * row as f64).sin()).collect()).collect()
}

/// An array as `numpy.save` writes it, in a version of the format.
pub(crate) fn npy(version: u8, header: &str, values: impl Iterator<Item = f64>) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY".to_vec();
    bytes.extend([version, 0]);
    // Numbers begin at a multiple of 64 bytes, behind blanks and a line end.
    let length = |prefix: usize| (prefix + header.len() + 1).div_ceil(64) * 64 - prefix;
    match version {
        1 => bytes.extend((length(10) as u16).to_le_bytes()),
        _ => bytes.extend((length(12) as u32).to_le_bytes()),
    }
    bytes.extend(header.as_bytes());
    while !(bytes.len() + 1).is_multiple_of(64) {
        bytes.push(b' ');
    }
    bytes.push(b'\n');
    values.for_each(|value| bytes.extend(value.to_le_bytes()));
    bytes
}

pub(crate) fn head(order: &str, shape: &str) -> String {
    format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': ({shape}), }}")
}

/// A job that takes the modes of `file`.
fn reduced(place: &Place, file: &str) -> supel_runtime::Superelement {
    let reduction = format!(r#"method = "mode-acceleration", modes = {{ file = "{file}" }}"#);
    let reduction: &'static str = reduction.leak();
    Case { interface: TIP, fixed: "", reduction }.made(place)
}

#[test]
fn every_format_gives_the_same_numbers() {
    let model = steel_brick();
    let place = Place::with(&model);
    let modes = modes(&model);
    let (n, k) = (model.n, modes.len());
    place.write("array.mtx", array(&modes).as_bytes());
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gzip.write_all(array(&modes).as_bytes()).expect("packed");
    place.write("array.mtx.gz", &gzip.finish().expect("packed"));
    // Each value in two halves, which are added up, the last column first.
    let mut entries = format!("%%MatrixMarket matrix coordinate real general\n{n} {k} {}\n", 2 * n * k);
    for column in (0..k).rev() {
        for row in (0..n).chain(0..n) {
            entries += &format!("{} {} {:.17e}\n", row + 1, column + 1, 0.5 * modes[column][row]);
        }
    }
    place.write("entries.mtx", entries.as_bytes());
    let by_columns = || modes.iter().flatten().copied();
    let by_rows = || (0..n).flat_map(|row| modes.iter().map(move |mode| mode[row]));
    let shape = format!("{n}, {k}");
    place.write("c.npy", &npy(1, &head("False", &shape), by_rows()));
    place.write("fortran.npy", &npy(1, &head("True", &shape), by_columns()));
    place.write("two.npy", &npy(2, &head("False", &shape), by_rows()));
    let expected = reduced(&place, "array.mtx");
    #[cfg_attr(not(feature = "hdf5"), expect(unused_mut, reason = "only HDF5 adds to them"))]
    let mut files = vec!["array.mtx.gz", "entries.mtx", "c.npy", "fortran.npy", "two.npy"];
    #[cfg(feature = "hdf5")]
    {
        let file = hdf5_metno::File::create(place.path("modes.h5")).expect("a file");
        let group = file.create_group("test").expect("a group");
        let put = |name: &str, values: Vec<f64>, shape: [usize; 2]| {
            let dataset = group.new_dataset::<f64>().shape(shape).create(name).expect("a dataset");
            dataset.write_raw(&values).expect("written");
        };
        put("V", by_rows().collect(), [n, k]);
        put("of_matlab", by_columns().collect(), [k, n]);
        files.extend(["modes.h5:/test/V", "modes.h5:/test/of_matlab"]);
    }
    for file in files {
        assert!(reduced(&place, file).tensors() == expected.tensors(), "{file}");
    }
    // One mode: an array of one dimension.
    place.write("one.mtx", array(&modes[..1]).as_bytes());
    place.write("one.npy", &npy(1, &head("False", &format!("{n},")), modes[0].iter().copied()));
    assert!(reduced(&place, "one.npy").tensors() == reduced(&place, "one.mtx").tensors());
}

/// The flag for a run without a job.
#[test]
fn modes_by_a_flag() {
    let model = steel_brick();
    let place = Place::with(&model);
    place.write("array.mtx", array(&modes(&model)).as_bytes());
    let expected = reduced(&place, "array.mtx");
    let modes = place.text("array.mtx");
    let flags = format!("--interface tip=5,15,45 --method mode-acceleration --modes-from {modes}");
    place.reduce(&place.model_flags(), &flags).expect(ExitCode::Done);
    assert!(place.superelement("x.supel").tensors() == expected.tensors());
    let without = place.reduce(&place.model_flags(), "--interface tip=5,15,45 --method mode-acceleration");
    assert!(without.expect(ExitCode::Usage).err.contains("--modes-from"));
    // Next to a job the flag of another method does not take its modes along.
    let given = supel(&["reduce", &place.text("job.toml"), "--method", "craig-bampton"]).expect(ExitCode::Usage).err;
    assert!(given.contains("E-JOB-MODES") && given.contains("is a file"), "{given}");
    supel(&["reduce", &place.text("job.toml"), "--method", "guyan"]).expect(ExitCode::Done);
}

/// Rows of the files that were dropped have no mass: their values are not asked.
#[test]
fn modes_have_a_value_for_dropped_rows_too() {
    let model = steel_brick();
    let expected = {
        let place = Place::with(&model);
        place.write("modes.mtx", array(&modes(&model)).as_bytes());
        reduced(&place, "modes.mtx")
    };
    let place = Place::new();
    // A row of nothing in front of all others.
    let moved = |entries: &[(u32, u32, f64)]| {
        let mut text =
            format!("%%MatrixMarket matrix coordinate real general\n{0} {0} {1}\n", model.n + 1, entries.len());
        entries.iter().for_each(|(row, column, value)| text += &format!("{} {} {value:.17e}\n", row + 2, column + 2));
        text
    };
    place.write("K.mtx", moved(&model.stiffness).as_bytes());
    place.write("M.mtx", moved(&model.mass).as_bytes());
    let columns: Vec<Vec<f64>> =
        modes(&model).iter().map(|mode| std::iter::once(7.7).chain(mode.iter().copied()).collect()).collect();
    place.write("modes.mtx", array(&columns).as_bytes());
    let rows: Vec<String> =
        (0..model.n).filter(|row| [5, 15, 45].contains(&model.dofs[*row].0)).map(|row| (row + 1).to_string()).collect();
    let (modes, rows) = (place.text("modes.mtx"), rows.join(","));
    let flags = format!("--drop-empty --interface tip=rows:{rows} --method mode-acceleration --modes-from {modes}");
    place.reduce(&place.matrix_flags(), &flags).expect(ExitCode::Done);
    let found = place.superelement("x.supel");
    for [found, expected] in [[&found.tensors().mass, &expected.tensors().mass].map(unpacked), {
        [&found.tensors().stiffness, &expected.tensors().stiffness].map(unpacked)
    }] {
        // Rigid-body modes come from the matrices here, which changes the correction of Ψ_S by its rounding.
        let size = expected.norm_max();
        assert!((found - expected).norm_max() <= 1e-9 * size);
    }
}
