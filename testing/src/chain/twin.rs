//! The dense twin of a partition, made from the model's own entries and from the definitions of a rigid patch and of a mean motion.

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};
use supel::basis::Basis;
use supel::dofs::Direction;
use supel::job::{Coupling, InterfaceJob, NodeSelection, Origin, Weights};
use supel::model::Site;
use supel::partition::{DofOrigin, Partition};
use supel::sparse::SparseMatrix;
use supel_models as models;
use supel_models::model::Entry;

/// Rounding unit of double precision.
pub const EPS: f64 = f64::EPSILON;

/// The dense twin of a partition.
pub struct Twin {
    /// T, n × n'.
    pub transformation: Mat<f64>,
    /// TᵀKT, scaled as the partition is.
    pub k: Mat<f64>,
    /// TᵀMT, scaled as the partition is.
    pub m: Mat<f64>,
    /// |T|ᵀ|K||T|: the sizes of the terms that K is summed from, which its rounding is relative to.
    pub k_terms: Mat<f64>,
    /// |T|ᵀ|M||T|.
    pub m_terms: Mat<f64>,
    /// n_I.
    pub n_i: usize,
}

impl Twin {
    pub fn new(model: &models::Model, interfaces: &[InterfaceJob], partition: &Partition) -> Self {
        let (transformation, sizes) = transformation(model, interfaces, partition);
        for (index, node) in partition.interface.iter().enumerate() {
            let job = interfaces.iter().find(|job| job.name == node.name).expect("a job for every node");
            if job.coupling == Coupling::Average {
                assert_mean_motion(model, job, (partition, index), transformation.as_ref());
            }
        }
        let scaled = |entries: &[Entry], unit: f64| {
            let mut full = Mat::zeros(model.n, model.n);
            entries.iter().for_each(|&(i, j, value)| full[(i as usize, j as usize)] = value / unit);
            full
        };
        let k = scaled(&model.stiffness, partition.scaling.stiffness_unit());
        let m = scaled(&model.mass, partition.scaling.mass_unit());
        let t = &transformation;
        Self {
            k: t.transpose() * &k * t,
            m: t.transpose() * &m * t,
            k_terms: sizes.transpose() * absolute(k.as_ref()) * &sizes,
            m_terms: sizes.transpose() * absolute(m.as_ref()) * &sizes,
            n_i: partition.n_internal,
            transformation,
        }
    }

    fn n_b(&self) -> usize {
        self.k.nrows() - self.n_i
    }

    pub fn k_ii(&self) -> MatRef<'_, f64> {
        self.k.submatrix(0, 0, self.n_i, self.n_i)
    }

    pub fn m_ii(&self) -> MatRef<'_, f64> {
        self.m.submatrix(0, 0, self.n_i, self.n_i)
    }

    pub fn k_ib(&self) -> MatRef<'_, f64> {
        self.k.submatrix(0, self.n_i, self.n_i, self.n_b())
    }

    pub fn m_ib(&self) -> MatRef<'_, f64> {
        self.m.submatrix(0, self.n_i, self.n_i, self.n_b())
    }

    pub fn k_bb(&self) -> MatRef<'_, f64> {
        self.k.submatrix(self.n_i, self.n_i, self.n_b(), self.n_b())
    }

    /// K_II⁻¹ F.
    pub fn solve(&self, forces: MatRef<'_, f64>) -> Mat<f64> {
        self.k_ii().llt(Side::Lower).expect("K_II is definite").solve(forces)
    }

    /// n_I κ ε: the relative error that solving with K_II may have, κ of the matrix with unit diagonal, because Cholesky
    /// factorisation does not see a diagonal scaling (van der Sluis 1969; Higham 2002, theorem 10.6).
    pub fn solve_error(&self) -> f64 {
        let d: Vec<f64> = (0..self.n_i).map(|i| self.k[(i, i)].sqrt()).collect();
        let scaled = Mat::from_fn(self.n_i, self.n_i, |i, j| self.k[(i, j)] / (d[i] * d[j]));
        let eigenvalues = scaled.self_adjoint_eigenvalues(Side::Lower).expect("a finite matrix");
        self.n_i as f64 * EPS * eigenvalues[self.n_i - 1] / eigenvalues[0]
    }

    /// All finite eigenvalues of the free component, ascending.
    pub fn free_spectrum(&self) -> Vec<f64> {
        spectrum(self.k.as_ref(), self.m.as_ref())
    }

    /// All finite eigenvalues with the interface held, ascending.
    pub fn clamped_spectrum(&self) -> Vec<f64> {
        spectrum(self.k_ii(), self.m_ii())
    }
}

