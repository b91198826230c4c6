//! What a variant of an example gives, and how it is recorded.

use supel_runtime::motion::{Motion, Vector3, transposed_times_3};

use crate::curve::Curves;
use crate::integrator::{Effort, Instant, Scheme, simulate};
use crate::system::System;

/// What one variant of an example gave.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// The recorded quantities.
    pub curves: Curves,
    /// What it took.
    pub effort: Effort,
    /// Why it stopped before its end, if it did.
    pub stopped: Option<String>,
}

/// Moves a mechanism and records every so many steps.
pub(super) fn recorded(
    mut system: System,
    scheme: &Scheme,
    every: usize,
    names: &[&str],
    quantities: impl Fn(&System, &Instant) -> Vec<f64>,
) -> Run {
    let mut curves = Curves::new(names);
    let mut step = 0_usize;
    let outcome = simulate(&mut system, scheme, |system, now| {
        if step.is_multiple_of(every) {
            curves.push(now.time, quantities(system, now));
        }
        step += 1;
    });
    let (effort, stopped) = match outcome {
        Ok(effort) => (effort, None),
        Err(why) => (Effort::default(), Some(why.to_string())),
    };
    Run { curves, effort, stopped }
}

/// A point in the turned axes of a node, from that node's place: Rᵀ (x − x_node).
pub(super) fn seen_from(node: &Motion, place: &Vector3, point: &Vector3) -> Vector3 {
    transposed_times_3(&node.rotation, &std::array::from_fn(|d| point[d] - place[d]))
}
