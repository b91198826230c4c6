//! Rubin's method (2.6): residual attachment modes, found without a singular solve, and the maps to and from Herting's coordinates.
//!
//! ```text
//! Ψ_R  = Ψ_S + N Z_B      n_I × n_B    static modes (49): what a force at the interface and the inertia it sets free make together
//! N    = K_II⁻¹ (MU)_I    n_I × n_r    inertia-relief modes (37), with the sign of this program
//! Z_B  = −[(MU)_Iᵀ N]⁻¹ Uᵀ M [Ψ_S; I]  from Uᵀ M [Ψ_R; I] = 0, n_r × n_B
//! Ψ_RD = X_I − Ψ_R X_B    n_I × k      dynamic modes (41)
//! ```
//! The paper inverts the attachment modes of the interface, A_B, which loses all digits where interface dofs are tied stiffly. The
//! matrix here is n_r × n_r and as well conditioned as the inertia of the interior, and needs no solve that Herting's method has not
//! made.
//!
//! Rubin's coordinates are u_B, the amplitudes η of the free modes, and the floating frame u_F. Herting's are those of the file, q.
//! Both describe the same motions (50); [`Rubin::to_herting`] and [`Rubin::from_herting`] are the map (51) and its inverse.

use faer::prelude::Solve;
use faer::{Mat, MatRef, Side};
use supel_runtime::{Coordinate, Flag, Superelement};

use crate::basis::Basis;
use crate::dense::{self, unpacked};
use crate::error::{Error, Result};
use crate::job::{Mechanisms, ReductionJob};
use crate::modes::Retained;
use crate::partition::Partition;
use crate::plan::Plan;
use crate::reduction::Reduction;
use crate::rigid::{InterfaceRank, RigidBodyModes, interface_rank, rank_of_every};

/// Steps that take rigid-body motion out of the static modes: each leaves rounding of what the one before it left.
const REFINEMENTS: usize = 2;

/// The share of rigid-body motion in the static modes that remains where the deformations do not tell motions apart, to rounding: half of the
/// digits.
const NOT_TAKEN_OUT: f64 = 1e-8;

/// What Rubin's form is made from: a reduced model in Herting's coordinates q, of r = n_B + n_η.
#[derive(Clone, Debug)]
pub struct Herting {
    /// K̂, r × r.
    pub stiffness: Mat<f64>,
    /// M̂, r × r.
    pub mass: Mat<f64>,
    /// Û, r × n_r.
    pub motions: Mat<f64>,
    /// M_F, n_r × n_r.
    pub rigid_body_mass: Mat<f64>,
    /// N in the modal coordinates, n_η × n_r.
    pub relief: Mat<f64>,
    /// The elastic modes V̄ (35), of unit mass, r × k.
    pub modes: Mat<f64>,
    /// n_B.
    pub n_interface: usize,
}

impl Herting {
    /// Of a reduction whose basis has inertia relief for every rigid-body motion, in scaled units.
    fn of_reduction(basis: &Basis<'_>, reduction: &Reduction, retained: &Retained) -> Self {
        let n_r = reduction.rigid_body_modes.ncols();
        Self {
            stiffness: reduction.stiffness.clone(),
            mass: reduction.mass.clone(),
            motions: reduction.rigid_body_modes.clone(),
            rigid_body_mass: reduction.rigid_body_mass.clone(),
            // A relief mode that others span has its parts in those.
            relief: basis.mixing.as_ref().subcols(0, n_r).to_owned(),
            modes: basis.reduced_modes(&retained.modes, basis.constraint_modes.n_internal()),
            n_interface: basis.constraint_modes.n_interface(),
        }
    }

