//! By which rules a claim of the paper is judged: one set for all examples.
//!
//! The paper compares by eye. What its words are taken for here was chosen with the first results in view: a word was
//! given one number, and that number is used wherever the word or its like occurs.

use crate::study::Study;

/// Whether a claim holds here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It does.
    Reached,
    /// Some of it does.
    Partly,
    /// It does not.
    NotReached,
}

/// A claim of the paper and what was found.
#[derive(Clone, Debug)]
pub struct Claim {
    /// The paper's words, shortened.
    pub paper: &'static str,
    /// What was found here.
    pub found: String,
    /// Largest values of what it is compared with and how uncertain they are; a dash where nothing is compared.
    pub reference: String,
    /// Whether the claim holds here.
    pub verdict: Verdict,
}

impl Claim {
    /// A claim that holds in all respects, in some, or in none.
    pub fn new(paper: &'static str, holds: &[bool], found: String) -> Self {
        let verdict = match holds.iter().filter(|holds| **holds).count() {
            0 => Verdict::NotReached,
            n if n == holds.len() => Verdict::Reached,
            _ => Verdict::Partly,
        };
        Self { paper, found, reference: "–".to_owned(), verdict }
    }

    /// This claim, compared with columns of the reference.
    pub fn against(self, study: &Study, columns: &[usize]) -> Self {
        let one = |column: &usize| {
            let largest = study.reference.column(*column).into_iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
            let (what, unit) = study.reference.quantity(*column);
            format!("{what} up to {largest:.4}\u{a0}{unit}")
        };
        let columns: Vec<String> = columns.iter().map(one).collect();
        Self { reference: format!("{}; {}", columns.join(", "), study.example.uncertainty()), ..self }
    }
}

/// RMS misfit up to which a response is captured "overall", per cent.
pub const OVERALL: f64 = 15.0;
/// RMS misfit up to which a response is captured "accurately", per cent; above it the correlation is "poor".
pub const ACCURATE: f64 = 5.0;
/// RMS misfit up to which there is "excellent correlation", per cent.
pub const EXCELLENT: f64 = 2.0;
/// Share of a misfit from which its change is "noticed", "considerable" or "significant".
pub const NOTICED: f64 = 0.25;
/// Share of a misfit below which there is no change; from here to [`NOTICED`] it is "slight" or "marginal".
pub const SLIGHT: f64 = 0.05;
/// "About n iterations": not more than n and so many.
pub const ABOUT: f64 = 0.5;

/// How one misfit compares with another, from worse to better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Change {
    /// Larger by a share that is noticed.
    Worse,
    /// Larger.
    SlightlyWorse,
    /// Neither larger nor smaller.
    Same,
    /// Smaller.
    SlightlyBetter,
    /// Smaller by a share that is noticed.
    Better,
}

impl Change {
    /// Between two misfits, of which one without a solution is infinite.
    pub fn between(from: f64, to: f64) -> Self {
        if from.is_infinite() {
            return if to.is_infinite() { Self::Same } else { Self::Better };
        }
        match (from - to) / from {
            gain if gain >= NOTICED => Self::Better,
            gain if gain >= SLIGHT => Self::SlightlyBetter,
            gain if gain > -SLIGHT => Self::Same,
            gain if gain > -NOTICED => Self::SlightlyWorse,
            _ => Self::Worse,
        }
    }

    /// Whether the share is large enough.
    pub fn is_noticed(self) -> bool {
        matches!(self, Self::Better | Self::Worse)
    }

    /// By however little.
    pub fn is_better(self) -> bool {
        self > Self::Same
    }

    /// By however little.
    pub fn is_worse(self) -> bool {
        self < Self::Same
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_told_by_their_share() {
        let stops = f64::INFINITY;
        let cases = [
            ([1.0, 0.75], Change::Better),
            ([1.0, 0.8], Change::SlightlyBetter),
            ([1.0, 1.04], Change::Same),
            ([1.0, 1.2], Change::SlightlyWorse),
            ([1.0, 1.25], Change::Worse),
            ([stops, 1.0], Change::Better),
            ([1.0, stops], Change::Worse),
            ([stops, stops], Change::Same),
        ];
        for ([from, to], expected) in cases {
            assert_eq!(Change::between(from, to), expected, "{from} to {to}");
        }
    }
}
