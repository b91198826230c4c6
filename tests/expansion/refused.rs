//! Files that have no modes, and components that cannot answer them.

use supel::cli::ExitCode;
use supel_testing::place::{Place, steel_brick, supel};

use crate::files::{head, npy};
use crate::{Case, OF_FILE, TIP, WALL, array};

/// Rows of the brick.
const N: usize = 135;

#[track_caller]
fn assert_refused(place: &Place, case: Case, (code, words): (ExitCode, &[&str])) {
    let _ = std::fs::remove_file(place.path("x.supel"));
    let said = case.run(place).expect(code).err;
    words.iter().for_each(|word| assert!(said.contains(word), "{word:?} is not in {said}"));
    assert!(!place.path("x.supel").exists());
}

fn of(file: &str) -> Case {
    let reduction: &'static str = format!(r#"method = "mode-acceleration", modes = {{ file = "{file}" }}"#).leak();
    Case { interface: TIP, fixed: "", reduction }
}

fn mode(n: usize) -> Vec<f64> {
    (1..=n).map(|row| row as f64).collect()
}

#[test]
fn texts_that_are_no_modes() {
    let place = Place::with(&steel_brick());
    let sound = array(&[mode(N)]);
    let coordinate = |rest: &str| format!("%%MatrixMarket matrix coordinate real general\n{rest}");
    let few = sound.trim_end().rsplit_once('\n').expect("lines").0.to_owned();
    for (content, words) in [
        (array(&[mode(N - 1)]), vec!["E-MODES-ROWS", "the modes have 134 rows – expected 135"]),
        (array(&[mode(N + 1)]), vec!["E-MODES-ROWS", "136 rows"]),
        (format!("%%MatrixMarket matrix array real general\n{N} 0\n"), vec!["E-MODES-COUNT", "0 columns"]),
        (coordinate("135 136 1\n1 1 1\n"), vec!["E-MODES-COUNT", "136 columns", "from 1 to 135"]),
        (coordinate("135 18446744073709551615 1\n1 1 1\n"), vec!["E-MODES-COUNT"]),
        (coordinate("135 3 2\n1 1 1\n1 3 1\n"), vec!["E-MODES-NOTHING", "mode 2", "zero everywhere"]),
        (coordinate("135 2 2\n1 1 1\n1 2 0\n"), vec!["E-MODES-NOTHING", "mode 2", "zero everywhere"]),
        (array(&[mode(N), vec![0.0; N]]), vec!["E-MODES-NOTHING", "mode 2"]),
        (few, vec!["E-NNZ", "modes.mtx:136", "the end of the file after 134"]),
        (sound.clone() + "1\n", vec!["E-NNZ-SURPLUS"]),
        (sound.replace("7.00000000000000000e0", "nan"), vec!["E-NONFINITE", "entry (7, 1)"]),
        (sound.replace("7.00000000000000000e0", "seven"), vec!["E-ENTRY", "`seven`"]),
        (sound.replace("real", "complex"), vec!["E-MODES-FORMAT", ":1: not the modes", "array real general"]),
        ("1 2 3\n".to_owned(), vec!["E-MODES-FORMAT", "found `1 2 3`"]),
        (String::new(), vec!["E-NO-DATA", "modes in Matrix Market form"]),
    ] {
        place.write("modes.mtx", content.as_bytes());
        assert_refused(&place, of("modes.mtx"), (ExitCode::InputData, &words));
    }
    assert_refused(&place, of("none.mtx"), (ExitCode::Io, &["E-READ", "none.mtx"]));
}

