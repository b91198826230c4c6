//! What interfaces ask of the faces of their patches.

use crate::error::{Error, Result};
use crate::input::{Faces, PatchFaces};
use crate::job::{InterfaceJob, Origin};

/// The interfaces with the area-weighted centroids of their faces as points, where they ask for these.
///
/// # Errors
/// [`Error::OriginWithoutFaces`].
pub fn with_faces(interfaces: &[InterfaceJob], faces: &[PatchFaces]) -> Result<Vec<InterfaceJob>> {
    let placed = |job: &InterfaceJob| {
        let unknown =
            |found: &str| Err(Error::OriginWithoutFaces { interface: job.name.clone(), found: found.to_owned() });
        let own = faces.iter().find(|faces| faces.interface == job.name).map(|faces| &faces.faces);
        match (&job.origin, own) {
            (Origin::Area, Some(Faces::Known { centroid, .. })) => {
                Ok(InterfaceJob { origin: Origin::Point(*centroid), ..job.clone() })
            }
            (Origin::Area, Some(Faces::Unknown { reason })) => unknown(reason),
            (Origin::Area, None) => {
                unknown("no face of the mesh has all its nodes in the patch, or the mesh has no cells")
            }
            _ => Ok(job.clone()),
        }
    };
    interfaces.iter().map(placed).collect()
}
