//! Elastic modes with what is known of each, and the counts taken among them.

use faer::Mat;

use super::problem::EigenWork;
use super::quality::ModeError;
use crate::dense;
use crate::factor::InertiaCount;

/// Elastic modes of one boundary condition.
#[derive(Clone, Debug)]
pub struct Modes {
    /// λ = ω² in scaled units, ascending: Rayleigh quotients.
    pub lambda: Vec<f64>,
    /// Mode shapes, n × k, M-orthonormal.
    pub shapes: Mat<f64>,
    /// How well each is known.
    pub errors: Vec<ModeError>,
    /// The end of the band that was searched, where one was asked for.
    pub searched_to: Option<f64>,
    /// The next eigenvalue above, where there is one.
    pub next: Option<f64>,
    /// Sturm counts taken during the search, ascending: the ends of its slices.
    pub counts: Vec<ElasticCount>,
    /// What they cost.
    pub work: EigenWork,
}

impl Modes {
    /// Number of modes k.
    pub fn count(&self) -> usize {
        self.lambda.len()
    }

    /// No modes of n dofs.
    pub fn none(n: usize) -> Self {
        Self {
            lambda: Vec::new(),
            shapes: Mat::zeros(n, 0),
            errors: Vec::new(),
            searched_to: None,
            next: None,
            counts: Vec::new(),
            work: EigenWork::default(),
        }
    }

    /// The largest λ over the smallest; one without modes.
    pub fn spread(&self) -> f64 {
        self.lambda.last().zip(self.lambda.first()).map_or(1.0, |(last, first)| last / first)
    }

    /// These modes after other work.
    pub(crate) fn after(mut self, work: EigenWork) -> Self {
        self.work += work;
        self
    }

    /// The largest backward error; zero without modes.
    pub fn largest_backward(&self) -> f64 {
        dense::worst(self.errors.iter().map(|error| error.backward))
    }

    /// How much larger than the modal energy the terms that cancel in it are, at most.
    pub fn largest_cancellation(&self) -> f64 {
        self.errors.iter().map(|error| error.cancellation).fold(0.0, f64::max)
    }

    /// Modes between two shifts.
    pub fn n_between(&self, from: f64, to: f64) -> usize {
        self.lambda.iter().filter(|lambda| from < **lambda && **lambda < to).count()
    }

    /// Whether a shift lies off the modes: by a thousandth of the gap it lies in and by a thousand times what rounding moves
    /// an eigenvalue by.
    pub fn is_clear(&self, sigma: f64) -> bool {
        const ROUNDINGS: f64 = 1e3;
        const SHARE_OF_GAP: f64 = 1e-3;
        let below = self.lambda.iter().copied().filter(|lambda| *lambda <= sigma).fold(0.0, f64::max);
        let above = self.lambda.iter().copied().chain(self.next).filter(|lambda| *lambda > sigma);
        let above = above.fold(f64::INFINITY, f64::min);
        let gap = if above.is_finite() { above - below } else { below };
        let floor = self.errors.iter().map(|error| error.rounding_floor).fold(0.0, f64::max);
        (sigma - below).min(above - sigma) >= (ROUNDINGS * floor).max(SHARE_OF_GAP * gap)
    }

    /// The shapes of the modes between two shifts.
    pub fn shapes_between(&self, from: f64, to: f64) -> Mat<f64> {
        self.selected(|lambda| from < lambda && lambda < to).shapes
    }

    /// These modes and others, ascending.
    pub fn joined(self, more: impl IntoIterator<Item = Self>) -> Self {
        let mut work = self.work;
        let parts: Vec<Self> = std::iter::once(self).chain(more).collect();
        parts[1..].iter().for_each(|part| work += part.work);
        if let [whole, rest @ ..] = &parts[..]
            && rest.iter().all(|part| part.count() == 0)
            && whole.lambda.is_sorted()
        {
            return Self { work, ..parts.into_iter().next().expect("the first") };
        }
        let mut order: Vec<(usize, usize)> =
            parts.iter().enumerate().flat_map(|(part, modes)| (0..modes.count()).map(move |j| (part, j))).collect();
        order.sort_by(|a, b| parts[a.0].lambda[a.1].total_cmp(&parts[b.0].lambda[b.1]));
        let n = parts[0].shapes.nrows();
        let mut shapes = Mat::zeros(n, order.len());
        for (mut to, (part, j)) in shapes.as_mut().col_iter_mut().zip(&order) {
            to.copy_from(parts[*part].shapes.as_ref().col(*j));
        }
        Self {
            lambda: order.iter().map(|(part, j)| parts[*part].lambda[*j]).collect(),
            errors: order.iter().map(|(part, j)| parts[*part].errors[*j]).collect(),
            shapes,
            work,
            searched_to: parts[0].searched_to,
            next: parts[0].next,
            counts: parts[0].counts.clone(),
        }
    }

    /// The lowest modes; the first of the others becomes the next eigenvalue above.
    pub fn truncated(self, count: usize) -> Self {
        if count >= self.count() {
            return self;
        }
        Self {
            next: Some(self.lambda[count]),
            shapes: self.shapes.as_ref().subcols(0, count).to_owned(),
            lambda: self.lambda[..count].to_vec(),
            errors: self.errors[..count].to_vec(),
            ..self
        }
    }

    /// All modes but one, as if it had never been found.
    pub fn without(&self, mode: usize) -> Self {
        let order: Vec<usize> = (0..self.count()).filter(|j| *j != mode).collect();
        self.in_order(&order)
    }

    /// These modes in ascending order.
    pub(crate) fn ascending(self) -> Self {
        if self.lambda.is_sorted() {
            return self;
        }
        let mut order: Vec<usize> = (0..self.count()).collect();
        order.sort_by(|a, b| self.lambda[*a].total_cmp(&self.lambda[*b]));
        self.in_order(&order)
    }

    /// The modes whose eigenvalue satisfies a condition.
    pub(crate) fn selected(&self, is_wanted: impl Fn(f64) -> bool) -> Self {
        let order: Vec<usize> = (0..self.count()).filter(|j| is_wanted(self.lambda[*j])).collect();
        self.in_order(&order)
    }

    pub(crate) fn in_order(&self, order: &[usize]) -> Self {
        Self {
            lambda: order.iter().map(|j| self.lambda[*j]).collect(),
            errors: order.iter().map(|j| self.errors[*j]).collect(),
            shapes: dense::columns(self.shapes.as_ref(), order),
            searched_to: self.searched_to,
            next: self.next,
            counts: self.counts.clone(),
            work: self.work,
        }
    }

    /// A shift above the highest mode and the band that was searched, and below the next mode, at this fraction of the
    /// way: where a Sturm count is taken.
    pub fn shift_above(&self, fraction: f64) -> f64 {
        let top = self.lambda.last().copied().into_iter().chain(self.searched_to).fold(0.0, f64::max);
        match self.next.filter(|next| *next > top) {
            Some(next) => top + fraction * (next - top),
            None if top > 0.0 => (1.0 + fraction) * top,
            None => fraction,
        }
    }
}

/// The elastic eigenvalues below a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticCount {
    /// The count with both boundaries.
    pub inertia: InertiaCount,
    /// Eigenvalues below the shift under the boundary at hand, without the rigid-body modes.
    pub n_elastic: usize,
}
