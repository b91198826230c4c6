//! Results that cannot be read, and numbers in another unit than is said.

use supel::cli::ExitCode;
use supel_models::transform::supported;
use supel_testing::place::{Place, supel};

use super::superelement::{self, Foreign};
use super::{bar, certify, lowest, place_of};

fn refused(place: &Place, flags: [&str; 2]) -> (ExitCode, String) {
    let [k, m, v] = ["K.mtx", "M.mtx", "V.mtx"].map(|name| place.text(name));
    let ended = supel(&["certify", &k, &m, &v, flags[0], flags[1]]);
    (ended.code, ended.err)
}

#[test]
fn numbers_in_another_unit_are_noticed() {
    let pairs = lowest(&bar(), 12);
    let place = place_of(&bar(), &pairs);
    let list =
        |of: &dyn Fn(f64) -> f64| pairs.hertz.iter().map(|hertz| of(*hertz).to_string()).collect::<Vec<_>>().join(",");
    let hertz = list(&|hertz| hertz);
    let omega = list(&|hertz| hertz * std::f64::consts::TAU);
    let lambda = list(&|hertz| (hertz * std::f64::consts::TAU).powi(2));
    let kilohertz = list(&|hertz| 1e-3 * hertz);
    for (flag, numbers, advice) in [
        ("--hz", &omega, "say --rad-per-s"),
        ("--hz", &lambda, "say --eigenvalues"),
        ("--rad-per-s", &hertz, "say --hz"),
        ("--eigenvalues", &omega, "say --rad-per-s"),
        ("--hz", &kilohertz, "frequencies in kHz"),
    ] {
        let (code, said) = refused(&place, [flag, numbers]);
        assert_eq!(code, ExitCode::Usage, "{said}");
        assert!(said.contains("E-VALUES-UNIT") && said.contains(advice), "{flag}: {said}");
    }
    // A few wrong ones are no other unit.
    certify(&place, "").expect(ExitCode::Done);
}

#[test]
fn frequencies_that_do_not_go_with_the_shapes_are_refused() {
    let place = place_of(&bar(), &lowest(&bar(), 8));
    let said = |flags: [&str; 2], code: ExitCode| {
        let (found, said) = refused(&place, flags);
        assert_eq!(found, code, "{said}");
        said
    };
    let count = said(["--hz", "1,2,3"], ExitCode::InputData);
    assert!(count.contains("E-VALUES-COUNT") && count.contains("found 3 frequencies – expected 8"), "{count}");
    place.write("few.txt", b"1\n2\n");
    assert!(said(["--hz", &place.text("few.txt")], ExitCode::InputData).contains("few.txt: the frequencies"));
    place.write("many.txt", "1\n".repeat(9).as_bytes());
    assert!(said(["--hz", &place.text("many.txt")], ExitCode::InputData).contains("E-VALUES-COUNT"));
    place.write("table.txt", b"1 10\n2 20\n");
    let table = said(["--hz", &place.text("table.txt")], ExitCode::InputData);
    assert!(table.contains("E-VALUES]") && table.contains("table.txt:2"), "{table}");
    place.write("words.txt", b"1\ntwo\n");
    let words = said(["--hz", &place.text("words.txt")], ExitCode::InputData);
    assert!(words.contains("words.txt:2") && words.contains("`two`"), "{words}");
    place.write("empty.txt", b"# nothing\n");
    assert!(said(["--hz", &place.text("empty.txt")], ExitCode::InputData).contains("E-NO-DATA"));
    let band = said(["--band", "10,5"], ExitCode::Usage);
    assert!(band.contains("E-FLAG") && band.contains("--band"), "{band}");
    let other = Place::with(&lowest_model());
    let [k, m] = ["K.mtx", "M.mtx"].map(|name| other.text(name));
    let shapes = supel(&["certify", &k, &m, &place.text("V.mtx")]).expect(ExitCode::InputData).err;
    assert!(shapes.contains("E-MODES-ROWS"), "{shapes}");
}

fn lowest_model() -> supel_models::Model {
    supel_testing::place::steel_brick()
}

#[test]
fn an_output_is_never_written_over_an_input() {
    let place = place_of(&bar(), &lowest(&bar(), 8));
    let html = place.text("V.html");
    std::fs::rename(place.path("V.mtx"), place.path("V.html")).expect("renamed");
    let [k, m] = ["K.mtx", "M.mtx"].map(|name| place.text(name));
    let ended = supel(&["certify", &k, &m, &html, "--html", &html]).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-OVERWRITE"), "{}", ended.err);
    assert!(place.bytes("V.html").starts_with(b"%%MatrixMarket"));
}

