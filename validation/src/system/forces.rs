//! Forces on the coordinates of a mechanism, and their derivatives.

use faer::Mat;

/// Forces on all coordinates.
#[derive(Clone, Debug, Default)]
pub struct Forces {
    /// f_E (81).
    pub elastic: Vec<f64>,
    /// f_I (84).
    pub inertial: Vec<f64>,
    /// Of the components' damping.
    pub damping: Vec<f64>,
    /// Loads and gravity.
    pub applied: Vec<f64>,
}

impl Forces {
    /// f_E + f_I + f_D − f_ext.
    pub fn residual(&self) -> Vec<f64> {
        let sums = self.elastic.iter().zip(&self.inertial).zip(&self.damping).map(|((e, i), d)| e + i + d);
        sums.zip(&self.applied).map(|(sum, applied)| sum - applied).collect()
    }
}

/// Tangent matrices of the components, n × n.
#[derive(Clone, Debug)]
pub struct Matrices {
    /// K_T (82).
    pub stiffness: Mat<f64>,
    /// Derivative of f_E + f_I + f_D by the place.
    pub exact_stiffness: Mat<f64>,
    /// M_I (86).
    pub mass: Mat<f64>,
    /// Derivative of f_I by the velocities.
    pub gyroscopic: Mat<f64>,
    /// Derivative of f_D by the velocities.
    pub damping: Mat<f64>,
}

impl Matrices {
    pub(super) fn zeros(n: usize) -> Self {
        let zeros = || Mat::zeros(n, n);
        Self { stiffness: zeros(), exact_stiffness: zeros(), mass: zeros(), gyroscopic: zeros(), damping: zeros() }
    }
}
