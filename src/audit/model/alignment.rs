//! Which combination of the columns made again each stored column is.
//!
//! ```text
//! R   n_N × n_η   signs of the modes, rotations inside their groups
//! C   n_η × n_η   mixing: stored = named · C
//! B   q × r'      [I 0; 0 RC]: stored columns are W B, r' = p + n_η
//! ```
//! The sign of a mode and the basis of modes that lie together are free, and so is the mixing: whatever they are, K̂ and M̂ have
//! to be those of W B. R is the orthogonal matrix that brings both sets of columns together best, group by group, in what the
//! interface, gravity and the recovered rows see of them.

use std::ops::Range;

use faer::{Mat, MatRef};

use super::columns::Named;
use super::projection::{Form, Projected};
use super::scaled::Scaled;
use crate::audit::named_modes::{WithInverse, terms_of_unmixing};
use crate::dense::{self, NOISE_FACTOR};
use crate::eigen::NO_MASS;

/// Weight of recovered rows and further matrices relative to all others: in single precision they have seven digits, which may decide on what nothing else
/// sees and on nothing more.
const RECOVERED: f64 = 1e-3;

/// The parts of the basis that may turn.
pub(super) struct Freedom<'a> {
    /// The named column that each modal coordinate of the file is, as its place among those made again.
    pub(super) kept: &'a [usize],
    /// Ranges of modes that are one space.
    pub(super) groups: &'a [Range<usize>],
    /// Motions of the file's inertia relief from those made again, n_r × n_r, and the share of them that is none of these; none where both
    /// are the same.
    pub(super) relief: Option<(Mat<f64>, f64)>,
    /// C; none where the stored columns are the named ones, or orthonormal ones of the same span.
    pub(super) mixing: Option<MatRef<'a, f64>>,
}

/// B, and what rounding of the mixing may make of it.
pub(super) struct Combination {
    /// B.
    pub(super) columns: Mat<f64>,
    /// |R||C||C⁻¹||C|: ε times this is what B may be off by (Higham 2002, section 8.1). Columns that nearly depend on each other
    /// are put together from large parts of little. To this comes what the fit leaves open of R, over ε.
    pub(super) amplified: Mat<f64>,
}

