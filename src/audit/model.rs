//! A superelement against the full matrices of its job.
//!
//! ```text
//! K, M          n' × n'     of the partition
//! K − σM        n' × n'     factored whole, σ < 0: zero modes and free-free modes
//! K_II − σM_II  n_I × n_I   factored, σ < 0: static answers by conjugate gradients on K_II, fixed-interface modes
//! W             n' × q      the columns of the basis, made again
//! WᵀKW, WᵀMW    q × q       what K̂ and M̂ have to be, but for signs, rotations of repeated modes and the mixing
//! ```
//! The [`Reference`] is made of the job and its files alone. Nothing in it uses the factor of K_II at shift zero that the
//! reduction rests on, its eigensolver or its order of elimination, and nothing comes from the file that is judged.

mod alignment;
mod asked;
mod attached;
mod bars;
mod bilinear;
mod columns;
mod combined;
mod comparison;
mod coordinates;
mod dependence;
mod entries;
mod full;
mod identity;
mod interior;
mod motions;
mod nearby;
mod projection;
mod scaled;
mod solve_errors;
mod unseen;
mod weighed;

use faer::Mat;
use supel_runtime::Superelement;

use super::Audit;
use super::content::{ModelNoise, mass_rank};
use super::spectrum::condition_of;
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::Factored;
use crate::error::{Error, Result};
use crate::factor::Analysis;
use crate::input::InputFacts;
use crate::job::{Boundary, Job, MassOf};
use crate::modes::{Coupling, couplings};
use crate::partition::Partition;
use crate::plan::{Plan, Unseen};
use crate::reduction::Reduction;
use crate::rigid::{self, RigidBodyModes, RigidSource};
use crate::rubin::reaction;
use crate::verification::Evidence;
use crate::verification::check::{Check, Limits, Verdict};
use crate::verification::limits::{self, energy_noise};

use alignment::{Combination, Freedom, combination};
use asked::AskedModes;
use attached::FreeAnswers;
use columns::{Columns, Motions};
use comparison::Comparison;
use full::Full;
use interior::{Interior, Solved};
use motions::{KnownMotions, Sight};
use nearby::Nearby;
use projection::{Massive, Projected};
use scaled::Scaled;

/// Condition of a reduced mass in which lengths of columns are rounding.
const SINGULAR: f64 = 1e-2 / f64::EPSILON;

/// The reduction of a job with K̂ and M̂ of a file in the units of its partition; none where the file has other numbers of coordinates.
pub fn reduction_of(superelement: &Superelement, evidence: &Evidence<'_>) -> Option<Reduction> {
    let file = Scaled::of(superelement, evidence.partition);
    let n = evidence.reduction.n_reduced();
    // Modes that both leave out are uncoupled from the matrices of the file, which have a place for each in the whole.
    let own = evidence.unseen.iter().map(|mode| mode.mode);
    let kept: Vec<usize> = (0..n).filter(|at| evidence.unseen.iter().all(|mode| mode.coordinate != *at)).collect();
    let is_alike = file.n_b == evidence.partition.n_interface()
        && file.k.nrows() == kept.len()
        && superelement.metadata().unseen_modes().eq(own);
    let whole = |of_file: &Mat<f64>, own: &Mat<f64>| {
        let is_left_out = |at: usize| kept.binary_search(&at).is_err();
        let mut whole = Mat::from_fn(n, n, |i, j| if i == j && is_left_out(i) { own[(i, i)] } else { 0.0 });
        for (j, to) in kept.iter().enumerate() {
            kept.iter().enumerate().for_each(|(i, row)| whole[(*row, *to)] = of_file[(i, j)]);
        }
        whole
    };
    let Reduction { stiffness, mass, .. } = evidence.reduction;
    is_alike.then(|| Reduction {
        stiffness: whole(&file.k, stiffness),
        mass: whole(&file.m, mass),
        ..evidence.reduction.clone()
    })
}

/// What a superelement of a job has to be, computed without a superelement.
pub struct Reference<'a> {
    plan: &'a Plan,
    facts: &'a InputFacts,
    partition: &'a Partition,
    motions: KnownMotions,
    asked: AskedModes,
    /// What each mode contributes, where the plan lets modes go that contribute nothing.
    couplings: Vec<Coupling>,
    projected: Projected,
    /// The first elastic eigenvalue.
    first: f64,
    /// What rounding and the digits of the data make of an energy, relative to that of the first elastic mode.
    noise: f64,
}

