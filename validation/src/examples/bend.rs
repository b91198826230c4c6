//! Section 5.1: a bend of 45 degrees, clamped at its root, with a dead load out of its plane at the tip.

use std::f64::consts::FRAC_PI_4;

use supel_runtime::Superelement;
use supel_runtime::component::FloatingFrame;

use super::run::Run;
use super::variant::Variant;
use crate::Result;
use crate::beam::{Section, arc};
use crate::curve::Curves;
use crate::integrator::Effort;
use crate::joint::{CLAMPED, FREE};
use crate::part::Part;
use crate::selection::{Modes, selected};
use crate::statics::{Tangent, equilibria};
use crate::system::{Formulation, Load, System};

const RADIUS: f64 = 100.0;
/// Finite elements of the whole arc.
const ELEMENTS: usize = 64;
/// Load of each of the steps, N.
const LOAD: f64 = 100.0;
const STEPS: usize = 10;

/// The arc in so many equal parts.
pub fn parts(layout: usize) -> Vec<Part> {
    // The example is static: the mass is any.
    let section = Section {
        axial: 1e7,
        shear: [4.167e6; 2],
        torsion: 8.334e5,
        bending: [8.334e5; 2],
        mass: 1.0,
        inertia: [2.0, 1.0, 1.0],
    };
    let elements = ELEMENTS / layout;
    let share = |part: usize| part as f64 / layout as f64;
    let part = |number: usize| Part {
        name: format!("bend-{}-of-{layout}", number + 1),
        model: arc(RADIUS, FRAC_PI_4, [share(number), share(number + 1)], elements, &section),
        interface: vec![vec![1], vec![elements as i64 + 1]],
        recovered: Vec::new(),
        units: "m-kg-s",
        n_modes: 0,
    };
    (0..layout).map(part).collect()
}

/// Displacement of the tip under each load, with the static modes alone.
///
/// The floating frame is defined by Y = U of the reduced model, the mid-frame of the two nodes: it does not depend on the mesh.
///
/// # Errors
/// A superelement that the component refuses.
pub fn run(parts: &[Superelement], variant: &Variant, tangent: Tangent) -> Result<Run> {
    let static_ones = |part: &Superelement| selected(part, Modes::Free(0));
    let positions = ends(parts);
    let parts: Vec<Superelement> = parts.iter().map(static_ones).collect::<Result<_>>()?;
    let tip = parts.len();
    let nodes: Vec<[usize; 2]> = (0..tip).map(|j| [j, j + 1]).collect();
    let placed: Vec<_> = parts.iter().zip(&nodes).map(|(part, nodes)| (part, nodes.as_slice())).collect();
    let mut supports = vec![FREE; tip + 1];
    supports[0] = CLAMPED;
    let formulation = Formulation { frame: FloatingFrame::Rigid, measures: variant.measures };
    let mut system = System::new(positions, &supports, &placed, formulation)?;
    system.loads = vec![Load::force(tip, [0.0, 0.0, LOAD], |step| step)];
    let mut curves = Curves::new(&["load_N", "ux_m", "uy_m", "uz_m"]);
    let mut effort = Effort::default();
    let outcome = equilibria(&mut system, STEPS, tangent, |system, at, iterations| {
        let place = system.position(at, tip);
        let displacement = (0..3).map(|d| place[d] - system.positions[tip][d]).collect();
        effort.steps += 1;
        effort.iterations += iterations;
        effort.most = effort.most.max(iterations);
        curves.push(LOAD * effort.steps as f64, displacement);
    });
    Ok(Run { curves, effort, stopped: outcome.err().map(|why| why.to_string()) })
}

/// Places of the nodes along a chain of two-node parts.
fn ends(parts: &[Superelement]) -> Vec<[f64; 3]> {
    let first = parts.iter().take(1).map(|part| part.tensors().interface_positions[0]);
    first.chain(parts.iter().map(|part| part.tensors().interface_positions[1])).collect()
}
