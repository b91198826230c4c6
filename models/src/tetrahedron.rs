//! The straight-sided quadratic tetrahedron, three displacements at each of ten nodes, integrated exactly.

use crate::element::{ElementMatrices, add_block, elastic_block, invert3, lame_constants};
use crate::model::Material;

/// Corners of the edge that each of the nodes 4 to 9 halves, in the order of the C3D10 of CalculiX and Abaqus.
pub const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];

/// Barycentric coordinates of the four-point rule, (5 ± √5)/20; it is exact for the quadratic integrand of K.
const GAUSS: [f64; 2] = [0.138_196_601_125_010_5, 0.585_410_196_624_968_5];

/// Stiffness and consistent mass of an element given by its corners; the other nodes halve the edges.
///
/// Gradients of the shape functions are linear, so that four points integrate K exactly; M is the closed form.
///
/// # Panics
/// If the element is turned inside out: node 3 must lie on the side of 0, 1, 2 from where they turn anticlockwise.
pub fn tetrahedron(corners: &[[f64; 3]; 4], material: &Material) -> ElementMatrices<30> {
    let (lame, shear) = lame_constants(material);
    let jacobian = std::array::from_fn(|i| std::array::from_fn(|j| corners[i + 1][j] - corners[0][j]));
    let (inverse, determinant) = invert3(&jacobian);
    let volume = determinant / 6.0;
    // Gradients of the barycentric coordinates, whose sum is zero.
    let mut corner_gradient = [[0.0; 3]; 4];
    for d in 0..3 {
        (1..4).for_each(|a| corner_gradient[a][d] = inverse[d][a - 1]);
        corner_gradient[0][d] = -(inverse[d][0] + inverse[d][1] + inverse[d][2]);
    }
    let mut element = ElementMatrices { stiffness: [[0.0; 30]; 30], mass: [[0.0; 30]; 30] };
    for point in 0..4 {
        let at: [f64; 4] = std::array::from_fn(|a| GAUSS[usize::from(a == point)]);
        let gradient = shape_gradients(&at, &corner_gradient);
        for a in 0..10 {
            for b in a..10 {
                let block = elastic_block(&gradient[a], &gradient[b], lame, shear);
                add_block(&mut element, (a, b), &block, volume / 4.0);
            }
        }
    }
    for a in 0..10 {
        for b in a..10 {
            let share = f64::from(mass_share(a, b)) / 420.0 * material.density * volume;
            (0..3).for_each(|d| element.mass[3 * a + d][3 * b + d] = share);
        }
    }
    element
}

/// Gradients of N_a = L_a (2 L_a − 1) at corners and N_ab = 4 L_a L_b at the middles of edges.
fn shape_gradients(at: &[f64; 4], corner_gradient: &[[f64; 3]; 4]) -> [[f64; 3]; 10] {
    std::array::from_fn(|node| {
        std::array::from_fn(|d| match node.checked_sub(4) {
            None => (4.0 * at[node] - 1.0) * corner_gradient[node][d],
            Some(edge) => {
                let [a, b] = TET_EDGES[edge];
                4.0 * (at[a] * corner_gradient[b][d] + at[b] * corner_gradient[a][d])
            }
        })
    })
}

/// ∫ N_a N_b dV in units of V/420, by ∫ L_0^i L_1^j L_2^k L_3^l dV = 6 V i! j! k! l! / (i + j + k + l + 3)!.
fn mass_share(a: usize, b: usize) -> i32 {
    let common = |a: [usize; 2], b: [usize; 2]| a.iter().filter(|corner| b.contains(corner)).count();
    match (a.checked_sub(4), b.checked_sub(4)) {
        (None, None) => [1, 6][usize::from(a == b)],
        (Some(a), Some(b)) => [8, 16, 32][common(TET_EDGES[a], TET_EDGES[b])],
        (None, Some(edge)) | (Some(edge), None) => [-6, -4][usize::from(TET_EDGES[edge].contains(&a.min(b)))],
    }
}