/// T from the definition: one at a dof's own row, the rigid motion about the patch's node elsewhere; and the sizes that
/// rounding of its entries is relative to, which for a lever are those of the coordinates it is the difference of.
fn transformation(model: &models::Model, interfaces: &[InterfaceJob], partition: &Partition) -> (Mat<f64>, Mat<f64>) {
    let position = |label: i64| model.nodes[model.labels.iter().position(|other| *other == label).expect("a node")];
    let mut t = Mat::zeros(model.n, partition.dofs.len());
    let mut sizes = t.clone();
    for (column, dof) in partition.dofs.iter().enumerate() {
        match dof.origin {
            DofOrigin::Row(row) => (t[(row, column)], sizes[(row, column)]) = (1.0, 1.0),
            // Any will do that leave the mean motion as it is: see assert_mean_motion.
            DofOrigin::Distortion(..) => {
                for (row, own) in partition.transformation.rows.iter().enumerate() {
                    for (_, factor) in own.entries().filter(|(dof, _)| *dof as usize == column) {
                        (t[(row, column)], sizes[(row, column)]) = (factor, factor.abs());
                    }
                }
            }
            DofOrigin::PatchNode(index, direction) => {
                let node = &partition.interface[index];
                let job = interfaces.iter().find(|job| job.name == node.name).expect("a job for every node");
                let members = members(model, &job.nodes);
                let centre = centre(model, job);
                let follows =
                    |dof: &(i64, u8)| members.contains(&dof.0) && (job.coupling == Coupling::Rigid || dof.1 < 3);
                for (row, &(label, at)) in model.dofs.iter().enumerate().filter(|(_, dof)| follows(dof)) {
                    let r = position(label);
                    let at = Direction::ALL[usize::from(at)];
                    let lever = |offset| unit_motions(Site { position: offset, direction: at })[direction as usize];
                    t[(row, column)] = lever(std::array::from_fn(|axis| r[axis] - centre[axis]));
                    sizes[(row, column)] = lever(std::array::from_fn(|axis| r[axis].abs() + centre[axis].abs())).abs();
                }
            }
        }
    }
    (t, sizes)
}

/// Where the node of a patch sits.
fn centre(model: &models::Model, job: &InterfaceJob) -> [f64; 3] {
    let members = members(model, &job.nodes);
    let position = |label: &i64| model.nodes[model.labels.iter().position(|other| other == label).expect("a node")];
    match job.origin {
        Origin::Point(point) => point,
        _ => std::array::from_fn(|axis| {
            members.iter().map(|label| position(label)[axis]).sum::<f64>() / members.len() as f64
        }),
    }
}

/// G of a patch from the normal equations, for these directions of its node, d × n: the q for which Σ w |u − L q|² is least.
pub fn mean_motion(model: &models::Model, job: &InterfaceJob, directions: &[Direction]) -> Mat<f64> {
    let (members, centre) = (members(model, &job.nodes), centre(model, job));
    let weight = |label: i64| match &job.weights {
        Some(Weights::Given(given)) => given[members.iter().position(|member| *member == label).expect("a node")],
        _ => 1.0,
    };
    let mut normal: Mat<f64> = Mat::zeros(directions.len(), directions.len());
    let mut moments: Mat<f64> = Mat::zeros(directions.len(), model.n);
    for (row, &(label, at)) in model.dofs.iter().enumerate().filter(|(_, dof)| members.contains(&dof.0) && dof.1 < 3) {
        let r = model.nodes[model.labels.iter().position(|other| *other == label).expect("a node")];
        let position = std::array::from_fn(|axis| r[axis] - centre[axis]);
        let motions = unit_motions(Site { position, direction: Direction::ALL[usize::from(at)] });
        for (i, a) in directions.iter().enumerate() {
            moments[(i, row)] = weight(label) * motions[*a as usize];
            for (j, b) in directions.iter().enumerate() {
                normal[(i, j)] += weight(label) * motions[*a as usize] * motions[*b as usize];
            }
        }
    }
    normal.partial_piv_lu().solve(moments)
}

