//! What a VTKHDF file holds of a grid.

/// Cells on numbered points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cells {
    /// Points of all cells, one cell after the other, counted from zero.
    pub connectivity: Vec<i64>,
    /// Where each cell begins among these, and their end.
    pub offsets: Vec<i64>,
    /// VTK's number of the kind of each cell.
    pub types: Vec<u8>,
}

/// Values that each point has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// What ParaView calls it.
    pub name: &'static str,
    /// 1 for a scalar, 3 for a vector.
    pub n_components: usize,
}

/// Values of a field at all points.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// One number each.
    Scalars(&'a [f64]),
    /// A vector each.
    Vectors(&'a [[f64; 3]]),
}

impl Cells {
    /// Faces between points, and a vertex at each of the `n_points` points that no face has.
    ///
    /// The kind of a face follows from how many points it has; VTK orders them as [`supel_runtime::RecoveredFaces`] does.
    pub fn of_faces<'a>(faces: impl IntoIterator<Item = &'a [usize]>, n_points: usize) -> Self {
        /// VTK's number of a vertex.
        const VERTEX: u8 = 1;
        let mut cells = Self { connectivity: Vec::new(), offsets: vec![0], types: Vec::new() };
        let mut is_alone = vec![true; n_points];
        for face in faces {
            face.iter().for_each(|point| is_alone[*point] = false);
            cells.push(face, kind_of_face(face.len()));
        }
        for point in (0..n_points).filter(|point| is_alone[*point]) {
            cells.push(&[point], VERTEX);
        }
        cells
    }

    fn push(&mut self, points: &[usize], kind: u8) {
        self.connectivity.extend(points.iter().map(|point| *point as i64));
        self.offsets.push(self.connectivity.len() as i64);
        self.types.push(kind);
    }
}

/// VTK's number of a triangle or quadrilateral with so many points.
fn kind_of_face(n_points: usize) -> u8 {
    match n_points {
        3 => 5,
        4 => 9,
        6 => 22,
        7 => 34,
        8 => 23,
        9 => 28,
        // A polygon: no face of a superelement has another number of nodes.
        _ => 7,
    }
}