    /// Of a superelement, in its units; none where it has no inertia relief for every rigid-body motion, no modes of the free interface,
    /// or no interface, and none of a singular mass, which is not that of Rubin's residual modes.
    pub fn of_file(superelement: &Superelement) -> Option<Self> {
        let (n_b, tensors) = (superelement.n_interface(), superelement.tensors());
        let coordinates = &superelement.metadata().coordinates[n_b..];
        let [stiffness, mass, motions, rigid_body_mass] =
            [&tensors.stiffness, &tensors.mass, &tensors.rigid_body_modes, &tensors.rigid_body_mass].map(unpacked);
        let n_eta = coordinates.len();
        let named = match &tensors.mixing {
            Some(mixing) => dense::inverse(unpacked(mixing).as_ref()),
            None => Mat::identity(n_eta, n_eta),
        };
        let slot_of = |index: usize| {
            coordinates.iter().position(|c| matches!(c, Coordinate::InertiaRelief { index: own } if *own == index))
        };
        let relief: Vec<usize> = (0..motions.ncols()).map(slot_of).collect::<Option<_>>()?;
        let is_free = |c: &Coordinate| {
            use Coordinate::{ElasticMode, InertiaRelief, ResidualVector};
            matches!(c, InertiaRelief { .. } | ElasticMode { .. } | ResidualVector { .. })
        };
        let has_whole_mass = |flag: &Flag| !matches!(flag, Flag::SingularMass | Flag::StiffnessOnly);
        let is_singular = !superelement.metadata().flags.iter().all(has_whole_mass);
        if is_singular || n_b == 0 || !coordinates.iter().all(is_free) {
            return None;
        }
        let modes = coordinates.iter().enumerate().filter_map(|(slot, c)| c.mode().map(|(mode, _)| (slot, mode)));
        let shapes: Vec<Mat<f64>> = modes
            .map(|(slot, mode)| {
                let lambda = tensors.frequencies[mode].powi(2);
                whole_mode((&stiffness, &mass), lambda, named.as_ref().subcols(slot, 1), n_b)
            })
            .collect();
        Some(Self {
            relief: dense::columns(named.as_ref(), &relief),
            modes: dense::concatenated(n_b + n_eta, shapes.iter().map(Mat::as_ref)),
            stiffness,
            mass,
            motions,
            rigid_body_mass,
            n_interface: n_b,
        })
    }
}

/// [X_B; q] of a mode whose modal amplitudes are q: the displacement of the interface that leaves least of (K̂ − λM̂)V̄.
fn whole_mode((k, m): (&Mat<f64>, &Mat<f64>), lambda: f64, q: MatRef<'_, f64>, n_b: usize) -> Mat<f64> {
    let r = k.nrows();
    // A body that one interface node holds has rounding on the diagonal of K̂ there, which is no scale.
    let scale: Vec<f64> = (0..r).map(|i| dense::power_of_two_root(k[(i, i)] + lambda * m[(i, i)])).collect();
    let dynamic = Mat::from_fn(r, r, |i, j| (k[(i, j)] - lambda * m[(i, j)]) * scale[i] * scale[j]);
    let amplitude = Mat::from_fn(r - n_b, 1, |i, _| -q[(i, 0)] / scale[n_b + i]);
    let load = dense::product(dynamic.as_ref().subcols(n_b, r - n_b), amplitude.as_ref());
    let interface = dense::least_squares(dynamic.as_ref().subcols(0, n_b), load.as_ref());
    Mat::from_fn(r, 1, |i, _| if i < n_b { interface[(i, 0)] * scale[i] } else { q[(i - n_b, 0)] })
}

/// Rubin's form of a reduced model.
#[derive(Clone, Debug)]
pub struct Rubin {
    /// Z_B, n_r × n_B.
    pub relief: Mat<f64>,
    /// [Ψ_R Ψ_RD] in Herting's coordinates, r × (n_B + k).
    pub columns: Mat<f64>,
    /// Û, r × n_r.
    pub motions: Mat<f64>,
    /// K′ = ΨᵀKΨ of the columns, (n_B + k) × (n_B + k).
    pub columns_stiffness: Mat<f64>,
    /// M′ = ΨᵀMΨ of the columns, (n_B + k) × (n_B + k).
    pub columns_mass: Mat<f64>,
    /// M_F, n_r × n_r.
    pub rigid_body_mass: Mat<f64>,
}

/// How an interface reacts the motions without energy.
#[derive(Clone, Debug)]
pub struct Reaction {
    /// Its rank; none where it leaves some of them free and the method of the job is Rubin's, whose static modes do without: the answers of
    /// the free component to loads stand in the place of constraint modes.
    pub rank: Option<InterfaceRank>,
    /// All of those motions, where it leaves mechanisms free.
    pub every: Option<RigidBodyModes>,
    /// Factorisations that counting them took.
    pub n_factorisations: usize,
}

impl Reaction {
    /// Of an interface that reacts rigid-body motions so well.
    fn of_rank(rank: Option<InterfaceRank>) -> Self {
        Self { rank, every: None, n_factorisations: 0 }
    }
}

