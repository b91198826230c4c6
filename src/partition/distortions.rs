//! The motions of a patch besides its mean motion, as degrees of freedom.
//!
//! ```text
//! u      n          displacements of the rows of a patch, with weights W
//! L      n × d      rigid motions of the rows, d of six where the rows move in no more
//! q = (LᵀWL)⁻¹LᵀWu  the mean motion: Σ w |u − L q|² is least
//! u = L q + D v     D is n × (n − d), of full rank, with LᵀWD = 0
//! ```
//! No motion of the patch is lost: q and v stand for u, so that an average stiffens nothing. Any D will do. This one is sparse: a column
//! of a D taken from all rows at once would be as long as the patch.
//!
//! The patch is divided into groups of nodes, those into smaller ones, down to a few nodes each. A group c moves by its own mean motion
//! and what deviates from it, and its mean motion is that of the group p around it plus B_c δ_c, with B_c rigid motions of c for which
//! B_cᵀ W B_c = I:
//! ```text
//! Σ_c M_cᵀ δ_c = 0,  M_c = B_cᵀ W B_p      the mean motion of p is as it was
//! δ_k = −M_k⁻ᵀ Σ_{c ≠ k} M_cᵀ δ_c           of the child k whose M_k is farthest from singular; the others' δ_c are dofs
//! ```
//! A smallest group has its rows as dofs, but for d of them, which make up for the mean motion of the others.

use faer::Mat;
use faer::linalg::solvers::Solve;

use crate::dense;
use crate::error::{Error, Result};

/// Nodes that are divided no further: few enough for short columns, enough for few levels.
const SMALLEST: usize = 24;
/// Times that a group is halved to give its children: of eight, one follows from seven.
const HALVINGS: usize = 3;
/// Least singular value of the firmest M_k at which a group is divided: below it, that child would have to make up for the others
/// with motions fifty times as large. The end of a strip cut into eight has 0.04 and more, a quarter of a disc above 0.2.
const FIRM: f64 = 0.02;
/// Entries of D that are rounding of none, where the largest are of order one: they would only fill K.
pub(super) const NO_ENTRY: f64 = 16.0 * f64::EPSILON;

/// A row of a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchRow {
    /// Number of its node.
    pub(super) node: u32,
    /// Where that is.
    pub(super) position: [f64; 3],
    /// Its weight, positive.
    pub(super) weight: f64,
    /// Which way it moves.
    pub(super) direction: [f64; 3],
}

impl PatchRow {
    /// Its displacement under the six unit motions about a point. The mean motion is none about all points or about no point: that of the patch's
    /// own middle is used, since the node may be far away, and the difference of two long ways is none of a short one.
    fn lever_about(&self, centre: [f64; 3]) -> [f64; 6] {
        let ([x, y, z], [a, b, c]) = ([0, 1, 2].map(|axis| self.position[axis] - centre[axis]), self.direction);
        [a, b, c, y * c - z * b, z * a - x * c, x * b - y * a]
    }
}

/// D of a patch.
#[derive(Clone, Debug, Default)]
pub(super) struct Distortions {
    /// What each dof belongs to.
    pub(super) owners: Vec<Owner>,
    /// The entries of each row of D.
    pub(super) rows: Vec<Vec<(u32, f64)>>,
}

/// What a distortion belongs to, for the order of elimination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    /// A row of the patch, by its place there.
    Row(usize),
    /// A group of nodes, by its number in the patch.
    Group(u32),
}

impl Distortions {
    /// D for rows that follow `d` motions independently.
    ///
    /// # Errors
    /// [`Error::DenseEigen`].
    pub(super) fn of(rows: &[PatchRow], d: usize) -> Result<Self> {
        let mut nodes: Vec<Vec<usize>> = Vec::new();
        for (index, row) in rows.iter().enumerate() {
            match nodes.last_mut() {
                Some(last) if rows[last[0]].node == row.node => last.push(index),
                _ => nodes.push(vec![index]),
            }
        }
        let patch = Patch { rows, d };
        let mut found = Self { owners: Vec::new(), rows: vec![Vec::new(); rows.len()] };
        let mut n_groups = 0;
        let mut open = vec![patch.group(nodes)?];
        while let Some(group) = open.pop() {
            match patch.division(&group)? {
                None => found.take_rows(&patch, &group),
                Some(division) => {
                    found.take_groups(&division, &mut n_groups);
                    open.extend(division.children);
                }
            }
        }
        Ok(found)
    }