impl<'a> Reference<'a> {
    /// Finds zero modes, elastic modes and static answers of the full model, and projects its matrices on them.
    ///
    /// # Errors
    /// K − σM is not definite; an eigensolver fails; a Sturm count falls on an eigenvalue.
    pub fn new(plan: &'a Plan, facts: &'a InputFacts, partition: &'a Partition) -> Result<Self> {
        let job = plan.job();
        let (given, _) = rigid::rigid_body_modes(partition)?;
        let analysis = Analysis::new(partition.pencil())?;
        let found = Free::new(plan, partition, (&analysis, &given))?;
        drop(analysis);
        let Free { zero, motions, asked, first, answers } = found;
        let unit = given.is_classical.then(|| given.modes.as_ref());
        let (asked, columns) = match asked {
            Some(asked) if partition.n_interface() == 0 && zero.count() > 0 => {
                let columns = Columns::modal(deflated(&given, &zero), &asked);
                (asked, columns)
            }
            asked => {
                let all = if motions.is_relief_of_given() { &given.modes } else { &zero.orthonormal }.as_ref();
                let source = if motions.has_unit() { RigidSource::Geometric } else { RigidSource::Algebraic };
                let mass = plan.mass();
                let whole = Motions { carried: &given, relieved: all, numbers: &[], source, mass };
                match (asked, answers) {
                    (Some(asked), Some(answers)) => with_attachment(partition, (asked, &answers), whole)?,
                    (asked, _) => {
                        let numbers = plan.relief().motions(all.ncols(), given.in_file(partition));
                        let relieved = dense::columns(all, &numbers);
                        let motions = Motions { relieved: relieved.as_ref(), numbers: &numbers, ..whole };
                        with_interior(job, partition, (asked, motions), first)?
                    }
                }
            }
        };
        let massive =
            (job.reduction.method.mass() == MassOf::RetainedModes).then(|| {
                let rigid = deflated(&given, &zero);
                let shapes = asked.modes.shapes.as_ref();
                let shapes = Mat::from_fn(partition.n_dofs(), shapes.ncols(), |i, j| {
                    if i < shapes.nrows() { shapes[(i, j)] } else { 0.0 }
                });
                let angles = asked.angles.iter().copied();
                Massive {
                    shapes: dense::side_by_side(rigid.orthonormal.as_ref(), shapes.as_ref()),
                    angle: angles.fold(if rigid.count() > 0 { rigid.energy.angle } else { 0.0 }, f64::max),
                }
            });
        let couplings = match plan.unseen() {
            Unseen::LeftOut => couplings(partition, (&asked.modes, asked.boundary), plan.gravity()),
            Unseen::Kept => Vec::new(),
        };
        let projected = Projected::new(partition, columns, (unit, zero.count(), first), massive);
        let noise = energy_noise((partition, &given), asked.known(), first);
        Ok(Self { plan, facts, partition, motions, asked: asked.without_shapes(), couplings, projected, first, noise })
    }

    /// What rounding and the digits of the data make of a file of this reference.
    pub(super) fn noise(&self) -> ModelNoise {
        ModelNoise {
            energy: self.noise,
            answers: self.projected.error_of_answers(),
            inertia: self.projected.rounding_of_inertia(),
            frequency: limits::of_frequencies(&self.asked.modes, self.partition),
        }
    }

    /// Compares a superelement with this reference.
    ///
    /// # Errors
    /// A dense eigenproblem that does not converge.
    pub(super) fn against(&self, superelement: &Superelement) -> Result<Audit> {
        let file = Scaled::of(superelement, self.partition);
        let mut audit = self.identity(superelement, &file)?;
        let checks = &mut audit.checks;
        checks.push(bars::frequencies(&file, &self.asked, self.partition.precision));
        checks.push(bars::error_bars(superelement, &file, &self.asked));
        checks.push(self.motions.count(&file));
        if file.n_b != self.partition.n_interface() {
            audit.notes.push("the interface of the job has another number of dofs: no matrix was compared".to_owned());
            return Ok(audit.sorted());
        }
        if file.u.ncols() != self.motions.n_zero {
            audit.notes.push("the model is held or free in another way: no matrix was compared".to_owned());
            return Ok(audit.sorted());
        }
        checks.extend(self.motions.checks(&file));
        checks.extend(coordinates::untested(self.partition));
        checks.extend(weighed::expectations((self.plan, self.partition), &self.motions, superelement));
        self.matrices(superelement, &file, &mut audit)?;
        let is_missed = audit.checks.iter().any(|check| check.verdict() == Verdict::Fail);
        audit.notes.extend(self.partition.model.heavy.iter().filter(|_| is_missed).map(ToString::to_string));
        Ok(audit.sorted())
    }

