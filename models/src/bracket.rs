//! The bundled example: a lug bracket, bolted down at four holes, with a bore that takes a pin.
//!
//! Millimetre, tonne, second. A base plate 160 × 120 × 12 with rounded corners, four bolt holes and two cut-outs; an
//! upright web with a window; four gussets; an eye with bosses about a bore of radius 18 whose axis is y. Built of
//! structured blocks that meet node to node; plates with a hole are rings of cells mapped between circle and square.

use std::f64::consts::PI;

use crate::hexahedra::HexMesh;
use crate::model::{Material, Model};

/// Distance below which nodes of two blocks are one, in mm; cells are millimetres, rounding is 1e-14.
const TOLERANCE: f64 = 1e-6;
/// Node planes of the base along y: 10 mm cells, but for the web, 12 mm thick.
const BASE_Y: [f64; 13] = [-60.0, -50.0, -40.0, -30.0, -20.0, -6.0, 0.0, 6.0, 20.0, 30.0, 40.0, 50.0, 60.0];
const BASE_THICKNESS: f64 = 12.0;
const BOLT_CENTRES: [[f64; 2]; 4] = [[-60.0, -40.0], [60.0, -40.0], [60.0, 40.0], [-60.0, 40.0]];
const BOLT_RADIUS: f64 = 9.0;
const WEB_HALF_THICKNESS: f64 = 6.0;
const EYE_HALF_WIDTH: f64 = 40.0;
/// Height of the bore's axis: the web's six cells of 10 mm lie between the base and the eye.
const EYE_HEIGHT: f64 = BASE_THICKNESS + 60.0 + EYE_HALF_WIDTH;
const BORE_RADIUS: f64 = 18.0;
const BOSS_RADIUS: f64 = 26.0;
const BOSS_HALF_LENGTH: f64 = 14.0;

/// The bracket's matrices, steel, free-free, with the node groups `BASE` (walls of the bolt holes) and `EYE` (wall of the
/// bore).
pub fn bracket() -> Model {
    bracket_mesh().assemble(&Material::STEEL_MM_T_S)
}

/// The bracket's mesh with its two node groups.
pub fn bracket_mesh() -> HexMesh {
    let mut mesh = HexMesh::default();
    let mut blocks = vec![base(), web(), eye()];
    blocks.extend(BOLT_CENTRES.iter().map(|&centre| base_corner(centre)));
    blocks.extend([-1.0, 1.0].map(boss));
    blocks.extend([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].map(gusset));
    blocks.iter().for_each(|block| mesh.merge(block, TOLERANCE));
    let on_circle = |p: f64, q: f64, radius: f64| (p.hypot(q) - radius).abs() < TOLERANCE;
    mesh.add_group("BASE", |[x, y, z]| {
        z <= BASE_THICKNESS && BOLT_CENTRES.iter().any(|&[a, b]| on_circle(x - a, y - b, BOLT_RADIUS))
    });
    mesh.add_group("EYE", |[x, _, z]| on_circle(x, z - EYE_HEIGHT, BORE_RADIUS));
    mesh
}

/// The base without its corners, which hold the bolt holes, and with a cut-out on either side of the web.
fn base() -> HexMesh {
    let place = |[x, y, z]: [f64; 3]| [160.0 * x - 80.0, station(&BASE_Y, y), BASE_THICKNESS * z];
    HexMesh::structured([16, 12, 2], place, |[i, j, _]| {
        let is_corner = !(4..12).contains(&i) && !(4..8).contains(&j);
        let is_cut_out = (6..10).contains(&i) && (1..3).chain(9..11).any(|cut| cut == j);
        !is_corner && !is_cut_out
    })
}

/// A corner of the base: 40 × 40 with a bolt hole, its outer corner rounded about the hole.
fn base_corner([x, y]: [f64; 2]) -> HexMesh {
    let plate = HoledPlate { half_width: 20.0, cells: 4, circles: &[BOLT_RADIUS, 13.0], cells_outward: 1 };
    plate.mesh(2, |p, q| p * x > 0.0 && q * y > 0.0, |p, q, t| [x + p, y + q, BASE_THICKNESS * t])
}

/// The upright from the base to the eye, with a window.
fn web() -> HexMesh {
    let place =
        |[x, y, z]: [f64; 3]| [80.0 * x - 40.0, WEB_HALF_THICKNESS * (2.0 * y - 1.0), BASE_THICKNESS + 60.0 * z];
    HexMesh::structured([8, 2, 6], place, |[i, _, k]| !((2..6).contains(&i) && (2..5).contains(&k)))
}

