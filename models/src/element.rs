//! Isoparametric elements with two Gauss points a direction: the 8-node hexahedron and the 4-node quadrilateral.

// Index loops read like the formulas they compute.
#![allow(clippy::needless_range_loop)]

use crate::model::Material;

/// Abscissa of two-point Gauss quadrature, 1/√3; both weights are one.
pub(crate) const GAUSS: f64 = 0.577_350_269_189_625_8;

/// Corners of the reference cube in the order VTK, XDMF and MED share with the Abaqus C3D8.
pub const HEX_CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Stiffness and consistent mass of one element, N dofs in node-major order.
pub struct ElementMatrices<const N: usize> {
    /// K, N × N.
    pub stiffness: [[f64; N]; N],
    /// M, N × N.
    pub mass: [[f64; N]; N],
}

/// The 8-node hexahedron, full 2 × 2 × 2 integration, three displacements a node.
///
/// # Panics
/// If the element is turned inside out at a Gauss point.
pub fn hexahedron(corners: &[[f64; 3]; 8], material: &Material) -> ElementMatrices<24> {
    let (lame, shear) = lame_constants(material);
    let mut element = ElementMatrices { stiffness: [[0.0; 24]; 24], mass: [[0.0; 24]; 24] };
    for point in HEX_CORNERS.map(|corner| corner.map(|x| x * GAUSS)) {
        let shape = HEX_CORNERS.map(|c| (0..3).map(|d| 1.0 + c[d] * point[d]).product::<f64>() / 8.0);
        let local = HEX_CORNERS.map(|c| {
            let f: [f64; 3] = std::array::from_fn(|d| 1.0 + c[d] * point[d]);
            [c[0] * f[1] * f[2] / 8.0, f[0] * c[1] * f[2] / 8.0, f[0] * f[1] * c[2] / 8.0]
        });
        let mut jacobian = [[0.0; 3]; 3];
        for (d, x) in local.iter().zip(corners) {
            for i in 0..3 {
                for j in 0..3 {
                    jacobian[i][j] += d[i] * x[j];
                }
            }
        }
        let (inverse, volume) = invert3(&jacobian);
        let gradient = local.map(|d| std::array::from_fn::<f64, 3, _>(|i| (0..3).map(|j| inverse[i][j] * d[j]).sum()));
        for a in 0..8 {
            for b in a..8 {
                add_block(&mut element, (a, b), &elastic_block(&gradient[a], &gradient[b], lame, shear), volume);
                for i in 0..3 {
                    element.mass[3 * a + i][3 * b + i] += material.density * shape[a] * shape[b] * volume;
                }
            }
        }
    }
    element
}

/// The 4-node quadrilateral in plane stress, 2 × 2 integration, two displacements a node.
///
/// # Panics
/// If the element is turned inside out at a Gauss point.
pub fn quadrilateral(corners: &[[f64; 2]; 4], material: &Material, thickness: f64) -> ElementMatrices<8> {
    const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let (lame, shear) = lame_constants(material);
    // Plane stress replaces λ by 2λµ/(λ + 2µ).
    let lame = 2.0 * lame * shear / (lame + 2.0 * shear);
    let mut element = ElementMatrices { stiffness: [[0.0; 8]; 8], mass: [[0.0; 8]; 8] };
    for [r, s] in CORNERS.map(|corner| corner.map(|x| x * GAUSS)) {
        let shape = CORNERS.map(|c| (1.0 + c[0] * r) * (1.0 + c[1] * s) / 4.0);
        let local = CORNERS.map(|c| [c[0] * (1.0 + c[1] * s) / 4.0, c[1] * (1.0 + c[0] * r) / 4.0]);
        let mut jacobian = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        for (d, x) in local.iter().zip(corners) {
            for i in 0..2 {
                for j in 0..2 {
                    jacobian[i][j] += d[i] * x[j];
                }
            }
        }
        let (inverse, area) = invert3(&jacobian);
        let gradient = local.map(|d| std::array::from_fn::<f64, 2, _>(|i| (0..2).map(|j| inverse[i][j] * d[j]).sum()));
        let volume = area * thickness;
        for a in 0..4 {
            for b in a..4 {
                add_block(&mut element, (a, b), &elastic_block(&gradient[a], &gradient[b], lame, shear), volume);
                for i in 0..2 {
                    element.mass[2 * a + i][2 * b + i] += material.density * shape[a] * shape[b] * volume;
                }
            }
        }
    }
    element
}

/// Lamé's λ and µ.
pub(crate) fn lame_constants(material: &Material) -> (f64, f64) {
    let Material { young, poisson, .. } = *material;
    (young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson)))
}

/// Energy density coupling of two shape functions: λ aᵢbⱼ + µ aⱼbᵢ + µ (a·b) δᵢⱼ.
pub(crate) fn elastic_block<const D: usize>(a: &[f64; D], b: &[f64; D], lame: f64, shear: f64) -> [[f64; D]; D] {
    let product: f64 = a.iter().zip(b).map(|(x, y)| x * y).sum();
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let diagonal = if i == j { shear * product } else { 0.0 };
            lame * a[i] * b[j] + shear * a[j] * b[i] + diagonal
        })
    })
}

/// Adds a weighted node block to the element stiffness.
pub(crate) fn add_block<const D: usize, const N: usize>(
    element: &mut ElementMatrices<N>,
    (a, b): (usize, usize),
    block: &[[f64; D]; D],
    weight: f64,
) {
    for i in 0..D {
        for j in 0..D {
            element.stiffness[D * a + i][D * b + j] += block[i][j] * weight;
        }
    }
}

/// Inverse and determinant of the Jacobian.
pub(crate) fn invert3(m: &[[f64; 3]; 3]) -> ([[f64; 3]; 3], f64) {
    let cofactor = |i: usize, j: usize| {
        let (r, s) = ((i + 1) % 3, (i + 2) % 3);
        let (u, v) = ((j + 1) % 3, (j + 2) % 3);
        m[r][u] * m[s][v] - m[r][v] * m[s][u]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    assert!(determinant > 0.0, "an element is turned inside out: Jacobian {determinant}");
    (std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant)), determinant)
}
