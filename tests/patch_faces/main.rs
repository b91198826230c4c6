//! The centroid of a patch's faces: every kind of cell in every format, against the centroid of a rectangle.

#![cfg(feature = "hdf5")]

use std::fs;
use std::path::{Path, PathBuf};

use hdf5_metno::{File, H5Type};
use supel::error::{Error, Result, Selector};
use supel::input::{Allowance, Faces, Patch, PatchFaces, Patches, area_vectors, patch_faces};
use supel::job::ModelJob;
use tempfile::TempDir;

type Point = [f64; 3];

/// Two bricks side by side, one twice as long as the other: 3 × 2 × 1. The faces below have their centroid at (1.5, 1, 0).
const X: [f64; 3] = [0.0, 1.0, 3.0];
const CENTROID: Point = [1.5, 1.0, 0.0];

/// A few sums of a few products.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// How nodes in the middles of edges are ordered in wedges and bricks.
#[derive(Clone, Copy, PartialEq)]
enum Order {
    BottomTopUpright,
    BottomUprightTop,
}

/// A kind of cell: its names in the formats, its number in streams of XDMF.
struct Kind {
    med: &'static str,
    moab: &'static str,
    xdmf: &'static str,
    code: i64,
}

const fn kind(med: &'static str, moab: &'static str, xdmf: &'static str, code: i64) -> Kind {
    Kind { med, moab, xdmf, code }
}

/// All kinds with the number of their nodes: shape by corners and whether they have a volume.
const KINDS: [(Shape, usize, Kind); 17] = [
    (Shape::Triangle, 3, kind("TR3", "Tri3", "Triangle", 4)),
    (Shape::Triangle, 6, kind("TR6", "Tri6", "Tri_6", 36)),
    (Shape::Triangle, 7, kind("TR7", "Tri7", "", 0)),
    (Shape::Quad, 4, kind("QU4", "Quad4", "Quadrilateral", 5)),
    (Shape::Quad, 8, kind("QU8", "Quad8", "Quadrilateral_8", 37)),
    (Shape::Quad, 9, kind("QU9", "Quad9", "Quad_9", 35)),
    (Shape::Tet, 4, kind("TE4", "Tet4", "Tetrahedron", 6)),
    (Shape::Tet, 10, kind("T10", "Tet10", "Tetrahedron_10", 38)),
    (Shape::Pyramid, 5, kind("PY5", "Pyramid5", "Pyramid", 7)),
    (Shape::Pyramid, 13, kind("P13", "Pyramid13", "Pyramid_13", 39)),
    (Shape::Wedge, 6, kind("PE6", "Prism6", "Wedge", 8)),
    (Shape::Wedge, 15, kind("P15", "Prism15", "Wedge_15", 40)),
    (Shape::Wedge, 18, kind("P18", "Prism18", "Wedge_18", 41)),
    (Shape::Brick, 8, kind("HE8", "Hex8", "Hexahedron", 9)),
    (Shape::Brick, 20, kind("H20", "Hex20", "Hexahedron_20", 48)),
    (Shape::Brick, 27, kind("H27", "Hex27", "Hexahedron_27", 50)),
    // A kind once more, for the number of rows.
    (Shape::Brick, 8, kind("HE8", "Hex8", "HEXAHEDRON", 9)),
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Triangle,
    Quad,
    Tet,
    Pyramid,
    Wedge,
    Brick,
}

/// Points, each once, and cells of one kind.
#[derive(Default)]
struct Mesh {
    points: Vec<Point>,
    cells: Vec<Vec<usize>>,
}

impl Mesh {
    fn node(&mut self, point: Point) -> usize {
        let found = self.points.iter().position(|other| (0..3).all(|axis| (other[axis] - point[axis]).abs() < 1e-9));
        found.unwrap_or_else(|| {
            self.points.push(point);
            self.points.len() - 1
        })
    }

    /// The bricks cut into cells of a shape with so many nodes. Surfaces are those below, and one upright.
    fn of(shape: Shape, n_nodes: usize, order: Order) -> Self {
        let mut mesh = Self::default();
        for long in 0..2 {
            let (a, b) = (X[long], X[long + 1]);
            let below = [[a, 0.0, 0.0], [b, 0.0, 0.0], [b, 2.0, 0.0], [a, 2.0, 0.0]];
            let above = below.map(|[x, y, _]| [x, y, 1.0]);
            let [p, q, r, s] = below;
            let [t, u, v, w] = above;
            let middle = mean(&[p, v]);
            let cells: Vec<Vec<Point>> = match shape {
                Shape::Brick => vec![vec![p, q, r, s, t, u, v, w]],
                Shape::Wedge => vec![vec![p, q, r, t, u, v], vec![p, r, s, t, v, w]],
                Shape::Pyramid => [[p, q, r, s], [t, u, v, w], [p, q, u, t], [q, r, v, u], [r, s, w, v], [s, p, t, w]]
                    .map(|base| [&base[..], &[middle]].concat())
                    .into(),
                // Around the diagonal from p to v.
                Shape::Tet => [[q, r], [r, s], [s, w], [w, t], [t, u], [u, q]].map(|[a, b]| vec![p, v, a, b]).into(),
                Shape::Quad => vec![vec![p, q, r, s], vec![p, q, u, t]],
                Shape::Triangle => vec![vec![p, q, r], vec![p, r, s], vec![p, q, u]],
            };
            for corners in cells {
                let points = completed(shape, n_nodes, &corners, order);
                let cell = points.into_iter().map(|point| mesh.node(point)).collect();
                mesh.cells.push(cell);
            }
        }
        mesh
    }

