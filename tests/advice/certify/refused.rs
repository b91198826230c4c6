//! Results that cannot be read, and numbers in another unit than is said.

use supel::cli::ExitCode;
use supel_testing::place::{Place, supel};

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
    assert!(said(["--hz", &place.text("empty.txt")], ExitCode::InputData).contains("E-VALUES-COUNT"));
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
