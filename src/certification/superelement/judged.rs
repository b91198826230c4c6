//! A foreign superelement against the component as it is, its interface free.

use faer::{Mat, MatRef};

use super::checks;
use super::compared::{Compared, Nearest};
use super::foreign::Foreign;
use super::interface::Interface;
use super::left_out::LeftOut;
use super::pairing::paired;
use super::zero_motions;
use crate::certification::band::Band;
use crate::certification::certified::lowest_elastic;
use crate::dense;
use crate::eigen::{Modes, Spectral};
use crate::error::Result;
use crate::job::{Certify, InterfaceJob, Job, Method, ModeSelection, ReductionJob, SceneJob};
use crate::modes::{Component, ModeSource, Search, certified};
use crate::number::counted;
use crate::partition::Partition;
use crate::random::SEED;
use crate::sparse::product;
use crate::verification::check::{Check, Verdict};
use crate::verification::preservation::{BoundaryComparison, Preservation, Unmade, unmade_check};

/// Modes are compared up to the highest of the component's own over this: above, no superelement of as many modes is meant to serve.
const CUT_OFF: f64 = 1.5;

/// Eigenvalues of a superelement above the end of the band that belong to modes below it: a hundredth, and half of a frequency where that
/// fails.
const ABOVE: f64 = 4.0;

/// What was found of a superelement of another program.
#[derive(Clone, Debug)]
pub struct ReducedCertification {
    /// Coordinates.
    pub n_coordinates: usize,
    /// How many of them are rows of the model.
    pub n_interface: usize,
    /// The comparison with the component, its interface free.
    pub free: FreeComparison,
    /// The comparison at the interface, where it has one.
    pub preservation: Option<Preservation>,
    /// The measures, in the order of their identifiers.
    pub checks: Vec<Check>,
    /// What is to be known of it besides, one sentence each.
    pub notes: Vec<String>,
}

impl ReducedCertification {
    /// What is known of a superelement before its interface is looked at.
    pub fn new(foreign: &Foreign, interface: &Interface, (free, names): (FreeComparison, Option<Check>)) -> Self {
        let notes = notes(interface);
        let (n_coordinates, n_interface) = (foreign.n_reduced(), interface.coordinates.len());
        let mut checks: Vec<Check> = free.checks.iter().cloned().chain(names).collect();
        checks.sort_by_key(place);
        Self { n_coordinates, n_interface, checks, free, preservation: None, notes }
    }

    /// The job of a comparison at the interface, where there is one and the superelement is one of this model.
    pub fn job_of_interface(&self, job: &Job, interfaces: Vec<InterfaceJob>) -> Option<Job> {
        // A component without elastic modes has no band of its own.
        let band_hz = Some(self.free.band_hz).filter(|[_, to_hz]| *to_hz > 0.0);
        let scene = SceneJob { band_hz, ..SceneJob::default() };
        let reduction = ReductionJob::new(Method::Guyan, ModeSelection::Count { count: 0 });
        let is_comparable = !interfaces.is_empty() && self.free.frequencies.is_some();
        is_comparable.then(|| Job { interfaces, reduction, scene: Some(scene), ..job.clone() })
    }

    /// Adds the comparison at the interface; one that the model does not allow is a note, and counts in M-33.
    ///
    /// # Errors
    /// Those of the machine.
    pub fn compare(&mut self, compared: Result<(Preservation, Vec<Check>)>) -> Result<()> {
        match compared {
            Ok((preservation, checks)) => {
                self.checks.extend(checks);
                self.checks.sort_by_key(place);
                self.preservation = Some(preservation);
                Ok(())
            }
            Err(error) if error.class().is_of_matrices() => {
                self.notes.push(format!("nothing was compared at the interface: {error}"));
                let what = "statics, other boundaries and responses at the interface".to_owned();
                self.checks.extend(unmade_check(&[Unmade { what, is_of_reduced: false }]));
                self.checks.sort_by_key(place);
                Ok(())
            }
            Err(error) => Err(error),
        }
    }

