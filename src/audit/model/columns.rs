//! The columns of the basis, made again: constraint modes, inertia relief, modes.
//!
//! ```text
//! P      n_B × p          motions of the interface: each dof, or random mixtures where there are too many
//! Z      n' × p           [Ψ_S P; P], the interior in equilibrium, corrected so that it carries rigid-body motion (24)
//! N      n_I × n_N        named columns: inertia relief K_II⁻¹(MU)_I (37), X_I − Ψ_S X_B (23), or the modes X_I (38), those of a file
//!                         K_II⁻¹(MV)_I (23), and residual vectors K_II⁻¹f_I
//! W      n' × (p + n_N)   [Z N]
//! ```
//! A stored column is a combination of named ones, so that K̂ and M̂ are those of W but for that combination.

use faer::{Mat, MatRef};

use super::asked::AskedModes;
use super::interior::{Answers, Interior, Solved, column_products};
use super::solve_errors::{Gains, Lengths, Terms};
use crate::basis::clear_unloaded;
use crate::constraint::left_inverse;
use crate::dense;
use crate::job::Boundary;
use crate::partition::Partition;
use crate::plan::Mass;
use crate::random::SplitMix64;
use crate::rigid::{RigidBodyModes, RigidSource};
use crate::sparse::{energies_of_terms, product, product_and_terms};

/// Motions of the interface that are solved at most: more dofs than these are mixed at random.
const MAX_PROBES: usize = 256;
/// Seed of the mixing.
const SEED: u64 = 0xa0d1;

/// What a named column is; each in the order of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Named {
    /// Rigid-body motion itself, M-orthonormal, in a component without interface.
    Rigid(usize),
    /// Inertia relief of a rigid-body mode.
    Relief(usize),
    /// An elastic mode.
    Mode(usize),
    /// A mode-accelerated expansion mode of a file.
    Expansion(usize),
    /// The residual vector of a load.
    Residual(usize),
}

/// W with what is known of its errors.
pub(super) struct Columns {
    /// W, n' × (p + n_N).
    pub(super) shapes: Mat<f64>,
    /// P, n_B × p.
    pub(super) probes: Mat<f64>,
    /// What the columns behind the first p are.
    pub(super) named: Vec<Named>,
    /// Energy of the error of each column, as a length: √(eᵀKe).
    pub(super) energy_errors: Vec<f64>,
    /// Inertia of the error of each column: √(eᵀMe).
    pub(super) inertia_errors: Vec<f64>,
    /// The largest displacement at a recovered row that errors of the solves make of each column.
    pub(super) displacement_errors: Vec<f64>,
    /// How well static answers solve their equations.
    pub(super) solved: Solved,
    /// √(f_Iᵀ K_II⁻¹ f_I) of each load of the job: what it makes of an error of unit energy. None without an interior to answer it.
    pub(super) load_norms: Option<Vec<f64>>,
}

/// The motions of the component as a rigid body.
#[derive(Clone, Copy)]
pub(super) struct Motions<'a> {
    /// Motions that the constraint modes are made to carry.
    pub(super) carried: &'a RigidBodyModes,
    /// Motions that inertia relief answers.
    pub(super) relieved: MatRef<'a, f64>,
    /// The number of each among the zero modes.
    pub(super) numbers: &'a [usize],
    /// Where those come from: by the coordinates they are exact, and rounding turns zero modes of K.
    pub(super) source: RigidSource,
    /// Whether the reduction projects the mass; if not, it makes no constraint modes.
    pub(super) mass: Mass,
}

/// P: the identity, or as many random mixtures as are solved, of dofs that weigh alike in energy.
pub(super) fn probes(partition: &Partition) -> Mat<f64> {
    let (n_i, n_b) = (partition.n_internal, partition.n_interface());
    if n_b <= MAX_PROBES {
        return Mat::identity(n_b, n_b);
    }
    let mut probes = Mat::zeros(n_b, MAX_PROBES);
    SplitMix64::new(SEED).fill(probes.as_mut());
    let stiffness = |i: usize| partition.stiffness.get(n_i + i, n_i + i).copied().unwrap_or(0.0);
    let scale: Vec<f64> = (0..n_b).map(|i| dense::power_of_two_root(stiffness(i))).collect();
    Mat::from_fn(n_b, MAX_PROBES, |i, j| probes[(i, j)] * scale[i])
}