/// B; none where the modes of a group may turn without being seen, and the matrices with them.
pub(super) fn combination(file: &Scaled, projected: &Projected, freedom: &Freedom<'_>) -> Option<Combination> {
    let (p, n_named, n_eta) = (projected.n_probes(), projected.named.len(), freedom.kept.len());
    let seen = seen(file, projected, freedom.mixing);
    let inverse = freedom.mixing.map(dense::inverse);
    let mixing = freedom.mixing.zip(inverse.as_ref().map(Mat::as_ref));
    let noise = noise(projected, freedom.kept, (seen[1].as_ref(), mixing));
    let (mut turned, mut open) = (Mat::zeros(n_named, n_eta), Mat::zeros(n_named, n_eta));
    let place = |turned: &mut Mat<f64>, (columns, slots): (&[usize], &[usize]), block: MatRef<'_, f64>| {
        for (i, column) in columns.iter().enumerate() {
            slots.iter().enumerate().for_each(|(j, slot)| turned[(*column, *slot)] = block[(i, j)]);
        }
    };
    for columns in groups(&projected.named, freedom.groups) {
        let slots: Vec<usize> = (0..n_eta).filter(|slot| columns.contains(&freedom.kept[*slot])).collect();
        match projected.named[columns[0]] {
            // Next to an interface rigid-body modes are those of Û, as inertia relief answers them.
            named
                if matches!(named, Named::Relief(_) | Named::Expansion(_) | Named::Residual(_))
                    || is_of_motion(named, p) =>
            {
                let n = columns.len();
                // The load of a residual vector leaves nothing of it free, nor do the inertia forces of a given mode.
                let relief = freedom.relief.clone().filter(|_| matches!(named, Named::Relief(_) | Named::Rigid(_)));
                if let (Some((_, left)), Some((softest, answer))) = (&relief, softest(projected)) {
                    slots.iter().for_each(|slot| open[(softest, *slot)] += left * answer);
                }
                let all = relief.map_or_else(|| Mat::identity(n, n), |(motions, _)| motions);
                let numbers: Vec<usize> = slots.iter().map(|slot| freedom.kept[*slot] - columns[0]).collect();
                place(&mut turned, (&columns, &slots), dense::columns(all.as_ref(), &numbers).as_ref());
            }
            _ => {
                let [mine, files] =
                    [(&seen[0], &columns), (&seen[1], &slots)].map(|(a, at)| dense::columns(a.as_ref(), at));
                let noise: Vec<f64> = slots.iter().map(|slot| noise[*slot]).collect();
                if turns_unseen(projected, &columns, (mine.as_ref(), noise.iter().copied().fold(0.0, f64::max))) {
                    return None;
                }
                let [mine, files] = completed(mine.as_ref(), files.as_ref());
                let turn = nearest_rotation(mine.as_ref(), files.as_ref());
                let left_open = left_open(mine.as_ref(), turn.as_ref(), dense::norm(&noise));
                place(&mut turned, (&columns, &slots), turn.as_ref().subcols(0, slots.len()));
                place(&mut open, (&columns, &slots), left_open.as_ref().subcols(0, slots.len()));
            }
        }
    }
    let mut amplified = open * faer::Scale(1.0 / f64::EPSILON);
    if let Some((mixing, inverse)) = mixing {
        let terms = terms_of_unmixing(turned.as_ref(), (mixing, inverse)) + amplified;
        amplified = dense::product(terms.as_ref(), dense::absolute(mixing).as_ref());
        turned = dense::product(turned.as_ref(), mixing);
    }
    let with_probes = |of_probes: Mat<f64>, of_named: &Mat<f64>| {
        let mut whole = Mat::zeros(p + n_named, p + n_eta);
        whole.as_mut().submatrix_mut(0, 0, p, p).copy_from(of_probes);
        whole.as_mut().submatrix_mut(p, p, n_named, n_eta).copy_from(of_named);
        whole
    };
    Some(Combination {
        columns: with_probes(Mat::identity(p, p), &turned),
        amplified: with_probes(Mat::zeros(p, p), &amplified),
    })
}

/// The softest named column, and the most of it that the interior answers to the inertia of a motion of unit mass: 1/λ in inertia and 1/√λ in
/// energy. What deforms in a motion of the file, by rounding, answers likewise, which next to short columns is more than its share of them.
fn softest(projected: &Projected) -> Option<(usize, f64)> {
    let p = projected.n_probes();
    let of = |form: &Form, j: usize| form.matrix[(p + j, p + j)];
    let pairs = (0..projected.named.len()).map(|j| (j, of(&projected.stiffness, j), of(&projected.mass, j)));
    let massive = pairs.filter(|(_, stiffness, mass)| *stiffness > 0.0 && *mass > 0.0);
    let least = massive.min_by(|(_, k, m), (_, l, n)| (k / m).total_cmp(&(l / n)));
    least.map(|(j, stiffness, mass)| (j, mass.sqrt() / stiffness))
}

/// Whether a column is what static modes leave of a rigid-body mode.
fn is_of_motion(named: Named, n_probes: usize) -> bool {
    matches!(named, Named::Rigid(_)) && n_probes > 0
}

impl Combination {
    /// The interface alone.
    pub(super) fn of_interface(projected: &Projected) -> Self {
        let (p, q) = (projected.n_probes(), projected.n_probes() + projected.named.len());
        Self { columns: Mat::identity(q, p), amplified: Mat::zeros(q, p) }
    }
}