    fn add(&mut self, owner: Owner) -> u32 {
        self.owners.push(owner);
        self.owners.len() as u32 - 1
    }

    /// The mean motions of children relative to that of their group.
    fn take_groups(&mut self, Division { children, moments, firmest }: &Division, n_groups: &mut u32) {
        let of_firmest = moments[*firmest].transpose().partial_piv_lu();
        let firmest = &children[*firmest];
        let others = children.iter().zip(moments).filter(|(child, _)| !std::ptr::eq(*child, firmest));
        for (child, moments) in others {
            let owner = Owner::Group(*n_groups);
            *n_groups += 1;
            let first = self.owners.len() as u32;
            self.owners.extend(std::iter::repeat_n(owner, moments.nrows()));
            // Columns of the size of one, whatever the weights and the number of rows.
            let size = child.weight.sqrt();
            self.put(&child.rows, first, &(&child.basis * faer::Scale(size)));
            let made_up = of_firmest.solve(moments.transpose()) * faer::Scale(-size);
            self.put(&firmest.rows, first, &dense::product(firmest.basis.as_ref(), made_up.as_ref()));
        }
    }

    /// The rows of a smallest group, but for d of them.
    fn take_rows(&mut self, patch: &Patch<'_>, group: &Group) {
        let (n, d) = (group.rows.len(), patch.d);
        // d × n, its first d columns those of the rows that make up for the others.
        let weighted = Mat::from_fn(d, n, |i, j| patch.rows[group.rows[j]].weight * group.basis[(j, i)]);
        let order = pivots(&weighted);
        let columns = |numbers: &[usize]| dense::columns(weighted.as_ref(), numbers);
        let made_up = columns(&order[..d]).partial_piv_lu().solve(columns(&order[d..])) * faer::Scale(-1.0);
        for (column, own) in order[d..].iter().enumerate() {
            let row = group.rows[*own];
            let number = self.add(Owner::Row(row));
            self.rows[row].push((number, 1.0));
            for (at, other) in order[..d].iter().enumerate().filter(|(at, _)| made_up[(*at, column)].abs() > NO_ENTRY) {
                self.rows[group.rows[*other]].push((number, made_up[(at, column)]));
            }
        }
    }

    fn put(&mut self, rows: &[usize], first: u32, values: &Mat<f64>) {
        for (i, row) in rows.iter().enumerate() {
            let entries = (0..values.ncols()).filter(|j| values[(i, *j)].abs() > NO_ENTRY);
            self.rows[*row].extend(entries.map(|j| (first + j as u32, values[(i, j)])));
        }
    }
}

struct Patch<'a> {
    rows: &'a [PatchRow],
    d: usize,
}

/// Some nodes of a patch.
struct Group {
    /// The rows of each node.
    nodes: Vec<Vec<usize>>,
    /// All rows, node by node.
    rows: Vec<usize>,
    /// B_c, rows × d.
    basis: Mat<f64>,
    /// The sum of the rows' weights.
    weight: f64,
}

/// A group divided into children.
struct Division {
    children: Vec<Group>,
    /// M of each, d × d.
    moments: Vec<Mat<f64>>,
    /// The child whose M is farthest from singular.
    firmest: usize,
}

