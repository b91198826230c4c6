//! What the reduction preserves: modes, frequencies under other boundaries, statics and the frequency response, each
//! of the reduced model next to those of the full one.

use serde::Serialize;

use super::accuracy::{Accuracy, AccuracyMeasure, LimitSource};

/// Reduced against full model.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Preservation {
    /// The retained modes under the boundary they were computed with (equations 34 and 35).
    pub modes: Vec<PreservedMode>,
    /// Modal assurance criterion of the full (rows) against the reduced (columns) retained modes, in the M-inner product.
    pub mac: Vec<Vec<f64>>,
    /// Frequencies under other boundaries.
    pub boundaries: Vec<BoundaryComparison>,
    /// Static stiffness at each interface.
    pub statics: Vec<InterfaceStatics>,
    /// Frequency response between interface dofs.
    pub response: Option<ResponseComparison>,
    /// Internal loads under forces on the interface, where the scene says how far off they may be.
    pub internal_loads: Option<InternalLoads>,
    /// How many modes would give which error.
    pub size_errors: Vec<SizeError>,
    /// The highest frequency of the reduced model and the step that an integrator needs for it.
    pub highest: Option<HighestFrequency>,
    /// What was not compared, and why.
    pub not_compared: Vec<String>,
    /// The band that was compared, in Hz; none where neither the job nor a mode gives one.
    pub band_hz: Option<[f64; 2]>,
    /// The largest errors, each with its limit: the accuracy of the reduced model for the scene.
    pub accuracy: Vec<Accuracy>,
}

impl Preservation {
    /// Whether every limit of the scene is met that more modes could meet.
    pub fn modes_are_enough(&self) -> bool {
        let of_modes =
            |accuracy: &&Accuracy| accuracy.set_by == LimitSource::Scene && accuracy.measure != AccuracyMeasure::Static;
        self.accuracy.iter().filter(of_modes).all(Accuracy::is_met)
    }
}

/// One retained mode in the full and in the reduced model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PreservedMode {
    /// Number of the mode, from one.
    pub index: usize,
    /// Frequency in the full model.
    pub full_hz: f64,
    /// Frequency in the reduced model under the same boundary.
    pub reduced_hz: f64,
    /// |reduced / full − 1|.
    pub relative_difference: f64,
    /// Backward error of (λ, V̄) in the reduced pencil.
    pub backward_error: f64,
    /// Smallest singular value of X_cᵀ M Y_c over the mode's cluster, squared: the MAC of a single mode.
    pub mac: f64,
}

/// Frequencies of the full and the reduced model under one boundary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoundaryComparison {
    /// `free`, `fix:hub`, `mass:hub=2.5` or `spring:hub=1e6`.
    pub boundary: String,
    /// What was done to the component, in words.
    pub description: String,
    /// The elastic frequencies, ascending.
    pub frequencies: Vec<FrequencyPair>,
    /// The largest relative difference within the band.
    pub worst_in_band: f64,
    /// The Sturm count of the full model under this boundary, where one was made.
    pub count: Option<BoundaryCount>,
}

/// How many frequencies the full model has under a boundary, and how many of them were found; rigid-body motion included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BoundaryCount {
    /// The frequency below which was counted.
    pub below_hz: f64,
    /// Counted from the signs of a factorisation.
    pub n_counted: usize,
    /// Found by the eigensolver.
    pub n_found: usize,
}

/// One frequency in both models.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrequencyPair {
    /// In the full model; zero where rounding leaves nothing to tell from it in either model.
    pub full_hz: f64,
    /// What it may be off by, as the error bar of a mode; of a zero the frequency up to which it is one.
    pub full_error_bar_hz: f64,
    /// In the reduced model.
    pub reduced_hz: f64,
    /// Reduced / full − 1.
    pub relative_difference: f64,
    /// Whether it lies in the band that the reduction is meant for, in either model.
    pub in_band: bool,
}

impl FrequencyPair {
    /// A motion that costs no energy in either model, as far as anybody can tell up to this frequency.
    pub(crate) fn of_no_energy(level_hz: f64, band_hz: [f64; 2]) -> Self {
        Self { relative_difference: 0.0, ..Self::new([0.0; 2], level_hz, band_hz) }
    }

