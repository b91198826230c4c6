//! Types of elements of Abaqus and CalculiX: which cell each is, and which of its nodes are on which face.

use crate::input::cell_kind::Kind;
use crate::input::faces::{Cell, Shape};

/// What is known of a type of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ElementType {
    /// The cell that it is.
    pub(super) kind: Kind,
    /// Whether faces are numbered as those of a solid, a shell or a cell in the plane.
    pub(super) numbering: Numbering,
}

/// How the faces of an element are numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbering {
    Solid,
    Shell,
    Plane,
    None,
}

/// Families of solids: what stands before the number of nodes.
const SOLIDS: [&str; 9] = ["C3D", "AC3D", "DC3D", "DCC3D", "Q3D", "EMC3D", "F3D", "COH3D", "SC"];
/// Families of shells, membranes and rigid surfaces.
const SHELLS: [&str; 8] = ["STRI", "S", "DS", "M3D", "SFM3D", "R3D", "ACIN3D", "EMC2D"];
/// Families in the plane or of revolution.
const PLANES: [&str; 13] =
    ["CPS", "CPEG", "CPE", "CAX", "CGAX", "AC2D", "ACAX", "DC2D", "DCC2D", "DCAX", "DCCAX", "COH2D", "COHAX"];
/// Beginnings of the names of elements without faces.
const FACELESS: [&str; 27] = [
    "B2", "B3", "PIPE", "T2D", "T3D", "DC1D", "DCC1D", "SAX", "RAX", "R2D", "MAX1", "MAX2", "MGAX", "SFMAX", "ELBOW",
    "FRAME", "SPRING", "DASHPOT", "MASS", "ROTARYI", "HEATCAP", "CONN", "GAP", "DCOUP", "JOINT", "ITS", "RB",
];

impl ElementType {
    /// The type of a name.
    pub(super) fn of(name: &str) -> Self {
        let name = name.to_ascii_uppercase();
        let with = |kind, numbering| Self { kind, numbering };
        if name == "D" || FACELESS.iter().any(|start| name.starts_with(start)) {
            return with(Kind::Faceless, Numbering::None);
        }
        let family = name.trim_end_matches(|c: char| !c.is_ascii_digit());
        // Of `C3D20R` the family is `C3D` and the number 20, of `S8R5` it is `S` and 8.
        let number_of = |family: &str| -> Option<(usize, String)> {
            let rest = name.strip_prefix(family)?;
            let n_digits = rest.bytes().take_while(u8::is_ascii_digit).count();
            Some((rest[..n_digits].parse().ok()?, rest[n_digits..].to_owned()))
        };
        let found = |families: &[&str]| families.iter().find_map(|family| number_of(family));
        let unknown = with(Kind::Unknown, Numbering::None);
        if family.is_empty() {
            return unknown;
        }
        if let Some((n_nodes, rest)) = found(&SOLIDS) {
            // The number of nodes of a C3D15V and of a C3D27 is not that of the name.
            let is_variable = rest.starts_with('V') || n_nodes == 27;
            return match solid(n_nodes) {
                Some(cell) if !is_variable => with(Kind::Faced(cell), Numbering::Solid),
                _ => unknown,
            };
        }
        for (families, numbering) in [(&PLANES[..], Numbering::Plane), (&SHELLS, Numbering::Shell)] {
            if let Some((n_nodes, _)) = found(families) {
                // STRI65 has six nodes.
                let n_nodes = if n_nodes == 65 { 6 } else { n_nodes };
                return surface(n_nodes).map_or(unknown, |cell| with(Kind::Faced(cell), numbering));
            }
        }
        unknown
    }

    /// How many nodes an element has, where the type says it.
    pub(super) fn n_nodes(self) -> Option<usize> {
        match self.kind {
            Kind::Faced(cell) => Some(cell.n_nodes()),
            Kind::Faceless | Kind::Unknown => None,
        }
    }

    /// The places of the nodes on a face, by the label of the face: `S3`, `SPOS`, `E1`. None where there is no such face.
    pub(super) fn nodes_on(self, face: &str) -> Option<Vec<usize>> {
        let Kind::Faced(cell) = self.kind else { return None };
        let face = face.to_ascii_uppercase();
        let number = face.get(1..).and_then(|number| number.parse::<usize>().ok()).and_then(|n| n.checked_sub(1));
        let all = || Some((0..cell.n_nodes()).collect());
        let edge = |at: usize| cell.edges().get(at).map(|edge| cell.nodes_on(edge));
        match self.numbering {
            Numbering::Solid if face.starts_with('S') => faces_of(cell).get(number?).map(|face| cell.nodes_on(face)),
            // CalculiX counts the edges of a shell from three.
            Numbering::Shell if face.starts_with('S') => match number {
                None | Some(0 | 1) => matches!(&*face, "SPOS" | "SNEG" | "S1" | "S2").then(all)?,
                Some(number) => edge(number - 2),
            },
            Numbering::Shell if face.starts_with('E') => edge(number?),
            Numbering::Plane if matches!(&*face, "SPOS" | "SNEG" | "SP" | "SN") => all(),
            Numbering::Plane if face.starts_with('S') => edge(number?),
            _ => None,
        }
    }

