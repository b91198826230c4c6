//! Origins of patches that lie far away from the part: a length in another unit.

use super::interface_node::{Interfaces, Resolved};
use crate::dense;
use crate::error::{Error, Result};
use crate::model::{Finding, Model, Site};

/// Sizes of the part that an origin may be away from its patch: a hub or a shaft's end lies within a few.
const FAR: f64 = 10.0;
/// Sizes of the part at which an origin is refused. Rotations about it move the patch a hundred times as far as the part is large, so
/// that four digits of the stiffness cancel; and between metres and millimetres lies a thousand.
const TOO_FAR: f64 = 100.0;

/// One finding for each patch whose origin is far away.
///
/// # Errors
/// [`Error::OriginTooFar`].
pub(super) fn far_origins(model: &Model, interfaces: &Interfaces) -> Result<Vec<Finding>> {
    let Some(sites) = model.sites() else { return Ok(Vec::new()) };
    let size = size_of(&sites);
    let mut findings = Vec::new();
    for Resolved { node, rows, .. } in &interfaces.list {
        let (Some(rows), Some(origin)) = (rows.of_patch(), node.position) else { continue };
        let places = || rows.iter().filter_map(|row| sites[*row]);
        let mean = |axis: usize| places().map(|site| site.position[axis]).sum::<f64>() / rows.len() as f64;
        let middle = [0, 1, 2].map(mean);
        let ratio = dense::norm(&[0, 1, 2].map(|axis| origin[axis] - middle[axis])) / size;
        let interface = node.name.clone();
        // A part of one node has no size.
        if size > 0.0 && ratio > TOO_FAR {
            return Err(Error::OriginTooFar { interface, origin, ratio, middle });
        }
        if size > 0.0 && ratio > FAR {
            findings.push(Finding::OriginFar { interface, origin, ratio });
        }
    }
    Ok(findings)
}

/// The diagonal of the box around the nodes.
fn size_of(sites: &[Option<Site>]) -> f64 {
    let span = |axis: usize| {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = sites
            .iter()
            .flatten()
            .fold(ends, |(low, high), site| (low.min(site.position[axis]), high.max(site.position[axis])));
        high - low
    };
    if sites.is_empty() { 0.0 } else { dense::norm(&[0, 1, 2].map(span)) }
}
