//! What units give reason to say.

use super::finding::{Finding, Severity};
use super::units::{UnitGuess, Units};

impl Units {
    /// Units that may not go together or that nobody knows, and frequencies that are in kHz.
    pub(super) fn finding(&self) -> Option<Finding> {
        let Self::Guessed(guesses) = self else { return None };
        match guesses.as_slice() {
            [] => Some(remark(
                "density and speed of sound are those of no system of units that is known: the nodes may be in another unit of length \
                 than the matrices, or the mass in another system than the stiffness"
                    .to_owned(),
                "compare extents and mass of the body with what the component measures and weighs, and bring nodes and matrices into one \
                 system; nothing, if it is of foam, or of springs and point masses"
                    .to_owned(),
                Vec::new(),
            )),
            // No sound system explains the model as well.
            [UnitGuess { system, is_mixed: true, frequencies, mend, .. }, ..] => Some(remark(
                format!(
                    "density and speed of sound fit no system of units, but a mixture: {system}; frequencies come out {frequencies} then"
                ),
                format!("compare the mass of the body with what the component weighs; if that is {mend}"),
                Vec::new(),
            )),
            [UnitGuess { system, label: Some(label), frequencies, .. }, ..] if frequencies.contains("kHz") => {
                Some(remark(
                    format!("the units look like {system}: frequencies are {frequencies}"),
                    "give --up-to-hz and bands of the job in kHz, or write the matrices with time in seconds".to_owned(),
                    vec![format!("units = \"{label}\"          # [model] of the job")],
                ))
            }
            _ => None,
        }
    }
}

fn remark(what: String, remedy: String, lines: Vec<String>) -> Finding {
    Finding { severity: Severity::Remark, code: None, what, remedy, lines, went_on: None }
}