    /// Adds what modes of its own the superelement left out, or why that is not known.
    ///
    /// # Errors
    /// Those of the machine.
    pub fn complete(&mut self, left_out: Result<Option<LeftOut>>) -> Result<()> {
        match left_out {
            Ok(left_out) => {
                let worst = self.free.frequencies.as_ref().map_or(f64::INFINITY, |compared| compared.worst_in_band);
                let is_needed = || dense::worse(worst, FREQUENCY_FAILS[0]);
                self.checks.extend(left_out.map(|left_out| left_out.check(is_needed)));
                self.checks.sort_by_key(place);
                Ok(())
            }
            Err(error) if error.class().is_of_matrices() => {
                self.notes.push(format!("whether modes of its own were left out is not known: {error}"));
                Ok(())
            }
            Err(error) => Err(error),
        }
    }

    /// The worst verdict of the checks.
    pub fn verdict(&self) -> Verdict {
        self.checks.iter().map(Check::verdict).fold(Verdict::Pass, Verdict::max)
    }
}

/// Where a check stands: those that reductions have, too, come first.
fn place(check: &Check) -> (bool, &'static str) {
    (check.id.starts_with('C'), check.id)
}

/// What is said besides the checks.
fn notes(interface: &Interface) -> Vec<String> {
    /// Rows that a note names.
    const NAMED: usize = 3;
    let mut notes = Vec::new();
    if interface.coordinates.is_empty() {
        notes.push(
            "no coordinate is a row of the model: there is no interface at which statics and responses could be compared".to_owned(),
        );
    }
    let at_rest = &interface.at_rest;
    if !at_rest.is_empty() {
        let listed: Vec<&str> = at_rest.iter().take(NAMED).map(String::as_str).collect();
        notes.push(format!(
            "{} of the model no column of the basis moves, {} among them: held in the other program, perhaps; hold them with --fix",
            counted(at_rest.len(), "row", "rows"),
            listed.join(", ")
        ));
    }
    notes
}

/// A superelement against its component, both free.
#[derive(Clone, Debug)]
pub struct FreeComparison {
    /// The band in which it is to serve, in Hz.
    pub band_hz: [f64; 2],
    /// Rigid-body modes of the component.
    pub n_rigid: usize,
    /// Motions of the superelement without stiffness.
    pub n_without_stiffness: usize,
    /// Frequencies of both; none where K̂ and M̂ have none.
    pub frequencies: Option<BoundaryComparison>,
    /// The measures.
    pub checks: Vec<Check>,
}

/// Difference of a frequency that fails in a band that was asked for, and in one that was not: half of it is open then.
const FREQUENCY_FAILS: [f64; 2] = [1e-1, 0.5];

/// Compares a superelement with its component. The job says how many modes of the component are looked for.
///
/// # Errors
/// Those of the search for the modes of the component.
pub fn compared_free(
    component: Component<'_>,
    job: &ReductionJob,
    foreign: &Foreign,
    band: Option<Band>,
) -> Result<FreeComparison> {
    let search = Search::new(component, job)?;
    let found = component.factor.vouched(search.lowest(SEED))?;
    let (modes, certificate) = certified(&search, &search.problem, found, search.edge(), Certify::Count)?;
    let scaling = component.partition.scaling;
    let highest = modes.lambda.last().copied().unwrap_or(0.0);
    let top = match band {
        Some(band) => scaling.eigenvalue(band.to_hz),
        // Its first mode alone, where no more are asked for.
        None if modes.count() <= 1 => highest * (1.0 + 1e-3),
        None => (highest / CUT_OFF.powi(2)).max(modes.lambda[0] * (1.0 + 1e-3)),
    };
    // A band may end below it.
    let first = match modes.lambda.first() {
        Some(first) => *first,
        None => lowest_elastic(component, job)?.unwrap_or(1.0),
    };
    let spectral = Spectral::if_definite(foreign.stiffness.given.as_ref(), foreign.mass.given.as_ref(), first)?;
    let of_digits = spectral.as_ref().map_or_else(Vec::new, |spectral| changes(foreign, spectral, top));
    let reduced = spectral.as_ref().map(Spectral::eigenvalues);
    let n_without_stiffness = zero_motions::count(foreign, first)?;
    let partners = match &spectral {
        Some(spectral) => partners(component.partition, foreign, (&modes, spectral), n_without_stiffness),
        None => vec![None; modes.count()],
    };
    let compared = Compared {
        component,
        foreign,
        full: &modes.lambda,
        first,
        errors: &modes.errors,
        reduced,
        of_digits,
        n_without_stiffness,
        rigid: rigid(component, foreign)?,
        partners,
        left_of_modes: nearest(component.partition, foreign, modes.shapes.as_ref())?.left,
        frequency_fails: FREQUENCY_FAILS[usize::from(band.is_none())],
        top,
        certificate: certificate.as_ref(),
    };
    let from_hz = band.map_or(0.0, |band| band.from_hz);
    let band_hz = [from_hz, scaling.hertz(top)];
    Ok(FreeComparison {
        band_hz,
        n_rigid: component.rigid.count(),
        n_without_stiffness,
        frequencies: compared.frequencies(band_hz),
        checks: checks::checks(&compared, band_hz)?,
    })
}

