//! Whether what a scene says fits together, and fits the interfaces of its job.

use std::collections::BTreeSet;

use super::analysis::AnalysisJob;
use super::gravity::GravityJob;
use super::interface::InterfaceJob;
use super::outputs::OutputsJob;
use super::ranges::{number, size};
use super::scene::SceneJob;
use super::statements;
use crate::error::{Error, Result};

pub(super) fn validate(scene: &SceneJob, interfaces: &[InterfaceJob]) -> Result<()> {
    if scene.analysis == Some(AnalysisJob::Static)
        && let Some(key) = scene.dynamic_keys().next()
    {
        return Err(Error::SceneStatic { key });
    }
    scene.gravity.map_or(Ok(()), GravityJob::validate)?;
    statements::validate(scene, interfaces)?;
    scene.outputs.as_ref().map_or(Ok(()), OutputsJob::validate)?;
    if let Some([low, high]) = scene.band_hz {
        if !(low.is_finite() && low >= 0.0) {
            return Err(number("scene.band_hz[0]".to_owned(), low, "zero or more"));
        }
        size("scene.band_hz[1]", high)?;
        if high <= low {
            return Err(number("scene.band_hz[1]".to_owned(), high, "a frequency above that of `band_hz[0]`"));
        }
    }
    for (index, support) in scene.boundaries.iter().flatten().enumerate() {
        let known = || -> BTreeSet<&str> {
            let own = interfaces.iter().map(|interface| interface.name.as_str());
            own.chain(scene.prescribed.iter().map(|carrier| carrier.name.as_str())).collect()
        };
        if let Some(name) = support.interface().filter(|name| !known().contains(name)) {
            return Err(Error::SceneInterface {
                boundary: support.to_string(),
                name: name.to_owned(),
                known: known().into_iter().map(str::to_owned).collect(),
            });
        }
        statements::refuse_left_out(
            scene,
            interfaces,
            (&support.to_string(), "scene.boundaries"),
            support.interface(),
        )?;
        if let Some(stated) = support.size() {
            size(&format!("scene.boundaries[{index}]"), stated)?;
        }
    }
    if let Some(damping) = scene.damping {
        size("scene.damping.ratio", damping.ratio)?;
        if damping.ratio >= 1.0 {
            return Err(number("scene.damping.ratio".to_owned(), damping.ratio, "a share of critical damping below 1"));
        }
    }
    scene.accept.map_or(Ok(()), |accept| accept.validate())
}