impl Patch<'_> {
    fn group(&self, nodes: Vec<Vec<usize>>) -> Result<Group> {
        let rows: Vec<usize> = nodes.iter().flatten().copied().collect();
        let weight: f64 = rows.iter().map(|row| self.rows[*row].weight).sum();
        let mean = |of: &dyn Fn(&PatchRow) -> f64| {
            rows.iter().map(|row| self.rows[*row].weight / weight * of(&self.rows[*row])).sum::<f64>()
        };
        let centre = [0, 1, 2].map(|axis| mean(&|row| row.position[axis]));
        let square = |row: &PatchRow| (0..3).map(|axis| (row.position[axis] - centre[axis]).powi(2)).sum::<f64>();
        let size = mean(&square).sqrt();
        let size = if size > 0.0 { size } else { 1.0 };
        let root: Vec<f64> = rows.iter().map(|row| (self.rows[*row].weight / weight).sqrt()).collect();
        // Rows of zeros change no singular value.
        let mut motions = Mat::<f64>::zeros(rows.len().max(6), 6);
        for (i, row) in rows.iter().enumerate() {
            let lever = self.rows[*row].lever_about(centre);
            (0..6).for_each(|j| motions[(i, j)] = root[i] * if j < 3 { lever[j] } else { lever[j] / size });
        }
        let svd = motions.thin_svd().map_err(|_| Error::DenseEigen { n: 6 })?;
        let basis = Mat::from_fn(rows.len(), self.d, |i, j| svd.U()[(i, j)] / (root[i] * weight.sqrt()));
        Ok(Group { nodes, rows, basis, weight })
    }

    /// How a group is divided; none where it is small, or where no child is firm.
    fn division(&self, group: &Group) -> Result<Option<Division>> {
        let mut parts = vec![group.nodes.clone()];
        for _ in 0..HALVINGS {
            parts = parts.into_iter().flat_map(|part| self.halves(part)).collect();
        }
        if parts.len() < 2 {
            return Ok(None);
        }
        let children = parts.into_iter().map(|nodes| self.group(nodes)).collect::<Result<Vec<Group>>>()?;
        let moments: Vec<Mat<f64>> = children.iter().map(|child| self.moments(child, group)).collect();
        let least = |m: &Mat<f64>| m.singular_values().ok().and_then(|values| values.last().copied()).unwrap_or(0.0);
        let firmness: Vec<f64> = moments.iter().map(least).collect();
        let firmest = (0..children.len()).fold(0, |best, at| if firmness[at] > firmness[best] { at } else { best });
        Ok((firmness[firmest] >= FIRM).then_some(Division { children, moments, firmest }))
    }

    /// The halves of some nodes along their largest extent; the nodes themselves where they are few.
    fn halves(&self, mut nodes: Vec<Vec<usize>>) -> Vec<Vec<Vec<usize>>> {
        let n_rows = nodes.iter().map(Vec::len).sum::<usize>();
        if nodes.len() <= SMALLEST || n_rows < 4 * self.d {
            return vec![nodes];
        }
        let at = |node: &Vec<usize>, axis: usize| self.rows[node[0]].position[axis];
        let extent = |axis: usize| {
            let along = || nodes.iter().map(|node| at(node, axis));
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        };
        let extents = [0, 1, 2].map(extent);
        let axis = (0..3).fold(0, |longest, axis| if extents[axis] > extents[longest] { axis } else { longest });
        nodes.sort_by(|a, b| at(a, axis).total_cmp(&at(b, axis)).then(a[0].cmp(&b[0])));
        let upper = nodes.split_off(nodes.len() / 2);
        vec![nodes, upper]
    }

    /// M = B_cᵀ W B_p of a child, d × d.
    fn moments(&self, child: &Group, group: &Group) -> Mat<f64> {
        let place: std::collections::HashMap<usize, usize> = group.rows.iter().copied().zip(0..).collect();
        let weighted = Mat::from_fn(child.rows.len(), self.d, |i, j| {
            let row = child.rows[i];
            self.rows[row].weight * group.basis[(place[&row], j)]
        });
        dense::gram(child.basis.as_ref(), weighted.as_ref())
    }
}

