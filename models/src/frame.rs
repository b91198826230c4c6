//! FRAME: Euler-Bernoulli beams in space, six dofs a node.

use crate::model::{Assembler, Material, Model, cross};
use crate::two_node::{Element, add_rod, place, to_global};

/// Cross-section of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Area A.
    pub area: f64,
    /// Second moment of area about the local y axis, bending in the local x-z plane.
    pub second_moment_y: f64,
    /// Second moment of area about the local z axis, bending in the local x-y plane.
    pub second_moment_z: f64,
    /// Torsion constant J.
    pub torsion: f64,
}

impl Section {
    /// A round bar.
    pub fn round(radius: f64) -> Self {
        let second_moment = std::f64::consts::PI * radius.powi(4) / 4.0;
        Self {
            area: std::f64::consts::PI * radius * radius,
            second_moment_y: second_moment,
            second_moment_z: second_moment,
            torsion: 2.0 * second_moment,
        }
    }
}

/// The mass matrix of a beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// From the shape functions of the stiffness.
    Consistent,
    /// Half of the mass at each end, rotations massless: M is singular of rank n/2.
    LumpedTranslations,
}

/// FRAME(nodes, edges): one beam for each edge, free.
///
/// The local y axis lies in the plane of the beam and the global axis least aligned with it, the first on ties.
///
/// # Panics
/// If an edge names a node that does not exist or has no length.
pub fn frame(
    nodes: &[[f64; 3]],
    edges: &[[usize; 2]],
    section: &Section,
    material: &Material,
    inertia: Inertia,
) -> Model {
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for &[start, end] in edges {
        let along: [f64; 3] = std::array::from_fn(|d| nodes[end][d] - nodes[start][d]);
        let length = norm(along);
        assert!(length > 0.0, "the beam from node {start} to node {end} has no length");
        let axes = local_axes(along.map(|x| x / length));
        let dofs: [u32; 12] = std::array::from_fn(|i| (6 * if i < 6 { start } else { end } + i % 6) as u32);
        stiffness.add_element(&dofs, &to_global(&beam_stiffness(section, material, length), &axes));
        let local_mass = match inertia {
            Inertia::Consistent => beam_mass(section, material, length),
            Inertia::LumpedTranslations => lumped_mass(section, material, length),
        };
        mass.add_element(&dofs, &to_global(&local_mass, &axes));
    }
    Model::node_major(nodes.to_vec(), &[0, 1, 2, 3, 4, 5], stiffness, mass)
}

/// Rows and columns of deflection and slope at both ends: in the x-y plane, and in the x-z plane, where a positive
/// rotation lowers the end.
const BENDING: [([usize; 4], f64); 2] = [([1, 5, 7, 11], 1.0), ([2, 4, 8, 10], -1.0)];

fn beam_stiffness(section: &Section, material: &Material, length: f64) -> Element {
    let mut k = [[0.0; 12]; 12];
    let shear_modulus = material.young / (2.0 * (1.0 + material.poisson));
    add_rod(&mut k, 0, [material.young * section.area / length, -material.young * section.area / length]);
    add_rod(&mut k, 3, [shear_modulus * section.torsion / length, -shear_modulus * section.torsion / length]);
    for ((rows, sign), second_moment) in BENDING.iter().zip([section.second_moment_z, section.second_moment_y]) {
        let (one, slope) = (material.young * second_moment / length.powi(3), sign * length);
        let shape = [
            [12.0, 6.0 * slope, -12.0, 6.0 * slope],
            [6.0 * slope, 4.0 * slope * slope, -6.0 * slope, 2.0 * slope * slope],
            [-12.0, -6.0 * slope, 12.0, -6.0 * slope],
            [6.0 * slope, 2.0 * slope * slope, -6.0 * slope, 4.0 * slope * slope],
        ];
        place(&mut k, rows, &shape, one);
    }
    k
}

fn beam_mass(section: &Section, material: &Material, length: f64) -> Element {
    let mut m = [[0.0; 12]; 12];
    let total = material.density * section.area * length;
    let polar = material.density * (section.second_moment_y + section.second_moment_z) * length;
    add_rod(&mut m, 0, [total / 3.0, total / 6.0]);
    add_rod(&mut m, 3, [polar / 3.0, polar / 6.0]);
    for (rows, sign) in &BENDING {
        let slope = sign * length;
        let shape = [
            [156.0, 22.0 * slope, 54.0, -13.0 * slope],
            [22.0 * slope, 4.0 * slope * slope, 13.0 * slope, -3.0 * slope * slope],
            [54.0, 13.0 * slope, 156.0, -22.0 * slope],
            [-13.0 * slope, -3.0 * slope * slope, -22.0 * slope, 4.0 * slope * slope],
        ];
        place(&mut m, rows, &shape, total / 420.0);
    }
    m
}

fn lumped_mass(section: &Section, material: &Material, length: f64) -> Element {
    let mut m = [[0.0; 12]; 12];
    for row in [0, 1, 2, 6, 7, 8] {
        m[row][row] = material.density * section.area * length / 2.0;
    }
    m
}

/// The local axes as rows.
fn local_axes(x: [f64; 3]) -> [[f64; 3]; 3] {
    let least = (1..3).fold(0, |least, d| if x[d].abs() < x[least].abs() { d } else { least });
    let mut reference = [0.0; 3];
    reference[least] = 1.0;
    let z = cross(x, reference);
    let z = z.map(|c| c / norm(z));
    [x, cross(z, x), z]
}

fn norm(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::spectrum;

    #[test]
    fn free_beam_has_the_classical_roots() {
        // Roots of cos βL cosh βL = 1; a slender round bar, so that Euler-Bernoulli bending comes in equal pairs below
        // the first torsional and axial modes.
        let (length, section, material) = (2.0, Section::round(0.01), Material::STEEL_SI);
        let elements = 16;
        // Along a slanted line, so that the change of axes is tested too.
        let direction = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
        let nodes: Vec<[f64; 3]> =
            (0..=elements).map(|i| direction.map(|d| d * length * f64::from(i) / f64::from(elements))).collect();
        let edges: Vec<[usize; 2]> = (0..elements as usize).map(|i| [i, i + 1]).collect();
        let lambda = spectrum(&frame(&nodes, &edges, &section, &material, Inertia::Consistent));
        assert!(lambda[5].abs() < 1e-6 * lambda[6], "six rigid-body modes: {:e} of {:e}", lambda[5], lambda[6]);
        let unit = material.young * section.second_moment_y / (material.density * section.area * length.powi(4));
        for (pair, beta) in [4.730_041, 7.853_205, 10.995_608].into_iter().enumerate() {
            for mode in [6 + 2 * pair, 7 + 2 * pair] {
                let found = (lambda[mode] / unit).powf(0.25);
                // Cubic elements converge as (βh)⁴/720 in β², below 1e-4 here, and from above but for the seven digits.
                let bound = (beta / f64::from(elements)).powi(4) / 720.0 + 1e-6;
                assert!((found / beta - 1.0).abs() < bound, "mode {mode}: {found} for {beta}");
            }
        }
    }
}
