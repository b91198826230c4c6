//! Pieces of an element with two nodes of six dofs, in axes of its own.

/// A matrix of the element: displacements and rotations of its first node, then of its second.
pub type Element = [[f64; 12]; 12];

/// Adds the two-node matrix [d o; o d] for the direction `first`.
pub fn add_rod(matrix: &mut Element, first: usize, [diagonal, off]: [f64; 2]) {
    let second = first + 6;
    matrix[first][first] += diagonal;
    matrix[second][second] += diagonal;
    matrix[first][second] += off;
    matrix[second][first] += off;
}

/// Adds a multiple of a block of four rows and columns.
pub fn place(matrix: &mut Element, rows: &[usize; 4], block: &[[f64; 4]; 4], factor: f64) {
    for (&row, values) in rows.iter().zip(block) {
        for (&column, value) in rows.iter().zip(values) {
            matrix[row][column] += factor * value;
        }
    }
}

/// TᵀAT with T = diag(axes, axes, axes, axes); the local axes are rows.
pub fn to_global(local: &Element, axes: &[[f64; 3]; 3]) -> Element {
    let rotate = |row: usize, d: usize| axes[row % 3][d];
    let mut global = [[0.0; 12]; 12];
    for (i, j) in (0..12).flat_map(|i| (i..12).map(move |j| (i, j))) {
        let (block_i, block_j) = (i - i % 3, j - j % 3);
        for (r, s) in (block_i..block_i + 3).flat_map(|r| (block_j..block_j + 3).map(move |s| (r, s))) {
            global[i][j] += rotate(r, i % 3) * local[r][s] * rotate(s, j % 3);
        }
        global[j][i] = global[i][j];
    }
    global
}
