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
    /// A vertex at each of so many points.
    pub fn vertices(n_points: usize) -> Self {
        /// VTK's number of a vertex.
        const VERTEX: u8 = 1;
        let n = n_points as i64;
        Self { connectivity: (0..n).collect(), offsets: (0..=n).collect(), types: vec![VERTEX; n_points] }
    }
}