/// How the interface reacts the motions without energy; for Rubin's method those of mechanisms that are meant as well, of which the matrices
/// tell: `counted` is all motions without energy with the factorisations that they took. What few digits turn rigid-body modes by is no
/// reaction of the interface.
///
/// # Errors
/// Any error of the rank for another method; memory of the count.
pub fn reaction(
    partition: &Partition,
    (rigid, counted): (&RigidBodyModes, impl FnOnce() -> Result<(RigidBodyModes, usize)>),
    plan: &Plan,
) -> Result<Reaction> {
    if !plan.job().reduction.method.has_attachment_modes() {
        return interface_rank(partition, rigid).map(|rank| Reaction::of_rank(Some(rank)));
    }
    let rank = match interface_rank(partition, rigid) {
        Err(Error::InterfaceRank { .. }) => return Ok(Reaction::of_rank(None)),
        Ok(rank) if rank.singular_ratio <= rigid.energy.angle => return Ok(Reaction::of_rank(None)),
        rank => rank?,
    };
    if plan.job().model.mechanisms != Mechanisms::Accept || partition.n_interface() == 0 {
        return Ok(Reaction::of_rank(Some(rank)));
    }
    let (every, n_factorisations) = match counted() {
        // What the digits do not let be counted is no lack of this interface.
        Err(error) if error.class().is_of_matrices() => return Ok(Reaction::of_rank(Some(rank))),
        counted => counted?,
    };
    match rank_of_every(partition, (rigid, &every)) {
        Err(Error::InterfaceRank { .. }) => Ok(Reaction { rank: None, every: Some(every), n_factorisations }),
        rank_of_every => rank_of_every.map(|_| Reaction { rank: Some(rank), every: None, n_factorisations }),
    }
}

/// Rubin's form where the method of the job is Rubin's; none in a component without interface, which has its modes themselves, and none
/// without an interior, where there is nothing to attach.
///
/// # Errors
/// What [`Rubin::new`] refuses.
pub fn rubin_where_asked(
    job: &ReductionJob,
    basis: &Basis<'_>,
    reduction: &Reduction,
    retained: &Retained,
) -> Result<Option<Rubin>> {
    let (n_internal, n_interface) = (basis.constraint_modes.n_internal(), basis.constraint_modes.n_interface());
    // Where rigid-body modes are columns the basis is Rubin's own.
    let is_own = basis.rigid_amplitudes().is_some();
    let is_asked = job.method.has_attachment_modes() && n_interface > 0 && n_internal > 0 && !is_own;
    is_asked.then(|| Rubin::new(Herting::of_reduction(basis, reduction, retained))).transpose()
}

impl Rubin {
    /// Rubin's form of a reduced model in Herting's coordinates.
    ///
    /// # Errors
    /// [`Error::NoAttachmentModes`] where unit acceleration of the body does not deform the interior: nothing can take rigid-body
    /// motion out of the static modes then.
    pub fn new(herting: Herting) -> Result<Self> {
        let Herting { stiffness: k, mass: m, motions: u, relief, modes, n_interface: n_b, rigid_body_mass } = herting;
        let r = k.nrows();
        let frame = unit_mass(&rigid_body_mass);
        let [motions, relief] = [&u, &relief].map(|a| dense::product(a.as_ref(), frame.as_ref()));
        let loads = dense::product(m.as_ref().subrows(n_b, r - n_b), motions.as_ref());
        let inertia = dense::gram(relief.as_ref(), loads.as_ref());
        let momenta = dense::product(m.as_ref(), motions.as_ref());
        let mut statics = Mat::zeros(r, n_b);
        statics.as_mut().subrows_mut(0, n_b).copy_from(Mat::<f64>::identity(n_b, n_b));
        let mut z = Mat::zeros(u.ncols(), n_b);
        let mut left = dense::gram(momenta.as_ref(), statics.as_ref());
        let before = left.norm_l2();
        // What a step leaves is rounding of the constraint modes and of relief modes, which cancel, and of the solve; the next takes it out.
        for _ in 0..REFINEMENTS {
            let step = solved(inertia.clone(), left)?;
            dense::add_product(z.as_mut(), -1.0, frame.as_ref(), step.as_ref());
            dense::add_product(statics.as_mut().subrows_mut(n_b, r - n_b), -1.0, relief.as_ref(), step.as_ref());
            left = dense::gram(momenta.as_ref(), statics.as_ref());
        }
        if dense::worse(left.norm_l2(), NOT_TAKEN_OUT * before) {
            return Err(Error::NoAttachmentModes);
        }
        let mut dynamics = modes;
        let x_b = dynamics.as_ref().subrows(0, n_b).to_owned();
        dense::add_product(dynamics.as_mut(), -1.0, statics.as_ref(), x_b.as_ref());
        let columns = dense::side_by_side(statics.as_ref(), dynamics.as_ref());
        let (columns_stiffness, columns_mass) = (projected(&k, &columns), projected(&m, &columns));
        Ok(Self { relief: z, columns, motions: u, columns_stiffness, columns_mass, rigid_body_mass })
    }