#[test]
fn arrays_that_are_no_modes() {
    let place = Place::with(&steel_brick());
    let sound = |header: String, n: usize| npy(1, &header, (0..n).map(|at| at as f64 + 1.0));
    let mut long = sound(head("False", "135, 1"), N);
    long.push(0);
    let mut nan = sound(head("False", "135, 1"), N);
    let last = nan.len() - 8;
    nan[last..].copy_from_slice(&f64::NAN.to_le_bytes());
    let header = |text: &str| sound(text.to_owned(), N);
    for (content, words) in [
        (sound(head("False", "134, 1"), 134), vec!["E-MODES-ROWS", "134 rows"]),
        (sound(head("False", "135, 0"), 0), vec!["E-MODES-COUNT", "0 columns"]),
        (sound(head("False", "135, 99999999999"), N), vec!["E-MODES-COUNT"]),
        (sound(head("False", "135, 135"), N), vec!["E-MODES-FORMAT", "1080 bytes behind the header of 135 × 135"]),
        (sound(head("False", "135, 1"), N - 1), vec!["E-MODES-FORMAT", "1072 bytes"]),
        (long, vec!["E-MODES-FORMAT", "1081 bytes"]),
        (nan, vec!["E-MODES-FORMAT", "`NaN` in row 135, column 1"]),
        (sound(head("False", "135, 1, 1"), N), vec!["E-MODES-FORMAT", "the shape [135, 1, 1]"]),
        (sound(head("False", ""), N), vec!["E-MODES-FORMAT", "the shape []"]),
        (header("{'descr': '<c16', 'fortran_order': False, 'shape': (135,), }"), vec!["type '<c16'", "real numbers"]),
        (header("{'descr': '<f4', 'fortran_order': False, 'shape': (135,), }"), vec!["1080 bytes behind the header"]),
        (header("{'descr': '<f8', 'shape': (135,), }"), vec!["E-MODES-FORMAT", "the header"]),
        (header("{'descr': '<f8', 'fortran_order': False, }"), vec!["E-MODES-FORMAT", "the header"]),
        (header("{'descr': '<f8', 'fortran_order': False, 'shape': (135"), vec!["E-MODES-FORMAT", "the header"]),
        (npy(2, &head("False", "135"), std::iter::empty())[..11].to_vec(), vec!["cut short or too long"]),
        (b"\x93NUMPY\x01\x00\xff\xff{".to_vec(), vec!["cut short or too long"]),
        (b"\x93NUMPY\x09\x00\x10\x00{".to_vec(), vec!["version 9 of the format"]),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(), vec!["cut short or too long"]),
        (b"\x93NUMPY".to_vec(), vec!["cut short or too long"]),
    ] {
        place.write("modes.npy", &content);
        assert_refused(&place, of("modes.npy"), (ExitCode::InputData, &words));
    }
}

#[cfg(feature = "hdf5")]
#[test]
fn datasets_that_are_no_modes() {
    let place = Place::with(&steel_brick());
    {
        let file = hdf5_metno::File::create(place.path("modes.h5")).expect("a file");
        let put = |name: &str, values: Vec<f64>, shape: &[usize]| {
            let dataset = file.new_dataset::<f64>().shape(shape.to_vec()).create(name).expect("a dataset");
            dataset.write_raw(&values).expect("written");
        };
        put("few", mode(2 * (N - 1)), &[N - 1, 2]);
        put("cube", mode(N), &[N, 1, 1]);
        put("nan", vec![f64::NAN; N], &[N, 1]);
        put("zero", vec![0.0; N], &[N]);
        put("none", Vec::new(), &[N, 0]);
        file.create_group("group").expect("a group");
        file.new_dataset::<u8>().shape(N).create("bytes").expect("a dataset").write_raw(&[0u8; N]).expect("written");
    }
    for (dataset, words) in [
        (":/few", vec!["E-MODES-ROWS", "134 rows"]),
        (":/cube", vec!["E-MODES-FORMAT", "extents [135, 1, 1]"]),
        (":/nan", vec!["E-MODES-FORMAT", "`NaN` in row 1, column 1"]),
        (":/zero", vec!["E-MODES-NOTHING", "mode 1"]),
        (":/bytes", vec!["E-MODES-NOTHING", "mode 1"]),
        (":/none", vec!["E-MODES-COUNT", "0 columns"]),
        (":/other", vec!["E-HDF5-MISSING", "/other"]),
        (":/group", vec!["E-HDF5-TYPE", "/group"]),
        ("", vec!["E-MODES-FORMAT", "model.h5:/V"]),
    ] {
        assert_refused(&place, of(&format!("modes.h5{dataset}")), (ExitCode::InputData, &words));
    }
}