/// G T picks the dofs of the patch's node, and T is regular: T stands for all motions of the model, and none is tied.
fn assert_mean_motion(
    model: &models::Model,
    job: &InterfaceJob,
    (partition, index): (&Partition, usize),
    t: MatRef<'_, f64>,
) {
    let of_node = |direction: Direction| {
        partition.dofs.iter().position(|dof| dof.origin == DofOrigin::PatchNode(index, direction))
    };
    let directions: Vec<Direction> =
        Direction::ALL.into_iter().filter(|direction| of_node(*direction).is_some()).collect();
    let g = mean_motion(model, job, &directions);
    let (found, sizes) = (&g * t, absolute(g.as_ref()) * absolute(t));
    for (i, direction) in directions.iter().enumerate() {
        for j in 0..t.ncols() {
            let expected = f64::from(u8::from(of_node(*direction) == Some(j)));
            // Sums of n terms, of coefficients that are rounded as the largest of a row are, from small equations whose condition
            // is in the hundreds.
            let bound = 1e3 * model.n as f64 * EPS * sizes.row(i).norm_max();
            let error = (found[(i, j)] - expected).abs();
            assert!(error <= bound, "{} {direction}, dof {j}: {error:e} above {bound:e}", job.name);
        }
    }
    let singular = t.singular_values().expect("a finite matrix");
    let condition = singular[0] / singular[singular.len() - 1];
    assert!(condition < 1e4, "{}: the condition of T is {condition:e}", job.name);
}

/// Equation (2) written out: u = t + θ × r.
fn unit_motions(site: Site) -> [f64; 6] {
    let r = site.position;
    let component = site.direction.axis();
    std::array::from_fn(|motion| {
        let axis = motion % 3;
        match (site.direction.is_rotation(), motion >= 3) {
            (true, true) | (false, false) => f64::from(u8::from(axis == component)),
            (true, false) => 0.0,
            // (e_a × r)_c = ε_{cab} r_b.
            (false, true) => match (component + 3 - axis) % 3 {
                1 => -r[(axis + 2) % 3],
                2 => r[(axis + 1) % 3],
                _ => 0.0,
            },
        }
    })
}

fn members(model: &models::Model, nodes: &NodeSelection) -> Vec<i64> {
    match nodes {
        NodeSelection::Labels(labels) => labels.clone(),
        NodeSelection::Group(name) => model.groups[name.trim_start_matches("group:")].clone(),
        _ => panic!("rigid patches of these tests are lists or groups"),
    }
}

/// Finite eigenvalues λ of K x = λ M x, ascending; M may be singular and K too, where they share no null vector.
///
/// They come from M x = ν (K + sM) x, λ = 1/ν − s, with s near the lowest elastic eigenvalue: an error ε/s of ν is then
/// an error ε (λ + s)²/s of λ.
pub fn spectrum(k: MatRef<'_, f64>, m: MatRef<'_, f64>) -> Vec<f64> {
    let n = k.nrows();
    let largest = (0..n).filter(|i| m[(*i, *i)] > 0.0).map(|i| k[(i, i)] / m[(i, i)]).fold(0.0, f64::max);
    let first = shifted_spectrum(k, m, 1e-4 * largest);
    let elastic = first.iter().copied().find(|lambda| *lambda > 1e-9 * largest).unwrap_or(largest);
    shifted_spectrum(k, m, elastic)
}

