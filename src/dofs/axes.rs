//! Axes from two directions, and how many digits they were given with.

use std::collections::BTreeMap;
use std::path::PathBuf;

/// Three axes, each by its components along those of the model.
pub(crate) type Axes = [[f64; 3]; 3];

/// Sine of the angle between two directions below which they are one: coordinates of six digits tell no less.
const PARALLEL: f64 = 1e-6;

/// Right-handed axes: the first along a direction, the second along the part of another that is perpendicular to it. None where the
/// directions are parallel, or one is nothing.
pub(crate) fn spanned(first: [f64; 3], second: [f64; 3]) -> Option<Axes> {
    let (a, b) = (unit(first), unit(second));
    let part: f64 = (0..3).map(|i| a[i] * b[i]).sum();
    let across: [f64; 3] = std::array::from_fn(|i| b[i] - part * a[i]);
    let size = across.iter().map(|value| value * value).sum::<f64>().sqrt();
    if size.is_nan() || size <= PARALLEL {
        return None;
    }
    let b = unit(across);
    Some([a, b, cross(a, b)])
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A vector of length one, whatever the size of its components.
pub(crate) fn unit(vector: [f64; 3]) -> [f64; 3] {
    let largest = vector.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
    let scaled = vector.map(|value| value / largest);
    let length = scaled.iter().map(|value| value * value).sum::<f64>().sqrt();
    scaled.map(|value| value / length)
}

/// Axes of nodes that look rounded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoundedAxes {
    /// The table.
    pub path: PathBuf,
    /// The nodes, by label.
    pub of_node: BTreeMap<i64, AxisDigits>,
}

/// The digits of the axes of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisDigits {
    /// Line of the table, from 1.
    pub line: u64,
    /// Decimals of their components.
    pub decimals: i32,
}

impl AxisDigits {
    /// Decimals that leave an angle of a hundred-thousandth: little enough for what stands at these nodes.
    pub const ENOUGH: i32 = 5;

    /// What components may be off by: half a unit of the last decimal.
    pub fn off(self) -> f64 {
        0.5 * 10f64.powi(-self.decimals)
    }

    /// Whether what the digits leave open is little. Fewer are refused where the stiffness shows that the axes are off.
    pub fn are_enough(self) -> bool {
        self.decimals >= Self::ENOUGH
    }
}

impl RoundedAxes {
    /// The node with the fewest digits of those that have enough.
    pub fn coarsest_of_enough(&self) -> Option<(i64, AxisDigits)> {
        let enough = self.of_node.iter().filter(|(_, digits)| digits.are_enough());
        enough.min_by_key(|(_, digits)| digits.decimals).map(|(node, digits)| (*node, *digits))
    }
}