    /// The nodes below.
    fn patch(&self) -> Patches<'_> {
        self.patch_where(|point| point[2] == 0.0)
    }

    fn patch_where(&self, is_in: impl Fn(Point) -> bool) -> Patches<'_> {
        let nodes: Vec<usize> = (0..self.points.len()).filter(|node| is_in(self.points[*node])).collect();
        Patches { coordinates: &self.points, list: vec![Patch { of: below(), nodes }] }
    }
}

/// Who asks for the faces of the one patch.
fn below() -> Selector {
    Selector::Interface("below".to_owned())
}

fn mean(points: &[Point]) -> Point {
    std::array::from_fn(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64)
}

/// Corners, and behind them the nodes on edges, faces and inside that a cell of so many nodes has.
fn completed(shape: Shape, n_nodes: usize, corners: &[Point], order: Order) -> Vec<Point> {
    let ring = |n: usize, from: usize| (0..n).map(move |at| [from + at, from + (at + 1) % n]);
    let upright = |n: usize| (0..n).map(move |at| [at, at + n]);
    let prism = |n: usize| -> Vec<[usize; 2]> {
        match order {
            Order::BottomTopUpright => ring(n, 0).chain(ring(n, n)).chain(upright(n)).collect(),
            Order::BottomUprightTop => ring(n, 0).chain(upright(n)).chain(ring(n, n)).collect(),
        }
    };
    let edges: Vec<[usize; 2]> = match shape {
        Shape::Triangle => ring(3, 0).collect(),
        Shape::Quad => ring(4, 0).collect(),
        Shape::Tet => ring(3, 0).chain((0..3).map(|at| [at, 3])).collect(),
        Shape::Pyramid => ring(4, 0).chain((0..4).map(|at| [at, 4])).collect(),
        Shape::Wedge => prism(3),
        Shape::Brick => prism(4),
    };
    let mut points = corners.to_vec();
    if n_nodes == corners.len() {
        return points;
    }
    let of = |corner_numbers: &[usize]| mean(&corner_numbers.iter().map(|at| corners[*at]).collect::<Vec<_>>());
    points.extend(edges.iter().map(|edge| of(edge)));
    if n_nodes > points.len() {
        let sides = |n: usize| (0..n).map(move |at| vec![at, (at + 1) % n, (at + 1) % n + n, at + n]);
        let faces: Vec<Vec<usize>> = match shape {
            Shape::Triangle | Shape::Quad => vec![(0..corners.len()).collect()],
            Shape::Wedge => sides(3).collect(),
            _ => [vec![0, 1, 2, 3]].into_iter().chain(sides(4)).chain([vec![4, 5, 6, 7], (0..8).collect()]).collect(),
        };
        points.extend(faces.iter().map(|face| of(face)));
    }
    assert_eq!(points.len(), n_nodes, "{shape:?}");
    points
}

/// A file in a folder that lives as long.
struct Written(TempDir, PathBuf);

impl Written {
    fn new(name: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        Self(folder, path)
    }

    fn faces(&self, patches: &Patches<'_>) -> Result<Vec<PatchFaces>> {
        self.faces_within(patches, None)
    }

    fn faces_within(&self, patches: &Patches<'_>, bytes: Option<u64>) -> Result<Vec<PatchFaces>> {
        let model = ModelJob { nodes: Some(self.1.clone()), ..ModelJob::default() };
        patch_faces(&model, patches, &Allowance::of(bytes))
    }
}

fn put<T: H5Type>(group: &hdf5_metno::Group, name: &str, values: &[T]) {
    group.new_dataset_builder().with_data(values).create(name).expect("a dataset");
}

/// Numbers of nodes, a row for each cell.
fn rows(cells: &[Vec<usize>], first: i64) -> Vec<i64> {
    cells.iter().flatten().map(|node| *node as i64 + first).collect()
}

const STEP: &str = "ENS_MAA/M/-0000000000000000001-0000000000000000001";

/// A MED file with the connectivity of each kind, a column for each cell.
fn med(mesh: &Mesh, kinds: &[(&str, Vec<i64>)]) -> Written {
    let written = Written::new("a.med");
    let file = File::create(&written.1).expect("a file");
    let step = file.create_group(STEP).expect("a group");
    let of_mesh = file.group("ENS_MAA/M").expect("a group");
    of_mesh.new_attr_builder().with_data(&[3]).create("ESP").expect("an attribute");
    let nodes = step.create_group("NOE").expect("a group");
    let by_axis: Vec<f64> = (0..3).flat_map(|axis| mesh.points.iter().map(move |point| point[axis])).collect();
    put(&nodes, "COO", &by_axis);
    let cells = step.create_group("MAI").expect("a group");
    for (kind, numbers) in kinds {
        put(&cells.create_group(kind).expect("a group"), "NOD", numbers);
    }
    written
}

/// The numbers of rows as MED stores them.
fn columns(numbers: &[i64], n_nodes: usize) -> Vec<i64> {
    let n_cells = numbers.len() / n_nodes;
    (0..n_nodes).flat_map(|corner| (0..n_cells).map(move |cell| numbers[cell * n_nodes + corner])).collect()
}

