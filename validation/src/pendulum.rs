//! A solid in large rotation: the bundled bracket, of a material as soft as rubber, swinging about the bore of its eye.
//!
//! Millimetre, tonne, second. The bore's axis is y; gravity acts along x, so that the bracket is let go from the horizontal
//! and swings through half a turn and back. There is no reference but the physics: energy is constant, and a finer basis
//! gives the same motion.

use std::path::Path;

use supel_models::{bracket, transform};
use supel_runtime::Superelement;
use supel_runtime::component::{FloatingFrame, Measures};

use crate::Result;
use crate::curve::Curves;
use crate::integrator::{Effort, IterationMatrix, Scheme, simulate};
use crate::joint::{CLAMPED, FREE, Support};
use crate::part::{Part, reduced};
use crate::system::{Formulation, System};

/// Stiffness as a share of steel's: 21 MPa. The first free frequency falls from 1513 Hz to 15 Hz, ten times that of the
/// swing.
const SOFTNESS: f64 = 1e-4;
/// mm/s².
const GRAVITY: f64 = 9810.0;

/// Without numerical damping, so that energy shows the error of the scheme.
pub const SCHEME: Scheme = Scheme {
    step: 1e-3,
    n_steps: 2000,
    spectral_radius: 1.0,
    tolerance: 1e-8,
    floor: 1e-3,
    matrix: IterationMatrix::Constant,
};

/// The bracket with both of its rigid patches: the walls of the bolt holes and of the bore.
pub fn part(n_modes: usize) -> Part {
    let model = transform::scaled(&bracket(), SOFTNESS, 1.0);
    let interface = ["BASE", "EYE"].map(|name| model.groups[name].clone()).to_vec();
    Part { name: format!("bracket-{n_modes}"), model, interface, units: "mm-t-s", n_modes }
}

/// A swing: place of the base's middle, and kinetic, strain, potential energy and their sum.
#[derive(Clone, Debug)]
pub struct Swing {
    /// What was recorded at every step.
    pub curves: Curves,
    /// What it took.
    pub effort: Effort,
}

/// Reduces the bracket and lets it swing.
///
/// # Errors
/// Those of the reduction; a step that does not converge.
pub fn swing(folder: &Path, n_modes: usize, scheme: &Scheme) -> Result<Swing> {
    let part = part(n_modes);
    let superelement = reduced(&part.write(&folder.join(&part.name))?)?;
    swing_of(&superelement, scheme)
}

/// Lets the bracket of a superelement swing.
///
/// # Errors
/// A superelement that the component refuses; a step that does not converge.
pub fn swing_of(superelement: &Superelement, scheme: &Scheme) -> Result<Swing> {
    let mut hinge = CLAMPED;
    hinge[4] = Support::Free;
    let formulation = Formulation { frame: FloatingFrame::MassWeighted, measures: Measures::MotionBased };
    let positions = superelement.tensors().interface_positions.clone();
    let mut system = System::new(positions, &[FREE, hinge], &[(superelement, &[0, 1])], formulation)?;
    system.gravity = [GRAVITY, 0.0, 0.0];
    let mut curves = Curves::new(&[
        "t_s",
        "base_x_mm",
        "base_y_mm",
        "base_z_mm",
        "kinetic_mJ",
        "strain_mJ",
        "potential_mJ",
        "sum_mJ",
    ]);
    let effort = simulate(&mut system, scheme, |system, now| {
        let energies = system.energies();
        let mut row = system.position(&now.at, 0).to_vec();
        row.extend(energies);
        row.push(energies.iter().sum());
        curves.push(now.time, row);
    })?;
    Ok(Swing { curves, effort })
}
