//! Files of a job other than matrices, maps and tables of the model: constraints, internal forces, loads, modes, further matrices, recovery
//! matrices and their names. Cut, turned over, no files at all, numbers that are none: I-03, I-08, I-10, I-14, I-23.

use supel::error::Error;
use supel::job::Job;
use supel::memory_forecast::Resources;
use supel::outcome::Outcome;
use supel_models::model::Assembler;
use supel_models::{Ends, Model, spring};

use crate::place::Place;

/// A file, the job that names it, and what stands in it.
struct Subject {
    file: &'static str,
    job: String,
    content: Vec<u8>,
    model: Model,
    /// Rows and columns of a file of Matrix Market.
    size: Option<[usize; 2]>,
}

const GENERAL: &str = "%%MatrixMarket matrix coordinate real general\n";
const ARRAY: &str = "%%MatrixMarket matrix array real general\n";

/// The job of the chain of five with further keys of the model, a reduction, further tables and further keys of `write`.
fn chain_job(of_model: &str, reduction: &str, tables: &str, of_write: &str) -> String {
    format!(
        "model     = {{ stiffness = \"K.mtx\", mass = \"M.mtx\"{of_model} }}\n\
         interface = [{{ name = \"ends\", nodes = {{ rows = [0, 4] }} }}]\n\
         reduction = {{ {reduction} }}\n{tables}\n[write]\nsuperelement = \"x.supel\"\n{of_write}\n"
    )
}

/// Three points on a string under tension: an elongation that costs one, and a tension of a tenth that resists deflection.
fn string() -> Model {
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for (a, b) in [(0u32, 1u32), (1, 2)] {
        for (axis, k) in [1.0, 0.1, 0.1].into_iter().enumerate() {
            let [a, b] = [3 * a + axis as u32, 3 * b + axis as u32];
            [(a, a, k), (b, b, k), (a, b, -k)].into_iter().for_each(|(i, j, k)| stiffness.add(i, j, k));
        }
    }
    (0..9).for_each(|row| mass.add(row, row, 1.0));
    Model::node_major((0..3).map(|i| [f64::from(i), 0.0, 0.0]).collect(), &[0, 1, 2], stiffness, mass)
}

/// A column of five numbers as NumPy writes it.
fn npy() -> Vec<u8> {
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (5, 1), }";
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(format!("{header:<117}\n").into_bytes());
    [0.0f64, 1.0, 2.0, -1.0, 0.0].iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    bytes
}

/// Numbers of one digit with an exponent of zero: cut short they are the same number or none.
fn subjects() -> Vec<Subject> {
    const HELD: &str = r#"method = "craig-bampton", modes = { count = 1 }"#;
    const OF_FILE: [&str; 2] = [
        r#"method = "mode-acceleration", modes = { file = "V.mtx" }"#,
        r#"method = "mode-acceleration", modes = { file = "V.npy" }"#,
    ];
    let chain = |file, job, content: Vec<u8>, size| Subject { file, job, content, model: spring(5, Ends::Free), size };
    let text = |text: String| text.into_bytes();
    let column = "0e0\n1e0\n2e0\n-1e0\n0e0\n";
    let constraints = text(format!("{GENERAL}1 5 3\n1 3 2e0\n1 2 -1e0\n1 4 -1e0\n"));
    let damping = text(format!("{GENERAL}5 5 4\n2 2 1e0\n3 3 1e0\n3 2 -1e0\n2 3 -1e0\n"));
    let recovery = text(format!("{GENERAL}2 5 3\n1 2 1e0\n1 3 -1e0\n2 4 3e0\n"));
    let names = "name,unit\nfirst,N\nsecond,N\n".to_owned();
    let quantities = || chain_job("", HELD, "", "quantities = { matrix = \"R.mtx\", names = \"R.csv\" }");
    let of_string = "model = { stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\", state = \
         \"preloaded\", internal_forces = \"q.mtx\" }\ninterface = [{ name = \"ends\", nodes = [1, 3] }]\n\
         reduction = { method = \"craig-bampton\", modes = { count = 1 } }\nwrite = { superelement = \"x.supel\" }\n";
    // A tension of a tenth pulls the ends towards each other; forces of a tenth take a negative exponent.
    let forces = text(format!("{ARRAY}9 1\n-1e-1\n0e0\n0e0\n0e0\n0e0\n0e0\n1e-1\n0e0\n0e0\n"));
    vec![
        chain("G.mtx", chain_job(", constraints = \"G.mtx\"", HELD, "", ""), constraints, Some([1, 5])),
        chain(
            "f.mtx",
            chain_job("", HELD, "[[load]]\nname = \"pull\"\nfile = \"f.mtx\"", ""),
            text(format!("{ARRAY}5 1\n{column}")),
            Some([5, 1]),
        ),
        chain("V.mtx", chain_job("", OF_FILE[0], "", ""), text(format!("{ARRAY}5 1\n{column}")), Some([5, 1])),
        chain("V.npy", chain_job("", OF_FILE[1], "", ""), npy(), None),
        chain(
            "C.mtx",
            chain_job("", HELD, "[[matrix]]\nname = \"seal\"\nkind = \"damping\"\nfile = \"C.mtx\"", ""),
            damping,
            Some([5, 5]),
        ),
        chain("R.mtx", quantities(), recovery, Some([2, 5])),
        chain("R.csv", quantities(), text(names), None),
        Subject { file: "q.mtx", job: of_string.to_owned(), content: forces, model: string(), size: Some([9, 1]) },
    ]
}

