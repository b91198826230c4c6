//! Section 5.3: a beam on a spherical joint, driven by a moment and kicked out of its plane.

use supel_runtime::Superelement;
use supel_runtime::component::FloatingFrame;
use supel_runtime::motion::times_3;

use super::run::{Run, recorded};
use super::variant::Variant;
use crate::Result;
use crate::beam::{Section, polyline};
use crate::integrator::{IterationMatrix, Scheme};
use crate::joint::{FREE, SPHERICAL};
use crate::part::Part;
use crate::selection::{Modes, selected};
use crate::system::{Formulation, Load, System};

const LENGTH: f64 = 141.42;
const ELEMENTS: usize = 48;

/// The time integration of the paper.
pub const SCHEME: Scheme = Scheme {
    step: 0.02,
    n_steps: 2500,
    spectral_radius: 0.99,
    tolerance: 1e-6,
    floor: 10.0,
    matrix: IterationMatrix::Constant,
};

/// The beam as one part.
pub fn parts() -> Vec<Part> {
    let section = Section {
        axial: 18.9e6,
        shear: [7.27e6; 2],
        torsion: 10.9e6,
        bending: [14.175e6; 2],
        mass: 0.0702,
        inertia: [13.5, 6.75, 6.75],
    };
    let model = polyline(&[[0.0; 3], [LENGTH, 0.0, 0.0]], ELEMENTS, &section);
    vec![Part {
        name: "spherical".into(),
        model,
        interface: vec![vec![1], vec![ELEMENTS as i64 + 1]],
        recovered: Vec::new(),
        units: "m-kg-s",
        n_modes: 80,
    }]
}

/// Angular velocity of the root about the inertial z axis, and the place of the tip; modes are clamped at the root.
///
/// # Errors
/// A superelement that the component refuses.
pub fn run(parts: &[Superelement], variant: &Variant, scheme: &Scheme) -> Result<Run> {
    let [part] = parts else { return Err("the beam is one part".into()) };
    let part = selected(part, Modes::Held { node: 0, count: variant.n_modes })?;
    let formulation = Formulation { frame: FloatingFrame::MassWeighted, measures: variant.measures };
    let positions = vec![[0.0; 3], [LENGTH, 0.0, 0.0]];
    let mut system = System::new(positions, &[SPHERICAL, FREE], &[(&part, &[0, 1])], formulation)?;
    system.loads = vec![Load::moment(0, [0.0, 0.0, 1.0], moment), Load::force(1, [0.0, 0.0, 1.0], force)];
    let names = ["t_s", "root_omega_z_rad_s", "tip_x_m", "tip_y_m", "tip_z_m"];
    Ok(recorded(system, scheme, 1, &names, |system, now| {
        let spin = times_3(&now.at.motions[0].rotation, &[now.velocity[3], now.velocity[4], now.velocity[5]]);
        let [x, y, z] = system.position(&now.at, 1);
        vec![spin[2], x, y, z]
    }))
}

/// M(t) of (95), N m.
fn moment(time: f64) -> f64 {
    1000.0 * time.min(0.2).min(10.2 - time).max(0.0)
}

/// F(t) of (95), N.
fn force(time: f64) -> f64 {
    500.0 * (time - 15.0).min(15.4 - time).max(0.0)
}
