//! Shells of flat 4-node quadrilaterals, six dofs a node.

// Index loops read like the formulas they compute.
#![allow(clippy::needless_range_loop)]

use crate::element::GAUSS;
use crate::model::{Assembler, Material, Model, cross, dot};

/// Corners of the reference square.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
/// Share of the shear energy that is integrated at the Gauss points, against motions that the middle of an element does not see.
const AGAINST_HOURGLASSING: f64 = 1e-3;

type Element = [[f64; 24]; 24];
/// Row of the matrix B of one strain: what each dof adds to it.
type Strain = [f64; 24];

/// What a shell is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Elastic constants and density.
    pub material: Material,
    /// Thickness t.
    pub thickness: f64,
    /// Stiffness against drilling rotations – those about the normal, less what the membrane turns – relative to E t.
    pub drilling: f64,
}

/// A grid of shell elements, mapped from the unit square, free: six rigid-body modes.
///
/// Membrane and bending by Mindlin's theory, shear of the middle point, a penalty on drilling rotations. Groups `XMIN`, `XMAX`, `YMIN`,
/// `YMAX` name the edges of the square. Node order is x fastest.
///
/// # Panics
/// If an element is turned inside out.
pub fn shell(cells: [usize; 2], map: impl Fn([f64; 2]) -> [f64; 3], wall: &Wall) -> Model {
    let [nx, ny] = cells;
    let grid = |i: usize, j: usize| (i + (nx + 1) * j) as u32;
    let square: Vec<[f64; 2]> =
        (0..=ny).flat_map(|j| (0..=nx).map(move |i| [i as f64 / nx as f64, j as f64 / ny as f64])).collect();
    let nodes: Vec<[f64; 3]> = square.iter().map(|&at| map(at)).collect();
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for (i, j) in (0..ny).flat_map(|j| (0..nx).map(move |i| (i, j))) {
        let corners = [grid(i, j), grid(i + 1, j), grid(i + 1, j + 1), grid(i, j + 1)];
        let [element, inertia] = element(&corners.map(|corner| nodes[corner as usize]), wall);
        let dofs: [u32; 24] = std::array::from_fn(|a| 6 * corners[a / 6] + (a % 6) as u32);
        stiffness.add_element(&dofs, &element);
        mass.add_element(&dofs, &inertia);
    }
    let mut model = Model::node_major(nodes, &[0, 1, 2, 3, 4, 5], stiffness, mass);
    for (axis, letter) in ["X", "Y"].iter().enumerate() {
        for (end, at) in [("MIN", 0.0), ("MAX", 1.0)] {
            let of_edge = model.labels.iter().zip(&square).filter(|(_, point)| point[axis] == at);
            let labels = of_edge.map(|(&label, _)| label).collect();
            model.groups.insert(format!("{letter}{end}"), labels);
        }
    }
    model
}

/// K and M of one element in the axes of the model.
fn element(corners: &[[f64; 3]; 4], wall: &Wall) -> [Element; 2] {
    let axes = axes_of(corners);
    let flat = corners.map(|x| [dot(&axes[0], &x), dot(&axes[1], &x)]);
    let Wall { material: Material { young, poisson, density }, thickness: t, drilling } = *wall;
    let shear = young / (2.0 * (1.0 + poisson));
    let plane = young / (1.0 - poisson * poisson);
    let (mut stiffness, mut mass) = ([[0.0; 24]; 24], [[0.0; 24]; 24]);
    let add_plane = |stiffness: &mut Element, strains: &[Strain; 3], weight: f64| {
        let [x, y, xy] = strains;
        add(stiffness, (x, x), plane * weight);
        add(stiffness, (y, y), plane * weight);
        add(stiffness, (x, y), poisson * plane * weight);
        add(stiffness, (y, x), poisson * plane * weight);
        add(stiffness, (xy, xy), shear * weight);
    };
    for point in CORNERS.map(|corner| corner.map(|x| x * GAUSS)) {
        let (shape, gradient, area) = at_point(&flat, point);
        add_plane(&mut stiffness, &membrane(&gradient), t * area);
        add_plane(&mut stiffness, &curvatures(&gradient), t.powi(3) / 12.0 * area);
        let drill = drilling_strain(&shape, &gradient);
        add(&mut stiffness, (&drill, &drill), drilling * young * t * area);
        for slope in slopes(&shape, &gradient) {
            add(&mut stiffness, (&slope, &slope), AGAINST_HOURGLASSING * shear * t * 5.0 / 6.0 * area);
        }
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            for d in 0..6 {
                let inertia = if d < 3 { t } else { t.powi(3) / 12.0 };
                mass[6 * a + d][6 * b + d] += density * inertia * shape[a] * shape[b] * area;
            }
        }
    }
    let (shape, gradient, area) = at_point(&flat, [0.0; 2]);
    for slope in slopes(&shape, &gradient) {
        add(&mut stiffness, (&slope, &slope), shear * t * 5.0 / 6.0 * 4.0 * area);
    }
    [stiffness, mass].map(|matrix| turned(&matrix, &axes))
}