/// A folder with the files of a subject. Both files of a recovery matrix are there.
fn place_of(subject: &Subject) -> Place {
    let place = Place::with(&subject.model);
    subjects().iter().for_each(|other| place.write(other.file, &other.content));
    place.write("job.toml", subject.job.as_bytes());
    place
}

/// A run with something else in the place of the file.
fn run(place: &Place, subject: &Subject, content: &[u8]) -> Result<Outcome, Error> {
    place.write(subject.file, content);
    let job = Job::read(&place.path("job.toml"))?;
    supel::reduce(&job, Resources::default(), &mut ())
}

/// Asserts that an error says enough: of which file, and in words. Names that do not fit their matrix are told of that.
#[track_caller]
fn assert_names_the_file(error: &Error, subject: &Subject, case: &str) {
    let message = error.to_string();
    let is_named = message.contains(subject.file) || subject.file == "R.csv" && message.contains("R.mtx");
    assert!(is_named && message.contains(" – "), "{}, {case}: {message}", subject.file);
}

/// At every byte: what is cut off is missed, by the name of the file, or was not needed.
#[test]
fn i_14_further_files_cut_at_every_byte() {
    for subject in subjects() {
        let place = place_of(&subject);
        let expected =
            run(&place, &subject, &subject.content).unwrap_or_else(|error| panic!("{}: {error}", subject.file));
        let mut n_missed = 0;
        for end in 0..subject.content.len() {
            match run(&place, &subject, &subject.content[..end]) {
                Ok(outcome) => assert!(
                    outcome.superelement.tensors() == expected.superelement.tensors(),
                    "{}: other results of {end} bytes",
                    subject.file
                ),
                Err(error) => {
                    assert_names_the_file(&error, &subject, &format!("{end} bytes"));
                    n_missed += 1;
                }
            }
        }
        // The end of the last name or number may go, and its line end.
        assert!(n_missed + 10 >= subject.content.len(), "{}: {n_missed} of {}", subject.file, subject.content.len());
    }
}

/// Every bit of a text and of the header of a binary file: a result or an error with something to say, and no panic.
#[test]
fn i_14_every_bit_of_further_files_turned_over() {
    for subject in subjects().into_iter().filter(|subject| ["G.mtx", "V.npy"].contains(&subject.file)) {
        let place = place_of(&subject);
        for bit in 0..8 * subject.content.len().min(128) {
            let mut flipped = subject.content.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            if let Err(error) = run(&place, &subject, &flipped) {
                assert!(error.to_string().contains(" – "), "{}, bit {bit}: {error}", subject.file);
            }
        }
    }
}

/// Numbers that are none, indices from zero, and counts that no file can hold.
#[test]
fn i_03_i_08_i_10_numbers_of_further_files() {
    for subject in subjects() {
        let (place, Some([rows, columns])) = (place_of(&subject), subject.size) else { continue };
        let text = |n: &str, entries: &str| format!("{GENERAL}{rows} {columns} {n}\n{entries}");
        for (content, code, line) in [
            (text("1", "1 1 nan\n"), "E-NONFINITE", 3),
            (text("2", "1 1 1\n1 1 -inf\n"), "E-NONFINITE", 4),
            (text("1", "1 1 1e999\n"), "E-NONFINITE", 3),
            (text("2", "1 1 1\n0 1 1\n"), "E-INDEX", 4),
            (text("1", "1 0 1\n"), "E-INDEX", 3),
            (text("1", &format!("{} 1 1\n", rows + 1)), "E-INDEX", 3),
            (text("1000000000000000000", "1 1 1\n"), "E-NNZ", 0),
            (text("1", "1 1 1\n1 1 1\n"), "E-NNZ-SURPLUS", 4),
        ] {
            let refused = run(&place, &subject, content.as_bytes());
            let error = refused.err().unwrap_or_else(|| panic!("{}: {content:?} was taken", subject.file));
            assert_eq!(error.code(), code, "{}, {content:?}: {error}", subject.file);
            assert_names_the_file(&error, &subject, &content);
            if line > 0 {
                let place = format!("{}:{line}", subject.file);
                assert!(error.to_string().contains(&place), "{place} is not in {error}");
            }
        }
    }
}

/// Pipes, devices and folders are refused before anything waits for them.
#[cfg(unix)]
#[test]
fn i_23_further_files_that_are_none() {
    for subject in subjects() {
        let place = place_of(&subject);
        std::fs::create_dir(place.path("folder")).expect("a folder");
        let pipe = format!("pipe{}", &subject.file[1..]);
        let made = std::process::Command::new("mkfifo").arg(place.path(&pipe)).status().expect("mkfifo");
        assert!(made.success());
        for path in ["folder", &pipe, "/dev/zero", "/dev/stdin", "."] {
            let job = subject.job.replace(&format!("\"{}\"", subject.file), &format!("{path:?}"));
            assert!(job != subject.job);
            place.write("job.toml", job.as_bytes());
            let refused = run(&place, &subject, &subject.content);
            let error = refused.err().unwrap_or_else(|| panic!("{}: {path} was taken", subject.file));
            assert_eq!(error.code(), "E-NOT-A-FILE", "{}, {path}: {error}", subject.file);
        }
    }
}
