//! Bands: what belongs to one, by its shape or by what is stated of it, and what is said where nothing does.

use supel::cli::ExitCode;
use supel_testing::place::supel;

use super::{Pairs, bar, certify, document, lowest, missing, of_kind, place_of, verdict};

/// The modes of the bar that the band has, of those that are numbered from zero.
const INSIDE: std::ops::Range<usize> = 10..14;
/// Pairs that the tests take some of.
const KNOWN: usize = 70;

/// The band around these modes, half way to their neighbours.
fn band_of(all: &Pairs, inside: std::ops::Range<usize>) -> String {
    let between = |a: usize, b: usize| 0.5 * (all.hertz[a] + all.hertz[b]);
    format!("--band {},{}", between(inside.start - 1, inside.start), between(inside.end - 1, inside.end))
}

/// Some pairs of a result, and another one that is stated at a frequency.
fn with(all: &Pairs, right: std::ops::Range<usize>, shape: Vec<f64>, hertz: f64) -> Pairs {
    let mut pairs = Pairs { hertz: all.hertz[right.clone()].to_vec(), shapes: all.shapes[right].to_vec() };
    pairs.hertz.push(hertz);
    pairs.shapes.push(shape);
    pairs
}

/// A frequency that is stated in the band is judged there, wherever its shape belongs.
#[test]
fn what_is_stated_in_the_band_is_judged_there() {
    let all = lowest(&bar(), KNOWN);
    let stated = 0.5 * (all.hertz[11] + all.hertz[12]) * 1.001;
    let mixed: Vec<f64> = all.shapes[25].iter().zip(&all.shapes[60]).map(|(a, b)| a + b).collect();
    let foreign = [
        (all.shapes[60].clone(), "inexact", "C-01"),
        (all.shapes[6].clone(), "inexact", "C-01"),
        (all.shapes[0].clone(), "inexact", "C-05"),
        (mixed, "invented", "C-02"),
    ];
    for (from, right) in [(band_of(&all, INSIDE), INSIDE), (format!("--band 0,{}", all.hertz[13] * 1.001), 6..14)] {
        for (at, (shape, kind, check)) in foreign.iter().enumerate() {
            // A band from zero has the mode of this shape in it already.
            if at == 1 && right.start == 6 {
                continue;
            }
            let pairs = with(&all, right.clone(), shape.clone(), stated);
            let found = document(&place_of(&bar(), &pairs), &from, ExitCode::CheckFailed);
            assert_eq!(of_kind(&found, kind), [pairs.hertz.len() as u64], "{at}: {found}");
            assert_eq!((verdict(&found, check), missing(&found).len()), (Some("fail"), 0), "{at}: {found}");
        }
        let right = Pairs { hertz: all.hertz[right.clone()].to_vec(), shapes: all.shapes[right].to_vec() };
        document(&place_of(&bar(), &right), &from, ExitCode::Done);
    }
    // A mode of the band whose frequency is stated outside of it.
    let outside = with(&all, 10..13, all.shapes[13].clone(), 2.0 * all.hertz[13]);
    let found = document(&place_of(&bar(), &outside), &band_of(&all, INSIDE), ExitCode::CheckFailed);
    assert_eq!((of_kind(&found, "inexact"), missing(&found).len()), (vec![4], 0), "{found}");
    // A band without any mode of the model, and pairs that are all stated there.
    let [low, high] = [all.hertz[9], all.hertz[10]];
    let in_gap = Pairs { hertz: vec![0.6 * low + 0.4 * high; 3], shapes: all.shapes[60..63].to_vec() };
    let flags = format!("--band {},{} --strict", 0.9 * low + 0.1 * high, 0.1 * low + 0.9 * high);
    let found = document(&place_of(&bar(), &in_gap), &flags, ExitCode::CheckFailed);
    assert_eq!((of_kind(&found, "inexact"), verdict(&found, "C-01")), (vec![1, 2, 3], Some("fail")), "{found}");
}