    /// Whether the file speaks of the component of the job, and has the modes it asks for.
    fn identity(&self, superelement: &Superelement, file: &Scaled) -> Result<Audit> {
        let mut audit = Audit::default();
        let checks = &mut audit.checks;
        checks.push(identity::digests(superelement, self.facts));
        checks.extend(identity::jobs(superelement, self.plan.given())?);
        checks.push(identity::interface(superelement, self.partition));
        checks.push(identity::statements(superelement, (self.partition, self.plan), &self.motions));
        audit.notes.extend(self.asked.note());
        let checks = &mut audit.checks;
        checks.push(self.asked.backward_error());
        checks.extend(self.asked.count());
        checks.push(identity::n_modes(superelement, &self.asked));
        checks.push(identity::modal_coordinates(superelement, &self.projected, self.asked.boundary));
        checks.push(self.solves());
        let modes = (&self.couplings[..], self.asked.boundary);
        checks.extend(unseen::unseen(superelement, &self.projected, modes, self.first));
        match mass_rank(superelement).is_none() && condition_of(file.m.as_ref())? < SINGULAR {
            true => {
                checks.extend(identity::dropped(superelement, (&self.projected, self.partition), self.asked.boundary))
            }
            false => audit.notes.push(
                "its mass is singular: which columns depend on those that were kept is not seen in it".to_owned(),
            ),
        }
        Ok(audit)
    }

    /// Everything that has the coordinates of the file.
    fn matrices(&self, superelement: &Superelement, file: &Scaled, audit: &mut Audit) -> Result<()> {
        let projected = &self.projected;
        let b = match identity::places(superelement, projected, self.asked.boundary) {
            Some(_) if self.motions.sight == Sight::Part && !self.motions.has_unit() => {
                audit.notes.push(
                    "its rigid-body modes are any of the matrices, which the interface does not tell apart: of its matrices only the \
                     interface was compared"
                        .to_owned(),
                );
                Combination::of_interface(projected)
            }
            Some(kept) => {
                let is_modal = file.n_b == 0 && self.motions.n_zero > 0;
                let relief =
                    (!self.motions.is_relief_of_given() && file.n_b > 0).then(|| self.motions.combination(file));
                let mixing = file.mixing.as_ref().filter(|_| !is_modal).map(Mat::as_ref);
                let freedom = Freedom { kept: &kept, groups: &self.asked.groups, relief, mixing };
                combination(file, projected, &freedom).unwrap_or_else(|| {
                    audit.notes.push(
                        "modes of one cluster may turn without the interface seeing it: of its matrices only the interface was \
                         compared"
                            .to_owned(),
                    );
                    Combination::of_interface(projected)
                })
            }
            None => {
                audit.notes.push(
                    "its modes are not those of the job: of its matrices only the interface was compared".to_owned(),
                );
                Combination::of_interface(projected)
            }
        };
        let comparison = Comparison { projected, superelement, file, b, first: self.first };
        audit.checks.extend(comparison.checks()?);
        Ok(())
    }

    /// M-10: how well the static answers solve the full model.
    fn solves(&self) -> Check {
        const FAIL: f64 = 1e-6;
        let Solved { residual, rounding } = self.projected.solved;
        let arithmetic = self.motions.rounding().max((NOISE_FACTOR * rounding).min(FAIL));
        let limits = Limits { engineering: 1e-10, arithmetic, data: 0.0 };
        Check {
            id: "M-10",
            name: "static loads on the full model were solved",
            equation: "max ‖f − K_II x‖ / ‖f‖, of a free component ‖f − Kx‖ / ‖f‖, by conjugate gradients",
            value: residual,
            limits,
            fail_above: limits.value().max(FAIL),
            worst: Some(format!("{} motions of the interface", self.projected.n_probes())),
        }
    }
}

/// What a factor of all dofs gives.
struct Free {
    zero: RigidBodyModes,
    motions: KnownMotions,
    /// The modes asked for, where they are those of the free interface.
    asked: Option<AskedModes>,
    first: f64,
    /// Answers to loads, where the interface leaves rigid-body motions free and the method does without constraint modes.
    answers: Option<FreeAnswers>,
}

