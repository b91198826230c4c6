//! What the numbers of modes are: frequencies, or their squares.

/// What the numbers of modes are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueUnit {
    /// Frequencies in Hz.
    Hertz,
    /// Circular frequencies in rad/s.
    RadPerSecond,
    /// Eigenvalues λ = ω² in (rad/s)².
    Eigenvalue,
}

impl ValueUnit {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Hertz, Self::RadPerSecond, Self::Eigenvalue];

    /// What messages call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hertz => "frequencies in Hz",
            Self::RadPerSecond => "circular frequencies in rad/s",
            Self::Eigenvalue => "eigenvalues in (rad/s)²",
        }
    }

    /// λ = ω² in (rad/s)² of a number in this unit; that of a negative one is negative.
    pub fn eigenvalue(self, value: f64) -> f64 {
        let square = |omega: f64| omega * omega.abs();
        match self {
            Self::Hertz => square(std::f64::consts::TAU * value),
            Self::RadPerSecond => square(value),
            Self::Eigenvalue => value,
        }
    }
}