impl Columns {
    /// W of a component with an interface, or held without one.
    pub(super) fn new(
        partition: &Partition,
        interior: Option<&Interior<'_>>,
        motions: Motions<'_>,
        (asked, probes): (&AskedModes, Mat<f64>),
    ) -> Self {
        let (n_i, p, n_modes) = (partition.n_internal, probes.ncols(), asked.modes.count());
        let n_relief = motions.relieved.ncols();
        let relief = motions.numbers.iter().copied().map(Named::Relief);
        let loads = partition.loads.facts.iter().enumerate().filter(|(_, load)| load.has_residual_vector);
        let residual = loads.map(|(load, _)| Named::Residual(load));
        let expansion = (0..partition.expansion.count()).map(Named::Expansion);
        let named: Vec<Named> = relief.chain((0..n_modes).map(Named::Mode)).chain(expansion).chain(residual).collect();
        let mut columns = Self {
            shapes: Mat::zeros(partition.n_dofs(), p + named.len()),
            energy_errors: vec![0.0; p + named.len()],
            inertia_errors: vec![0.0; p + named.len()],
            displacement_errors: vec![0.0; p + named.len()],
            solved: Solved::default(),
            load_norms: None,
            probes,
            named,
        };
        columns.shapes.as_mut().subrows_mut(n_i, partition.n_interface()).subcols_mut(0, p).copy_from(&columns.probes);
        let Some(interior) = interior else { return columns };
        let mut follower = Follower { partition, interior, carried: None, gains: Gains::new(partition) };
        let statics = follower.follow(columns.probes.as_ref());
        follower.carried = Carried::of(&mut follower, motions, statics.x.as_ref());
        let statics = follower.carrying(statics, columns.probes.as_ref());
        columns.solved = columns.take(0, statics);
        columns.relieve(&mut follower, motions.relieved);
        columns.add_turns(&mut follower, motions);
        columns.answer_inertia(&mut follower, n_relief + n_modes);
        columns.answer_loads(&mut follower);
        match asked.boundary {
            Boundary::FreeInterface | Boundary::MixedInterface => {
                columns.accelerate(&mut follower, (n_relief, asked));
            }
            Boundary::FixedInterface => {
                let mut at = columns.shapes.as_mut().subrows_mut(0, n_i).subcols_mut(p + n_relief, n_modes);
                at.copy_from(&asked.modes.shapes);
            }
        }
        columns.add_angles(partition, asked);
        columns
    }

    /// W of a free component without interface: its rigid-body modes and its elastic modes.
    pub(super) fn modal(motions: &RigidBodyModes, asked: &AskedModes) -> Self {
        let (n_r, n_modes) = (motions.count(), asked.modes.count());
        // Zero modes of K are turned towards elastic ones by its rounding; motions by the coordinates are not.
        let rounding = |j: usize| if j < n_r { motions.energy.angle.max(f64::EPSILON) } else { asked.angles[j - n_r] };
        let size = |j: usize| if j < n_r { asked.lambda().first() } else { asked.lambda().get(j - n_r) };
        let omega = |j: usize| size(j).copied().unwrap_or(1.0).sqrt();
        Self {
            shapes: dense::side_by_side(motions.orthonormal.as_ref(), asked.modes.shapes.as_ref()),
            probes: Mat::zeros(0, 0),
            named: (0..n_r).map(Named::Rigid).chain((0..n_modes).map(Named::Mode)).collect(),
            energy_errors: (0..n_r + n_modes).map(|j| rounding(j) * omega(j)).collect(),
            inertia_errors: (0..n_r + n_modes).map(rounding).collect(),
            displacement_errors: vec![0.0; n_r + n_modes],
            solved: Solved::default(),
            load_norms: None,
        }
    }