/// Places of the named columns that turn together, in their order.
fn groups(named: &[Named], of_modes: &[Range<usize>]) -> Vec<Vec<usize>> {
    let places =
        |is: &dyn Fn(&Named) -> bool| -> Vec<usize> { (0..named.len()).filter(|at| is(&named[*at])).collect() };
    let rigid = places(&|named| matches!(named, Named::Rigid(_)));
    let relief = places(&|named| matches!(named, Named::Relief(_)));
    let modes =
        of_modes.iter().map(|group| places(&|named| matches!(named, Named::Mode(mode) if group.contains(mode))));
    let expansion = places(&|named| matches!(named, Named::Expansion(_)));
    let residual = places(&|named| matches!(named, Named::Residual(_)));
    [rigid, relief].into_iter().chain(modes).chain([expansion, residual]).filter(|group| !group.is_empty()).collect()
}

/// What interface, gravity, rigid-body motion, recovered rows and further matrices see of the columns made again, and of the named ones of the file;
/// f × n_N and f × n_η.
fn seen(file: &Scaled, projected: &Projected, mixing: Option<MatRef<'_, f64>>) -> [Mat<f64>; 2] {
    let (p, n_named, n_eta) = (projected.n_probes(), projected.named.len(), file.n_modal());
    let of_file = |a: &Mat<f64>| a.as_ref().subcols(file.n_b, n_eta).to_owned();
    let of_mine = |a: &Mat<f64>| a.as_ref().subcols(p, n_named).to_owned();
    let mut pairs: Vec<[Mat<f64>; 2]> = Vec::new();
    let mut add = |weight: f64, pair: [Mat<f64>; 2]| pairs.push(pair.map(|a| a * faer::Scale(weight)));
    let [stiffness, mass] = [&projected.stiffness, &projected.mass].map(|form| |j: usize| form.matrix[(j, j)].max(0.0));
    let softest = (0..p).filter(|j| projected.is_stiff(*j)).map(|j| mass(j) / stiffness(j)).fold(0.0, f64::max);
    // A rotation without inertia has what rounding squares leave, and divided by that its rounding would be all that is seen: next to the
    // energy of other motions it is nothing, and where it has no energy either it is no more than what its own column may be off by.
    let of_rounding = |j: usize| NOISE_FACTOR * projected.mass.errors[j];
    let inertia = |j: usize| match mass(j).max(NO_MASS * softest * stiffness(j)).sqrt() {
        length if length > of_rounding(j) => length,
        _ => f64::INFINITY,
    };
    let coupling = dense::product(projected.probes.transpose(), file.m.as_ref().subrows(0, file.n_b));
    let weighted = |a: Mat<f64>| Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)] / inertia(i));
    let known = projected.reduced_mass().matrix.as_ref().submatrix(0, p, p, n_named).to_owned();
    add(1.0, [weighted(known), weighted(of_file(&coupling))]);
    if let Some(motions) = projected.motions.as_ref().filter(|motions| motions.nrows() == file.u.ncols()) {
        // Without an interface Û are the amplitudes ΨᵀMU: rigid-body motion as the stored columns see it.
        add(1.0 / motions.norm_max(), [of_mine(motions), file.u.transpose().to_owned()]);
    }
    if let (Some(weight), Some(known), Some(stored)) = (projected.gravity_weight, &projected.gravity, &file.gravity) {
        add(weight, [of_mine(&known.rows), of_file(stored)]);
    }
    let recovery = projected.recovery.iter().zip(&file.recovery).map(|rows| (RECOVERED, rows));
    let recovery = recovery.filter(|(_, (known, stored))| known.rows.nrows() == stored.nrows());
    let loads = projected.loads.iter().zip(&file.loads).map(|rows| (1.0, rows));
    for (weight, (known, stored)) in loads.chain(recovery) {
        let modal = of_mine(&known.rows);
        // Where no column moves a load or a row, all that is seen there is what the columns may be off by.
        if modal.norm_max() > known.errors[p..].iter().copied().fold(0.0, f64::max) {
            add(weight / modal.norm_max(), [modal, of_file(stored)]);
        }
    }
    // What damping and further matrices tie to the interface tells the signs of modes that nothing else sees.
    for (known, stored) in projected.matrices.iter().zip(&file.matrices) {
        let of_probes = |a: MatRef<'_, f64>| a.submatrix(0, p, p, n_named).to_owned();
        let (modal, errors) = (of_probes(known.matrix.as_ref()), of_probes(known.errors.as_ref()));
        if modal.norm_max() > errors.norm_max() {
            let tied = dense::product(projected.probes.transpose(), stored.as_ref().subrows(0, file.n_b));
            add(RECOVERED / modal.norm_max(), [modal, of_file(&tied)]);
        }
    }
    let [mine, stored] = [0, 1].map(|which| stacked(pairs.iter().map(|pair| pair[which].as_ref()).collect()));
    // Stored = named · C: the named columns of the file are its stored ones times C⁻¹.
    let named = match mixing {
        Some(mixing) => dense::divided(stored.as_ref(), mixing),
        None => stored,
    };
    [mine, named]
}

