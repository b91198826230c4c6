//! A state of a simulation.

/// Which derivative of the coordinates by time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// q.
    Displacement,
    /// q̇.
    Velocity,
    /// q̈.
    Acceleration,
}

impl Order {
    /// All three, in the order of the derivatives.
    pub const ALL: [Self; 3] = [Self::Displacement, Self::Velocity, Self::Acceleration];

    /// What columns and messages call it.
    pub fn name(self) -> &'static str {
        ["displacement", "velocity", "acceleration"][self as usize]
    }
}

/// Coordinates of a superelement at one time, and their derivatives where they are known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Its number, from 1.
    pub number: u64,
    /// Its time, where it is known.
    pub time: Option<f64>,
    /// q, q̇ and q̈, r values each.
    pub coordinates: [Option<Vec<f64>>; 3],
}

impl State {
    /// The coordinates or one of their derivatives, r values.
    pub fn of(&self, order: Order) -> Option<&[f64]> {
        self.coordinates[order as usize].as_deref()
    }
}