/// A MOAB file whose nodes have the file ids 11 and up.
fn moab(mesh: &Mesh, kind: &str, (n_nodes, numbers): (usize, Vec<i64>)) -> Written {
    let written = Written::new("a.h5m");
    let file = File::create(&written.1).expect("a file");
    let nodes = file.create_group("tstt/nodes").expect("a group");
    let points: Vec<Point> = mesh.points.clone();
    let flat: Vec<f64> = points.into_iter().flatten().collect();
    let table = nodes.new_dataset::<f64>().shape([mesh.points.len(), 3]).create("coordinates").expect("a dataset");
    table.write_raw(&flat).expect("written");
    table.new_attr_builder().with_data(&[11_i64]).create("start_id").expect("an attribute");
    let group = file.create_group(&format!("tstt/elements/{kind}")).expect("a group");
    let shape = [numbers.len() / n_nodes, n_nodes];
    let table = group.new_dataset::<i64>().shape(shape).create("connectivity").expect("a dataset");
    table.write_raw(&numbers).expect("written");
    written
}

/// An XDMF document with topologies.
fn xdmf(mesh: &Mesh, topologies: &str) -> Written {
    let written = Written::new("a.xdmf");
    let points: Vec<String> = mesh.points.iter().flatten().map(f64::to_string).collect();
    let text = format!(
        "<Xdmf><Domain><Grid>{topologies}<Geometry GeometryType=\"XYZ\"><DataItem Format=\"XML\">{}</DataItem></Geometry>\
         </Grid></Domain></Xdmf>",
        points.join(" ")
    );
    fs::write(&written.1, text).expect("written");
    written
}

fn topology(kind: &str, numbers: &[i64]) -> String {
    let words: Vec<String> = numbers.iter().map(i64::to_string).collect();
    let item = format!("<DataItem Dimensions=\"{}\" Format=\"XML\">{}</DataItem>", numbers.len(), words.join(" "));
    format!("<Topology TopologyType=\"{kind}\">{item}</Topology>")
}

#[track_caller]
fn assert_centroid(found: &Result<Vec<PatchFaces>>, n_faces: usize, centroid: Point, what: &str) {
    let Ok([only]) = found.as_deref() else { panic!("{what}: {found:?}") };
    let Faces::Known { faces, centroid: found, .. } = &only.faces else { panic!("{what}: {only:?}") };
    assert_eq!((&only.of, faces.len()), (&below(), n_faces), "{what}");
    for (found, expected) in found.iter().zip(centroid) {
        assert!((found - expected).abs() <= ROUNDING * 3.0, "{what}: {only:?}");
    }
}

/// Asserts that the faces of the one patch are not known, and why.
#[track_caller]
fn assert_unknown(found: &Result<Vec<PatchFaces>>, why: &str, what: &str) {
    let Ok([only]) = found.as_deref() else { panic!("{what}: {found:?}") };
    let Faces::Unknown { reason } = &only.faces else { panic!("{what}: {only:?}") };
    assert!(reason.contains(why), "{what}: {reason}");
}

#[test]
fn every_kind_of_cell_in_every_format() {
    for (shape, n_nodes, kind) in &KINDS {
        // Triangles below: two of the bottom; tetrahedra about the diagonal p–v have p, q, r and p, r, s there.
        let n_faces = if matches!(shape, Shape::Triangle | Shape::Tet | Shape::Wedge) { 4 } else { 2 };
        for order in [Order::BottomTopUpright, Order::BottomUprightTop] {
            let mesh = Mesh::of(*shape, *n_nodes, order);
            let patches = mesh.patch();
            let places: Vec<Point> = patches.list[0].nodes.iter().map(|node| mesh.points[*node]).collect();
            let node_mean = mean(&places);
            assert!(
                (node_mean[0] - CENTROID[0]).abs() > 0.04,
                "the mean of a graded patch is elsewhere: {node_mean:?}"
            );
            let what = |format: &str| format!("{format}, {shape:?} of {n_nodes} nodes");
            let numbers = columns(&rows(&mesh.cells, 1), *n_nodes);
            let found = med(&mesh, &[(kind.med, numbers)]).faces(&patches);
            assert_centroid(&found, n_faces, CENTROID, &what("MED"));
            let found = moab(&mesh, kind.moab, (*n_nodes, rows(&mesh.cells, 11))).faces(&patches);
            assert_centroid(&found, n_faces, CENTROID, &what("MOAB"));
            if kind.code == 0 {
                continue;
            }
            let table = topology(kind.xdmf, &rows(&mesh.cells, 0));
            // The same grid at another time.
            let found = xdmf(&mesh, &(table.clone() + &table)).faces(&patches);
            assert_centroid(&found, n_faces, CENTROID, &what("XDMF"));
            let stream: Vec<i64> = mesh
                .cells
                .iter()
                .flat_map(|cell| [&[kind.code], &rows(std::slice::from_ref(cell), 0)[..]].concat())
                .collect();
            let points_and_lines = [&[1, 1, 0, 2, 2, 0, 1, 34, 0, 1, 2], &stream[..]].concat();
            let found = xdmf(&mesh, &topology("Mixed", &points_and_lines)).faces(&patches);
            assert_centroid(&found, n_faces, CENTROID, &what("XDMF, mixed"));
        }
    }
}

/// The sums of area vectors, and of places times them, over all faces of the one patch.
fn areas(found: &Result<Vec<PatchFaces>>, patches: &Patches<'_>) -> (Point, f64) {
    let Ok([only]) = found.as_deref() else { panic!("{found:?}") };
    let Faces::Known { faces, .. } = &only.faces else { panic!("{only:?}") };
    let position = |place: usize| patches.coordinates[patches.list[0].nodes[place]];
    let (mut sum, mut along) = ([0.0; 3], 0.0);
    for face in faces {
        for (node, area) in face.nodes().zip(area_vectors(face, position)) {
            for axis in 0..3 {
                sum[axis] += area[axis];
                along += position(node)[axis] * area[axis];
            }
        }
    }
    (sum, along)
}

