//! What a result has too little or too much.

use super::subject::Subject;
use crate::certification::listing::first_of;
use crate::certification::pair::PairKind;
use crate::number::quantity;
use crate::verification::check::{Check, Limits};

/// Frequencies or numbers that a line lists at most.
const LISTED: usize = 6;

impl Subject<'_> {
    /// M-06.
    pub(super) fn missing(&self) -> Option<Check> {
        let certificate = self.completed.certificate.as_ref();
        let missing = &self.judged.lacking.missing;
        let n_missing = missing.len() + self.completed.n_not_sought;
        let listed: Vec<String> =
            missing.iter().take(LISTED).map(|mode| format!("{} Hz", quantity(mode.frequency_hz, 6))).collect();
        let mut said = match (listed.len(), certificate) {
            (0, Some(certificate)) => {
                format!("counted {}, all there", certificate.n_counted - self.judged.lacking.n_outside)
            }
            (0, None) => String::new(),
            (n, _) if n < missing.len() => format!("{} and {} more", listed.join(", "), missing.len() - n),
            _ => listed.join(", "),
        };
        if self.completed.n_not_sought > 0 {
            said += &format!("; {} more by the count alone", self.completed.n_not_sought);
        }
        if let Some(doubt) = certificate.map(|certificate| certificate.doubt()).filter(|doubt| *doubt > 1.0) {
            said += &format!("; the count is likely, not certain: doubt {} (limit 1)", quantity(doubt, 2));
        }
        (certificate.is_some() || n_missing > 0).then_some(Check {
            id: "M-06",
            name: "no mode is missing",
            equation: "eigenvalues counted in the band, by the inertia of K − σM at its ends, that no pair is",
            value: n_missing as f64,
            limits: Limits::default(),
            fail_above: 0.0,
            worst: Some(said),
        })
    }

    /// C-02.
    pub(super) fn invented(&self) -> Check {
        let invented = self.of_kinds(&[PairKind::Invented]);
        self.none_of(invented, "C-02", "no mode is invented", "pairs that are no mode of K and M, nor nearly one")
    }

    /// C-03.
    pub(super) fn repeated(&self) -> Check {
        let repeated = self.of_kinds(&[PairKind::Repeated]);
        self.none_of(repeated, "C-03", "no mode is given twice", "shapes that are combinations of others")
    }

    fn none_of(&self, claims: Vec<usize>, id: &'static str, name: &'static str, equation: &'static str) -> Check {
        let listed = first_of(claims.iter().map(|claim| self.name(*claim)), (LISTED, claims.len()));
        Check {
            id,
            name,
            equation,
            value: claims.len() as f64,
            limits: Limits::default(),
            fail_above: 0.0,
            worst: (!claims.is_empty()).then_some(listed),
        }
    }

    /// C-04, where the band begins at zero and the model is free. A result without any leaves them out on purpose.
    pub(super) fn rigid_modes(&self) -> Option<Check> {
        let n_missing = self.judged.n_rigid_missing;
        let n_rigid = self.component.rigid.count() - self.component.rigid.n_massless;
        let has_none = n_missing == n_rigid;
        (n_rigid > 0 && self.completed.ends[0] <= 0.0).then(|| Check {
            id: "C-04",
            name: "rigid-body modes are there",
            equation: "rigid-body modes of the model that the result has not",
            value: n_missing as f64,
            limits: Limits::default(),
            fail_above: if has_none { Check::NEVER } else { 0.0 },
            worst: Some(match (n_missing, has_none) {
                (0, _) => format!("all {n_rigid}"),
                (_, true) => format!(
                    "{n_rigid} motions in which the model is free: the result has none of them (a `--band` that begins above zero says that \
                     this is meant)"
                ),
                (n, false) => format!("{n} of {n_rigid} motions in which the model is free"),
            }),
        })
    }
}
