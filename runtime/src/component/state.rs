//! The state of a component.

use crate::motion::Motion;

/// State of a component: what an evaluation needs to know.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// Changes of configuration of the k interface nodes.
    pub motions: &'a [Motion],
    /// Modal amplitudes η, n_η.
    pub amplitudes: &'a [f64],
    /// Material velocities of the nodes, then η̇: 6k + n_η.
    pub velocities: &'a [f64],
    /// Material accelerations of the nodes, then η̈: 6k + n_η.
    pub accelerations: &'a [f64],
}
