//! Everything in the file that has its coordinates, against the columns made again.

use faer::{Mat, MatRef};
use supel_runtime::Superelement;

use super::alignment::Combination;
use super::bilinear::Bilinear;
use super::columns::Named;
use super::entries::{self, Kind, Order, compared, rows, statics};
use super::projection::{Form, Projected, Rows};
use super::scaled::Scaled;
use crate::audit::content::coordinate_name;
use crate::error::Result;
use crate::verification::check::Check;

/// A file and the columns made again that its stored columns are combinations of.
pub(super) struct Comparison<'a> {
    pub(super) projected: &'a Projected,
    pub(super) superelement: &'a Superelement,
    pub(super) file: &'a Scaled,
    /// B, q × (p + as many modal coordinates as are compared).
    pub(super) b: Combination,
    /// The first elastic eigenvalue.
    pub(super) first: f64,
}

impl Comparison<'_> {
    /// All checks.
    ///
    /// # Errors
    /// A dense eigenproblem that does not converge.
    pub(super) fn checks(&self) -> Result<Vec<Check>> {
        let Self { projected, file, first, .. } = self;
        let (p, b) = (projected.n_probes(), &self.b);
        let name = |i: usize| self.name_of(i);
        let (mut stiffness, mass) = (self.without_rigid_energy().combined(b), projected.reduced_mass().combined(b));
        if file.u.ncols() == file.k.nrows() {
            // Nothing but rigid-body motion: what was projected is the rounding of its terms.
            stiffness.matrix.fill(0.0);
        }
        let (k, m) = (self.mixed(file.k.as_ref()), self.mixed(file.m.as_ref()));
        let of_stiffness = (Kind::Energy, projected.n_in_equilibrium());
        let of_first = if file.has_mass { *first } else { 0.0 };
        let inertia: Vec<f64> = (0..k.nrows()).map(|j| of_first * mass.matrix[(j, j)].max(0.0)).collect();
        let mut checks = vec![compared(k.as_ref(), (&stiffness, &inertia), of_stiffness, &name)];
        if file.has_mass {
            checks.push(compared(m.as_ref(), (&mass, &vec![0.0; k.nrows()]), (Kind::Inertia, 0), &name));
        }
        if p > 0 {
            let order = if projected.n_in_equilibrium() == p { Order::Second } else { Order::First };
            checks.push(statics(k.as_ref(), [&stiffness, &mass], *first, (p, order))?);
        }
        if let (Some(expected), Some(stored)) = (&projected.gravity, &file.gravity) {
            let words = ("M-18", "loads of gravity are those of the full model", "max |g − ΨᵀMe|_i / (√M̂_ii √m)");
            let at = |axis: usize, i: usize| format!("{} along {}", name(i), ["x", "y", "z"][axis]);
            let found = self.mixed_rows(stored.as_ref());
            checks.push(rows(found.as_ref(), &expected.combined(b), f64::EPSILON, (words, &at)));
        }
        checks.extend(self.loads());
        checks.extend(self.quantities());
        checks.extend(self.matrices());
        if let (Some(expected), Some(stored)) = (&projected.recovery, &file.recovery)
            && expected.rows.nrows() == stored.nrows()
        {
            let words = (
                "M-15",
                "recovered rows are those of the full model",
                "max |W − TΨ|_ij, relative to the displacements of like columns",
            );
            let at = |row: usize, i: usize| format!("{} of {}", self.row_name(row), name(i));
            let found = self.mixed_rows(stored.as_ref());
            checks.push(rows(found.as_ref(), &expected.combined(b), file.recovery_rounding, (words, &at)));
        }
        Ok(checks)
    }

    /// The energies, but of named rigid-body motions, which cost nothing in a file: what they have by K is the rounding of its digits.
    fn without_rigid_energy(&self) -> Form {
        let (mut form, p) = (self.projected.stiffness.clone(), self.projected.n_probes());
        if p > 0 {
            // What static modes leave of a rigid-body motion has the energy of these.
            return form;
        }
        let is_rigid = |named: &Named| matches!(named, Named::Rigid(_));
        for (at, _) in self.projected.named.iter().enumerate().filter(|(_, named)| is_rigid(named)) {
            form.matrix.row_mut(p + at).fill(0.0);
            form.matrix.col_mut(p + at).fill(0.0);
        }
        form
    }

    /// M-27: the loads of the job, of which the worst is told.
    fn loads(&self) -> Option<Check> {
        let words = ("M-27", "loads of the job are those of the full model", "max |Ψᵀf − f̂|_i, relative to |Ψ|ᵀ|f|");
        let names = &self.superelement.metadata().load_names;
        let of_load = |(load, (expected, stored)): (usize, (&Rows, &Mat<f64>))| {
            let at = |_: usize, i: usize| format!("{} at {}", names[load], self.name_of(i));
            let found = self.mixed_rows(stored.as_ref());
            rows(found.as_ref(), &expected.combined(&self.b), f64::EPSILON, (words, &at))
        };
        worst(self.projected.loads.iter().zip(&self.file.loads).enumerate().map(of_load))
    }

    /// M-15: the quantities of the job, each by itself because their units differ, of which the worst is told.
    fn quantities(&self) -> Option<Check> {
        let words =
            ("M-15", "quantities are those of the full model", "max |R T Ψ − quantities|_ij, relative to |R T||Ψ|");
        let names = &self.superelement.metadata().quantities;
        let of_row = |(row, (expected, stored)): (usize, (&Rows, &Mat<f64>))| {
            let at = |_: usize, i: usize| format!("{} of {}", names[row].name, self.name_of(i));
            let found = self.mixed_rows(stored.as_ref());
            rows(found.as_ref(), &expected.combined(&self.b), f64::EPSILON, (words, &at))
        };
        worst(self.projected.quantities.iter().zip(&self.file.quantities).enumerate().map(of_row))
    }

    /// M-28: the further matrices of the job, of which the worst is told.
    fn matrices(&self) -> Option<Check> {
        let names = &self.superelement.metadata().matrices;
        let of_matrix = |(at, (expected, stored)): (usize, (&Bilinear, &Mat<f64>))| {
            let name = |i: usize, j: usize| format!("{}, {} and {}", names[at].name, self.name_of(i), self.name_of(j));
            // Rows are mixed first, then columns: the matrix comes back transposed twice.
            let found = self.mixed(stored.as_ref());
            entries::bilinear(found.as_ref().transpose(), &expected.combined(&self.b), &name)
        };
        worst(self.projected.matrices.iter().zip(&self.file.matrices).enumerate().map(of_matrix))
    }

    /// How many modal coordinates are compared.
    fn n_modal(&self) -> usize {
        self.b.columns.ncols() - self.projected.n_probes()
    }

    /// A matrix of the file with its interface rows and columns mixed as the probes are.
    fn mixed(&self, a: MatRef<'_, f64>) -> Mat<f64> {
        let half = self.mixed_rows(a);
        self.mixed_rows(half.transpose())
    }

    /// Rows of the file with their interface columns mixed as the probes are.
    fn mixed_rows(&self, a: MatRef<'_, f64>) -> Mat<f64> {
        let (n_b, p) = (self.file.n_b, self.projected.n_probes());
        let interface = crate::dense::product(a.subcols(0, n_b), self.projected.probes.as_ref());
        Mat::from_fn(a.nrows(), p + self.n_modal(), |i, j| if j < p { interface[(i, j)] } else { a[(i, n_b + j - p)] })
    }

    fn name_of(&self, i: usize) -> String {
        let (n_b, p) = (self.file.n_b, self.projected.n_probes());
        if i < p && p < n_b {
            format!("mixture {} of the interface", i + 1)
        } else {
            coordinate_name(self.superelement, n_b + i - p)
        }
    }

    fn row_name(&self, row: usize) -> String {
        let dof = self.superelement.tensors().recovery.as_ref().map(|recovery| recovery.dofs()[row]);
        dof.map_or_else(String::new, |dof| {
            format!("node {} {}", dof.node, format!("{:?}", dof.direction).to_lowercase())
        })
    }
}

/// The check that is farthest beyond its limit, or closest to it.
fn worst(checks: impl Iterator<Item = Check>) -> Option<Check> {
    let share = |check: &Check| check.value / check.limits.value();
    checks.reduce(|worst, check| if crate::dense::worse(share(&check), share(&worst)) { check } else { worst })
}