#[test]
fn jobs_whose_modes_are_not_those_of_the_method() {
    let place = Place::with(&steel_brick());
    place.write("modes.mtx", array(&[mode(N)]).as_bytes());
    for (reduction, words) in [
        (r#"method = "mode-acceleration""#, ["E-JOB-MODES", "missing – expected the file of the modes"]),
        (r#"method = "mode-acceleration", modes = { count = 3 }"#, ["E-JOB-MODES", "is without a file"]),
        (r#"method = "herting", modes = { file = "modes.mtx" }"#, ["E-JOB-MODES", "is a file – expected how many"]),
        (r#"method = "herting", modes = { accept = true }"#, ["E-JOB-MODES", "is accept = true – expected a scene"]),
        (r#"method = "herting", modes = { accept = false }"#, ["E-JOB]", "exactly one of"]),
        (r#"method = "guyan", modes = { file = "modes.mtx" }"#, ["E-JOB-MODES", "guyan keeps no modes"]),
        (r#"method = "mode-acceleration", modes = { file = "" }"#, ["E-JOB-EMPTY", "reduction.modes.file"]),
        (r#"method = "mode-acceleration", modes = { file = "modes.mtx", count = 1 }"#, ["E-JOB]", "exactly one of"]),
    ] {
        assert_refused(&place, Case { interface: TIP, fixed: "", reduction }, (ExitCode::Usage, &words));
    }
}

/// E-MODES-UNHELD, and modes that move nothing but what is held.
#[test]
fn components_that_cannot_answer() {
    let model = steel_brick();
    let place = Place::with(&model);
    place.write("modes.mtx", array(&[mode(N)]).as_bytes());
    let free = Case { interface: "", fixed: "", reduction: OF_FILE };
    assert_refused(&place, free, (ExitCode::ModelPhysics, &["E-MODES-UNHELD", "name an interface"]));
    // The same component, held, has an answer without an interface.
    Case { fixed: WALL, ..free }.made(&place);
    let held = |row: usize| if model.dofs[row].0 % 5 == 1 { 1.0 } else { 0.0 };
    // A lumped mass, through which held dofs move no others.
    let lumped: Vec<(u32, u32, f64)> = (0..model.n as u32).map(|row| (row, row, 1.0)).collect();
    let mut mass = format!("%%MatrixMarket matrix coordinate real general\n{N} {N} {N}\n");
    lumped.iter().for_each(|(row, column, value)| mass += &format!("{} {} {value}\n", row + 1, column + 1));
    place.write("M.mtx", mass.as_bytes());
    place.write("modes.mtx", array(&[mode(N), (0..N).map(held).collect()]).as_bytes());
    let case = Case { interface: TIP, fixed: WALL, reduction: OF_FILE };
    assert_refused(&place, case, (ExitCode::InputData, &["E-MODES-NOTHING", "mode 2", "on held dofs"]));
}

/// E-OVERWRITE: a report over the modes.
#[test]
fn outputs_spare_the_modes() {
    let place = Place::with(&steel_brick());
    place.write("modes.json", array(&[mode(N)]).as_bytes());
    of("modes.json").run(&place).expect(ExitCode::Done);
    let args = ["reduce", &place.text("job.toml"), "--report", &place.text("modes.json")];
    let said = supel(&args).expect(ExitCode::Usage).err;
    assert!(said.contains("E-OVERWRITE") && said.contains("the modes"), "{said}");
}
