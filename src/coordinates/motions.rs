//! The six unit motions of every body, and the forces that K answers them with.

use faer::Mat;

use super::rounded_axes::forces_of_rounding;
use crate::dense;
use crate::model::{Frame, Model, Site};
use crate::sparse::{product, product_and_terms};

/// Displacement, for a body of unit size, that six digits lose: nodes are not told apart below it.
pub(super) const SIX_DIGITS: f64 = 1e-6;
/// Displacement out of place, in units of the size of a body, that coordinates of five digits leave. Of a free body zero modes mend
/// what patches are tied by; of a held one nothing does, and in a thin part little displacement is much stiffness.
pub(super) const FIVE_DIGITS: f64 = 2e-5;
/// Names of the axes.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// Motions of all bodies of a model, in the same six columns: no two bodies share a row.
pub(super) struct Motions<'a> {
    pub(super) model: &'a Model,
    pub(super) sites: &'a [Option<Site>],
    /// The bodies that have a node; those without stiffness and mass, which only constraints tie to others, are none.
    pub(super) bodies: Vec<Body>,
    /// C, n × 6.
    pub(super) centred: Mat<f64>,
    /// K C, n × 6.
    pub(super) forces: Mat<f64>,
    /// |K||C|, n × 6.
    pub(super) terms: Mat<f64>,
    /// |E||C| of roundings E of K, where an entry may be off by more than a share of itself, n × 6.
    of_digits: Option<Mat<f64>>,
    /// What roundings of the axes of nodes can make of the forces, n × 6; none where no axes look rounded.
    of_axes: Option<Mat<f64>>,
    rounding: f64,
}

/// A connected part of the model.
pub(super) struct Body {
    /// Its rows, ascending.
    pub(super) rows: Vec<usize>,
    pub(super) frame: Frame,
    /// Rounding of its levers relative to its size: coordinates far from the origin have that of their distance.
    pub(super) lever_rounding: f64,
}

impl Body {
    fn of(sites: &[Option<Site>], rows: Vec<usize>) -> Self {
        let frame = Frame::of(sites, &rows);
        let far = rows
            .iter()
            .filter_map(|row| sites[*row])
            .flat_map(|site| site.position)
            .fold(0.0f64, |max, x| max.max(x.abs()));
        Self { frame, lever_rounding: f64::EPSILON * far / frame.size, rows }
    }
}

impl<'a> Motions<'a> {
    pub(super) fn of(model: &'a Model, sites: &'a [Option<Site>]) -> Self {
        let mut rows = vec![Vec::new(); model.bodies.n_bodies];
        for (row, body) in model.bodies.of_row.iter().enumerate() {
            rows[*body as usize].push(row);
        }
        let empty = model.empty_rows();
        let is_there = |row: &usize| sites[*row].is_some() && empty.binary_search(row).is_err();
        rows.retain(|rows| rows.iter().any(is_there));
        let bodies: Vec<Body> = rows.into_iter().map(|rows| Body::of(sites, rows)).collect();
        let mut centred = Mat::zeros(sites.len(), 6);
        for Body { rows, frame, .. } in &bodies {
            for row in rows {
                let Some(site) = sites[*row] else { continue };
                let motion = site.rigid_motion_about(frame.centre);
                for (j, value) in motion.into_iter().enumerate() {
                    centred[(*row, j)] = if j < 3 { value } else { value / frame.size };
                }
            }
        }
        let (forces, terms) = product_and_terms(&model.stiffness, centred.as_ref());
        let rounding = model.precision.stiffness;
        let of_digits =
            rounding.is_beyond_entries().then(|| rounding.terms((&model.stiffness).into(), centred.as_ref()));
        let rounding = f64::EPSILON
            + match &of_digits {
                Some(of_digits) => share_of(of_digits, (&terms, &centred), &bodies),
                None => rounding.relative,
            };
        let of_axes = forces_of_rounding(model, &centred);
        Self { model, sites, bodies, centred, forces, terms, of_digits, of_axes, rounding }
    }

    /// M C of each body moving alone, n × 6: what M carries over from one body to another is left out.
    pub(super) fn momenta(&self) -> Mat<f64> {
        let Model { mass, bodies, .. } = self.model;
        let mut momenta = product(mass, self.centred.as_ref());
        for (row, view) in mass.outer_iterator().enumerate() {
            let of_others = view.iter().filter(|(col, _)| bodies.of_row[*col] != bodies.of_row[row]);
            of_others.for_each(|(col, value)| (0..6).for_each(|j| momenta[(row, j)] -= value * self.centred[(col, j)]));
        }
        momenta
    }

    /// Relative size of what rounding of K can make of the forces and the energy of a motion.
    pub(super) fn rounding(&self) -> f64 {
        self.rounding
    }

