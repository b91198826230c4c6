//! Rows of nodes under the labels of others, told by the cells of the mesh where no force does: nodes at one place.

use supel_models::model::{Assembler, Entry};
use supel_models::transform::{join, translated};
use supel_models::{HexMesh, Material, Model, brick};

use crate::place::{Ended, Place, xdmf};
use crate::table::{listed, said};

/// Cells of each block, and its sizes.
const CELLS: [usize; 3] = [3, 2, 2];
const SIZE: [f64; 3] = [0.7, 0.5, 0.4];
/// Nodes of a block.
const N: i64 = 36;

/// Blocks that touch each other node by node, held together by springs between nodes at one place.
struct Blocks {
    model: Model,
    cells: Vec<Vec<usize>>,
}

impl Blocks {
    /// `at` has the corner of each, in sizes of a block.
    fn of(at: &[[f64; 3]]) -> Self {
        let block = brick(CELLS, SIZE, &Material::STEEL_SI);
        let placed = |at: &[f64; 3]| translated(&block, [0, 1, 2].map(|d| SIZE[d] * at[d]));
        let mut model = at[1..].iter().fold(placed(&at[0]), |all, at| join(&all, &placed(at), &[]));
        let mut stiffness = Assembler::default();
        stiffness.extend(model.stiffness.iter().copied());
        for (i, j) in (0..model.nodes.len()).flat_map(|j| (0..j).map(move |i| (i, j))) {
            let [a, b] = [i, j].map(|node| model.nodes[node]);
            if (0..3).all(|d| (a[d] - b[d]).abs() < 1e-9) {
                (0..3).for_each(|d| stiffness.extend(spring((3 * i + d) as u32, (3 * j + d) as u32)));
            }
        }
        model.stiffness = stiffness.finish();
        let mesh = HexMesh::structured(CELLS, |point| point, |_| true);
        let of_block = |k: usize, cell: &[u32; 8]| cell.iter().map(|node| *node as usize + N as usize * k).collect();
        let cells = (0..at.len()).flat_map(|k| mesh.elements.iter().map(move |cell| of_block(k, cell)));
        Self { cells: cells.collect(), model }
    }

    fn in_a_row(n_blocks: usize) -> Self {
        Self::of(&[0.0, 1.0, 2.0].map(|x| [x, 0.0, 0.0])[..n_blocks])
    }

    /// One more spring than cells know, between two nodes of one height.
    fn with_spring(mut self) -> Self {
        let mut stiffness = Assembler::default();
        stiffness.extend(self.model.stiffness.iter().copied());
        stiffness.extend(spring(0, 3 * 2));
        self.model.stiffness = stiffness.finish();
        self
    }

    /// What is said of a map with some nodes relabelled, each as the next one and the last as the first, by cells as they are.
    fn said(&self, labels: &[i64]) -> String {
        let label = |node: i64| match labels.iter().position(|other| *other == node) {
            Some(at) => labels[(at + 1) % labels.len()],
            None => node,
        };
        let dofs = self.model.dofs.iter().map(|(node, direction)| (label(*node), *direction)).collect();
        self.reduced(&Model { dofs, ..self.model.clone() }, &[("Hexahedron", self.cells.clone())])
    }

    /// What is said of a map with the labels of some pairs exchanged.
    fn exchanged(&self, pairs: &[[i64; 2]]) -> String {
        let label = |node: i64| {
            let of_pair = |[a, b]: &[i64; 2]| [(*a, *b), (*b, *a)].into_iter().find(|(own, _)| *own == node);
            pairs.iter().find_map(of_pair).map_or(node, |(_, other)| other)
        };
        let dofs = self.model.dofs.iter().map(|(node, direction)| (label(*node), *direction)).collect();
        self.reduced(&Model { dofs, ..self.model.clone() }, &[("Hexahedron", self.cells.clone())])
    }

    /// What is said of a model whose mesh has such cells.
    fn reduced(&self, model: &Model, cells: &[(&str, Vec<Vec<usize>>)]) -> String {
        let (place, ended) = reduced(model, &xdmf(&model.nodes, cells));
        said(&place, &ended)
    }
}

/// A spring between two rows.
fn spring(i: u32, j: u32) -> [Entry; 3] {
    [(i, i, 1e9), (j, j, 1e9), (i.min(j), i.max(j), -1e9)]
}

fn reduced(model: &Model, mesh: &str) -> (Place, Ended) {
    let place = Place::with(model);
    place.write("mesh.xdmf", mesh.as_bytes());
    let mut flags = place.matrix_flags();
    flags.extend(["--dofs".to_owned(), place.text("dofs.txt"), "--nodes".to_owned(), place.text("mesh.xdmf")]);
    let end: Vec<i64> = (1..=N).filter(|label| label % 4 == 1).collect();
    let ended = place.reduce(&flags, &format!("--method craig-bampton --interface end={} --modes 4", listed(&end)));
    (place, ended)
}

