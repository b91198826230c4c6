//! Something that an examination found, with its remedy.

use serde::Serialize;

use crate::dofs::Direction;
use crate::error::{Error, Uncertain, Warning};
use crate::verification::catalogue;
use crate::verification::check::Check;

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing.
    Remark,
    /// A reduction goes on and warns.
    Warning,
    /// A reduction stops, or a check fails.
    Error,
}

/// Something that was found, with what to do about it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// The code of the error, the warning or the check.
    pub code: Option<&'static str>,
    /// What was found.
    pub what: String,
    /// What to do.
    pub remedy: String,
    /// Lines for the job, the command line or the deck of the finite element program that do it.
    pub lines: Vec<String>,
    /// How the examination went on, where a stage refused the model.
    pub went_on: Option<String>,
}

impl Finding {
    /// An error of a stage. Its message ends with what to do.
    pub fn of_error(error: &Error, went_on: Option<&str>) -> Self {
        let message = error.to_string();
        let (what, advice) = match message.rsplit_once(" – ") {
            Some((what, advice)) if !advice.starts_with("expected") => (what.to_owned(), Some(advice.to_owned())),
            _ => (message, None),
        };
        let of_table =
            || Error::CODES.iter().find(|entry| entry.code == error.code()).map(|entry| entry.remedy.to_owned());
        Self {
            severity: Severity::Error,
            code: Some(error.code()),
            what,
            remedy: advice.or_else(of_table).unwrap_or_default(),
            lines: lines_of(error),
            went_on: went_on.map(str::to_owned),
        }
    }

    /// A warning of a reduction: one sentence that ends with what to do.
    pub(super) fn of_warning(warning: &Warning) -> Self {
        let (what, remedy) = match warning.message.rsplit_once("; ") {
            Some((what, remedy)) => (what.to_owned(), remedy.to_owned()),
            None => (warning.message.clone(), format!("`supel explain {}` says what to do", warning.code)),
        };
        let (remedy, lines) = match warning.code {
            "W-DATA-PRECISION" => {
                let lines = lines_of_remedy(&remedy);
                (format!("{remedy}; until then checks of a reduction may fail, and no superelement is written"), lines)
            }
            _ => (remedy, Vec::new()),
        };
        Self { severity: Severity::Warning, code: Some(warning.code), what, remedy, lines, went_on: None }
    }

    /// A remark of a reader or of the model: where it asks for something, that stands behind its last semicolon and begins with one of a few
    /// words.
    pub(super) fn of_note(note: &str) -> Self {
        const NOTHING: &str = "nothing, if that is what is meant";
        const ASKING: [&str; 4] = ["if ", "check ", "give ", "where Abaqus "];
        let asking = note.rsplit_once("; ").filter(|(_, rest)| ASKING.iter().any(|word| rest.starts_with(word)));
        let (what, remedy) = asking.unwrap_or((note, NOTHING));
        let [what, remedy] = [what, remedy].map(str::to_owned);
        Self { severity: Severity::Remark, code: None, what, remedy, lines: Vec::new(), went_on: None }
    }

    /// A check that failed.
    pub(super) fn of_check(check: &Check) -> Self {
        let at = check.worst.as_ref().map_or_else(String::new, |worst| format!(", at {worst}"));
        Self {
            severity: Severity::Error,
            code: Some(check.id),
            what: format!("{}: not so{at}", check.name),
            remedy: catalogue::entry(check.id).map_or_else(String::new, |entry| entry.remedy.to_owned()),
            lines: Vec::new(),
            went_on: None,
        }
    }
}

/// One triangle for both.
const ONE_TRIANGLE: [&str; 2] = [
    "symmetric = \"lower\"         # [model] of the job, or --symmetric lower: where the upper triangle is incomplete",
    "symmetric = \"upper\"         # where the lower one is",
];

/// Lines for the keys of a job that a remedy names, and for no others: what is wrong decides which of them help.
fn lines_of_remedy(remedy: &str) -> Vec<String> {
    const OF_KEYS: [(&str, &[&str]); 3] = [
        ("model.symmetric", &ONE_TRIANGLE),
        ("model.stiffness_digits", &["stiffness_digits = 17       # [model] of the job, if the numbers are exact"]),
        ("model.mass_digits", &["mass_digits = 17            # [model] of the job, if the numbers are exact"]),
    ];
    let named = OF_KEYS.iter().filter(|(key, _)| remedy.contains(key));
    named.flat_map(|(_, lines)| lines.iter().map(|line| (*line).to_owned())).collect()
}

/// Lines that do what an error asks for, where lines can.
fn lines_of(error: &Error) -> Vec<String> {
    let lines: &[&str] = match error {
        Error::Unsymmetric { .. } => &ONE_TRIANGLE,
        Error::EmptyRows { .. } => &["drop_empty = true           # [model] of the job, or --drop-empty"],
        Error::ConstraintGround { .. } => {
            &["constraints_to_ground = \"accept\" # [model] of the job, or --constraints-to-ground accept"]
        }
        Error::DigitsTooFew { cause: Uncertain::Triangles, .. } => &ONE_TRIANGLE,
        Error::DigitsTooFew { cause: Uncertain::Digits, .. } => {
            &["stiffness_digits = 17       # [model] of the job, if its numbers are exact"]
        }
        Error::RotationsHeld { directions, .. } => return vec![held_rotations(directions)],
        _ => &[],
    };
    lines.iter().map(|line| (*line).to_owned()).collect()
}

/// The line that says that supports hold these rotations.
fn held_rotations(directions: &[Direction]) -> String {
    let names: Vec<String> = directions.iter().map(|direction| format!("\"{direction}\"")).collect();
    format!("held_rotations = [{}]     # [model] of the job, if supports do hold them", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::{Differing, Rounding};

    /// What is refused for its digits is mended by digits, and what is refused for triangles that differ is not.
    #[test]
    fn refusals_name_what_is_uncertain_and_what_helps() {
        let of =
            |rounding: Rounding| Finding::of_error(&rounding.too_uncertain("whether it is definite".to_owned()), None);
        let triangles = of(Rounding::BINARY.of_differing(Differing { of_rows: 3e-4, at: [7, 2] }));
        assert!(triangles.what.starts_with("the triangles of the stiffness differ, and do not tell"), "{triangles:?}");
        assert!(triangles.what.contains("3e-4 of their rows, most at row 7, column 2"), "{triangles:?}");
        assert!(triangles.lines.iter().any(|line| line.starts_with("symmetric = ")), "{triangles:?}");
        assert!(!format!("{triangles:?}").contains("_digits"), "{triangles:?}");
        let digits = of(Rounding::relative(5e-6));
        assert!(digits.remedy.contains("stiffness_digits = 17") && digits.lines.len() == 1, "{digits:?}");
        assert!(!format!("{digits:?}").contains("symmetric = "), "{digits:?}");
    }
}