/// Matrices of as many columns one below the other.
fn stacked(parts: Vec<MatRef<'_, f64>>) -> Mat<f64> {
    let n_rows = parts.iter().map(|part| part.nrows()).sum();
    let mut all = Mat::zeros(n_rows, parts.first().map_or(0, |part| part.ncols()));
    let mut at = 0;
    for part in parts {
        all.as_mut().subrows_mut(at, part.nrows()).copy_from(part);
        at += part.nrows();
    }
    all
}

/// Whether modes of one group may turn so that nothing sees it and their energies and inertias change: ZᵀA is not μZᵀ for the
/// combinations Z that are not seen. Accelerated modes do that whose cluster reaches into the interface.
fn turns_unseen(projected: &Projected, columns: &[usize], (mine, noise): (MatRef<'_, f64>, f64)) -> bool {
    /// Square of a share below which a combination is not seen: what is seen of it is rounding.
    const UNSEEN: f64 = 1e-14;
    /// Relative change of an energy that a turn makes: no less than the width of a cluster.
    const CHANGED: f64 = 1e-6;
    let Ok((seen, vectors)) = dense::symmetric_eigen(dense::gram(mine, mine).as_ref()) else { return true };
    // Noise turns two combinations by its share of what is seen of the better one.
    let most = (UNSEEN * seen.last().copied().unwrap_or(0.0)).max((noise / CHANGED).powi(2));
    let n_unseen = seen.iter().take_while(|square| **square <= most).count();
    // One alone has nothing to turn into.
    if n_unseen < 2 {
        return false;
    }
    let z = vectors.as_ref().subcols(0, n_unseen);
    let first = projected.n_probes();
    [&projected.stiffness, &projected.mass].into_iter().any(|form| {
        let n = columns.len();
        let a = Mat::from_fn(n, n, |i, j| form.matrix[(first + columns[i], first + columns[j])]);
        let mut change = dense::product(a.as_ref(), z);
        let mean = dense::dots(z, change.as_ref()).into_iter().sum::<f64>() / n_unseen as f64;
        change -= z * faer::Scale(mean);
        // An entry is relative to its own columns: the column of a mode that lies in the interface is short.
        let size = |i: usize| (a[(i, i)] * mean).max(0.0).sqrt();
        (0..n).any(|i| change.row(i).iter().any(|change| change.abs() > CHANGED * size(i)))
    })
}

/// What the columns made again and rounding of the mixing leave open of each named column of the file, as it is seen.
fn noise(
    projected: &Projected,
    kept: &[usize],
    (named, mixing): (MatRef<'_, f64>, Option<WithInverse<'_>>),
) -> Vec<f64> {
    let p = projected.n_probes();
    let own = kept.iter().map(|column| projected.mass.errors[p + column]);
    let Some(mixing) = mixing else { return own.collect() };
    let rounding = terms_of_unmixing(named, mixing);
    let of_slot = |j: usize| NOISE_FACTOR * f64::EPSILON * dense::norm(dense::column(rounding.as_ref(), j));
    own.zip((0..kept.len()).map(of_slot)).map(|(own, rounding)| own + rounding).collect()
}

/// A and the columns B of a file with, where it left out some of a group, what is seen of those: for [B D] = A Q with an orthogonal
/// Q the product D Dᵀ is A Aᵀ − B Bᵀ, whose leading eigenvectors make a D but for its own turns.
fn completed(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> [Mat<f64>; 2] {
    let n_left_out = a.ncols().saturating_sub(b.ncols());
    if n_left_out == 0 {
        return [a.to_owned(), b.to_owned()];
    }
    let both = dense::side_by_side(a, b);
    // Where more is seen than there are columns, what they span is enough, and no orthonormal change of it turns them.
    let seen = if both.nrows() > both.ncols() { both.qr().thin_R().to_owned() } else { both };
    let (a, b) = seen.as_ref().split_at_col(a.ncols());
    let square = |x: MatRef<'_, f64>| dense::product(x, x.transpose());
    let difference = square(a) - square(b);
    let Ok((values, vectors)) = dense::symmetric_eigen(difference.as_ref()) else {
        return [a.to_owned(), b.to_owned()];
    };
    let first = values.len().saturating_sub(n_left_out);
    let left_out = Mat::from_fn(a.nrows(), n_left_out, |i, j| {
        if first + j < values.len() { values[first + j].max(0.0).sqrt() * vectors[(i, first + j)] } else { 0.0 }
    });
    [a.to_owned(), dense::side_by_side(b, left_out.as_ref())]
}

/// What an error of the columns B, of this size, leaves open of the entries of the R that brings A R nearest to them.
///
/// With A = U Σ Vᵀ and B = A R + N the fit is off by V E VᵀR, E skew with |E_ab| ≤ ‖N‖ (σ_a + σ_b) / (σ_a² + σ_b²) (Kenney and Laub 1991):
/// two combinations that are hardly seen, those of oscillators of little mass for instance, may be turned into each other by much more than
/// ‖N‖. Errors of the pairs are independent: their squares add up.
fn left_open(a: MatRef<'_, f64>, turn: MatRef<'_, f64>, error: f64) -> Mat<f64> {
    let n = a.ncols();
    let Ok((squares, v)) = dense::symmetric_eigen(dense::gram(a, a).as_ref()) else { return Mat::zeros(n, n) };
    let angle = |i: usize, j: usize| {
        let [s, t] = [squares[i], squares[j]].map(|square| square.max(0.0));
        // One alone has nothing to turn into, and no turn is more than a whole one.
        if i == j { 0.0 } else { (error * (s.sqrt() + t.sqrt()) / (s + t).max(f64::MIN_POSITIVE)).min(1.0) }
    };
    let squared = |x: MatRef<'_, f64>| Mat::from_fn(n, n, |i, j| x[(i, j)].powi(2));
    let angles = Mat::from_fn(n, n, |i, j| angle(i, j).powi(2));
    let with_file = squared(dense::product(v.transpose(), turn).as_ref());
    let sum =
        dense::product(squared(v.as_ref()).as_ref(), dense::product(angles.as_ref(), with_file.as_ref()).as_ref());
    Mat::from_fn(n, n, |i, j| sum[(i, j)].sqrt())
}

/// The orthonormal columns R that bring A R nearest to B (Schönemann 1966): U Vᵀ of AᵀB = U Σ Vᵀ.
fn nearest_rotation(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let product = dense::gram(a, b);
    if product.shape() == (1, 1) {
        return Mat::from_fn(1, 1, |_, _| if product[(0, 0)] < 0.0 { -1.0 } else { 1.0 });
    }
    match product.thin_svd() {
        Ok(svd) => dense::product(svd.U(), svd.V().transpose()),
        Err(_) => Mat::from_fn(product.nrows(), product.ncols(), |_, _| f64::NAN),
    }
}