    /// Relative size of what rounding of K can make of a force at a row.
    pub(super) fn rounding_at(&self, row: usize) -> f64 {
        let scale = self.scale_of(row);
        match &self.of_digits {
            Some(of_digits) if scale > 0.0 => (0..6).fold(self.rounding, |max, j| max.max(of_digits[(row, j)] / scale)),
            _ => self.rounding,
        }
    }

    /// What roundings of the axes of nodes can make of the force of a translation at a row.
    pub(super) fn of_axes_at(&self, row: usize) -> f64 {
        let of_translations = |of_axes: &Mat<f64>| (0..3).fold(0.0, |max: f64, j| max.max(of_axes[(row, j)]));
        self.of_axes.as_ref().map_or(0.0, of_translations)
    }

    /// Whether roundings of axes make forces that nothing else does at some row of a body, and explain those of all its rows, with roundings of
    /// K and coordinates of five digits.
    pub(super) fn feels_axes(&self, body: &Body) -> bool {
        let Some(of_axes) = &self.of_axes else { return false };
        let entries = || body.rows.iter().flat_map(|row| (0..6).map(move |j| (*row, j)));
        let force = |(row, j): (usize, usize)| self.forces[(row, j)].abs();
        let own = |row: usize| self.rounding_at(row) * self.scale_of(row);
        let of_coordinates = |(row, j): (usize, usize)| if j < 3 { 0.0 } else { FIVE_DIGITS * self.scale_of(row) };
        // What roundings make of the translations together, and of the rotations, as where supports are looked for: between what they leave
        // unheld and what axes explain there is nothing.
        let of_alike = |(row, j): (usize, usize)| {
            let alike = if j < 3 { 0..3 } else { 3..6 };
            alike.fold(0.0, |max: f64, j| max.max(of_axes[(row, j)]))
        };
        entries().any(|at| of_axes[at] > 0.0 && force(at) > own(at.0))
            && entries().all(|at| force(at) <= of_alike(at) + own(at.0) + of_coordinates(at))
    }

    /// Whether axes of nodes look rounded.
    pub(super) fn has_rounded_axes(&self) -> bool {
        self.of_axes.is_some()
    }

    /// The size of the terms of a row, over all motions.
    pub(super) fn scale_of(&self, row: usize) -> f64 {
        (0..6).fold(0.0, |max: f64, j| max.max(self.terms[(row, j)]))
    }

    /// The force of a motion at a row relative to its terms, as a displacement in units of the size of the body; nothing at a row without.
    pub(super) fn displacement(&self, row: usize, motion: usize) -> f64 {
        let scale = self.scale_of(row);
        if scale > 0.0 { self.forces[(row, motion)].abs() / scale } else { 0.0 }
    }

    /// ‖F‖ over some rows of a body relative to ‖T‖ over all its rows, for one motion.
    pub(super) fn residual(&self, body: &Body, rows: &[usize], motion: usize) -> f64 {
        let norm = |values: &Mat<f64>, rows: &[usize]| {
            dense::norm(&rows.iter().map(|row| values[(*row, motion)]).collect::<Vec<f64>>())
        };
        let size = norm(&self.terms, &body.rows);
        if size > 0.0 { norm(&self.forces, rows) / size } else { 0.0 }
    }

    /// cᵀKc and |c|ᵀ|K||c| of a motion of a body.
    pub(super) fn energy(&self, body: &Body, motion: usize) -> (f64, f64) {
        let terms = body.rows.iter().map(|row| {
            let c = self.centred[(*row, motion)];
            (c * self.forces[(*row, motion)], c.abs() * self.terms[(*row, motion)])
        });
        terms.fold((0.0, 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1))
    }

    /// What a row is called in messages.
    pub(super) fn name_of(&self, row: usize) -> String {
        self.model.names().short(row)
    }
}

/// The largest share that roundings have in the forces, or in the energy, of a motion of a body.
fn share_of(of_digits: &Mat<f64>, (terms, centred): (&Mat<f64>, &Mat<f64>), bodies: &[Body]) -> f64 {
    let ratio = |part: f64, whole: f64| if whole > 0.0 { (part / whole).min(1.0) } else { 0.0 };
    let of_motion = |body: &Body, j: usize| {
        let force = |of: &Mat<f64>| dense::norm(&body.rows.iter().map(|row| of[(*row, j)]).collect::<Vec<f64>>());
        let energy = |of: &Mat<f64>| body.rows.iter().map(|row| centred[(*row, j)].abs() * of[(*row, j)]).sum::<f64>();
        ratio(force(of_digits), force(terms)).max(ratio(energy(of_digits), energy(terms)))
    };
    bodies.iter().flat_map(|body| (0..6).map(move |j| of_motion(body, j))).fold(0.0, f64::max)
}