/// Area vectors of faces point out of their volume cells, however a format turns these: those of a closed surface add up to nothing and,
/// times the places of their nodes, to three times the volume, for x has the divergence 3 and elements interpolate it exactly.
#[test]
fn faces_of_volumes_look_outwards() {
    for (shape, n_nodes, kind) in &KINDS {
        let mut mesh = Mesh::of(*shape, *n_nodes, Order::BottomTopUpright);
        let numbers = columns(&rows(&mesh.cells, 1), *n_nodes);
        let found = med(&mesh, &[(kind.med, numbers.clone())]).faces(&mesh.patch());
        let (sum, _) = areas(&found, &mesh.patch());
        let what = format!("{shape:?} of {n_nodes} nodes");
        if matches!(shape, Shape::Triangle | Shape::Quad) {
            // Those are in the order of their nodes, upwards here.
            assert!((sum[2] - 6.0).abs() <= ROUNDING * 6.0, "{what}: {sum:?}");
            continue;
        }
        assert!((sum[2] + 6.0).abs() <= ROUNDING * 6.0, "{what}: {sum:?}");
        let whole = mesh.patch_where(|_| true);
        let (sum, along) = areas(&med(&mesh, &[(kind.med, numbers)]).faces(&whole), &whole);
        assert!(sum.iter().all(|sum| sum.abs() <= ROUNDING * 22.0), "{what}: {sum:?}");
        assert!((along - 18.0).abs() <= ROUNDING * 18.0, "{what}: {along}");
        // As the mirror image has them: bottom and top the other way round, as MED has bricks.
        mesh.points.iter_mut().for_each(|point| point[1] = 2.0 - point[1]);
        let whole = mesh.patch_where(|_| true);
        let written = med(&mesh, &[(kind.med, columns(&rows(&mesh.cells, 1), *n_nodes))]);
        let (sum, along) = areas(&written.faces(&whole), &whole);
        assert!(sum.iter().all(|sum| sum.abs() <= ROUNDING * 22.0), "{what}, mirrored: {sum:?}");
        assert!((along - 18.0).abs() <= ROUNDING * 18.0, "{what}, mirrored: {along}");
    }
}

/// What nodes have of faces drawn out of shape, by hand: (4 T_i + 2 T_{i±1} + T_{i+2}) / 18 of a face with the corner triangles T_i. Their
/// weighted mean is the centroid of the faces.
#[test]
fn areas_of_nodes_of_distorted_faces() {
    let mut mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let moved = mesh.points.iter_mut().find(|point| **point == [1.0, 0.0, 0.0]).expect("a node");
    moved[0] = 1.5;
    let expected = |[x, y, _]: Point| match (x, y) {
        (0.0, 0.0) => 2.0 / 3.0,
        (1.5, 0.0) | (1.0, 2.0) => 1.5,
        (3.0, 0.0) => 5.0 / 6.0,
        (0.0, 2.0) => 7.0 / 12.0,
        (3.0, 2.0) => 11.0 / 12.0,
        _ => panic!("no node below at {x}, {y}"),
    };
    let found = med(&mesh, &[("HE8", columns(&rows(&mesh.cells, 1), 8))]).faces(&mesh.patch());
    let Ok([only]) = found.as_deref() else { panic!("{found:?}") };
    let Faces::Known { areas, centroid, .. } = &only.faces else { panic!("{only:?}") };
    let places: Vec<Point> = mesh.patch().list[0].nodes.iter().map(|node| mesh.points[*node]).collect();
    for (place, area) in places.iter().zip(areas) {
        assert!((area - expected(*place)).abs() <= ROUNDING, "{place:?}: {area}");
    }
    for axis in 0..3 {
        let mean = places.iter().zip(areas).map(|(place, area)| place[axis] * area).sum::<f64>() / 6.0;
        assert!((mean - centroid[axis]).abs() <= ROUNDING, "{mean} {centroid:?}");
    }
}

/// Patches may have nodes in common: each has its own faces.
#[test]
fn a_node_may_belong_to_several_patches() {
    let mesh = Mesh::of(Shape::Brick, 20, Order::BottomTopUpright);
    let written = med(&mesh, &[("H20", columns(&rows(&mesh.cells, 1), 20))]);
    let whole = mesh.patch_where(|_| true).list.remove(0);
    let side = mesh.patch_where(|[x, ..]| x == 0.0).list.remove(0);
    let list = vec![mesh.patch().list.remove(0), whole, side];
    let found = written.faces(&Patches { coordinates: &mesh.points, list }).expect("read");
    let counts: Vec<usize> = found
        .iter()
        .map(|patch| match &patch.faces {
            Faces::Known { faces, .. } => faces.len(),
            Faces::Unknown { .. } => 0,
        })
        .collect();
    assert_eq!(counts, [2, 10, 1]);
}

/// Numbers in a file of HDF5 next to the document.
#[test]
fn xdmf_that_refers_to_hdf5() {
    let mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let topology = "<Topology TopologyType=\"Hexahedron\" BaseOffset=\"1\"><DataItem Format=\"HDF\" Dimensions=\"2 8\">a.h5:/cells\
                    </DataItem></Topology>";
    let written = xdmf(&mesh, topology);
    let numbers = rows(&mesh.cells, 1);
    put(&File::create(written.0.path().join("a.h5")).expect("a file"), "cells", &numbers);
    assert_centroid(&written.faces(&mesh.patch()), 2, CENTROID, "XDMF with HDF5");
    let patches = mesh.patch();
    let Err(Error::MemoryRead { .. }) = written.faces_within(&patches, Some(500)) else { panic!("no room") };
}

