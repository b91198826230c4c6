//! Where the node of a patch sits.

use super::fitted::{self, Fit};
use crate::error::{Error, Result};
use crate::job::{InterfaceJob, Origin};

/// The origin of a patch whose nodes are at `points`, and what it was fitted from, where it was.
///
/// # Errors
/// [`Error::OriginNotFitted`]; [`Error::PatchWithoutFaces`] where nobody looked for the faces of the patch.
pub(super) fn place(job: &InterfaceJob, points: &[[f64; 3]]) -> Result<([f64; 3], Option<Fit>)> {
    let fitted = |(place, fit)| (place, Some(fit));
    let refused =
        |shape: &'static str| move |found: String| Error::OriginNotFitted { interface: job.name.clone(), shape, found };
    match job.origin {
        Origin::Centroid => Ok((mean(points), None)),
        Origin::Point(point) => Ok((point, None)),
        Origin::Hole => fitted::hole(points).map(fitted).map_err(refused("cylinder")),
        Origin::Sphere => fitted::sphere(points).map(fitted).map_err(refused("sphere")),
        Origin::Area => Err(Error::PatchWithoutFaces {
            interface: job.name.clone(),
            key: "origin",
            found: "the file of the nodes has no cells".to_owned(),
        }),
    }
}

/// The mean of points, each counted once.
fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    let n = points.len() as f64;
    let mut mean = [0.0; 3];
    for point in points {
        (0..3).for_each(|axis| mean[axis] += point[axis] / n);
    }
    mean
}
