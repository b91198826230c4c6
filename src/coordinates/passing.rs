//! Motions of a body that make no force anywhere: translations, and turns about wherever supports let them pass.
//!
//! ```text
//! F_t    n × 3    forces of the three translations
//! f      n × 1    forces of a turn about an axis through the middle of the body
//! s      3 × 1    −(F_tᵀF_t)⁺ F_tᵀ f, the translation that goes with it
//! ```
//! Half a part whose plane holds what is along the plane turns about axes in that plane and about no others.

use faer::Mat;

use super::motions::{Body, Motions};
use super::nodes::{FIRST_ROTATION, NOTICEABLE, Nodes, noticeable_force};
use crate::dense;
use crate::error::Result;

/// Displacement by a unit motion below which it is none.
const AT_REST: f64 = 1e-9;
/// Share of the largest eigenvalue of F_tᵀF_t below which a translation makes no force.
const NO_FORCE: f64 = 1e-12;

/// Motions of a body that supports let pass.
pub(super) struct Passing {
    /// Combinations of the six unit motions.
    combinations: Vec<[f64; 6]>,
    /// The axes about which the body turns.
    pub(super) turns: [bool; 3],
}

impl Passing {
    /// Of a body.
    ///
    /// # Errors
    /// A dense eigenproblem of order three that does not converge.
    pub(super) fn of(motions: &Motions<'_>, nodes: &Nodes, body: &Body) -> Result<Self> {
        let rows: Vec<usize> = body.rows.iter().copied().filter(|row| nodes.is_placed(*row)).collect();
        let makes_force = |motion: &[f64; 6], row: usize| {
            let force: f64 = (0..6).map(|j| motion[j] * motions.forces[(row, j)]).sum();
            let of_levers = NOTICEABLE * body.lever_rounding * motions.scale_of(row);
            force.abs() > noticeable_force(motions, row) + of_levers
        };
        let passes = |motion: &[f64; 6]| !rows.iter().any(|row| makes_force(motion, *row));
        let of_translations = Mat::from_fn(rows.len(), FIRST_ROTATION, |i, j| motions.forces[(rows[i], j)]);
        let (squares, along) =
            dense::symmetric_eigen(dense::gram(of_translations.as_ref(), of_translations.as_ref()).as_ref())?;
        let largest = squares.last().copied().unwrap_or(0.0);
        let held: Vec<usize> = (0..FIRST_ROTATION).filter(|k| squares[*k] > NO_FORCE * largest).collect();
        let unit = |at: usize| -> [f64; 6] { std::array::from_fn(|j| f64::from(u8::from(j == at))) };
        let turn = |axis: usize| {
            let of_turn = Mat::from_fn(rows.len(), 1, |i, _| motions.forces[(rows[i], FIRST_ROTATION + axis)]);
            let work = dense::gram(of_translations.as_ref(), of_turn.as_ref());
            let mut motion = unit(FIRST_ROTATION + axis);
            for k in held.iter().copied() {
                let share: f64 = (0..FIRST_ROTATION).map(|j| along[(j, k)] * work[(j, 0)]).sum::<f64>() / squares[k];
                (0..FIRST_ROTATION).for_each(|j| motion[j] -= share * along[(j, k)]);
            }
            motion
        };
        let turns: [[f64; 6]; 3] = std::array::from_fn(turn);
        let passing_turns = turns.map(|turn| passes(&turn));
        let translations = (0..FIRST_ROTATION).map(unit).filter(passes);
        let turning = turns.into_iter().zip(passing_turns).filter(|(_, passes)| *passes).map(|(turn, _)| turn);
        Ok(Self { combinations: translations.chain(turning).collect(), turns: passing_turns })
    }

    /// Whether one of them moves a row.
    pub(super) fn moves(&self, motions: &Motions<'_>, row: usize) -> bool {
        let displacement = |motion: &[f64; 6]| (0..6).map(|j| motion[j] * motions.centred[(row, j)]).sum::<f64>();
        self.combinations.iter().any(|motion| displacement(motion).abs() > AT_REST)
    }
}