/// The document type that FEniCS writes names a file that is not there; one that declares something is refused.
#[test]
fn xdmf_with_a_document_type() {
    let mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let written = xdmf(&mesh, &topology("Hexahedron", &rows(&mesh.cells, 0)));
    let plain = fs::read_to_string(&written.1).expect("a document");
    let with = |declared: &str| {
        fs::write(&written.1, format!("<?xml version=\"1.0\"?>\n{declared}\n{plain}")).expect("written");
        written.faces(&mesh.patch())
    };
    assert_centroid(&with("<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>"), 2, CENTROID, "a document type");
    let entities = with("<!DOCTYPE Xdmf [<!ENTITY a \"0 0 0 0 0 0 0 0\"><!ENTITY b SYSTEM \"a.txt\">]>");
    assert_eq!(entities.map_err(|error| error.code()), Err("E-MESH-UNSUPPORTED"));
}

/// A patch of a whole brick has the five faces of it that are outside; the sixth, which it has in common with the other brick, is none.
#[test]
fn faces_between_cells_do_not_count() {
    let mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let patches = mesh.patch_where(|[x, ..]| x <= 1.0);
    let found = med(&mesh, &[("HE8", columns(&rows(&mesh.cells, 1), 8))]).faces(&patches);
    // Two of 2 × 1 at y, two of 1 × 1 … by area: x = 0: 2; below and above: 2 each; the sides: 1 each.
    let area = 2.0 + 2.0 * 2.0 + 2.0 * 1.0;
    assert_centroid(&found, 5, [(6.0 * 0.5) / area, 1.0, 0.5], "an end");
    // A cell that is there twice, in two topologies, is one cell.
    let cells = rows(&mesh.cells, 0);
    let twice = topology("Hexahedron", &cells) + &topology("Hexahedron", &cells[..8]);
    assert_centroid(&xdmf(&mesh, &twice).faces(&mesh.patch()), 2, CENTROID, "cells and a part of them");
}

/// Bottom, top and one side have all corners of a brick and not all nodes in the middles of its edges: the other sides have nodes elsewhere, and
/// no other order of the cell is made of those that are there.
#[test]
fn patches_with_all_corners_of_a_brick_need_not_have_its_edges() {
    for order in [Order::BottomTopUpright, Order::BottomUprightTop] {
        for n_nodes in [20, 27] {
            let mesh = Mesh::of(Shape::Brick, n_nodes, order);
            let patches = mesh.patch_where(|[x, _, z]| x <= 1.0 && (z == 0.0 || z == 1.0 || x == 0.0));
            let kind = if n_nodes == 20 { "H20" } else { "H27" };
            let found = med(&mesh, &[(kind, columns(&rows(&mesh.cells, 1), n_nodes))]).faces(&patches);
            // Below and above 1 × 2 each, the side at x = 0 is 2 × 1.
            assert_centroid(&found, 3, [1.0 / 3.0, 1.0, 0.5], kind);
        }
    }
}

/// A face that is there as a cell of a surface, too, is one face.
#[test]
fn surfaces_of_volumes_count_once() {
    let mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let numbers = columns(&rows(&mesh.cells, 1), 8);
    let below: Vec<Vec<usize>> = vec![mesh.cells[0][..4].to_vec()];
    let found = med(&mesh, &[("HE8", numbers), ("QU4", columns(&rows(&below, 1), 4)), ("SE2", vec![1, 2])]);
    assert_centroid(&found.faces(&mesh.patch()), 2, CENTROID, "with a surface");
}

/// Corners of the triangles on both sides of a diagonal of a quadrilateral.
fn halves(face: &[usize]) -> Vec<Vec<usize>> {
    vec![vec![face[0], face[1], face[2]], vec![face[0], face[2], face[3]]]
}