    /// The places of the nodes on each of the faces that a surface without labels of faces has.
    pub(super) fn all_faces(self) -> Vec<Vec<usize>> {
        let Kind::Faced(cell) = self.kind else { return Vec::new() };
        match self.numbering {
            Numbering::Solid => faces_of(cell).iter().map(|face| cell.nodes_on(face)).collect(),
            Numbering::Shell => vec![(0..cell.n_nodes()).collect()],
            Numbering::Plane => cell.edges().iter().map(|edge| cell.nodes_on(edge)).collect(),
            Numbering::None => Vec::new(),
        }
    }
}

/// Corners of the faces in the order of Abaqus and CalculiX.
fn faces_of(cell: Cell) -> &'static [&'static [usize]] {
    match cell.shape() {
        Shape::Tetrahedron => &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]],
        Shape::Pyramid => &[&[0, 1, 2, 3], &[0, 4, 1], &[1, 4, 2], &[2, 4, 3], &[3, 4, 0]],
        Shape::Wedge => &[&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]],
        Shape::Brick => &[&[0, 1, 2, 3], &[4, 7, 6, 5], &[0, 4, 5, 1], &[1, 5, 6, 2], &[2, 6, 7, 3], &[3, 7, 4, 0]],
        Shape::Triangle | Shape::Quadrilateral => &[],
    }
}

fn solid(n_nodes: usize) -> Option<Cell> {
    let shape = match n_nodes {
        4 | 10 => Shape::Tetrahedron,
        5 | 13 => Shape::Pyramid,
        6 | 15 => Shape::Wedge,
        8 | 20 => Shape::Brick,
        _ => return None,
    };
    Cell::new(shape, n_nodes)
}

fn surface(n_nodes: usize) -> Option<Cell> {
    let shape = if matches!(n_nodes, 3 | 6) { Shape::Triangle } else { Shape::Quadrilateral };
    Cell::new(shape, n_nodes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn n_nodes(name: &str) -> Option<usize> {
        ElementType::of(name).n_nodes()
    }

    #[test]
    fn names_of_types() {
        let known = [
            ("C3D4", 4),
            ("C3D10M", 10),
            ("c3d20rh", 20),
            ("C3D8I", 8),
            ("C3D15", 15),
            ("C3D6", 6),
            ("C3D5", 5),
            ("AC3D20", 20),
            ("SC8R", 8),
            ("S3", 3),
            ("STRI65", 6),
            ("STRI3", 3),
            ("S8R5", 8),
            ("S9R5", 9),
            ("S4R", 4),
            ("M3D6", 6),
            ("CPS8R", 8),
            ("CPEG4", 4),
            ("CAX6M", 6),
            ("R3D4", 4),
            ("DC3D10", 10),
            ("COH3D8", 8),
        ];
        for (name, n) in known {
            assert_eq!(n_nodes(name), Some(n), "{name}");
        }
        for name in ["B31", "B32R", "T3D2", "SPRINGA", "MASS", "DASHPOTA", "D", "CONN3D2", "GAPUNI", "PIPE31"] {
            assert_eq!(ElementType::of(name).kind, Kind::Faceless, "{name}");
        }
        for name in ["C3D27", "C3D15V", "CIN3D8", "U1", "", "C3D", "C3D999999999999999999999", "CCL24"] {
            assert_eq!(ElementType::of(name).kind, Kind::Unknown, "{name}");
        }
    }

    /// Faces by the manuals of both programs; node numbers there count from one.
    #[test]
    fn faces_with_the_nodes_of_their_edges() {
        let on = |name: &str, face: &str| {
            let nodes = ElementType::of(name).nodes_on(face);
            nodes.map(|mut nodes| {
                nodes.sort_unstable();
                nodes.into_iter().map(|node| node + 1).collect::<Vec<_>>()
            })
        };
        assert_eq!(on("C3D20", "S4"), Some(vec![2, 3, 6, 7, 10, 14, 18, 19]));
        assert_eq!(on("C3D20", "S2"), Some(vec![5, 6, 7, 8, 13, 14, 15, 16]));
        assert_eq!(on("C3D10", "S3"), Some(vec![2, 3, 4, 6, 9, 10]));
        assert_eq!(on("C3D15", "s5"), Some(vec![1, 3, 4, 6, 9, 12, 13, 15]));
        assert_eq!(on("C3D5", "S3"), Some(vec![2, 3, 5]));
        assert_eq!(on("S8R", "SPOS"), Some((1..=8).collect()));
        assert_eq!((on("S8R", "E2"), on("S8R", "S4")), (Some(vec![2, 3, 6]), Some(vec![2, 3, 6])));
        assert_eq!(on("CPS4", "S4"), Some(vec![1, 4]));
        for (name, face) in
            [("C3D8", "S7"), ("C3D8", "S0"), ("C3D8", "S"), ("C3D8", ""), ("B31", "S1"), ("CPS4", "E9"), ("S4", "Sé")]
        {
            assert_eq!(on(name, face), None, "{name} {face}");
        }
    }
}