/// What a right result has outside of the band is no matter of the band: neither modes next to its ends, nor rigid-body motion with the
/// rounding of its zeros in the band.
#[test]
fn right_pairs_about_the_ends_of_a_band_are_certified() {
    let all = lowest(&bar(), 20);
    let place = place_of(&bar(), &all);
    for band in [
        band_of(&all, INSIDE),
        format!("--band {},{}", all.hertz[9] * (1.0 + 1e-9), all.hertz[14] * (1.0 - 1e-9)),
        format!("--band {},{}", all.hertz[9] * 1.0001, all.hertz[14] * 0.9999),
    ] {
        let found = document(&place, &band, ExitCode::Done);
        assert_eq!((found["verdict"].as_str(), missing(&found).len()), (Some("pass"), 0), "{found}");
    }
    let mut rounded = all.clone();
    rounded.hertz[..6].fill(1e-4 * all.hertz[6]);
    let place = place_of(&bar(), &rounded);
    for from in [0.0, 1e-5 * all.hertz[6]] {
        let found = document(&place, &format!("--band {from},{}", all.hertz[13] * 1.001), ExitCode::Done);
        assert_eq!(of_kind(&found, "rigid-body"), [1, 2, 3, 4, 5, 6], "{found}");
    }
    // Shapes alone, and frequencies in other units.
    let omega: Vec<String> = all.hertz.iter().map(|hertz| (std::f64::consts::TAU * hertz).to_string()).collect();
    let lambda: Vec<String> =
        all.hertz.iter().map(|hertz| (std::f64::consts::TAU * hertz).powi(2).to_string()).collect();
    let [k, m, v] = ["K.mtx", "M.mtx", "V.mtx"].map(|name| place.text(name));
    let band = band_of(&all, INSIDE);
    for values in [&[] as &[&str], &["--rad-per-s", &omega.join(",")], &["--eigenvalues", &lambda.join(",")]] {
        let args = [&["certify", &k, &m, &v] as &[&str], &band.split(' ').collect::<Vec<_>>(), values].concat();
        supel(&args).expect(ExitCode::Done);
    }
}

/// A band in kHz has nothing of a result in Hz in it.
#[test]
fn a_band_without_any_pair_says_so() {
    let all = lowest(&bar(), 14);
    let place = place_of(&bar(), &all);
    let said = |band: &str| document(&place, band, ExitCode::Done)["notes"].to_string();
    let notes = said(&format!("--band 0,{}", 1e-3 * all.hertz[13]));
    assert!(notes.contains("no elastic pair of the result lies in the band: none was judged"), "{notes}");
    assert!(!said(&band_of(&all, 10..12)).contains("no elastic pair"));
}

#[test]
fn a_count_says_between_which_frequencies_it_counts() {
    let all = lowest(&bar(), 17);
    let place = place_of(&bar(), &all);
    let said = |band: &str| {
        let text = certify(&place, band).expect(ExitCode::Done).out;
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let text = said(&band_of(&all, INSIDE));
    assert!(text.contains("a Sturm count finds 4 modes between") && text.contains("all of them"), "{text}");
    let text = said("");
    assert!(text.contains("a Sturm count finds 17 modes up to"), "{text}");
}

/// The count is taken off the ends of a band, and modes that it finds there are none of the band.
#[test]
fn modes_next_to_a_band_are_not_counted_in_it() {
    let all = lowest(&bar(), 20);
    let to = 0.5 * (all.hertz[13] + all.hertz[14]);
    let counts = |pairs: &Pairs, from: f64, code: ExitCode| {
        let found = document(&place_of(&bar(), pairs), &format!("--band {from},{to}"), code);
        ["n_counted", "n_given"].map(|key| found["count"][key].as_u64().expect("a number"))
    };
    let one = Pairs { hertz: vec![all.hertz[12]], shapes: vec![all.shapes[12].clone()] };
    let below = Pairs { hertz: all.hertz[..8].to_vec(), shapes: all.shapes[..8].to_vec() };
    for above in [1.0001, 1.001, 1.0018] {
        let from = all.hertz[9] * above;
        assert_eq!(counts(&all, from, ExitCode::Done), [4, 4], "{above}");
        assert_eq!(counts(&all.clone().without(8), from, ExitCode::Done), [4, 4], "{above}");
        assert_eq!(counts(&one, from, ExitCode::CheckFailed), [4, 1], "{above}");
        assert_eq!(counts(&below, from, ExitCode::CheckFailed), [4, 0], "{above}");
    }
    // A pair that lies below the band by less than the modes of one frequency lie apart is missing to nobody.
    assert_eq!(counts(&all.clone().from(10), all.hertz[9] * (1.0 + 2e-6), ExitCode::Done), [4, 4]);
    // One that the result has half of there is looked at as a whole.
    let found = counts(&all.clone().without(8), all.hertz[9] * (1.0 + 2e-6), ExitCode::CheckFailed);
    assert_eq!(found, [6, 5]);
}