    /// Rubin's form of a superelement, in its units; none where [`Herting::of_file`] has none. A file whose rigid-body modes are
    /// coordinates beside an interface has Rubin's columns already, which need no relief: Z_B = 0.
    ///
    /// # Errors
    /// What [`Rubin::new`] refuses.
    pub fn of_file(superelement: &Superelement) -> Result<Option<Self>> {
        let (n_b, tensors) = (superelement.n_interface(), superelement.tensors());
        if !superelement.has_rigid_amplitudes() {
            return Herting::of_file(superelement).map(Self::new).transpose();
        }
        let coordinates = &superelement.metadata().coordinates[n_b..];
        let n_eta = coordinates.len();
        let named = match &tensors.mixing {
            Some(mixing) => dense::inverse(unpacked(mixing).as_ref()),
            None => Mat::identity(n_eta, n_eta),
        };
        let modes: Vec<usize> = (0..n_eta).filter(|slot| coordinates[*slot].mode().is_some()).collect();
        let modes = dense::columns(named.as_ref(), &modes);
        let columns = faer::concat![
            [Mat::<f64>::identity(n_b, n_b), Mat::<f64>::zeros(n_b, modes.ncols())],
            [Mat::<f64>::zeros(n_eta, n_b), modes]
        ];
        let motions = unpacked(&tensors.rigid_body_modes);
        Ok(Some(Self {
            relief: Mat::zeros(motions.ncols(), n_b),
            columns_stiffness: projected(&unpacked(&tensors.stiffness), &columns),
            columns_mass: projected(&unpacked(&tensors.mass), &columns),
            columns,
            motions,
            rigid_body_mass: unpacked(&tensors.rigid_body_mass),
        }))
    }

    /// n_B.
    pub fn n_interface(&self) -> usize {
        self.relief.ncols()
    }

    /// n_r.
    pub fn n_rigid(&self) -> usize {
        self.motions.ncols()
    }

    /// K of u_B, η and u_F (45), (n_B + k + n_r) × (n_B + k + n_r).
    pub fn stiffness(&self) -> Mat<f64> {
        with_frame(&self.columns_stiffness, self.frame().as_ref(), None)
    }

    /// M of u_B, η and u_F (47), (n_B + k + n_r) × (n_B + k + n_r).
    pub fn mass(&self) -> Mat<f64> {
        with_frame(&self.columns_mass, self.frame().as_ref(), Some(&self.rigid_body_mass))
    }

    /// T of (51), r × (n_B + k + n_r): q = T [u_B; η; u_F]. The floating frame carries what the deformation [u_B − U_B u_F; η] leaves.
    pub fn to_herting(&self) -> Mat<f64> {
        let mut frame = self.motions.clone();
        dense::add_product(frame.as_mut(), -1.0, self.columns.as_ref(), self.frame().as_ref());
        dense::side_by_side(self.columns.as_ref(), frame.as_ref())
    }

    /// The inverse of (51), (n_B + k + n_r) × r: [u_B; η; u_F] of a motion q. None where columns were left out of the basis: several
    /// coordinates of Rubin's describe one motion then; and none where there are residual vectors, which Rubin's do not describe.
    pub fn from_herting(&self) -> Option<Mat<f64>> {
        let to = self.to_herting();
        let r = to.nrows();
        if to.ncols() != r {
            return None;
        }
        // Amplitudes have units of their own: columns of one length make the condition that of the motions.
        let length = |j: usize| dense::norm(dense::column(to.as_ref(), j));
        let scale: Vec<f64> = (0..r).map(|j| dense::power_of_two_root(length(j).powi(2))).collect();
        let scaled = Mat::from_fn(r, r, |i, j| to[(i, j)] * scale[j]);
        let inverse = dense::inverse(scaled.as_ref());
        Some(Mat::from_fn(r, r, |i, j| inverse[(i, j)] * scale[i]))
    }

