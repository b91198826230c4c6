//! Linear Timoshenko beams in the plane z = 0: two-node elements, six dofs a node.
//!
//! Stiffness is that of the exact static solution, Φ = 12 EI / (GA L²); mass is consistent with the same shape functions
//! and includes the inertia of rotating cross-sections.

use supel_models::two_node::{Element, add_rod, place, to_global};
use supel_models::{Assembler, Model};

/// Cross-section of a beam, as stiffnesses and inertias along its axis.
///
/// Local axes: 1 along the beam, 3 along the global z axis, 2 = 3 × 1. Bending "about 3" is bending in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// EA, N.
    pub axial: f64,
    /// GA along 2 and 3, N.
    pub shear: [f64; 2],
    /// GJ, N m².
    pub torsion: f64,
    /// EI about 2 and about 3, N m².
    pub bending: [f64; 2],
    /// Mass per length, kg/m.
    pub mass: f64,
    /// Rotary inertia per length about 1, 2 and 3, kg m.
    pub inertia: [f64; 3],
}

impl Section {
    /// A section for motion in the plane alone.
    ///
    /// Out of the plane it is 1000 times stiffer in bending and in shear, and as stiff in torsion as it bends there: the
    /// frequencies of that bending, 32 times higher, lie above the third one in the plane (5.4 times the first for a free
    /// beam, 17.5 times for a clamped one), so that the lowest three modes are bending modes in the plane. Planar motion
    /// does not see these stiffnesses.
    pub fn planar(axial: f64, shear: f64, bending: f64, mass: f64, inertia: f64) -> Self {
        Self {
            axial,
            shear: [shear, OUT_OF_PLANE * shear],
            torsion: OUT_OF_PLANE * bending,
            bending: [OUT_OF_PLANE * bending, bending],
            mass,
            inertia: [inertia; 3],
        }
    }
}

/// How much stiffer a planar section is out of its plane.
const OUT_OF_PLANE: f64 = 1000.0;

/// Beams through the points in their order, `elements` straight ones between each two, free at both ends.
///
/// Nodes are labelled 1, 2, … along the line.
///
/// # Panics
/// If a point is off the plane z = 0 or repeats the one before it.
pub fn polyline(points: &[[f64; 3]], elements: usize, section: &Section) -> Model {
    let mut nodes: Vec<[f64; 3]> = points.first().copied().into_iter().collect();
    for ends in points.windows(2) {
        let share = |e: usize| (e + 1) as f64 / elements as f64;
        let between = |e| std::array::from_fn(|d| ends[0][d] + (ends[1][d] - ends[0][d]) * share(e));
        nodes.extend((0..elements).map(between));
    }
    through(&nodes, section)
}

/// A circular arc of `elements` chords from the origin, tangent to x there and curving to y; the part between two shares
/// of its angle.
pub fn arc(radius: f64, angle: f64, [from, to]: [f64; 2], elements: usize, section: &Section) -> Model {
    let at = |e: usize| {
        let phi = angle * (from + (to - from) * e as f64 / elements as f64);
        [radius * phi.sin(), radius * (1.0 - phi.cos()), 0.0]
    };
    through(&(0..=elements).map(at).collect::<Vec<_>>(), section)
}

fn through(nodes: &[[f64; 3]], section: &Section) -> Model {
    assert!(nodes.iter().all(|x| x[2] == 0.0), "these beams lie in the plane z = 0");
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for (start, ends) in nodes.windows(2).enumerate() {
        let along: [f64; 3] = std::array::from_fn(|d| ends[1][d] - ends[0][d]);
        let length = along[0].hypot(along[1]);
        assert!(length > 0.0, "the beam from node {start} has no length");
        let (c, s) = (along[0] / length, along[1] / length);
        let axes = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]];
        let dofs: [u32; 12] = std::array::from_fn(|i| (6 * start + i) as u32);
        stiffness.add_element(&dofs, &to_global(&local_stiffness(section, length), &axes));
        mass.add_element(&dofs, &to_global(&local_mass(section, length), &axes));
    }
    Model::node_major(nodes.to_vec(), &[0, 1, 2, 3, 4, 5], stiffness, mass)
}

/// One plane of bending: deflection and slope at both ends, and the sign of the slope. In the plane of 1 and 3 a positive
/// rotation lowers the end.
struct Plane {
    rows: [usize; 4],
    sign: f64,
    shear: f64,
    bending: f64,
    rotary: f64,
}

fn planes(section: &Section) -> [Plane; 2] {
    let [shear, bending, inertia] = [section.shear, section.bending, [section.inertia[1], section.inertia[2]]];
    [
        Plane { rows: [1, 5, 7, 11], sign: 1.0, shear: shear[0], bending: bending[1], rotary: inertia[1] },
        Plane { rows: [2, 4, 8, 10], sign: -1.0, shear: shear[1], bending: bending[0], rotary: inertia[0] },
    ]
}

fn local_stiffness(section: &Section, length: f64) -> Element {
    let mut k = [[0.0; 12]; 12];
    add_rod(&mut k, 0, [section.axial / length, -section.axial / length]);
    add_rod(&mut k, 3, [section.torsion / length, -section.torsion / length]);
    for plane in planes(section) {
        let phi = 12.0 * plane.bending / (plane.shear * length * length);
        let l = plane.sign * length;
        let (near, far) = ((4.0 + phi) * l * l, (2.0 - phi) * l * l);
        let shape = [
            [12.0, 6.0 * l, -12.0, 6.0 * l],
            [6.0 * l, near, -6.0 * l, far],
            [-12.0, -6.0 * l, 12.0, -6.0 * l],
            [6.0 * l, far, -6.0 * l, near],
        ];
        place(&mut k, &plane.rows, &shape, plane.bending / (length.powi(3) * (1.0 + phi)));
    }
    k
}