    /// p.
    pub(super) fn n_probes(&self) -> usize {
        self.probes.ncols()
    }

    /// N of inertia relief.
    fn relieve(&mut self, follower: &mut Follower<'_>, relieved: MatRef<'_, f64>) {
        let (partition, n_i) = (follower.partition, follower.partition.n_internal);
        let (momenta, terms) = product_and_terms(&partition.mass, relieved);
        let mut loads = momenta.as_ref().subrows(0, n_i).to_owned();
        // As in the reduction: what rests on the interface alone has no column.
        clear_unloaded(partition, &energies_of_terms(relieved, terms.as_ref()), loads.as_mut());
        let relief = follower.answer(loads.as_ref(), terms.as_ref().subrows(0, n_i));
        self.take(self.n_probes(), relief);
    }

    /// N of the modes of a file, which begin at this named column.
    fn answer_inertia(&mut self, follower: &mut Follower<'_>, first: usize) {
        let (partition, expansion) = (follower.partition, &follower.partition.expansion);
        let mut inertia = expansion.inertia.as_ref().subrows(0, partition.n_internal).to_owned();
        let terms: Vec<f64> = expansion.facts.iter().map(|facts| facts.terms).collect();
        clear_unloaded(partition, &terms, inertia.as_mut());
        let answers = follower.answer(inertia.as_ref(), dense::absolute(inertia.as_ref()).as_ref());
        self.take(self.n_probes() + first, answers);
    }

    /// What the interior answers to the loads of the job: N of residual vectors.
    fn answer_loads(&mut self, follower: &mut Follower<'_>) {
        let loads = follower.partition.loads.vectors.as_ref().subrows(0, follower.partition.n_internal);
        let answers = follower.answer(loads, dense::absolute(loads).as_ref());
        let energies = column_products(loads, answers.x.as_ref());
        self.load_norms = Some(energies.into_iter().map(|energy| energy.max(0.0).sqrt()).collect());
        for slot in 0..self.named.len() {
            let Named::Residual(load) = self.named[slot] else { continue };
            let (column, n_i) = (self.n_probes() + slot, answers.x.nrows());
            let mut shape = self.shapes.as_mut().subrows_mut(0, n_i).subcols_mut(column, 1);
            shape.copy_from(answers.x.as_ref().subcols(load, 1));
            self.energy_errors[column] = answers.errors.energy[load];
            self.inertia_errors[column] = answers.errors.inertia[load];
            self.displacement_errors[column] = answers.errors.displacement[load];
        }
    }

    /// N of mode acceleration, after the columns of inertia relief.
    fn accelerate(&mut self, follower: &mut Follower<'_>, (n_relief, asked): (usize, &AskedModes)) {
        let (n_i, p) = (follower.partition.n_internal, self.n_probes());
        let (x_i, x_b) = asked.modes.shapes.as_ref().split_at_row(n_i);
        let mut accelerated = follower.follow(x_b);
        accelerated.x *= faer::Scale(-1.0);
        accelerated.x += x_i;
        self.take(p + n_relief, accelerated);
    }

    /// Puts answers into the interior of columns, with what they lack; gives back how well they are solved.
    fn take(&mut self, first: usize, answers: Motion) -> Solved {
        let (n_i, n) = (answers.x.nrows(), answers.x.ncols());
        self.shapes.as_mut().subrows_mut(0, n_i).subcols_mut(first, n).copy_from(&answers.x);
        self.energy_errors[first..first + n].copy_from_slice(&answers.errors.energy);
        self.inertia_errors[first..first + n].copy_from_slice(&answers.errors.inertia);
        self.displacement_errors[first..first + n].copy_from_slice(&answers.errors.displacement);
        answers.solved
    }