/// Which elastic mode of the superelement each mode of the component is.
fn partners(
    partition: &Partition,
    foreign: &Foreign,
    (modes, spectral): (&Modes, &Spectral),
    n_without_stiffness: usize,
) -> Vec<Option<usize>> {
    let eigenvalues = spectral.eigenvalues();
    let elastic = eigenvalues.get(n_without_stiffness..).unwrap_or_default();
    let of_mode: Vec<Vec<f64>> =
        (0..elastic.len()).map(|mode| spectral.eigenvector(n_without_stiffness + mode)).collect();
    let q = Mat::from_fn(foreign.n_reduced(), elastic.len(), |i, j| of_mode[j][i]);
    let momenta = product(&partition.mass, modes.shapes.as_ref());
    let moments = dense::gram(foreign.basis.as_ref(), momenta.as_ref());
    let along = dense::gram(moments.as_ref(), q.as_ref());
    let masses = dense::dots(q.as_ref(), dense::product(foreign.mass.projected.as_ref(), q.as_ref()).as_ref());
    paired(
        &modes.lambda,
        elastic,
        &Mat::from_fn(modes.count(), elastic.len(), |i, j| along[(i, j)].powi(2) / masses[j]),
    )
}

/// What the digits of K̂ and M̂ may make of each eigenvalue up to one, relative to it.
fn changes(foreign: &Foreign, spectral: &Spectral, top: f64) -> Vec<f64> {
    if !foreign.has_few_digits() {
        return Vec::new();
    }
    let inside = spectral.eigenvalues().into_iter().enumerate().take_while(|(_, lambda)| *lambda <= ABOVE * top);
    inside.map(|(mode, lambda)| foreign.changed_by_digits(lambda, &spectral.eigenvector(mode))).collect()
}

/// Rigid-body motion with mass as the superelement has it.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn rigid(component: Component<'_>, foreign: &Foreign) -> Result<Nearest> {
    let Component { partition, rigid, .. } = component;
    nearest(partition, foreign, rigid.orthonormal.as_ref().subcols(0, rigid.count() - rigid.n_massless))
}

fn nearest(partition: &Partition, foreign: &Foreign, motions: MatRef<'_, f64>) -> Result<Nearest> {
    let momenta = product(&partition.mass, motions);
    let moments = dense::gram(foreign.basis.as_ref(), momenta.as_ref());
    let coordinates = dense_solution(&foreign.mass.projected, &moments)?;
    let mut left = motions.to_owned();
    dense::add_product(left.as_mut(), -1.0, foreign.basis.as_ref(), coordinates.as_ref());
    let masses = dense::dots(left.as_ref(), product(&partition.mass, left.as_ref()).as_ref());
    Ok(Nearest { coordinates, left: masses.into_iter().map(|mass| mass.max(0.0).sqrt()).collect() })
}

/// The least solution of M̃ X = B, whatever rank M̃ has.
fn dense_solution(mass: &Mat<f64>, right: &Mat<f64>) -> Result<Mat<f64>> {
    let (scaled, scale) = dense::unit_diagonal(mass.as_ref());
    let (values, vectors) = dense::symmetric_eigen(scaled.as_ref())?;
    let r = values.len();
    let least = dense::NOISE_FACTOR * r as f64 * f64::EPSILON * values.last().copied().unwrap_or(0.0);
    let right = Mat::from_fn(r, right.ncols(), |i, j| right[(i, j)] * scale[i]);
    let mut along = dense::gram(vectors.as_ref(), right.as_ref());
    for (i, value) in values.iter().enumerate() {
        (0..along.ncols()).for_each(|j| along[(i, j)] = if *value > least { along[(i, j)] / value } else { 0.0 });
    }
    let solution = dense::product(vectors.as_ref(), along.as_ref());
    Ok(Mat::from_fn(r, solution.ncols(), |i, j| solution[(i, j)] * scale[i]))
}
