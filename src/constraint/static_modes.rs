//! The static mode matrix Ψ_S as an operator: what stands in it is stored, or made by the factor each time.
//!
//! ```text
//! Ψ_S     n_I × n_B
//! stored      Ψ_S
//! by factor   −K_II⁻¹ K_IB + D L      D = U_I + K_II⁻¹ K_IB U_B (n_I × n_r), L = U_B⁺ (n_r × n_B): the correction of (24)
//! carried     U_I U_B⁻¹               where the interface has no motion but those of rigid bodies, n_B = n_r
//! ```
//! −K_II⁻¹ K_IB q is the backward half of a solve, and its transpose the forward half: whoever needs few columns at a time needs no room for
//! all of them. Stored columns take part in the same products as ever, to the bit.

use std::ops::Range;
use std::sync::Arc;

use faer::{Mat, MatMut, MatRef};

use crate::dense;
use crate::factor::Cholesky;

/// Ψ_S, however it is kept.
#[derive(Clone, Debug)]
pub struct StaticModes<'a> {
    form: Form<'a>,
    /// K̂_BB, n_B × n_B, where the columns are not stored and it is known without them.
    stiffness: Option<Arc<Mat<f64>>>,
}

#[derive(Clone, Debug)]
enum Form<'a> {
    Stored(Arc<Mat<f64>>),
    ByFactor { factor: &'a Cholesky<'a>, correction: Arc<LowRank> },
    Carried(Arc<LowRank>),
}

/// A product of a tall and a wide matrix, n_I × k and k × n_B.
#[derive(Clone, Debug)]
pub(super) struct LowRank {
    pub(super) tall: Mat<f64>,
    pub(super) wide: Mat<f64>,
}

impl StaticModes<'static> {
    /// Columns that are there.
    pub fn stored(columns: Mat<f64>) -> Self {
        Self { form: Form::Stored(Arc::new(columns)), stiffness: None }
    }

    /// U_I U_B⁻¹.
    pub(super) fn carried(motions: LowRank) -> Self {
        Self { form: Form::Carried(Arc::new(motions)), stiffness: None }
    }
}

impl<'a> StaticModes<'a> {
    /// Columns that the factor of K_II makes, with the correction of (24).
    pub(super) fn by_factor(factor: &'a Cholesky<'a>, correction: LowRank) -> Self {
        Self { form: Form::ByFactor { factor, correction: Arc::new(correction) }, stiffness: None }
    }

    /// These modes with the interface stiffness that they are known to have.
    pub(super) fn with_stiffness(self, stiffness: Mat<f64>) -> Self {
        Self { stiffness: Some(Arc::new(stiffness)), ..self }
    }

    /// K̂_BB, where it is known and the columns are not stored.
    pub fn stiffness(&self) -> Option<MatRef<'_, f64>> {
        self.stiffness.as_ref().map(|stiffness| stiffness.as_ref().as_ref())
    }

    /// How they are kept.
    pub(super) fn form(&self) -> &'static str {
        match self.form {
            Form::Stored(_) => "stored",
            Form::ByFactor { .. } => "by factor",
            Form::Carried(_) => "carried",
        }
    }

    /// n_I.
    pub fn n_internal(&self) -> usize {
        match &self.form {
            Form::Stored(columns) => columns.nrows(),
            Form::ByFactor { correction, .. } => correction.tall.nrows(),
            Form::Carried(motions) => motions.tall.nrows(),
        }
    }

    /// n_B.
    pub fn n_interface(&self) -> usize {
        match &self.form {
            Form::Stored(columns) => columns.ncols(),
            Form::ByFactor { correction, .. } => correction.wide.ncols(),
            Form::Carried(motions) => motions.wide.ncols(),
        }
    }

    /// Whether every column is stored.
    pub fn is_stored(&self) -> bool {
        matches!(self.form, Form::Stored(_))
    }

    /// The columns, where they are stored, to be changed in place: what another reduction might have made of them.
    pub fn stored_mut(&mut self) -> Option<&mut Mat<f64>> {
        match &mut self.form {
            Form::Stored(columns) => Some(Arc::make_mut(columns)),
            Form::ByFactor { .. } | Form::Carried(_) => None,
        }
    }

    /// Y ← Y + α Ψ_S Q, n_I × k.
    pub fn add_followed(&self, mut y: MatMut<'_, f64>, alpha: f64, q: MatRef<'_, f64>) {
        match &self.form {
            Form::Stored(columns) => dense::add_product(y, alpha, columns.as_ref().as_ref(), q),
            Form::ByFactor { factor, correction } => {
                let mut followed = factor.follow_border(q);
                correction.add_product(followed.as_mut(), 1.0, q);
                followed *= faer::Scale(alpha);
                y += followed;
            }
            Form::Carried(motions) => motions.add_product(y, alpha, q),
        }
    }

    /// Ψ_S Q, n_I × k: how the interior follows motions of the interface.
    pub fn follow(&self, q: MatRef<'_, f64>) -> Mat<f64> {
        match &self.form {
            Form::Stored(columns) => dense::product(columns.as_ref().as_ref(), q),
            Form::ByFactor { .. } | Form::Carried(_) => {
                let mut followed = Mat::zeros(self.n_internal(), q.ncols());
                self.add_followed(followed.as_mut(), 1.0, q);
                followed
            }
        }
    }

    /// Ψ_Sᵀ F of forces on the interior, n_B × k: what the interface takes of them.
    pub fn gather(&self, forces: MatRef<'_, f64>) -> Mat<f64> {
        match &self.form {
            Form::Stored(columns) => dense::gram(columns.as_ref().as_ref(), forces),
            Form::ByFactor { factor, correction } => {
                let mut gathered = factor.load_border(forces);
                correction.add_transposed(gathered.as_mut(), forces);
                gathered
            }
            Form::Carried(motions) => {
                let mut gathered = Mat::zeros(self.n_interface(), forces.ncols());
                motions.add_transposed(gathered.as_mut(), forces);
                gathered
            }
        }
    }

    /// Some columns, n_I × k.
    pub fn columns(&self, columns: Range<usize>) -> Mat<f64> {
        match &self.form {
            Form::Stored(stored) => stored.as_ref().as_ref().get(.., columns).to_owned(),
            Form::ByFactor { .. } | Form::Carried(_) => {
                let n_b = self.n_interface();
                let unit = |i: usize, j: usize| f64::from(u8::from(i == columns.start + j));
                self.follow(Mat::from_fn(n_b, columns.len(), unit).as_ref())
            }
        }
    }

    /// Columns that are stored, or all of them made.
    pub fn to_columns(&self) -> Mat<f64> {
        self.columns(0..self.n_interface())
    }
}

impl LowRank {
    /// Y ← Y + α A B Q.
    fn add_product(&self, y: MatMut<'_, f64>, alpha: f64, q: MatRef<'_, f64>) {
        let along = dense::product(self.wide.as_ref(), q);
        dense::add_product(y, alpha, self.tall.as_ref(), along.as_ref());
    }

    /// G ← G + Bᵀ Aᵀ F.
    fn add_transposed(&self, gathered: MatMut<'_, f64>, forces: MatRef<'_, f64>) {
        let along = dense::gram(self.tall.as_ref(), forces);
        dense::add_product(gathered, 1.0, self.wide.transpose(), along.as_ref());
    }
}
