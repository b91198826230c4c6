//! A foreign superelement and its component in numbers, both free.

use faer::Mat;

use super::foreign::Foreign;
use crate::dense;
use crate::eigen::ModeError;
use crate::modes::{Certificate, Component};
use crate::verification::preservation::{BoundaryComparison, BoundaryCount, FrequencyPair};

/// What both models are in numbers.
pub(super) struct Compared<'a> {
    pub(super) component: Component<'a>,
    pub(super) foreign: &'a Foreign,
    /// λ of the component, ascending, rigid-body motion left out.
    pub(super) full: &'a [f64],
    /// λ of its lowest elastic mode, which a band may end below.
    pub(super) first: f64,
    pub(super) errors: &'a [ModeError],
    /// λ of the superelement, ascending; none where K̂ or M̂ is not definite.
    pub(super) reduced: Option<Vec<f64>>,
    /// What the digits of K̂ and M̂ may make of each of them, relative to it; nothing where they have all digits.
    pub(super) of_digits: Vec<f64>,
    /// How many motions K̂ leaves free: as many of the lowest of them are no elastic mode's.
    pub(super) n_without_stiffness: usize,
    pub(super) rigid: Nearest,
    /// ‖x − Ψq‖ of each mode of the component, x of unit mass and q the best there is.
    pub(super) left_of_modes: Vec<f64>,
    /// Which elastic mode of the superelement each mode of the component is, by their shapes.
    pub(super) partners: Vec<Option<usize>>,
    /// Difference of a frequency in the band that fails.
    pub(super) frequency_fails: f64,
    /// λ up to which they are compared.
    pub(super) top: f64,
    pub(super) certificate: Option<&'a Certificate>,
}

/// Motions of the component as a superelement has them: the coordinates that come nearest to each.
pub(super) struct Nearest {
    /// Q, r × k.
    pub(super) coordinates: Mat<f64>,
    /// ‖U − ΨQ‖ of each in M.
    pub(super) left: Vec<f64>,
}

impl Compared<'_> {
    /// λ of the superelement that elastic modes have.
    pub(super) fn elastic(&self) -> &[f64] {
        self.reduced.as_deref().and_then(|reduced| reduced.get(self.n_without_stiffness..)).unwrap_or_default()
    }

    /// The eigenvalue of the superelement that lies above that of an elastic mode of the component by Courant and Fischer, with what the digits
    /// of K̂ and M̂ may make of it, relative to it: both are counted from the lowest of all, motions without stiffness among them.
    pub(super) fn above(&self, mode: usize) -> Option<(f64, f64)> {
        let at = self.rigid.left.len() + mode;
        let lambda = *self.reduced.as_ref()?.get(at)?;
        Some((lambda, self.of_digits.get(at).copied().unwrap_or(0.0)))
    }

    /// The frequencies of both models, one to one by the shapes of their modes.
    pub(super) fn frequencies(&self, band_hz: [f64; 2]) -> Option<BoundaryComparison> {
        self.reduced.as_ref()?;
        let hertz = |lambda: f64| self.component.partition.scaling.hertz(lambda);
        let pair = |(at, (full, error)): (usize, (&f64, &ModeError))| {
            let full_hz = hertz(*full);
            let reduced_hz = self.partners[at].map_or(f64::INFINITY, |partner| hertz(self.elastic()[partner]));
            FrequencyPair::new([full_hz, reduced_hz], error.bar_of(full_hz), band_hz)
        };
        let frequencies: Vec<FrequencyPair> = self.full.iter().zip(self.errors).enumerate().map(pair).collect();
        let inside = frequencies.iter().filter(|pair| pair.in_band);
        let worst_in_band = dense::worst(inside.map(|pair| pair.relative_difference.abs()));
        let count = self.certificate.map(|certificate| BoundaryCount {
            below_hz: hertz(certificate.count.sigma),
            n_counted: certificate.n_counted,
            n_found: certificate.n_found,
        });
        let description = "the component as it is".to_owned();
        Some(BoundaryComparison { boundary: "free".to_owned(), description, frequencies, worst_in_band, count })
    }
}
