//! Section 5.2: a beam that is spun up about a pin, in the plane.

use std::f64::consts::TAU;

use supel_runtime::Superelement;
use supel_runtime::component::FloatingFrame;

use super::run::{Run, recorded, seen_from};
use super::variant::Variant;
use crate::Result;
use crate::beam::{Section, polyline};
use crate::integrator::{IterationMatrix, Scheme};
use crate::joint::{PLANAR, driven_pin};
use crate::part::Part;
use crate::selection::{Modes, selected};
use crate::system::{Formulation, System};

const LENGTH: f64 = 8.0;
/// Finite elements of the whole beam.
const ELEMENTS: usize = 64;
/// Time of the spin-up, s.
const SPIN_UP: f64 = 15.0;
/// Angle ωT of (94), rad.
const ANGLE: f64 = 60.0;

/// The time integration of the paper.
pub const SCHEME: Scheme = Scheme {
    step: 2e-3,
    n_steps: 10_000,
    spectral_radius: 0.0,
    tolerance: 1e-6,
    floor: 1.0,
    matrix: IterationMatrix::Constant,
};

/// The beam in so many equal parts.
pub fn parts(layout: usize) -> Vec<Part> {
    let section = Section::planar(5.03e6, 1.94e6, 566.0, 0.201, 2.27e-5);
    let (elements, ends) = (ELEMENTS / layout, places(layout));
    let part = |(number, ends): (usize, &[[f64; 3]])| Part {
        name: format!("rotating-{}-of-{layout}", number + 1),
        model: polyline(ends, elements, &section),
        interface: vec![vec![1], vec![elements as i64 + 1]],
        recovered: Vec::new(),
        units: "m-kg-s",
        n_modes: 12,
    };
    ends.windows(2).enumerate().map(part).collect()
}

/// The tip in the axes of the root: transverse and axial displacement; modes are bending modes clamped at the root.
///
/// # Errors
/// A superelement that the component refuses.
pub fn run(parts: &[Superelement], variant: &Variant, scheme: &Scheme) -> Result<Run> {
    let modes = Modes::Held { node: 0, count: variant.n_modes };
    let parts: Vec<Superelement> = parts.iter().map(|part| selected(part, modes)).collect::<Result<_>>()?;
    let tip = parts.len();
    let mut supports = vec![PLANAR; tip + 1];
    supports[0] = driven_pin(angle, 0.0);
    let nodes: Vec<[usize; 2]> = (0..tip).map(|j| [j, j + 1]).collect();
    let placed: Vec<_> = parts.iter().zip(&nodes).map(|(part, nodes)| (part, nodes.as_slice())).collect();
    let formulation = Formulation { frame: FloatingFrame::MassWeighted, measures: variant.measures };
    let system = System::new(places(tip), &supports, &placed, formulation)?;
    let names = ["t_s", "tip_transverse_m", "tip_axial_m"];
    Ok(recorded(system, scheme, 5, &names, |system, now| {
        let [root, tip] = [0, tip].map(|node| system.position(&now.at, node));
        let seen = seen_from(&now.at.motions[0], &root, &tip);
        vec![seen[1], seen[0] - LENGTH]
    }))
}

fn places(layout: usize) -> Vec<[f64; 3]> {
    (0..=layout).map(|j| [LENGTH * j as f64 / layout as f64, 0.0, 0.0]).collect()
}

/// φ(t) of (94), rad.
fn angle(time: f64) -> f64 {
    let tau = time / SPIN_UP;
    if tau < 1.0 { ANGLE * (0.5 * tau * tau + ((TAU * tau).cos() - 1.0) / (TAU * TAU)) } else { ANGLE * (tau - 0.5) }
}
