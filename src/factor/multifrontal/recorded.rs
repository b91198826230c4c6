//! The numbers of a factor in an entry of a cache.

use super::{Entry, Numbers, TaskNumbers};
use crate::cache::{Reader, Writer};
use crate::factor::Analysis;

impl<T: Entry> Numbers<T> {
    /// Writes them.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(in crate::factor) fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        for task in &self.tasks {
            to.array(&task.values)?;
            to.array(&task.diagonal)?;
            to.array(&task.subdiagonal)?;
            to.array(&task.order)?;
            to.array(&[task.largest_product])?;
        }
        to.columns(self.schur.as_ref())?;
        to.array(&[self.largest_product])
    }

    /// Reads them; none where they are not those of a whole factor of this structure.
    pub(in crate::factor) fn read(from: &mut Reader<'_>, analysis: &Analysis) -> Option<Self> {
        let mut tasks = Vec::with_capacity(analysis.tasks().0.len());
        for task in &analysis.tasks().0 {
            let (n_steps, n_values) = (analysis.steps_of(task).len(), analysis.values_of(task).len());
            let numbers = TaskNumbers {
                values: from.array()?,
                diagonal: from.array()?,
                subdiagonal: from.array()?,
                order: from.array()?,
                largest_product: from.number()?,
            };
            let n_pivots = [numbers.diagonal.len(), numbers.subdiagonal.len(), numbers.order.len()];
            if numbers.values.len() != n_values || n_pivots != [n_steps; 3] {
                return None;
            }
            tasks.push(numbers);
        }
        let schur = from.columns()?;
        let is_border = [schur.nrows(), schur.ncols()] == [analysis.n_border(); 2];
        let largest_product = from.number()?;
        is_border.then_some(Self { tasks, schur, largest_product })
    }
}
