//! The axes of an interface node: a label for clients, on which no matrix depends.

use super::fitted;
use crate::dofs::spanned;
use crate::error::{Error, Result, Selector};
use crate::job::{Axes, AxesGiven, InterfaceJob};

/// A rotation matrix whose columns are the axes.
pub type Frame = [[f64; 3]; 3];

/// The axes of the model.
pub(crate) const OF_THE_MODEL: Frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The axes of the nodes of an interface, which are at `points`; none where they are those of the model.
///
/// # Errors
/// [`Error::AxesParallel`]; [`Error::OriginNotFitted`] where the nodes determine no cylinder; [`Error::InterfaceConflict`] where nodes have no
/// coordinates.
pub(super) fn of_nodes(job: &InterfaceJob, points: Option<&[[f64; 3]]>) -> Result<Option<Frame>> {
    let (Some(axes), points) = (&job.axes, points) else { return Ok(None) };
    let Some(points) = points else {
        let (selector, key) = (Selector::Interface(job.name.clone()), "axes".to_owned());
        let (situation, remedy) = ("nodes without coordinates", ", or give model.nodes");
        return Err(Error::InterfaceConflict { selector, key, situation, remedy });
    };
    match axes {
        Axes::Given(given) => of_job(given).map(Some).ok_or_else(|| Error::AxesParallel {
            interface: job.name.clone(),
            z: given.z,
            x: given.x,
        }),
        Axes::Hole => {
            let refused = |found| Error::OriginNotFitted { interface: job.name.clone(), shape: "cylinder", found };
            let (_, fit) = fitted::hole(points).map_err(refused)?;
            Ok(fit.axis.and_then(along))
        }
    }
}

/// The axes that a job gives by two directions; none where these are parallel.
pub(crate) fn of_job(given: &AxesGiven) -> Option<Frame> {
    right_handed(given.z, given.x)
}

/// Components of a unit vector that differ by less are alike. Coordinates have more digits than that, and their rounding must not turn
/// axes over.
const ALIKE: f64 = 1e-3;

/// Axes with z along a direction, and x along what it leaves of the axis of the model that it leaves most of, the first of those that are
/// alike.
fn along(z: [f64; 3]) -> Option<Frame> {
    let least = z.iter().fold(f64::INFINITY, |least, component| least.min(component.abs()));
    let first = z.iter().position(|component| component.abs() <= least + ALIKE)?;
    right_handed(z, std::array::from_fn(|i| f64::from(u8::from(i == first))))
}

/// z, and the part of x that is perpendicular to it.
fn right_handed(z: [f64; 3], x: [f64; 3]) -> Option<Frame> {
    let [z, x, y] = spanned(z, x)?;
    // No negative zeros: axes that are written out look as they are meant.
    Some(std::array::from_fn(|i| [x[i] + 0.0, y[i] + 0.0, z[i] + 0.0]))
}

#[cfg(test)]
mod tests {
    use super::along;

    #[test]
    fn rounding_turns_no_axes_over() {
        for tiny in [0.0, 1e-33, -1e-16, 1e-9] {
            for (x, z) in [(tiny, 0.0), (0.0, tiny)] {
                let frame = along([x, 1.0, z]).expect("a frame");
                let expected = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]];
                for (found, expected) in frame.as_flattened().iter().zip(expected.as_flattened()) {
                    assert!((found - expected).abs() <= 2.0 * tiny.abs() + f64::EPSILON, "{frame:?}");
                }
            }
        }
    }
}
