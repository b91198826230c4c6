//! What another program computed, held against its model: eigenpairs or a superelement.

use super::html::certification::{of_pairs, of_superelement};
use super::{CertificationReport, CertifiedModel, Paint, ReducedReport, Reservations, junit};
use crate::error::Result;
use crate::number::counted;
use crate::verification::check::{Check, Verdict};

/// A result of another program, held against its model.
#[derive(Clone, Debug)]
pub enum CertifiedResult {
    /// Eigenpairs.
    Pairs(Box<CertificationReport>),
    /// A superelement with its basis.
    Superelement(Box<ReducedReport>),
}

impl CertifiedResult {
    /// The worst verdict of the checks.
    pub fn verdict(&self) -> Verdict {
        match self {
            Self::Pairs(report) => report.certification.verdict(),
            Self::Superelement(report) => report.certification.verdict(),
        }
    }

    /// The measures, in the order of their identifiers.
    pub fn checks(&self) -> &[Check] {
        match self {
            Self::Pairs(report) => &report.certification.checks,
            Self::Superelement(report) => &report.certification.checks,
        }
    }

    /// The model.
    pub fn model(&self) -> &CertifiedModel {
        match self {
            Self::Pairs(report) => &report.model,
            Self::Superelement(report) => &report.model,
        }
    }

    /// The JSON document; numbers that are not finite become `null`.
    ///
    /// # Errors
    ///
    /// [`crate::error::Error::NotJson`]; nothing in it can have it.
    pub fn to_json(&self) -> Result<String> {
        match self {
            Self::Pairs(report) => report.to_json(),
            Self::Superelement(report) => report.to_json(),
        }
    }

    /// The text for people.
    pub fn to_text(&self, reservations: Reservations, paint: Paint) -> String {
        match self {
            Self::Pairs(report) => report.to_text(reservations, paint),
            Self::Superelement(report) => report.to_text(reservations, paint),
        }
    }

    /// The page to read, print and sign.
    pub fn to_html(&self, reservations: Reservations) -> String {
        match self {
            Self::Pairs(report) => of_pairs(report, reservations),
            Self::Superelement(report) => of_superelement(report, reservations),
        }
    }

    /// The checks as JUnit XML.
    pub fn to_junit(&self, reservations: Reservations) -> String {
        let subject = match self {
            Self::Pairs(report) => counted(report.result.n_pairs, "pair", "pairs"),
            Self::Superelement(report) => {
                format!(
                    "a superelement of {}",
                    counted(report.certification.n_coordinates, "coordinate", "coordinates")
                )
            }
        };
        junit::certified(&subject, self.checks(), self.model(), reservations)
    }
}
