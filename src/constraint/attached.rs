//! Rubin's static modes in the place of constraint modes.

use super::attachment::Attachment;
use super::constraint_modes::ConstraintModes;
use super::rigid_correction::Carried;
use super::schur_complement::condensed_stiffness;
use super::static_modes::StaticModes;
use crate::dense;
use crate::error::Result;
use crate::partition::Partition;

impl ConstraintModes<'static> {
    /// Ψ_R in the place of Ψ_S.
    ///
    /// # Errors
    /// [`Error::AttachmentCondition`](crate::error::Error::AttachmentCondition).
    pub fn attached(partition: &Partition, attachment: Attachment) -> Result<Self> {
        let inverse = attachment.inverse(partition)?;
        let modes = dense::product(attachment.modes.as_ref().subrows(0, partition.n_internal), inverse.as_ref());
        let modes = StaticModes::stored(modes);
        let (stiffness, cancellation) = condensed_stiffness(partition, &modes);
        let carried = Carried::nothing(partition.n_interface());
        Ok(Self { modes, carried, stiffness, cancellation, raw_rigid_error: 0.0, attachment: Some(attachment) })
    }
}