fn shifted_spectrum(k: MatRef<'_, f64>, m: MatRef<'_, f64>, s: f64) -> Vec<f64> {
    let n = k.nrows();
    let shifted = Mat::from_fn(n, n, |i, j| k[(i, j)] + s * m[(i, j)]);
    let l = shifted.llt(Side::Lower).expect("K + sM is definite").L().to_owned();
    let mut c = m.to_owned();
    l.solve_lower_triangular_in_place(&mut c);
    let mut c = c.transpose().to_owned();
    l.solve_lower_triangular_in_place(&mut c);
    let nu = c.self_adjoint_eigenvalues(Side::Lower).expect("a finite matrix");
    let top = nu[n - 1];
    // ν of a massless motion is rounding, which two substitutions enlarge by the condition of K + sM at unit diagonal.
    let size = |i: usize| shifted[(i, i)].sqrt();
    let at_unit_diagonal = Mat::from_fn(n, n, |i, j| shifted[(i, j)] / (size(i) * size(j)));
    let energies = at_unit_diagonal.self_adjoint_eigenvalues(Side::Lower).expect("a finite matrix");
    let rounding = n as f64 * EPS * energies[n - 1] / energies[0];
    nu.iter().rev().filter(|nu| **nu > rounding * top).map(|nu| 1.0 / nu - s).collect()
}

/// A sparse matrix as a dense one.
pub fn dense(matrix: &SparseMatrix) -> Mat<f64> {
    let mut full = Mat::zeros(matrix.rows(), matrix.cols());
    for (row, view) in matrix.outer_iterator().enumerate() {
        view.iter().for_each(|(col, value)| full[(row, col)] = *value);
    }
    full
}

/// Ψ of equation (18) in the partition's order: [Ψ_S Ψ_D; I 0].
pub fn psi(basis: &Basis<'_>) -> Mat<f64> {
    let (psi_s, psi_d) = (basis.constraint_modes.to_columns(), &basis.dynamic_modes);
    let (n_i, n_b) = (psi_s.nrows(), psi_s.ncols());
    Mat::from_fn(n_i + n_b, n_b + psi_d.ncols(), |i, j| match (i < n_i, j < n_b) {
        (true, true) => psi_s[(i, j)],
        (true, false) => psi_d[(i, j - n_b)],
        (false, _) => f64::from(u8::from(i - n_i == j)),
    })
}

/// |A|.
pub fn absolute(a: MatRef<'_, f64>) -> Mat<f64> {
    Mat::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)].abs())
}

/// The largest difference, relative to the largest entry of the expected matrix.
pub fn difference(found: MatRef<'_, f64>, expected: MatRef<'_, f64>) -> f64 {
    assert_eq!(found.shape(), expected.shape());
    let size = expected.norm_max();
    if expected.ncols() == 0 { 0.0 } else { (found - expected).norm_max() / size }
}

/// The largest difference in the worst column, each relative to its own largest entry.
pub fn column_difference(found: MatRef<'_, f64>, expected: MatRef<'_, f64>) -> f64 {
    assert_eq!(found.shape(), expected.shape());
    let columns = 0..found.ncols();
    columns.map(|j| difference(found.subcols(j, 1), expected.subcols(j, 1))).fold(0.0, f64::max)
}

/// √(|x_i|ᵀA|x_i| · |y_j|ᵀA|y_j|) ≥ |x_i|ᵀA|y_j|: the size of the terms of XᵀAY, free of units, for a matrix A of sizes.
pub fn terms(x: MatRef<'_, f64>, a: &Mat<f64>, y: MatRef<'_, f64>) -> Mat<f64> {
    let lengths = |x: MatRef<'_, f64>| -> Vec<f64> {
        let (sizes, image) = (absolute(x), a * absolute(x));
        (0..x.ncols()).map(|j| (sizes.col(j).transpose() * image.col(j)).sqrt()).collect()
    };
    let (of_x, of_y) = (lengths(x), lengths(y));
    Mat::from_fn(x.ncols(), y.ncols(), |i, j| of_x[i] * of_y[j])
}

/// The largest |found − expected| / bound over all entries: at most one where every entry keeps its own bound.
pub fn against_bound(found: MatRef<'_, f64>, expected: MatRef<'_, f64>, bound: MatRef<'_, f64>) -> f64 {
    assert_eq!(found.shape(), expected.shape());
    let entries = (0..found.nrows()).flat_map(|i| (0..found.ncols()).map(move |j| (i, j)));
    entries.fold(0.0, |worst: f64, at| {
        let error = (found[at] - expected[at]).abs();
        if error == 0.0 { worst } else { worst.max(error / bound[at]) }
    })
}