#[test]
fn nodes_at_one_place_exchanged_in_the_map() {
    let [two, three] = [2, 3].map(Blocks::in_a_row);
    let seam: Vec<i64> = (1..=N).filter(|label| label % 4 == 0).collect();
    for label in [4, 20, 36] {
        let pair = [label, N + label - 3];
        let [a, b] = pair.map(|label| two.model.nodes[label as usize - 1]);
        assert!((0..3).all(|d| (a[d] - b[d]).abs() < 1e-12), "{a:?} and {b:?} are one place");
        assert_eq!(two.said(&pair), "E-CELL-ORDER", "{pair:?}");
        assert_eq!(Blocks::in_a_row(2).with_spring().said(&pair), "E-CELL-ORDER", "{pair:?} and a spring");
        assert_eq!(three.said(&pair), "E-CELL-ORDER", "{pair:?} of three");
    }
    assert_eq!(two.said(&[]), "verified");
    assert_eq!(Blocks::in_a_row(2).with_spring().said(&[]), "verified");
    // All pairs of the seam, and half of it.
    let pairs: Vec<[i64; 2]> = seam.iter().map(|label| [*label, N + label - 3]).collect();
    for blocks in [&two, &Blocks::in_a_row(2).with_spring()] {
        assert_eq!(blocks.exchanged(&pairs), "E-CELL-ORDER");
        assert_eq!(blocks.exchanged(&pairs[..4]), "E-CELL-ORDER");
    }
    // Two blocks at one place, exchanged but for one end: neighbours go along with each node, and the border alone lacks some.
    let doubled = Blocks::of(&[[0.0; 3]; 2]).with_spring();
    assert_eq!(doubled.said(&[]), "verified");
    let most: Vec<[i64; 2]> = (1..=N).filter(|label| label % 4 != 1).map(|label| [label, N + label]).collect();
    assert_eq!(doubled.exchanged(&most), "E-CELL-ORDER");
}

/// Three nodes at one place, each under the label of the next: two are not exchanged, and K has springs that cells know nothing of.
#[test]
fn three_nodes_at_one_place_in_a_ring() {
    let blocks = Blocks::of(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, -1.0, 0.0]]).with_spring();
    assert_eq!(blocks.said(&[]), "verified");
    assert_eq!(blocks.said(&[4, N + 1, 2 * N + 9]), "W-CELL-ORDER");
}

/// Cells that are no elements of the matrices, and elements that have no cell.
#[test]
fn cells_of_another_purpose_are_sound() {
    let row = Blocks::in_a_row(2);
    let surface: Vec<Vec<usize>> = row.cells.iter().map(|cell| cell[..4].to_vec()).collect();
    let spider: Vec<Vec<usize>> = (0..8).map(|k| vec![0, 71 - k, 70 - k]).collect();
    let half = row.cells[..12].to_vec();
    for cells in [
        vec![("Quadrilateral", surface)],
        vec![("Hexahedron", row.cells.clone()), ("Triangle", spider.clone())],
        vec![("Triangle", spider), ("Hexahedron", half)],
    ] {
        assert_eq!(
            row.reduced(&row.model, &cells),
            "verified",
            "{:?}",
            cells.iter().map(|(kind, _)| kind).collect::<Vec<_>>()
        );
    }
}

/// Cells that K knows nothing of, at most of their nodes. With a spring counts of neighbours differ, and no two nodes are exchanged: the
/// order is that of multiples of five by the prime 73, which takes none back.
#[test]
fn cells_of_another_mesh() {
    for row in [Blocks::in_a_row(2), Blocks::in_a_row(2).with_spring()] {
        let moved = |node: &usize| (node + 1) * 5 % 73 - 1;
        let cells = row.cells.iter().map(|cell| cell.iter().map(moved).collect()).collect();
        assert_eq!(row.reduced(&row.model, &[("Hexahedron", cells)]), "E-CELL-ORDER");
    }
}

#[test]
fn damaged_cells_are_compared_with_nothing() {
    let row = Blocks::in_a_row(2);
    let mut cells = row.cells.clone();
    cells[3][2] = 4000;
    let (place, ended) = reduced(&row.model, &xdmf(&row.model.nodes, &[("Hexahedron", cells)]));
    assert_eq!(said(&place, &ended), "verified", "{}{}", ended.out, ended.err);
    let notes = place.report("x.report.json")["body"]["model"]["notes"].to_string();
    assert!(notes.contains("its cells are not compared with the stiffness"), "{notes}");
}