/// The eye: square where it meets the web, round above its axis.
fn eye() -> HexMesh {
    let plate =
        HoledPlate { half_width: EYE_HALF_WIDTH, cells: 8, circles: &[BORE_RADIUS, BOSS_RADIUS], cells_outward: 2 };
    // The plane is x-z, whose normal by the right-hand rule is −y: the thickness runs from +y to −y.
    plate.mesh(2, |_, q| q > 0.0, |p, q, t| [p, WEB_HALF_THICKNESS * (1.0 - 2.0 * t), EYE_HEIGHT + q])
}

/// A boss about the bore on one side of the eye, `side` = ±1.
fn boss(side: f64) -> HexMesh {
    let plate =
        HoledPlate { half_width: EYE_HALF_WIDTH, cells: 8, circles: &[BORE_RADIUS, BOSS_RADIUS], cells_outward: 0 };
    let (outer, inner) = (side * BOSS_HALF_LENGTH, side * WEB_HALF_THICKNESS);
    let (from, to) = (outer.max(inner), outer.min(inner));
    plate.mesh(1, |_, _| true, |p, q, t| [p, from + (to - from) * t, EYE_HEIGHT + q])
}

/// A gusset between web and base, 10 mm thick, falling from 40 mm at the web to 12 mm.
fn gusset([side_x, side_y]: [f64; 2]) -> HexMesh {
    const REACH: [f64; 4] = [6.0, 20.0, 30.0, 40.0];
    let place = |[x, y, z]: [f64; 3]| {
        // Mirrored blocks run through their node planes backwards, so that no cell is turned inside out.
        let away = station(&REACH, if side_y > 0.0 { y } else { 1.0 - y });
        let height = 40.0 - 28.0 * (away - REACH[0]) / (REACH[3] - REACH[0]);
        [side_x * 35.0 + 10.0 * (x - 0.5), side_y * away, BASE_THICKNESS + height * z]
    };
    HexMesh::structured([1, 3, 4], place, |_| true)
}

/// The node plane at the fraction `t` of a list.
fn station(planes: &[f64], t: f64) -> f64 {
    planes[(t * (planes.len() - 1) as f64).round() as usize]
}

/// A square plate with a round hole, meshed by rings.
struct HoledPlate<'a> {
    half_width: f64,
    /// Cells along a side, even.
    cells: usize,
    /// Radii of the circles of nodes, from the hole outwards.
    circles: &'a [f64],
    /// Cells between the last circle and the border.
    cells_outward: usize,
}

impl HoledPlate<'_> {
    /// Nodes (p, q) about the hole's centre and t through the thickness, placed in space; where `is_round` holds the border
    /// is a circle instead of the square.
    fn mesh(
        &self,
        layers: usize,
        is_round: impl Fn(f64, f64) -> bool,
        place: impl Fn(f64, f64, f64) -> [f64; 3],
    ) -> HexMesh {
        let around = 4 * self.cells;
        let rings = self.circles.len() - 1 + self.cells_outward;
        let map = |[radial, angular, t]: [f64; 3]| {
            let ring = (radial * rings as f64).round() as usize;
            let sector = (angular * around as f64).round() as usize % around;
            let angle = -0.75 * PI + 2.0 * PI * sector as f64 / around as f64;
            let (p, q) = (angle.cos(), angle.sin());
            let Some(outward) = ring.checked_sub(self.circles.len() - 1).filter(|&outward| outward > 0) else {
                return place(self.circles[ring] * p, self.circles[ring] * q, t);
            };
            let last = self.circles[self.circles.len() - 1];
            let border = if is_round(p, q) { [p, q].map(|c| c * self.half_width) } else { self.square(sector) };
            let share = outward as f64 / self.cells_outward as f64;
            place(last * p + (border[0] - last * p) * share, last * q + (border[1] - last * q) * share, t)
        };
        let mut mesh = HexMesh::default();
        // Merging closes the ring.
        mesh.merge(&HexMesh::structured([rings, around, layers], map, |_| true), TOLERANCE);
        mesh
    }

    /// The border of the square, counted from its corner (−, −) anticlockwise.
    fn square(&self, sector: usize) -> [f64; 2] {
        let along = self.half_width * (2.0 * (sector % self.cells) as f64 / self.cells as f64 - 1.0);
        match sector / self.cells {
            0 => [along, -self.half_width],
            1 => [self.half_width, along],
            2 => [-along, self.half_width],
            _ => [-self.half_width, -along],
        }
    }
}
