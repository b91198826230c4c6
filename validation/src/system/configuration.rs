//! Where the nodes of a mechanism are.

use supel_runtime::motion::Motion;

/// Where everything is.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// Motion of each node from its first position.
    pub motions: Vec<Motion>,
    /// Amplitudes of all components.
    pub amplitudes: Vec<f64>,
}
