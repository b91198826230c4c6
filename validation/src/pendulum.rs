//! A solid in large rotation: the bundled bracket, of a material as soft as rubber, swinging about the bore of its eye.
//!
//! Millimetre, tonne, second. The bore's axis is y; gravity acts along x, so that the bracket is let go from the horizontal
//! and swings through half a turn and back. There is no reference but the physics: energy is constant, and a finer basis
//! gives the same motion.

use std::path::Path;

use supel_models::{bracket, bracket_mesh, transform};
use supel_runtime::Superelement;
use supel_runtime::component::{FloatingFrame, Measures};

use crate::Result;
use crate::curve::Curves;
use crate::film::{Frame, strip};
use crate::integrator::{Effort, IterationMatrix, Scheme, simulate};
use crate::joint::{CLAMPED, FREE, Support};
use crate::part::{Part, reduced};
use crate::system::{Formulation, System};

/// Stiffness as a share of steel's: 21 MPa. The first free frequency falls from 1513 Hz to 15 Hz, ten times that of the
/// swing; the bracket is thick, and the strain energy stays below half a per cent of the kinetic.
const SOFTNESS: f64 = 1e-4;
/// mm/s².
pub const GRAVITY: f64 = 9810.0;

/// z of the bore's axis, mm.
pub const HINGE: f64 = 112.0;

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
    let recovered = (1..=model.nodes.len() as i64).collect();
    Part { name: format!("bracket-{n_modes}"), model, interface, recovered, units: "mm-t-s", n_modes }
}

/// A swing: place of the base's middle, and kinetic, strain, potential energy and their sum.
#[derive(Clone, Debug)]
pub struct Swing {
    /// What was recorded at every step.
    pub curves: Curves,
    /// What it took.
    pub effort: Effort,
    /// The whole bracket at the instants asked for.
    pub frames: Vec<Frame>,
}

/// The bracket reduced, with all of its nodes recovered.
///
/// # Errors
/// The errors of the reduction.
pub fn superelement(folder: &Path, n_modes: usize) -> Result<Superelement> {
    let part = part(n_modes);
    let job = part.write(&folder.join(&part.name))?;
    reduced(&job)
}

/// Lets the bracket of a superelement swing; every so many steps a frame of the film is kept.
///
/// # Errors
/// A superelement that the component refuses or that recovers other nodes than the bracket's; a step that does not converge.
pub fn swing(superelement: &Superelement, scheme: &Scheme, steps_of_frame: usize) -> Result<Swing> {
    let nodes = bracket_mesh().nodes;
    let mut frames = Vec::new();
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
    let mut failed = None;
    let effort = simulate(&mut system, scheme, |system, now| {
        if curves.times.len().is_multiple_of(steps_of_frame) {
            match frame(system, &nodes, now.time) {
                Ok(frame) => frames.push(frame),
                Err(why) => failed = Some(why),
            }
        }
        match system.energies() {
            Ok(energies) => {
                let mut row = system.position(&now.at, 0).to_vec();
                row.extend(energies);
                row.push(energies.iter().sum());
                curves.push(now.time, row);
            }
            Err(why) => failed = Some(why),
        }
    })?;
    match failed {
        None => Ok(Swing { curves, effort, frames }),
        Some(why) => Err(why),
    }
}

fn frame(system: &System, nodes: &[[f64; 3]], time: f64) -> Result<Frame> {
    let (recovered, floating) = system.interior(0, nodes)?;
    let places: Vec<[f64; 3]> =
        nodes.iter().zip(&recovered).map(|(x, node)| std::array::from_fn(|d| x[d] + node.displacement[d])).collect();
    let away = |(place, x): (&[f64; 3], &[f64; 3])| {
        let rigid = floating.apply(x);
        (0..3).map(|d| (place[d] - rigid[d]).powi(2)).sum::<f64>().sqrt()
    };
    let deformations = places.iter().zip(nodes).map(away).collect();
    Ok(Frame { time, places, deformations })
}

/// Swings of one bracket with static modes alone, with twenty, and with sixty modes.
#[derive(Clone, Debug)]
pub struct Pendulum {
    /// Numbers of modes and swings, the finest last.
    pub swings: Vec<(usize, Swing)>,
}

/// What a swing shows.
#[derive(Clone, Copy, Debug)]
pub struct Figures {
    /// Elastic modes.
    pub n_modes: usize,
    /// Largest change of energy as a share of the largest kinetic energy.
    pub of_kinetic: f64,
    /// Largest change of energy as a share of the largest strain energy.
    pub of_strain: f64,
    /// Largest distance of a coordinate of the base from the finest swing, as a share of its largest value.
    pub away: f64,
    /// Mean iterations per step.
    pub iterations: f64,
}

impl Pendulum {
    /// Reduces and swings in folders of their own below `folder`; a frame of the film every 10 ms.
    ///
    /// # Errors
    /// The errors of [`superelement`] and [`swing`].
    pub fn new(folder: &Path) -> Result<Self> {
        let one = |n_modes| Ok((n_modes, swing(&superelement(folder, n_modes)?, &SCHEME, 10)?));
        Ok(Self { swings: [0, 20, 60].into_iter().map(one).collect::<Result<_>>()? })
    }

    /// What each swing shows.
    pub fn figures(&self) -> Vec<Figures> {
        let Some((_, finest)) = self.swings.last() else { return Vec::new() };
        let figures = |(n_modes, swing): &(usize, Swing)| {
            let largest = |column| swing.curves.column(column).into_iter().fold(0.0, f64::max);
            let sum = swing.curves.column(6);
            let change = sum.iter().map(|energy| (energy - sum[0]).abs()).fold(0.0, f64::max);
            let away = |axis| swing.curves.misfit(axis, (&finest.curves, axis), [0.0, f64::INFINITY]).max;
            Figures {
                n_modes: *n_modes,
                of_kinetic: change / largest(3),
                of_strain: change / largest(4),
                away: f64::max(away(0), away(2)),
                iterations: swing.effort.mean(),
            }
        };
        self.swings.iter().map(figures).collect()
    }

    /// Five frames of the swing with twenty modes, from the start to the far side.
    pub fn film(&self) -> String {
        let frames: Vec<Frame> = self.swings[1].1.frames.iter().step_by(10).take(5).cloned().collect();
        film(&frames)
    }
}

/// The film strip of a swing.
pub fn film(frames: &[Frame]) -> String {
    // The bore's axis is at x = 0; the base swings 106 mm about it, and its plate is 160 wide.
    strip(&bracket_mesh(), frames, [20.0, HINGE], 150.0)
}