/// Cells of surfaces that lie on faces of volume cells with other corners add nothing to them.
#[test]
fn surfaces_on_volumes_count_once_whatever_their_corners() {
    let bricks = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let patch = bricks.patch();
    let cells = ("HE8", columns(&rows(&bricks.cells, 1), 8));
    let below: Vec<usize> = bricks.cells[0][..4].to_vec();
    let triangles = |faces: &[Vec<usize>]| ("TR3", columns(&rows(faces, 1), 3));
    let found = med(&bricks, &[cells.clone(), triangles(&halves(&below))]).faces(&patch);
    assert_centroid(&found, 2, CENTROID, "two triangles on one of two bricks");
    let found = med(&bricks, &[cells.clone(), triangles(&halves(&below)[1..])]).faces(&patch);
    assert_centroid(&found, 2, CENTROID, "one triangle");
    let quadrilateral = ("QU4", columns(&rows(std::slice::from_ref(&below), 1), 4));
    let found = med(&bricks, &[cells.clone(), triangles(&halves(&below)), quadrilateral.clone()]).faces(&patch);
    assert_centroid(&found, 2, CENTROID, "triangles on a cell of a surface on a brick");
    let alone = med(&bricks, &[triangles(&halves(&below)), quadrilateral.clone()]).faces(&patch);
    assert_centroid(&alone, 1, [0.5, 1.0, 0.0], "triangles on a cell of a surface");
    // In a stream the triangles come first.
    let stream: Vec<i64> =
        halves(&below).iter().flat_map(|t| [&[4], &rows(std::slice::from_ref(t), 0)[..]].concat()).collect();
    let bricks_of_it = bricks.cells.iter().flat_map(|cell| [&[9], &rows(std::slice::from_ref(cell), 0)[..]].concat());
    let stream: Vec<i64> = stream.into_iter().chain(bricks_of_it).collect();
    assert_centroid(&xdmf(&bricks, &topology("Mixed", &stream)).faces(&patch), 2, CENTROID, "in a stream");
    // Tetrahedra under a quadrilateral.
    let mut tetrahedra = Mesh::of(Shape::Tet, 4, Order::BottomTopUpright);
    let below: Vec<usize> =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]].map(|[x, y]| tetrahedra.node([x, y, 0.0])).into();
    let cells = columns(&rows(&tetrahedra.cells, 1), 4);
    let patch = tetrahedra.patch();
    let quadrilateral = ("QU4", columns(&rows(&[below], 1), 4));
    let found = med(&tetrahedra, &[("TE4", cells.clone()), quadrilateral.clone()]).faces(&patch);
    assert_centroid(&found, 4, CENTROID, "a quadrilateral on tetrahedra");
    // One of the two tetrahedra below it is gone.
    let is_left = |cell: &&Vec<usize>| cell.iter().filter(|node| tetrahedra.points[**node][2] == 0.0).count() < 3;
    let first = tetrahedra.cells.iter().position(|cell| !is_left(&cell)).expect("a tetrahedron with a face below");
    let mut cut = tetrahedra.cells.clone();
    cut.remove(first);
    let found = med(&tetrahedra, &[("TE4", columns(&rows(&cut, 1), 4)), quadrilateral]).faces(&patch);
    assert_unknown(&found, "in part", "half a quadrilateral");
}

/// A cell of a surface over several faces, or on a part of one, leaves open what the faces are; one next to them is a face more.
#[test]
fn surfaces_of_another_size_than_the_faces_below() {
    let mut bricks = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let mut cell = |x: [f64; 2], y: [f64; 2]| -> Vec<usize> {
        [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]].map(|[x, y]| bricks.node([x, y, 0.0])).into()
    };
    let (all, quarter, beyond) =
        (cell([0.0, 3.0], [0.0, 2.0]), cell([0.0, 0.5], [0.0, 1.0]), cell([3.0, 5.0], [0.0, 2.0]));
    let (patch, cells) = (bricks.patch(), ("HE8", columns(&rows(&bricks.cells, 1), 8)));
    let with =
        |surface: Vec<usize>| med(&bricks, &[cells.clone(), ("QU4", columns(&rows(&[surface], 1), 4))]).faces(&patch);
    assert_unknown(&with(all), "in part", "over both faces");
    assert_unknown(&with(quarter), "in part", "on a quarter of a face");
    assert_centroid(&with(beyond), 3, [2.5, 1.0, 0.0], "next to the faces");
}

/// The number of cells that a MED file states is named where it is not the number that is there.
#[test]
fn a_number_of_cells_that_is_wrong_is_named() {
    let mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let written = med(&mesh, &[("HE8", columns(&rows(&mesh.cells, 1), 8))]);
    let file = File::open_rw(&written.1).expect("a file");
    let connectivity = file.dataset(&format!("{STEP}/MAI/HE8/NOD")).expect("a dataset");
    connectivity.new_attr_builder().with_data(&[7]).create("NBR").expect("an attribute");
    drop((connectivity, file));
    let error = written.faces(&mesh.patch()).expect_err("a wrong number").to_string();
    assert!(
        error.ends_with("found 16 values – expected 8 for each of the 7 cells that the attribute NBR states"),
        "{error}"
    );
}

/// Eight triangles between the corners, the middles of the edges and the centre of a face of a brick of 27 nodes.
#[test]
fn surfaces_between_middles_of_edges_lie_on_the_face() {
    let mesh = Mesh::of(Shape::Brick, 27, Order::BottomTopUpright);
    let at = |x: f64, y: f64| mesh.points.iter().position(|p| *p == [x, y, 0.0]).expect("a node");
    let ring = [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (1.0, 2.0), (0.5, 2.0), (0.0, 2.0), (0.0, 1.0)];
    let centre = at(0.5, 1.0);
    let triangle = |k: usize| {
        let ((a, b), (c, d)) = (ring[k], ring[(k + 1) % 8]);
        vec![centre, at(a, b), at(c, d)]
    };
    let triangles: Vec<Vec<usize>> = (0..8).map(triangle).collect();
    let cells = ("H27", columns(&rows(&mesh.cells, 1), 27));
    let found = med(&mesh, &[cells, ("TR3", columns(&rows(&triangles, 1), 3))]).faces(&mesh.patch());
    assert_centroid(&found, 2, CENTROID, "eight triangles on a face");
}