impl Free {
    /// The factor is gone before the count takes place for its own.
    fn new(plan: &Plan, partition: &Partition, (analysis, given): (&Analysis, &RigidBodyModes)) -> Result<Self> {
        let job = plan.job();
        let full = Full::new(partition, analysis, given)?;
        let is_modal = partition.n_interface() == 0 && full.zero.count() > 0;
        let of_method = partition.boundary(job.reduction.method.boundary());
        let boundary = if is_modal { Boundary::FreeInterface } else { of_method };
        let asked = match boundary {
            Boundary::FreeInterface => {
                let (rigid, operator) = (deflated(given, &full.zero), Factored::new(&full.factor, full.sigma));
                Some(AskedModes::moving(&full, (boundary, &operator), rigid, &job.reduction)?)
            }
            Boundary::FixedInterface | Boundary::MixedInterface => None,
        };
        let reaction = reaction(partition, (given, || Ok((full.zero.clone(), 0))), plan);
        let is_attached = !is_modal && reaction.is_ok_and(|reaction| reaction.rank.is_none());
        let motions = KnownMotions::of(&full, given);
        let motions = if is_attached { motions.seen_in_part(given.count()) } else { motions };
        let operator = Factored::new(&full.factor, full.sigma);
        let answers = is_attached.then(|| FreeAnswers::of(partition, &operator, deflated(given, &full.zero)));
        let mixed = match boundary {
            Boundary::MixedInterface => Some(mixed(&full, deflated(given, &full.zero), job)?),
            Boundary::FreeInterface | Boundary::FixedInterface => None,
        };
        let Full { zero, first, factor, .. } = full;
        drop(factor);
        let asked = asked.map(|asked| asked.counted(partition, analysis, first)).transpose()?;
        Ok(Self { zero, motions, asked: asked.or(mixed), first, answers })
    }
}

/// The modes asked for with mixed boundaries, counted, by a factor of K − σM of the dofs that are not held.
fn mixed(full: &Full<'_>, rigid: &RigidBodyModes, job: &Job) -> Result<AskedModes> {
    let (partition, boundary) = (full.partition, Boundary::MixedInterface);
    let rigid = rigid::with_passing(rigid.clone(), partition)?;
    let pencil = partition.pencil_under(boundary);
    let analysis = Analysis::new(pencil)?;
    let name = |row: usize| partition.name_of(partition.dof_under(boundary, row));
    let nearby = Nearby::new(partition, (&analysis, pencil), full.sigma, &name)?;
    let operator = Factored::new(&nearby.factor, nearby.sigma);
    let asked = AskedModes::moving(full, (boundary, &operator), &rigid, &job.reduction)?;
    drop(nearby);
    asked.counted(partition, &analysis, full.first)
}

/// The motions that elastic modes are orthogonal to: those of the coordinates, where they are all.
fn deflated<'a>(given: &'a RigidBodyModes, zero: &'a RigidBodyModes) -> &'a RigidBodyModes {
    if given.count() == zero.count() { given } else { zero }
}

/// Columns of a component whose interface leaves rigid-body motions free.
fn with_attachment(
    partition: &Partition,
    (asked, answers): (AskedModes, &FreeAnswers),
    motions: Motions<'_>,
) -> Result<(AskedModes, Columns)> {
    let columns = Columns::attached(partition, answers, motions, (&asked, columns::probes(partition)));
    let refused = || Error::AttachmentCondition { condition: f64::INFINITY, error: f64::EPSILON };
    Ok((asked, columns.ok_or_else(refused)?))
}

/// Columns that take a factor of the interior, and the modes of the held interface where those are asked for.
fn with_interior(
    job: &Job,
    partition: &Partition,
    (asked, motions): (Option<AskedModes>, Motions<'_>),
    first: f64,
) -> Result<(AskedModes, Columns)> {
    let probes = columns::probes(partition);
    if partition.n_internal == 0 {
        let asked = asked.map_or_else(|| AskedModes::held(None, partition, &job.reduction), Ok)?;
        let columns = Columns::new(partition, None, motions, (&asked, probes));
        return Ok((asked, columns));
    }
    let analysis = Analysis::new(partition.internal())?;
    let interior = Interior::new(partition, &analysis, first)?;
    let (asked, is_counted) = match asked {
        Some(asked) => (asked, true),
        None => (AskedModes::held(Some(&interior), partition, &job.reduction)?, false),
    };
    let columns = Columns::new(partition, Some(&interior), motions, (&asked, probes));
    drop(interior);
    let asked = if is_counted { asked } else { asked.counted(partition, &analysis, first)? };
    Ok((asked, columns))
}