fn local_mass(section: &Section, length: f64) -> Element {
    let mut m = [[0.0; 12]; 12];
    let (total, polar) = (section.mass * length, section.inertia[0] * length);
    add_rod(&mut m, 0, [total / 3.0, total / 6.0]);
    add_rod(&mut m, 3, [polar / 3.0, polar / 6.0]);
    for plane in planes(section) {
        let phi = 12.0 * plane.bending / (plane.shear * length * length);
        let l = plane.sign * length;
        let square = (1.0 + phi).powi(2);
        place(&mut m, &plane.rows, &translation_shape(phi, l), total / square);
        place(&mut m, &plane.rows, &rotation_shape(phi, l), plane.rotary / (length * square));
    }
    m
}

/// ∫ N_w N_wᵀ (1 + Φ)² / L with the shape functions of the exact static solution.
fn translation_shape(phi: f64, l: f64) -> [[f64; 4]; 4] {
    let of = |c: [f64; 3]| c[0] + c[1] * phi + c[2] * phi * phi;
    let ww = of([13.0 / 35.0, 7.0 / 10.0, 1.0 / 3.0]);
    let wt = of([11.0 / 210.0, 11.0 / 120.0, 1.0 / 24.0]) * l;
    let ww_far = of([9.0 / 70.0, 3.0 / 10.0, 1.0 / 6.0]);
    let wt_far = of([13.0 / 420.0, 3.0 / 40.0, 1.0 / 24.0]) * l;
    let tt = of([1.0 / 105.0, 1.0 / 60.0, 1.0 / 120.0]) * l * l;
    let tt_far = -of([1.0 / 140.0, 1.0 / 60.0, 1.0 / 120.0]) * l * l;
    [[ww, wt, ww_far, -wt_far], [wt, tt, wt_far, tt_far], [ww_far, wt_far, ww, -wt], [-wt_far, tt_far, -wt, tt]]
}

/// ∫ N_θ N_θᵀ L (1 + Φ)².
fn rotation_shape(phi: f64, l: f64) -> [[f64; 4]; 4] {
    let wt = (0.1 - phi / 2.0) * l;
    let tt = (2.0 / 15.0 + phi / 6.0 + phi * phi / 3.0) * l * l;
    let tt_far = (-1.0 / 30.0 - phi / 6.0 + phi * phi / 6.0) * l * l;
    [[1.2, wt, -1.2, wt], [wt, tt, -wt, tt_far], [-1.2, -wt, 1.2, -wt], [wt, tt_far, -wt, tt]]
}

#[cfg(test)]
mod tests {
    use supel_models::model::{dot, multiply};

    use super::*;

    const SECTION: Section = Section {
        axial: 3e4,
        shear: [5e3, 4e3],
        torsion: 70.0,
        bending: [200.0, 300.0],
        mass: 2.0,
        inertia: [0.9, 0.3, 0.6],
    };

    #[test]
    fn clamped_beam_deflects_as_timoshenko_says() {
        // One element, clamped at node 1: K of the free end gives P L³/3EI + P L/GA exactly, in both planes.
        let length = 1.7;
        let k = local_stiffness(&SECTION, length);
        for (w, theta, bending, shear) in [(7, 11, 300.0, 5e3), (8, 10, 200.0, 4e3)] {
            let [[a, b], [_, d]] = [[k[w][w], k[w][theta]], [k[theta][w], k[theta][theta]]];
            let deflection = d / (a * d - b * b);
            let expected = length.powi(3) / (3.0 * bending) + length / shear;
            assert!((deflection / expected - 1.0).abs() < 1e-13, "{deflection} for {expected}");
        }
    }

    #[test]
    fn rigid_motions_have_no_energy_and_the_inertia_of_a_rod() {
        let length = 3.0;
        let model = polyline(&[[0.0; 3], [length, 0.0, 0.0]], 2, &SECTION);
        let modes = model.rigid_body_modes();
        let stiffest = model.stiffness.iter().fold(0.0, |size: f64, entry| size.max(entry.2.abs()));
        for mode in &modes {
            let force = multiply(&model.stiffness, mode);
            assert!(force.iter().all(|f| f.abs() < 1e-12 * stiffest), "a rigid motion is resisted");
        }
        let inertia = |mode: &Vec<f64>| dot(mode, &multiply(&model.mass, mode));
        let expected = [
            SECTION.mass * length,
            SECTION.mass * length,
            SECTION.mass * length,
            SECTION.inertia[0] * length,
            SECTION.inertia[1] * length + SECTION.mass * length.powi(3) / 3.0,
            SECTION.inertia[2] * length + SECTION.mass * length.powi(3) / 3.0,
        ];
        for (mode, expected) in modes.iter().zip(expected) {
            let found = inertia(mode);
            assert!((found / expected - 1.0).abs() < 1e-13, "{found} for {expected}");
        }
    }

    #[test]
    fn elements_of_an_arc_lie_on_it() {
        let model = arc(100.0, std::f64::consts::FRAC_PI_4, [0.5, 1.0], 8, &SECTION);
        for [x, y, _] in &model.nodes {
            assert!((x.hypot(y - 100.0) - 100.0).abs() < 1e-12);
        }
        let end = model.nodes.last().expect("nodes");
        let diagonal = 100.0 * std::f64::consts::FRAC_1_SQRT_2;
        assert!((end[0] - diagonal).abs() < 1e-12 && (end[1] - (100.0 - diagonal)).abs() < 1e-12);
    }
}