/// The columns of a d × n matrix in an order in which the first d are far from dependent: each the longest after those before it were
/// taken out of all others.
fn pivots(a: &Mat<f64>) -> Vec<usize> {
    let (d, n) = (a.nrows(), a.ncols());
    let mut rest = a.clone();
    let mut order: Vec<usize> = (0..n).collect();
    for step in 0..d.min(n) {
        let square =
            |column: usize| dense::dot(dense::column(rest.as_ref(), column), dense::column(rest.as_ref(), column));
        let squares: Vec<f64> = order[step..].iter().map(|column| square(*column)).collect();
        let longest = (0..squares.len()).fold(0, |best, at| if squares[at] > squares[best] { at } else { best });
        order.swap(step, step + longest);
        let length = squares[longest].sqrt();
        let unit: Vec<f64> = dense::column(rest.as_ref(), order[step]).iter().map(|value| value / length).collect();
        for column in &order[step + 1..] {
            let along = dense::dot(&unit, dense::column(rest.as_ref(), *column));
            dense::add_scaled(dense::column_mut(rest.as_mut(), *column), -along, &unit);
        }
    }
    // Dofs in the order of the rows, so that neighbours stay neighbours.
    order[d.min(n)..].sort_unstable();
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::MatRef;

    /// Translations of nodes of a curved skin, with weights of a factor of ten.
    fn skin((nodes, width): ([usize; 2], f64)) -> Vec<PatchRow> {
        let [n, m] = nodes;
        let node = |k: usize| {
            let (s, t) = ((k / m) as f64 / n as f64, width * (k % m) as f64 / m as f64);
            let position = [3.0 * s, (2.0 * t).sin(), (2.0 * t).cos() + 0.2 * s * s];
            let weight = 1.0 + 9.0 * (12.9 * k as f64).sin().abs();
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|direction| PatchRow {
                node: k as u32,
                position,
                weight,
                direction,
            })
        };
        (0..n * m).flat_map(node).collect()
    }

    fn dense_of(found: &Distortions) -> Mat<f64> {
        let mut d = Mat::zeros(found.rows.len(), found.owners.len());
        for (row, entries) in found.rows.iter().enumerate() {
            entries.iter().for_each(|(column, value)| d[(row, *column as usize)] += value);
        }
        d
    }

    fn condition(a: MatRef<'_, f64>) -> f64 {
        let singular = a.singular_values().expect("a finite matrix");
        singular[0] / singular[singular.len() - 1]
    }

    /// LᵀWD = 0, and [L D] is a basis of all motions, as far as its condition tells; for a patch of one group, of two, of many, and a strip.
    #[test]
    fn distortions_and_rigid_motions_are_all_motions() {
        let patches = [([4, 3], 1.0), ([8, 7], 1.0), ([21, 16], 1.0), ([150, 2], 0.01)];
        for nodes in patches {
            let rows = skin(nodes);
            let n = rows.len();
            let found = Distortions::of(&rows, 6).expect("distortions");
            assert_eq!(found.owners.len(), n - 6);
            let d = dense_of(&found);
            let levers: Vec<[f64; 6]> = rows.iter().map(|row| row.lever_about([1.5, 0.5, 0.5])).collect();
            let weighted = Mat::from_fn(n, 6, |i, j| rows[i].weight * levers[i][j]);
            let mean = dense::gram(weighted.as_ref(), d.as_ref());
            let sizes = dense::gram(dense::absolute(weighted.as_ref()).as_ref(), dense::absolute(d.as_ref()).as_ref());
            for (mean, sizes) in mean.col_iter().zip(sizes.col_iter()) {
                // Sums of n terms, with coefficients from matrices whose condition is below 1 / FIRM.
                let bound = n as f64 / FIRM * f64::EPSILON * sizes.norm_max();
                assert!(mean.norm_max() <= bound, "{nodes:?}: {:e} above {bound:e}", mean.norm_max());
            }
            let levers = Mat::from_fn(n, 6, |i, j| levers[i][j]);
            let all = dense::side_by_side(levers.as_ref(), d.as_ref());
            // A strip turns about its length with displacements of the size of its width.
            assert!(condition(all.as_ref()) < 1e3 / nodes.1, "{nodes:?}: {}", condition(all.as_ref()));
        }
    }

    /// The entries of D grow with the rows times the levels, not with their square.
    #[test]
    fn distortions_are_sparse() {
        let entries = |nodes: ([usize; 2], f64)| {
            let rows = skin(nodes);
            let found = Distortions::of(&rows, 6).expect("distortions");
            found.rows.iter().map(Vec::len).sum::<usize>() as f64 / rows.len() as f64
        };
        // 1 for a row of its own; of 24 nodes six rows in 72 have 66; at each of two levels 6, and 42 for one group in eight.
        let most = 1.0 + 6.0 * 66.0 / 36.0 + 2.0 * (6.0 + 42.0 / 8.0);
        for nodes in [([40, 30], 1.0), ([500, 2], 0.01)] {
            assert!(entries(nodes) < most, "{} of {most}", entries(nodes));
        }
    }
}
