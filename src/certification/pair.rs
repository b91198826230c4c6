//! A pair of a result, and a mode that the result has not.

/// What a pair of a result is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PairKind {
    /// Rigid-body motion.
    RigidBody,
    /// A mode of the model.
    Mode,
    /// Mostly a mode of the model, whose frequency or shape it has not well enough.
    Inexact,
    /// A combination of other shapes of the result.
    Repeated,
    /// No mode of the model.
    Invented,
    /// Outside of the band: measured, not judged.
    OutsideBand,
}

/// A pair of a result.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct JudgedPair {
    /// Its number in the result, from one.
    pub number: usize,
    /// What it is.
    pub kind: PairKind,
    /// Its frequency as the result has it, in Hz; none where the result has none.
    pub stated_hz: Option<f64>,
    /// The frequency that belongs to its shape, in Hz.
    pub shape_hz: f64,
    /// How far from that the nearest frequency of the model may be, in Hz; infinite where nothing is known.
    pub error_bar_hz: f64,
    /// The frequency of the mode that it is, in Hz; none where it is none.
    pub mode_hz: Option<f64>,
    /// The error bar of that, in Hz; none of rigid-body motion.
    pub mode_error_bar_hz: Option<f64>,
    /// Normwise backward error of its shape, with the frequency that belongs to that.
    pub backward_error: f64,
    /// Node and direction where its residual is largest.
    pub worst_at: String,
    /// How far it moves rows that are held, or that follow others, where that is too far.
    #[serde(skip)]
    pub out_of_place: Option<f64>,
    /// The number of the pair that it repeats.
    pub repeats: Option<usize>,
    /// The nearest frequencies of the model below and above it, of a pair that is no mode.
    pub neighbours_hz: [Option<f64>; 2],
}

/// What of a pair is farthest from its mode, relative to the frequency of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Off {
    /// The frequency that the result states.
    Stated(f64),
    /// The frequency that belongs to its shape.
    Shape(f64),
    /// Neither as much as the force that its shape leaves over lets either be.
    Residual,
}

impl JudgedPair {
    /// What of it is off; nothing where it is no mode.
    pub fn off(&self) -> Option<Off> {
        let mode = self.mode_hz.filter(|mode| *mode > 0.0)?;
        let of_shape = self.shape_hz / mode - 1.0;
        let of_stated = self.stated_hz.map_or(of_shape, |stated| stated / mode - 1.0);
        let of_residual = self.mode_error_bar_hz.filter(|_| mode == self.shape_hz).map_or(0.0, |bar| bar / mode);
        let of_pair = of_stated.abs().max(of_shape.abs());
        Some(match () {
            () if of_residual > of_pair => Off::Residual,
            () if of_shape.abs() > of_stated.abs() => Off::Shape(of_shape),
            () => Off::Stated(of_stated),
        })
    }
}

/// A mode of the model that the result has not.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct MissingMode {
    /// Its frequency in Hz.
    pub frequency_hz: f64,
    /// Its error bar.
    pub error_bar_hz: f64,
    /// How many modes of this frequency the model has, and how many of them the result.
    pub of_frequency: [usize; 2],
}
