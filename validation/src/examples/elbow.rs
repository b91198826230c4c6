//! Section 5.5: a right-angle beam, clamped at its root and loaded out of its plane at the elbow.

use supel_runtime::Superelement;
use supel_runtime::component::FloatingFrame;

use super::run::{Run, recorded};
use super::variant::Variant;
use crate::Result;
use crate::beam::{Section, polyline};
use crate::integrator::{IterationMatrix, Scheme};
use crate::joint::{CLAMPED, FREE};
use crate::part::Part;
use crate::selection::{Modes, selected};
use crate::system::{Formulation, Load, System};

/// Finite elements of each leg.
const ELEMENTS: usize = 32;
const ROOT: [f64; 3] = [0.0; 3];
const MIDDLES: [[f64; 3]; 2] = [[5.0, 0.0, 0.0], [10.0, 5.0, 0.0]];
const ELBOW: [f64; 3] = [10.0, 0.0, 0.0];
const TIP: [f64; 3] = [10.0, 10.0, 0.0];

/// The time integration of the paper. With a matrix that never changes the iteration fails in strategy 1, and in strategy 2
/// with modes: nodes turn so far in the floating frame that the axial stiffness enters their transverse directions.
pub const SCHEME: Scheme = Scheme {
    step: 0.01,
    n_steps: 3000,
    spectral_radius: 0.9,
    tolerance: 1e-4,
    floor: 1e-2,
    matrix: IterationMatrix::RenewedAfter(8),
};

/// Nodes of a strategy from root to tip, and the number of its elbow.
fn places(strategy: usize) -> (Vec<[f64; 3]>, usize) {
    if strategy == 3 { (vec![ROOT, MIDDLES[0], ELBOW, MIDDLES[1], TIP], 2) } else { (vec![ROOT, ELBOW, TIP], 1) }
}

/// Strategy 1: one part with three nodes; 2: the two legs; 3: the halves of the legs.
pub fn parts(strategy: usize) -> Vec<Part> {
    let section = Section {
        axial: 1e6,
        shear: [1e6; 2],
        torsion: 1e3,
        bending: [1e3; 2],
        mass: 1.0,
        // The polar inertia that goes with the two others, not given in the paper.
        inertia: [20.0, 10.0, 10.0],
    };
    let (places, _) = places(strategy);
    let elements = 2 * ELEMENTS / (places.len() - 1);
    let part = |number: usize, points: &[[f64; 3]]| Part {
        name: format!("elbow-{strategy}-{number}"),
        model: polyline(points, elements, &section),
        interface: (0..points.len()).map(|point| vec![(point * elements) as i64 + 1]).collect(),
        recovered: Vec::new(),
        units: "m-kg-s",
        n_modes: 12,
    };
    match strategy {
        1 => vec![part(1, &places)],
        _ => places.windows(2).enumerate().map(|(number, points)| part(number + 1, points)).collect(),
    }
}

/// Displacements of tip and elbow out of the plane; modes are free ones.
///
/// # Errors
/// A superelement that the component refuses.
pub fn run(parts: &[Superelement], variant: &Variant, scheme: &Scheme) -> Result<Run> {
    let modes = Modes::Free(variant.n_modes);
    let parts: Vec<Superelement> = parts.iter().map(|part| selected(part, modes)).collect::<Result<_>>()?;
    let (positions, elbow) = places(variant.layout);
    let tip = positions.len() - 1;
    let nodes: Vec<Vec<usize>> = match variant.layout {
        1 => vec![vec![0, elbow, tip]],
        _ => (0..tip).map(|j| vec![j, j + 1]).collect(),
    };
    let placed: Vec<_> = parts.iter().zip(&nodes).map(|(part, nodes)| (part, nodes.as_slice())).collect();
    let mut supports = vec![FREE; positions.len()];
    supports[0] = CLAMPED;
    let formulation = Formulation { frame: FloatingFrame::MassWeighted, measures: variant.measures };
    let mut system = System::new(positions, &supports, &placed, formulation)?;
    system.loads = vec![Load::force(elbow, [0.0, 0.0, 1.0], force)];
    Ok(recorded(system, scheme, 1, &["t_s", "tip_uz_m", "elbow_uz_m"], |system, now| {
        [tip, elbow].map(|node| system.position(&now.at, node)[2]).to_vec()
    }))
}

/// F(t) of (96), N.
fn force(time: f64) -> f64 {
    50.0 * time.min(2.0 - time).max(0.0)
}
