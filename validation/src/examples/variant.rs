//! How an example is modelled.

use supel_runtime::component::Measures;

/// One way to model an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Modal elements: those of the whole structure, or the strategy of section 5.5.
    pub layout: usize,
    /// Modes of each modal element in addition to its static modes.
    pub n_modes: usize,
    /// How deformation is measured.
    pub measures: Measures,
}

impl Variant {
    /// Name of its files.
    pub fn slug(&self) -> String {
        let measures = match self.measures {
            Measures::MotionBased => "motion-based",
            Measures::Classical => "classical",
        };
        format!("{measures}-layout-{}-modes-{}", self.layout, self.n_modes)
    }
}

/// A variant with the motion-based measures.
pub const fn motion_based(layout: usize, n_modes: usize) -> Variant {
    Variant { layout, n_modes, measures: Measures::MotionBased }
}

/// A variant with the classical measures.
pub const fn classical(layout: usize, n_modes: usize) -> Variant {
    Variant { layout, n_modes, measures: Measures::Classical }
}
