//! What interfaces ask of the faces of their patches.

use crate::error::{Error, Result, Selector};
use crate::input::{Faces, PatchFaces};
use crate::job::{InterfaceJob, Origin, Weights};

/// The interfaces with numbers for what they ask of the faces: the area-weighted centroid as a point, the areas of the nodes as weights.
///
/// # Errors
/// [`Error::PatchWithoutFaces`].
pub fn with_faces(interfaces: &[InterfaceJob], faces: &[PatchFaces]) -> Result<Vec<InterfaceJob>> {
    interfaces.iter().map(|job| with_own(job, faces)).collect()
}

fn with_own(job: &InterfaceJob, faces: &[PatchFaces]) -> Result<InterfaceJob> {
    let known = |key: &'static str| {
        let selector = Selector::Interface(job.name.clone());
        let found = match faces.iter().find(|faces| faces.of == selector).map(|faces| &faces.faces) {
            Some(Faces::Known { centroid, areas, .. }) => return Ok((*centroid, areas.clone())),
            Some(Faces::Unknown { reason }) => reason.clone(),
            None => "no face of the mesh has all its nodes in the patch, or the mesh has no cells".to_owned(),
        };
        Err(Error::PatchWithoutFaces { interface: job.name.clone(), key, found })
    };
    let mut job = job.clone();
    if job.origin == Origin::Area {
        job.origin = Origin::Point(known("origin")?.0);
    }
    if job.weights == Some(Weights::Area) {
        job.weights = Some(Weights::Given(known("weights")?.1));
    }
    Ok(job)
}