    /// What the angle α of a mode adds to its column. With the interface held it is the mode itself: α in inertia, α√λ in energy.
    /// Accelerated, X_I − Ψ_S X_B of the error: no more energy than the error itself, and inertia by the first eigenvalue of the
    /// interior, for which the softest column stands. Turning inside of a cluster changes energies by its width.
    fn add_angles(&mut self, partition: &Partition, asked: &AskedModes) {
        let (p, softest) = (self.n_probes(), self.softest(partition));
        for (slot, named) in self.named.iter().enumerate() {
            let Named::Mode(mode) = *named else { continue };
            let (angle, lambda) = (asked.angles[mode], asked.lambda()[mode]);
            let inertia = match asked.boundary {
                Boundary::FixedInterface => angle,
                Boundary::FreeInterface | Boundary::MixedInterface => {
                    angle * (lambda / softest).min(1.0 / f64::EPSILON)
                }
            };
            self.energy_errors[p + slot] += (angle + asked.width(mode)) * lambda.sqrt();
            self.inertia_errors[p + slot] += inertia;
        }
    }

    /// What the elastic motion in zero modes found by iteration, K_II⁻¹(KQ)_I of length δ in the mass, adds to inertia relief: δ/λ in
    /// inertia and δ/√λ in energy, λ the first eigenvalue of the interior, for which the softest column stands. Those that are made again have
    /// some, and those that the reduction starts from.
    fn add_turns(&mut self, follower: &mut Follower<'_>, motions: Motions<'_>) {
        if motions.source == RigidSource::Geometric {
            return;
        }
        let (p, softest) = (self.n_probes(), self.softest(follower.partition));
        let of_given: f64 = elastic_motion(follower, motions.carried.massive()).into_iter().sum();
        for (slot, square) in elastic_motion(follower, motions.relieved).into_iter().enumerate() {
            let turn = (square + of_given).sqrt();
            self.energy_errors[p + slot] += turn / softest.sqrt();
            self.inertia_errors[p + slot] += turn / softest;
        }
    }

    /// The least energy of a named column for its inertia.
    fn softest(&self, partition: &Partition) -> f64 {
        let pencil = partition.internal();
        let interior = self.shapes.as_ref().subrows(0, partition.n_internal).subcols(self.n_probes(), self.named.len());
        let energies = column_products(product(pencil.stiffness, interior).as_ref(), interior);
        let inertias = column_products(product(pencil.mass, interior).as_ref(), interior);
        let ratios = energies.iter().zip(&inertias).filter(|(_, inertia)| **inertia > 0.0).map(|(e, m)| e / m);
        ratios.fold(f64::INFINITY, f64::min)
    }
}

/// ‖K_II⁻¹(KQ)_I‖² in the mass, column by column.
fn elastic_motion(follower: &mut Follower<'_>, zero: MatRef<'_, f64>) -> Vec<f64> {
    let forces = product(&follower.partition.stiffness, zero);
    let elastic = follower.interior.solve(forces.as_ref().subrows(0, follower.partition.n_internal)).x;
    let momenta = product(follower.partition.internal().mass, elastic.as_ref());
    column_products(momenta.as_ref(), elastic.as_ref()).into_iter().map(|square| square.max(0.0)).collect()
}

/// Motions of the interior, with what they lack.
struct Motion {
    /// n_I × k.
    x: Mat<f64>,
    errors: Lengths,
    solved: Solved,
}

/// How the interior follows the interface.
struct Follower<'a> {
    partition: &'a Partition,
    interior: &'a Interior<'a>,
    /// Where rigid-body motion is carried.
    carried: Option<Carried>,
    /// What solves make of their roundings.
    gains: Gains,
}

/// The correction (24) that makes constraint modes carry rigid-body motion.
struct Carried {
    /// U_I − Ψ_S U_B, n_I × n_r.
    defect: Mat<f64>,
    /// U_B⁺, n_r × n_B.
    lift: Mat<f64>,
    /// What the correction of each motion may be off by, here and in the reduction. It goes into all columns that U_B⁺ takes a motion from.
    errors: Lengths,
}

