//! How far rows that are held, or that follow others, are in a result from where they have to be: C-10.
//!
//! ```text
//! v_i             the displacement of such a row in the file
//! (Tq)_i          what the dofs of the partition make of it; zero for a held row
//! |v_i − (Tq)_i|  relative to the largest displacement, of the file and in units of 1/√K_ii, whichever says more
//! ```

use crate::dense;
use crate::number::quantity;
use crate::partition::Partition;
use crate::verification::check::{Check, Limits};

/// Share of the largest displacement that practice does not see: penalties that are a million times as stiff let as much pass.
const FOLLOWS: f64 = 1e-6;
/// Share that is no penalty and no rounding: the result is that of other supports or constraints.
const STRAYS: f64 = 1e-4;
/// The most that digits excuse.
const MOST_EXCUSED: f64 = 1e-3;

/// The worst row of one shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Strayed {
    /// How far it is from where it has to be.
    pub(super) value: f64,
    /// How far the digits of the file may put it.
    pub(super) of_digits: f64,
    /// Which of the partition's followers it is.
    pub(super) follower: Option<usize>,
}

impl Strayed {
    fn limits(&self) -> Limits {
        let data = if self.of_digits > f64::EPSILON { self.of_digits } else { 0.0 };
        Limits { engineering: FOLLOWS, arithmetic: 0.0, data }.capped(0.0, MOST_EXCUSED)
    }

    /// Compared with what each may be.
    pub(super) fn is_worse_than(&self, other: &Self) -> bool {
        dense::worse(self.value / self.limits().value(), other.value / other.limits().value())
    }

    /// Whether a shape with it is none of the model.
    pub(super) fn fails(&self) -> bool {
        dense::worse(self.value, STRAYS.max(2.0 * self.limits().value()))
    }
}

/// C-10 of the shapes of a result, each called by its place in it; none where every row of the model is a dof.
pub(super) fn check(partition: &Partition, strayed: &[Strayed], name: impl Fn(usize) -> String) -> Option<Check> {
    let mut worst = (Strayed::default(), None);
    for (at, strayed) in strayed.iter().enumerate() {
        if strayed.is_worse_than(&worst.0) {
            worst = (*strayed, Some(at));
        }
    }
    let (found, at) = worst;
    let place = found.follower.zip(at).map(|(follower, at)| {
        let row = partition.followers[follower].name(&partition.model.rows);
        format!("{row} in {}, by {} of its largest displacement", name(at), quantity(found.value, 2))
    });
    (!partition.followers.is_empty()).then(|| Check {
        id: "C-10",
        name: "held and dependent rows stay in place",
        equation: "max |v − Tq| / max |v| over rows that are held or follow others, as in the file and equilibrated",
        value: found.value,
        limits: found.limits(),
        fail_above: STRAYS,
        worst: place,
    })
}