/// Where one half of a mesh is a brick and the other one tetrahedra, the face between them is inside.
#[test]
fn faces_between_bricks_and_tetrahedra_do_not_count() {
    let mut mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let cut = Mesh::of(Shape::Tet, 4, Order::BottomTopUpright);
    let mut to_mesh =
        |cell: &Vec<usize>| -> Vec<usize> { cell.iter().map(|node| mesh.node(cut.points[*node])).collect() };
    let tetrahedra: Vec<Vec<usize>> = cut.cells[6..].iter().map(&mut to_mesh).collect();
    let numbers = |n: usize| columns(&rows(&tetrahedra[..n], 1), 4);
    let brick = ("HE8", columns(&rows(&mesh.cells[..1], 1), 8));
    let written = med(&mesh, &[brick.clone(), ("TE4", numbers(6))]);
    let between = mesh.patch_where(|[x, ..]| x == 1.0);
    assert_eq!(written.faces(&between).expect("read"), [], "nothing of the plane is outside");
    let whole = written.faces(&mesh.patch_where(|_| true));
    assert_centroid(&whole, 5 + 10, [1.5, 1.0, 0.5], "the outside of both halves");
    // Skin on the inner face is what a user put there.
    let plane: Vec<usize> = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]
        .map(|[y, z]| mesh.points.iter().position(|p| *p == [1.0, y, z]).expect("a node"))
        .into();
    let skin = ("QU4", columns(&rows(&[plane], 1), 4));
    let found = med(&mesh, &[brick.clone(), ("TE4", numbers(6)), skin]).faces(&between);
    assert_centroid(&found, 1, [1.0, 1.0, 0.5], "a surface between the halves");
    // A tetrahedron with a face on the brick is gone: half of that face is outside.
    let on_brick = |cell: &Vec<usize>| cell.iter().filter(|node| mesh.points[**node][0] == 1.0).count() == 3;
    let first = tetrahedra.iter().position(on_brick).expect("a tetrahedron at the brick");
    let mut left = tetrahedra.clone();
    left.remove(first);
    let found = med(&mesh, &[brick, ("TE4", columns(&rows(&left, 1), 4))]).faces(&between);
    assert_unknown(&found, "in part", "half a face");
}

/// Bricks with corners drawn onto others are wedges.
#[test]
fn collapsed_cells_have_the_faces_that_are_left() {
    let mut mesh = Mesh::of(Shape::Wedge, 6, Order::BottomTopUpright);
    for cell in &mut mesh.cells {
        let [a, b, c, d, e, f] = cell[..] else { panic!("a wedge") };
        *cell = vec![a, b, c, c, d, e, f, f];
    }
    let found = med(&mesh, &[("HE8", columns(&rows(&mesh.cells, 1), 8))]).faces(&mesh.patch());
    assert_centroid(&found, 4, CENTROID, "collapsed");
}

/// Nothing is said where the mesh does not tell.
#[test]
fn without_known_faces_nothing_is_claimed() {
    let mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let (patches, numbers) = (mesh.patch(), columns(&rows(&mesh.cells, 1), 8));
    let none = |written: &Written, what: &str| assert_eq!(written.faces(&patches).expect(what), [], "{what}");
    none(&med(&mesh, &[]), "no cells");
    none(&med(&mesh, &[("SE2", vec![1, 2])]), "lines");
    let unknown = |written: &Written, why: &str| assert_unknown(&written.faces(&patches), why, why);
    unknown(&med(&mesh, &[("HE8", numbers.clone()), ("POE", vec![1, 2])]), "cells of type POE");
    unknown(&moab(&mesh, "Polyhedron", (2, vec![11, 12])), "cells of type Polyhedron");
    unknown(&moab(&mesh, "Hex9", (9, vec![11; 9])), "cells of type Hex9");
    unknown(&xdmf(&mesh, &topology("3DSMesh", &[])), "a Topology of type 3DSMesh");
    for code in [3, 16, 49, 51, 58, 64, 71] {
        unknown(&xdmf(&mesh, &topology("Mixed", &[code, 3, 0, 1, 2])), &format!("cells of type {code}"));
    }
    let outside = "<Topology TopologyType=\"Hexahedron\"><DataItem Format=\"HDF\">/etc/a.h5:/c</DataItem></Topology>";
    unknown(&xdmf(&mesh, outside), "outside the folder");
    let corners = mesh.patch_where(|[x, y, z]| z == 0.0 && (x == 0.0) == (y == 0.0));
    assert_eq!(med(&mesh, &[("HE8", numbers)]).faces(&corners).expect("read"), [], "nodes without a face between them");
    // Nodes of edges in an order that is none of the known.
    let mut shuffled = Mesh::of(Shape::Brick, 20, Order::BottomTopUpright);
    shuffled.cells.iter_mut().for_each(|cell| cell[8..12].rotate_left(1));
    let found = med(&shuffled, &[("H20", columns(&rows(&shuffled.cells, 1), 20))]).faces(&shuffled.patch());
    assert_unknown(&found, "in an order that no format has", "an order of its own");
}

#[test]
fn tables_of_nodes_have_no_faces() {
    let written = Written::new("a.csv");
    fs::write(&written.1, "node,x,y,z\n1,0,0,0\n2,1,0,0\n").expect("written");
    let mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let patches = mesh.patch();
    assert_eq!(written.faces(&patches).expect("nothing is read"), []);
}

