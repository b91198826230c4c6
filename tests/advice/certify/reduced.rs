//! Superelements that are singular, and right ones whose files have few digits.

use faer::Mat;
use supel::cli::ExitCode;
use supel_testing::place::{Place, steel_brick};

use super::superelement::{Foreign, certify, document, failed, interface};

/// A superelement with one of its columns a second time: K̂ and M̂ have a common null vector, to rounding.
fn doubled(right: &Foreign, column: usize, with_share_of: Option<usize>) -> Foreign {
    let r = right.basis.ncols();
    let basis = Mat::from_fn(right.basis.nrows(), r + 1, |i, j| match j == r {
        true => right.basis[(i, column)] + with_share_of.map_or(0.0, |other| 0.5 * right.basis[(i, other)]),
        false => right.basis[(i, j)],
    });
    Foreign::of(&steel_brick(), basis)
}

#[test]
fn columns_that_depend_on_each_other_fail_by_name() {
    for (n_modes, with_share_of) in [(10, None), (40, Some(3))] {
        let right = Foreign::craig_bampton(&steel_brick(), &interface(), n_modes);
        let found = document(&steel_brick(), &doubled(&right, n_modes - 1, with_share_of), ExitCode::CheckFailed);
        let failed = failed(&found);
        let (_, worst) = failed.iter().find(|(id, _)| id == "C-11").expect("C-11");
        for named in [n_modes, n_modes + interface().len() + 1] {
            assert!(worst.contains(&format!("coordinate {named}")), "{worst}");
        }
    }
}

/// What K̂ and M̂ themselves have no answer for is no warning: nothing can be computed with them.
#[test]
fn matrices_without_an_answer_fail_what_was_to_be_compared() {
    let right = Foreign::craig_bampton(&steel_brick(), &interface(), 10);
    let found = failed(&document(&steel_brick(), &doubled(&right, 9, None), ExitCode::CheckFailed));
    let (_, unmade) = found.iter().find(|(id, _)| id == "M-33").expect("M-33");
    // They are singular to rounding, which decides boundary by boundary, and for the response, whether a decomposition notices.
    let n_boundaries = unmade.matches("frequencies with boundary").count();
    let is_seen_elsewhere = ["frequency response", "monotonicity"].iter().any(|what| unmade.contains(what));
    assert!(n_boundaries >= 2 && is_seen_elsewhere, "{unmade}");
}

/// Numbers of so many digits, as a text has them.
fn rounded(matrix: &Mat<f64>, digits: usize) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        let value = 0.5 * (matrix[(i, j)] + matrix[(j, i)]);
        format!("{value:.*e}", digits - 1).parse().expect("a number")
    })
}

#[test]
fn matrices_of_few_digits_are_those_of_a_right_one() {
    let right = Foreign::craig_bampton(&steel_brick(), &interface(), 24);
    for digits in [9, 6] {
        let short = Foreign {
            stiffness: rounded(&right.stiffness, digits),
            mass: rounded(&right.mass, digits),
            basis: right.basis.clone(),
        };
        let found = document(&steel_brick(), &short, ExitCode::Done);
        assert_eq!(found["verdict"], "pass", "{digits} digits: {found}");
    }
    // A frequency that is too low by more than digits make of it fails all the same.
    let mut low = right.clone();
    low.stiffness = rounded(&low.stiffness, 9);
    low.mass = rounded(&low.mass, 9) * faer::Scale(1.003);
    let found = failed(&document(&steel_brick(), &low, ExitCode::CheckFailed));
    assert_eq!(found.iter().filter(|(id, _)| id == "M-24").count(), 2, "{found:?}");
}

/// What was to be compared and was not counts: with `--strict` it is not certified.
#[test]
fn what_could_not_be_compared_is_a_warning() {
    let right = Foreign::craig_bampton(&steel_brick(), &interface(), 12);
    let mut basis = right.basis;
    (0..basis.nrows()).for_each(|row| basis[(row, 12)] += 1e-2 * basis[(row, 3)] / basis.col(3).norm_max());
    let place = Place::with(&steel_brick());
    Foreign::of(&steel_brick(), basis).write(&place);
    certify(&place, "").expect(ExitCode::Done);
    let told = certify(&place, "--strict").expect(ExitCode::CheckFailed).out;
    assert!(told.contains("M-33") && told.contains("statics, other boundaries and responses"), "{told}");
    assert!(!told.contains("! certified") && told.contains("! not accepted: "), "{told}");
}
