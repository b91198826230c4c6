//! The loads of the job on a partition, none of them on what the scene says is unloaded.

use std::collections::BTreeMap;

use super::load::{Loads, RowLoad};
use super::partition::Partition;
use super::transformation::DofOrigin;
use crate::error::{Error, Result};
use crate::job::LoadJob;

/// Force on a dof relative to the terms of its sum that rounding leaves where they cancel.
const ROUNDING: f64 = 1e-12;

impl Partition {
    /// Takes the loads of the job. Centrifugal forces act on all that has mass, and say nothing of what is connected.
    ///
    /// # Errors
    /// [`Error::SceneLoad`] where one acts on what the scene says is unloaded; those of [`Loads::carried`].
    pub(crate) fn carry_loads(&mut self, loads: Vec<RowLoad>, jobs: &[LoadJob]) -> Result<()> {
        let unloaded = self.unloaded_dofs();
        for (load, job) in loads.iter().zip(jobs).filter(|(_, job)| job.rotation.is_none()) {
            let acts_on = unloaded.iter().filter(|(dof, _)| {
                let [force, terms] = load.force_on(**dof, &self.transformation);
                force.abs() > ROUNDING * terms
            });
            // Nodes of one interface have one name for each direction.
            let mut found: Vec<&str> = Vec::new();
            for (_, name) in acts_on {
                if !found.contains(name) {
                    found.push(name);
                }
            }
            if !found.is_empty() {
                return Err(Error::SceneLoad { load: job.name.clone(), found: found.join(", ") });
            }
        }
        self.loads = Loads::carried(loads, &self.transformation)?;
        Ok(())
    }

    /// The dofs that the scene says are unloaded, with their names.
    fn unloaded_dofs(&self) -> BTreeMap<u32, &str> {
        let name = |origin: DofOrigin| match origin {
            DofOrigin::Row(row) => self.unloaded.rows.get(&row),
            DofOrigin::PatchNode(number, direction) => self.unloaded.of_patches.get(&(number, direction)),
            DofOrigin::Distortion(..) => None,
        };
        (0..).zip(&self.dofs).filter_map(|(dof, reduced)| Some((dof, name(reduced.origin)?.as_str()))).collect()
    }
}