/// Entries that repeat a position are added with a note, and strictly refused: in the matrices of the model and of a superelement.
#[test]
fn repeated_entries_are_refused_strictly() {
    let place = place_of(&bar(), &lowest(&bar(), 12));
    repeat_an_entry(&place, "K.mtx");
    certify(&place, "").expect(ExitCode::Done);
    let said = certify(&place, "--strict").expect(ExitCode::InputData).err;
    assert!(said.contains("E-DUPLICATES") && said.contains("K.mtx"), "{said}");
    place.reduce(&place.model_flags(), "--interface ends=1,9,27 --method guyan").expect(ExitCode::Done);
    let file = place.text("x.supel");
    place.write("job.json", supel(&["inspect", &file, "--job"]).expect(ExitCode::Done).out.as_bytes());
    let job = place.text("job.json");
    supel(&["verify", &file, "--job", &job]).expect(ExitCode::Done);
    let said = supel(&["verify", &file, "--job", &job, "--strict"]).expect(ExitCode::InputData).err;
    assert!(said.contains("E-DUPLICATES") && said.contains("K.mtx"), "{said}");

    let model = lowest_model();
    let place = Place::with(&model);
    Foreign::craig_bampton(&model, &superelement::interface(), 12).write(&place);
    repeat_an_entry(&place, "mhat.mtx");
    superelement::certify(&place, "").expect(ExitCode::Done);
    let said = superelement::certify(&place, "--strict").expect(ExitCode::InputData).err;
    assert!(said.contains("E-DUPLICATES") && said.contains("mhat.mtx"), "{said}");
}

/// Adds a zero at a position that a Matrix Market file has already.
fn repeat_an_entry(place: &Place, name: &str) {
    let text = String::from_utf8(place.bytes(name)).expect("text");
    let is_size = |line: &&str| !line.starts_with('%');
    let size = text.lines().find(is_size).expect("a size line");
    let numbers: Vec<usize> = size.split_whitespace().map(|number| number.parse().expect("a number")).collect();
    let longer = format!("{} {} {}", numbers[0], numbers[1], numbers[2] + 1);
    place.write(name, (text.replacen(size, &longer, 1).trim_end().to_owned() + "\n1 1 0\n").as_bytes());
}

/// A constraint that holds the component: what the error advises is a flag of each of these commands.
#[test]
fn constraints_to_ground_are_taken_where_a_flag_says_so() {
    let model = lowest_model();
    let held = supported(&model, |dof| dof == (45, 1));
    let row = model.dofs.iter().position(|dof| *dof == (45, 1)).expect("a row");
    let mut pairs = lowest(&held, 12);
    pairs.shapes.iter_mut().for_each(|shape| shape.insert(row, 0.0));
    let place = place_of(&model, &pairs);
    let g = format!("%%MatrixMarket matrix coordinate real general\n1 {} 1\n1 {} 1\n", model.n, row + 1);
    place.write("G.mtx", g.as_bytes());
    let [k, m, g, dofs, nodes] = ["K.mtx", "M.mtx", "G.mtx", "dofs.txt", "nodes.csv"].map(|name| place.text(name));
    let flags = format!("--constraints {g} --dofs {dofs} --nodes {nodes}");
    let accepted = format!("{flags} --constraints-to-ground accept");
    let said = certify(&place, &flags).expect(ExitCode::ModelPhysics).err;
    assert!(said.contains("E-CONSTRAINT-GROUND") && said.contains("--constraints-to-ground accept"), "{said}");
    let text = certify(&place, &accepted).expect(ExitCode::Done).out;
    assert!(
        text.contains("holds the component to the ground") && text.contains("a Sturm count finds 12 modes"),
        "{text}"
    );
    let of =
        |command: &str, flags: &str| supel(&[&[command, &k, &m], &flags.split(' ').collect::<Vec<_>>()[..]].concat());
    let text = of("doctor", &flags).out;
    assert!(text.contains("E-CONSTRAINT-GROUND") && text.contains("--constraints-to-ground accept"), "{text}");
    let text = of("doctor", &accepted).expect(ExitCode::Done).out;
    assert!(!text.contains("E-CONSTRAINT-GROUND") && text.contains("holds the component"), "{text}");
    let job = of("init", &accepted).expect(ExitCode::Done).out;
    assert!(job.contains("constraints_to_ground = \"accept\""), "{job}");
}

/// Names that K̂ has and M̂ has not, and names that nothing gives: each text asks for what is possible there.
#[test]
fn rows_without_names_are_told_by_what_they_are_needed_for() {
    let model = lowest_model();
    let place = Place::with(&model);
    let foreign = Foreign::craig_bampton(&model, &superelement::interface(), 2);
    foreign.write(&place);
    let n = foreign.stiffness.nrows();
    let lines: Vec<String> = (1..=n).map(|row| format!("{row}, 1, {row}, 1, {row}.0")).collect();
    place.write("khat.mtx", (lines.join("\n") + "\n").as_bytes());
    let said = superelement::certify(&place, "").expect(ExitCode::InputData).err;
    assert!(said.contains("E-ROWS-UNNAMED") && said.contains("K̂ and M̂ do not agree"), "{said}");
    assert!(!said.contains("give `dofs`") && !said.contains("of the job"), "{said}");
    let [k, npz, table] = ["K.mtx", "k.npz", "rows.csv"].map(|name| place.text(name));
    let said = supel(&["convert", &k, &npz, "--write-dofs", &table]).expect(ExitCode::InputData).err;
    assert!(said.contains("nothing says what its rows are") && said.contains("--dofs"), "{said}");
    let dofs = place.text("dofs.txt");
    supel(&["convert", &k, &npz, "--write-dofs", &table, "--dofs", &dofs]).expect(ExitCode::Done);
}