impl Carried {
    /// U_I − Ψ_S U_B is K_II⁻¹(KU)_I: where the digits of K do not let U pass, it is what the correction of (24) adds, and otherwise
    /// rounding. `statics` are Ψ_S P.
    fn of(follower: &mut Follower<'_>, motions: Motions<'_>, statics: MatRef<'_, f64>) -> Option<Self> {
        let Follower { partition, interior, .. } = *follower;
        let (n_i, n_b) = (partition.n_internal, partition.n_interface());
        if motions.carried.count() == 0 || n_b == 0 {
            return None;
        }
        let u = motions.carried.orthonormal.as_ref();
        let u_b = u.subrows(n_i, n_b);
        let (forces, terms) = product_and_terms(&partition.stiffness, u);
        let defect = interior.solve(forces.as_ref().subrows(0, n_i)).x;
        // The reduction takes Ψ_S U_B from U_I: what its solves lack of that, and rounding of K U here, whose terms are the same.
        let terms = Terms { x: u.subrows(0, n_i), loads: terms.as_ref().subrows(0, n_i) };
        let mut errors = follower.gains.errors(partition, interior, terms);
        let whole = statics.ncols() == n_b;
        if !whole || motions.mass == Mass::NotAsked {
            // By mixtures, and without any column, U_B⁺ has other weights: it puts the correction into other columns.
            errors.add(&Lengths::of(partition, defect.as_ref()));
        }
        let nothing = Mat::zeros(n_i, n_b);
        let lift = left_inverse(partition, if whole { statics } else { nothing.as_ref() }, u_b);
        Some(Self { defect, lift, errors })
    }
}

impl Follower<'_> {
    /// Ψ_S X_B = −K_II⁻¹K_IB X_B + (U_I − K_II⁻¹K_IB U_B) U_B⁺ X_B.
    fn follow(&mut self, x_b: MatRef<'_, f64>) -> Motion {
        let (forces, terms) = forces_of(self.partition, x_b);
        let answers = self.answer(forces.as_ref(), terms.as_ref());
        self.carrying(answers, x_b)
    }

    /// Answers −K_II⁻¹K_IB X_B with the correction, where there is one.
    fn carrying(&self, mut motion: Motion, x_b: MatRef<'_, f64>) -> Motion {
        if let Some(Carried { defect, lift, errors }) = &self.carried {
            let shares = dense::product(lift.as_ref(), x_b);
            dense::add_product(motion.x.as_mut(), 1.0, defect.as_ref(), shares.as_ref());
            // The reduction has other motions of the same space: those of an interface dof without stiffness are mixed with others there.
            motion.errors.add(&errors.mixed(shares.as_ref()));
        }
        motion
    }

    /// K_II⁻¹ F of loads that are sums of such terms, |F| at least.
    fn answer(&mut self, loads: MatRef<'_, f64>, terms: MatRef<'_, f64>) -> Motion {
        let Answers { x, errors, residual } = self.interior.solve(loads);
        let mut errors = Lengths::of(self.partition, errors.as_ref());
        let of_rounding = self.gains.errors(self.partition, self.interior, Terms { x: x.as_ref(), loads: terms });
        errors.add(&of_rounding);
        let energies = column_products(loads, x.as_ref());
        let share = |(error, energy): (&f64, &f64)| if *energy > 0.0 { error / energy.sqrt() } else { 0.0 };
        let rounding = of_rounding.energy.iter().zip(&energies).map(share).fold(0.0, f64::max);
        Motion { x, errors, solved: Solved { residual, rounding } }
    }
}

/// −K_IB X_B and |K_IB||X_B|.
fn forces_of(partition: &Partition, x_b: MatRef<'_, f64>) -> (Mat<f64>, Mat<f64>) {
    let n_i = partition.n_internal;
    let mut border = Mat::zeros(partition.n_dofs(), x_b.ncols());
    border.as_mut().subrows_mut(n_i, x_b.nrows()).copy_from(x_b);
    let (mut forces, terms) = product_and_terms(&partition.stiffness, border.as_ref());
    forces *= faer::Scale(-1.0);
    (forces.as_ref().subrows(0, n_i).to_owned(), terms.as_ref().subrows(0, n_i).to_owned())
}