/// Axes of an element: along its middle line, in its mean plane, and normal to it.
fn axes_of([a, b, c, d]: &[[f64; 3]; 4]) -> [[f64; 3]; 3] {
    let unit = |x: [f64; 3]| x.map(|value| value / dot(&x, &x).sqrt());
    let less = |x: &[f64; 3], y: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| x[i] - y[i]) };
    let normal = unit(cross(less(c, a), less(d, b)));
    let along: [f64; 3] = std::array::from_fn(|i| b[i] + c[i] - a[i] - d[i]);
    let out = dot(&along, &normal);
    let x = unit(std::array::from_fn(|i| along[i] - out * normal[i]));
    [x, cross(normal, x), normal]
}

/// Shape functions, their gradients and the area of a unit of the reference square, at a point of it.
fn at_point(flat: &[[f64; 2]; 4], [r, s]: [f64; 2]) -> ([f64; 4], [[f64; 2]; 4], f64) {
    let shape = CORNERS.map(|c| (1.0 + c[0] * r) * (1.0 + c[1] * s) / 4.0);
    let local = CORNERS.map(|c| [c[0] * (1.0 + c[1] * s) / 4.0, c[1] * (1.0 + c[0] * r) / 4.0]);
    let mut jacobian = [[0.0; 2]; 2];
    for (d, x) in local.iter().zip(flat) {
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            jacobian[i][j] += d[i] * x[j];
        }
    }
    let [[a, b], [c, d]] = jacobian;
    let area = a * d - b * c;
    assert!(area > 0.0, "an element is turned inside out: Jacobian {area}");
    let gradient = local.map(|[r, s]| [(d * r - b * s) / area, (a * s - c * r) / area]);
    (shape, gradient, area)
}

/// ε_x, ε_y, γ_xy of the middle plane.
fn membrane(gradient: &[[f64; 2]; 4]) -> [Strain; 3] {
    let mut strains = [[0.0; 24]; 3];
    for (a, [dx, dy]) in gradient.iter().enumerate() {
        (strains[0][6 * a], strains[1][6 * a + 1]) = (*dx, *dy);
        (strains[2][6 * a], strains[2][6 * a + 1]) = (*dy, *dx);
    }
    strains
}

/// κ_x, κ_y, κ_xy: a point at height z moves by (z r_y, −z r_x).
fn curvatures(gradient: &[[f64; 2]; 4]) -> [Strain; 3] {
    let mut strains = [[0.0; 24]; 3];
    for (a, [dx, dy]) in gradient.iter().enumerate() {
        (strains[0][6 * a + 4], strains[1][6 * a + 3]) = (*dx, -dy);
        (strains[2][6 * a + 3], strains[2][6 * a + 4]) = (-dx, *dy);
    }
    strains
}

/// γ_xz and γ_yz.
fn slopes(shape: &[f64; 4], gradient: &[[f64; 2]; 4]) -> [Strain; 2] {
    let mut strains = [[0.0; 24]; 2];
    for (a, [dx, dy]) in gradient.iter().enumerate() {
        (strains[0][6 * a + 2], strains[0][6 * a + 4]) = (*dx, shape[a]);
        (strains[1][6 * a + 2], strains[1][6 * a + 3]) = (*dy, -shape[a]);
    }
    strains
}

/// Rotation about the normal, less that of the middle plane.
fn drilling_strain(shape: &[f64; 4], gradient: &[[f64; 2]; 4]) -> Strain {
    let mut strain = [0.0; 24];
    for (a, [dx, dy]) in gradient.iter().enumerate() {
        (strain[6 * a], strain[6 * a + 1], strain[6 * a + 5]) = (0.5 * dy, -0.5 * dx, shape[a]);
    }
    strain
}

fn add(matrix: &mut Element, (row, column): (&Strain, &Strain), weight: f64) {
    for i in 0..24 {
        for j in 0..24 {
            matrix[i][j] += weight * row[i] * column[j];
        }
    }
}

/// TᵀAT of a matrix in the axes of an element, three dofs by three.
fn turned(matrix: &Element, axes: &[[f64; 3]; 3]) -> Element {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let of_pair =
                |(k, l): (usize, usize)| axes[k][i % 3] * matrix[i / 3 * 3 + k][j / 3 * 3 + l] * axes[l][j % 3];
            (0..3).flat_map(|k| (0..3).map(move |l| (k, l))).map(of_pair).sum()
        })
    })
}