    /// The frequency of both models with the error bar of the full one, for a band in Hz. One that the reduced model has in the band, and the
    /// full one below it, is a resonance of the band that is not there: it counts.
    pub(crate) fn new([full_hz, reduced_hz]: [f64; 2], full_error_bar_hz: f64, band_hz: [f64; 2]) -> Self {
        Self {
            full_hz,
            full_error_bar_hz,
            reduced_hz,
            relative_difference: reduced_hz / full_hz - 1.0,
            in_band: [full_hz, reduced_hz].iter().any(|hertz| (band_hz[0]..=band_hz[1]).contains(hertz)),
        }
    }
}

/// Static stiffness at one interface, the other interfaces held.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InterfaceStatics {
    /// Name of the interface.
    pub interface: String,
    /// Its dofs, `ux` and so on with the node where there are several.
    pub dofs: Vec<String>,
    /// From the full model.
    pub full: Vec<Vec<f64>>,
    /// From the reduced model.
    pub reduced: Vec<Vec<f64>>,
    /// Largest difference over √(K_ii K_jj) of the stiffness before condensation.
    pub relative_difference: f64,
}

/// Frequency response between interface dofs, fixed structural damping.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ResponseComparison {
    /// Boundary of the component.
    pub boundary: String,
    /// Structural damping factor η of K (1 + iη).
    pub damping: f64,
    /// Length that turns rotations into displacements.
    pub rotation_length: f64,
    /// Dofs of outputs inside that were compared under a force on each interface dof.
    pub n_outputs: usize,
    /// Largest relative residual of the solves with the full model.
    pub residual: f64,
    /// The pair of dofs with the largest error: driven and observed.
    pub worst_pair: [String; 2],
    /// Largest error of it, in dB.
    pub worst_db: f64,
    /// Where.
    pub worst_at_hz: f64,
    /// Largest relative shift of a resonance peak.
    pub peak_shift: f64,
    /// Relative distance of the frequencies between which the largest errors were looked for, on the condensed models.
    pub scan_step: f64,
    /// The samples, ascending in frequency.
    pub samples: Vec<ResponseSample>,
}

/// The response at one frequency.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ResponseSample {
    /// The frequency.
    pub frequency_hz: f64,
    /// Magnitude of the worst pair in the full model.
    pub full: f64,
    /// Magnitude of the worst pair in the reduced model.
    pub reduced: f64,
    /// Largest error over all pairs, in dB.
    pub error_db: f64,
}

/// Internal loads under harmonic forces on the interface, reduced against full model, in the norm of the strain energy.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InternalLoads {
    /// Largest relative error.
    pub worst: f64,
    /// Where.
    pub worst_at_hz: f64,
    /// The interface dof that is driven there.
    pub driven: String,
    /// The samples, ascending in frequency.
    pub samples: Vec<LoadSample>,
}

/// Internal loads at one frequency.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LoadSample {
    /// The frequency.
    pub frequency_hz: f64,
    /// Largest relative error over all driven dofs.
    pub error: f64,
}

/// The error that a smaller basis would have.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SizeError {
    /// Elastic modes kept.
    pub n_modes: usize,
    /// Order of the reduced matrices.
    pub n_reduced: usize,
    /// Largest relative frequency error in the band, over the boundaries compared.
    pub frequency_error: f64,
    /// Largest error of the frequency response in the band, in dB.
    pub response_error_db: Option<f64>,
    /// Largest relative error of internal loads in the band, where the scene says how far off they may be.
    pub internal_load_error: Option<f64>,
}

/// The highest frequency of the reduced model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HighestFrequency {
    /// The frequency.
    pub frequency_hz: f64,
    /// The largest step of the central difference scheme: 2/ω, and less with damping, whose velocity is that of the half step before.
    pub explicit_step_s: f64,
    /// Whether the damping of the superelement is in that step.
    pub is_damped: bool,
    /// T/20: the step with which an implicit scheme still follows it.
    pub resolving_step_s: f64,
}