    /// [U_B; 0], (n_B + k) × n_r: the floating frame as the coordinates of the deformation see it.
    fn frame(&self) -> Mat<f64> {
        let n_b = self.n_interface();
        Mat::from_fn(self.columns.ncols(), self.n_rigid(), |i, j| if i < n_b { self.motions[(i, j)] } else { 0.0 })
    }
}

/// ΨᵀAΨ of columns Ψ.
fn projected(a: &Mat<f64>, columns: &Mat<f64>) -> Mat<f64> {
    let images = dense::product(a.as_ref(), columns.as_ref());
    let mut projected = dense::gram(columns.as_ref(), images.as_ref());
    dense::symmetrise(&mut projected);
    projected
}

/// W with WᵀM_F W = I: rotations about the origin are then motions about the centre of mass. Next to a heavy mass all unit motions that move it
/// load the interior alike. The identity where some motion has no mass.
fn unit_mass(rigid_body_mass: &Mat<f64>) -> Mat<f64> {
    let n = rigid_body_mass.nrows();
    let identity = Mat::<f64>::identity(n, n);
    let scale: Vec<f64> = (0..n).map(|i| rigid_body_mass[(i, i)].sqrt().recip()).collect();
    let scaled = Mat::from_fn(n, n, |i, j| rigid_body_mass[(i, j)] * scale[i] * scale[j]);
    let Ok(factor) = scaled.llt(Side::Lower) else { return identity };
    let inverse = dense::inverse(factor.L());
    let frame = Mat::from_fn(n, n, |i, j| scale[i] * inverse[(j, i)]);
    if frame.is_all_finite() { frame } else { identity }
}

/// [A, −AU; −UᵀA, UᵀAU + A_F].
fn with_frame(a: &Mat<f64>, frame: MatRef<'_, f64>, of_frame: Option<&Mat<f64>>) -> Mat<f64> {
    let (n, n_r) = (a.nrows(), frame.ncols());
    let mut coupling = dense::product(a.as_ref(), frame);
    let mut corner = dense::gram(frame, coupling.as_ref());
    if let Some(of_frame) = of_frame {
        corner += of_frame;
    }
    coupling *= faer::Scale(-1.0);
    let mut whole = Mat::zeros(n + n_r, n + n_r);
    whole.as_mut().submatrix_mut(0, 0, n, n).copy_from(a);
    whole.as_mut().submatrix_mut(0, n, n, n_r).copy_from(&coupling);
    whole.as_mut().submatrix_mut(n, 0, n_r, n).copy_from(coupling.transpose());
    whole.as_mut().submatrix_mut(n, n, n_r, n_r).copy_from(&corner);
    whole
}

/// A⁻¹ B of a small symmetric matrix that has to be definite, scaled so that units do not matter.
fn solved(mut a: Mat<f64>, mut b: Mat<f64>) -> Result<Mat<f64>> {
    /// A motion whose relief keeps less than this of its energy next to the others depends on them.
    const SINGULAR: f64 = 1e-12;
    dense::symmetrise(&mut a);
    let n = a.nrows();
    if (0..n).any(|i| a[(i, i)] <= 0.0 || !a[(i, i)].is_finite()) {
        return Err(Error::NoAttachmentModes);
    }
    let scale: Vec<f64> = (0..n).map(|i| a[(i, i)].sqrt().recip()).collect();
    let scaled = Mat::from_fn(n, n, |i, j| a[(i, j)] * scale[i] * scale[j]);
    let (values, _) = dense::symmetric_eigen(scaled.as_ref())?;
    if values.first().is_some_and(|least| *least <= SINGULAR) {
        return Err(Error::NoAttachmentModes);
    }
    let factor = scaled.llt(Side::Lower).map_err(|_| Error::NoAttachmentModes)?;
    for j in 0..b.ncols() {
        dense::column_mut(b.as_mut(), j).iter_mut().zip(&scale).for_each(|(value, scale)| *value *= scale);
    }
    factor.solve_in_place(b.as_mut());
    for j in 0..b.ncols() {
        dense::column_mut(b.as_mut(), j).iter_mut().zip(&scale).for_each(|(value, scale)| *value *= scale);
    }
    Ok(b)
}
