//! Section 5.4: a flexible slider-crank mechanism, driven for 5 s and then locked, in the plane.

use std::f64::consts::PI;

use supel_runtime::Superelement;
use supel_runtime::component::FloatingFrame;

use super::run::{Run, recorded, seen_from};
use super::variant::Variant;
use crate::Result;
use crate::beam::{Section, polyline};
use crate::integrator::{IterationMatrix, Scheme};
use crate::joint::{Joint, Kind, PLANAR, Side, driven_pin};
use crate::part::Part;
use crate::selection::{Modes, selected};
use crate::system::{Formulation, System};

const EA: f64 = 11.2e9;
/// Shear stiffness, which the paper does not give: 5/6 of EA / 2.6.
const GA: f64 = EA / 2.6 * 5.0 / 6.0;
/// Finite elements of the crank and of the rod.
const ELEMENTS: usize = 32;
/// Time of the lock, s.
const LOCK: f64 = 5.0;
/// φ̈ before the lock, rad/s².
const ACCELERATION: f64 = 6.0 * PI / 50.0;

/// The time integration of the paper. With a matrix that never changes the iteration with modes fails after the lock.
pub const SCHEME: Scheme = Scheme {
    step: 1e-3,
    n_steps: 10_000,
    spectral_radius: 0.95,
    tolerance: 1e-5,
    floor: 1e3,
    matrix: IterationMatrix::RenewedAfter(8),
};

/// Crank and rod, each with a node in its middle.
pub fn parts() -> Vec<Part> {
    let section = Section::planar(EA, GA, 149.3e6, 432.0, 5.759);
    let part = |name: &str, from: f64, to: f64| Part {
        name: format!("crank-{name}"),
        model: polyline(&[[from, 0.0, 0.0], [to, 0.0, 0.0]], ELEMENTS, &section),
        interface: vec![vec![1], vec![ELEMENTS as i64 / 2 + 1], vec![ELEMENTS as i64 + 1]],
        recovered: Vec::new(),
        units: "m-kg-s",
        n_modes: 12,
    };
    vec![part("crank", 0.0, 10.0), part("rod", 10.0, 30.0)]
}

/// Transverse displacements of the middles of crank and rod, each in the axes of its body's root; modes are free ones.
///
/// # Errors
/// A superelement that the component refuses.
pub fn run(parts: &[Superelement], variant: &Variant, scheme: &Scheme) -> Result<Run> {
    let modes = Modes::Free(variant.n_modes);
    let parts: Vec<Superelement> = parts.iter().map(|part| selected(part, modes)).collect::<Result<_>>()?;
    let [crank, rod] = parts.as_slice() else { return Err("a crank and a rod".into()) };
    let positions = [0.0, 5.0, 10.0, 10.0, 20.0, 30.0].map(|x| [x, 0.0, 0.0]);
    let mut supports = [PLANAR; 6];
    supports[0] = driven_pin(angle, ACCELERATION);
    let formulation = Formulation { frame: FloatingFrame::MassWeighted, measures: variant.measures };
    let mut system =
        System::new(positions.to_vec(), &supports, &[(crank, &[0, 1, 2]), (rod, &[3, 4, 5])], formulation)?;
    let pin = Kind::Revolute { axis: [0.0, 0.0, 1.0] };
    let slider = Kind::PointOnPlane { normal: [0.0, 1.0, 0.0] };
    system.joints = vec![
        Joint { kind: pin, sides: [Side::Node(2), Side::Node(3)], point: positions[2] },
        Joint { kind: slider, sides: [Side::Node(5), Side::Ground], point: positions[5] },
    ];
    let names = ["t_s", "M_transverse_m", "N_transverse_m"];
    Ok(recorded(system, scheme, 2, &names, |system, now| {
        let transverse = |root: usize, middle: usize| {
            let [root_at, middle_at] = [root, middle].map(|node| system.position(&now.at, node));
            seen_from(&now.at.motions[root], &root_at, &middle_at)[1]
        };
        vec![transverse(0, 1), transverse(3, 4)]
    }))
}

/// φ(t), rad: 270 degrees at the lock.
fn angle(time: f64) -> f64 {
    0.5 * ACCELERATION * time.min(LOCK).powi(2)
}