#[test]
fn connectivity_that_cannot_be_right_is_refused() {
    let mesh = Mesh::of(Shape::Brick, 8, Order::BottomTopUpright);
    let patches = mesh.patch();
    let code = |written: &Written| written.faces(&patches).map_err(|error| error.code());
    let changed = |at: usize, to: i64, first: i64| {
        let mut numbers = rows(&mesh.cells, first);
        numbers[at] = to;
        numbers
    };
    for wrong in [i64::MIN, -1, 0, 13, i64::MAX] {
        let numbers = columns(&changed(3, wrong, 1), 8);
        assert_eq!(code(&med(&mesh, &[("HE8", numbers)])), Err("E-HDF5-INDEX"), "{wrong}");
        let wrong = wrong.saturating_add(10);
        assert_eq!(code(&moab(&mesh, "Hex8", (8, changed(15, wrong, 11)))), Err("E-HDF5-INDEX"), "{wrong}");
    }
    for wrong in [i64::MIN, -1, 12, i64::MAX] {
        let table = topology("Hexahedron", &changed(0, wrong, 0));
        assert_eq!(code(&xdmf(&mesh, &table)), Err("E-HDF5-INDEX"), "{wrong}");
    }
    let cut = &rows(&mesh.cells, 1)[..15];
    assert_eq!(code(&med(&mesh, &[("HE8", cut.to_vec())])), Err("E-HDF5-SHAPE"));
    assert_eq!(code(&moab(&mesh, "Hex8", (5, cut.to_vec()))), Err("E-HDF5-SHAPE"));
    assert_eq!(code(&xdmf(&mesh, &topology("Hexahedron", &[0; 15]))), Err("E-HDF5-SHAPE"));
    let stated = topology("Hexahedron", &[0; 16]).replace("\"16\"", "\"4 8\"");
    assert_eq!(code(&xdmf(&mesh, &stated)), Err("E-HDF5-SHAPE"));
    assert_eq!(
        code(&xdmf(&mesh, &topology("Mixed", &[9, 0, 1, 2]))),
        Err("E-HDF5-SHAPE"),
        "a stream that ends in a cell"
    );
    assert_eq!(code(&xdmf(&mesh, &topology("Mixed", &[2]))), Err("E-HDF5-SHAPE"), "a line without its length");
    assert_eq!(code(&xdmf(&mesh, &topology("Mixed", &[2, i64::MAX]))), Err("E-HDF5-SHAPE"), "a line without end");
    for none in [i64::MIN, -1, 0, 10, 15, 17, 33, 42, 47, 59, 63, 72, 99, i64::MAX] {
        assert_eq!(code(&xdmf(&mesh, &topology("Mixed", &[none, 0]))), Err("E-HDF5-TYPE"), "{none}: no kind of cell");
    }
    let words = topology("Hexahedron", &[0; 8]).replace("0 0", "0 x");
    assert_eq!(code(&xdmf(&mesh, &words)), Err("E-HDF5-TYPE"));
}

/// Whatever numbers a file has, faces are found or the file is refused.
#[test]
fn random_connectivity_never_panics() {
    let mesh = Mesh::of(Shape::Brick, 27, Order::BottomTopUpright);
    let patches = mesh.patch_where(|_| true);
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |below: i64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as i64 % below
    };
    let n = mesh.points.len() as i64;
    for (_, n_nodes, kind) in &KINDS {
        let numbers: Vec<i64> = (0..40 * n_nodes).map(|_| random(n)).collect();
        let one = numbers.iter().map(|number| number + 1).collect();
        let found = med(&mesh, &[(kind.med, one)]).faces(&patches).expect("nodes that are there");
        let is_finite = |found: &PatchFaces| match &found.faces {
            Faces::Known { centroid, .. } => centroid.iter().all(|x| x.is_finite()),
            Faces::Unknown { reason } => !reason.is_empty(),
        };
        assert!(found.iter().all(is_finite), "{found:?}");
        let stream: Vec<i64> = (0..60).map(|_| random(52)).collect();
        let _ = xdmf(&mesh, &topology("Mixed", &stream)).faces(&patches);
    }
}

/// Many faces of few nodes take no more memory than is allowed.
#[test]
fn faces_are_counted_against_the_memory() {
    let mesh = Mesh::of(Shape::Brick, 27, Order::BottomTopUpright);
    let patches = mesh.patch_where(|_| true);
    let n = mesh.points.len();
    let triples = (0..n).flat_map(|a| (a + 1..n).flat_map(move |b| (b + 1..n).map(move |c| vec![a, b, c])));
    let triangles: Vec<Vec<usize>> = triples.collect();
    let bytes = (triangles.len() * 3 * 16) as u64;
    let written = med(&mesh, &[("TR3", columns(&rows(&triangles, 1), 3))]);
    let Faces::Known { faces, .. } = &written.faces(&patches).expect("room")[0].faces else { panic!("no faces") };
    assert_eq!(faces.len(), triangles.len());
    let within =
        |bytes_of_face: u64| written.faces_within(&patches, Some(bytes + triangles.len() as u64 * bytes_of_face));
    // A face counts 768 bytes where it is kept and 256 more while faces are compared. Without the first 300 would do, and 800 without the
    // second.
    for too_few in [300, 800] {
        let outcome = within(too_few);
        assert!(matches!(outcome, Err(Error::MemoryRead { .. })), "{too_few}: {outcome:?}");
    }
    assert!(within(1100).is_ok());
}

/// The bundled example: the base is a square plate with holes, the eye a bore.
#[test]
fn the_bundled_mesh_has_faces() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/bracket/bracket.med");
    let nodes = supel::input::hdf5::read_nodes(&path).expect("a mesh");
    let patch = |group: &str| Patch { of: Selector::Interface(group.to_owned()), nodes: nodes.groups[group].clone() };
    let patches = Patches { coordinates: &nodes.coordinates, list: vec![patch("BASE"), patch("EYE")] };
    let model = ModelJob { nodes: Some(path), ..ModelJob::default() };
    let found = patch_faces(&model, &patches, &Allowance::of(None)).expect("faces");
    assert_eq!(found.iter().map(|faces| faces.of.name()).collect::<Vec<_>>(), ["BASE", "EYE"]);
}
