//! Homogeneous equations solved for some of their unknowns, stably and with as few new terms as may be.
//!
//! ```text
//! A x = 0        A is m × n, sparse; rows and unknowns in units in which they are of order one
//! x_d = C x_i    C is sparse where A is; d are the dependent unknowns, as many as A has rank
//! ```
//! Constraints between nodes nearly always have an unknown of their own, as the slaves of ties and of rigid elements are: an equation that
//! alone has an unknown is solved for it, and leaves those that remain, until none is left that has one. No number changes by that. What
//! remains falls into blocks that share no unknown. Each is eliminated densely with complete pivoting, which tells its rank: pivots
//! that are none leave equations that follow from others, and pivots that may be rounding or not are for the user to judge.

use std::collections::{BTreeMap, HashMap, VecDeque};

/// Size of a coefficient below which it is rounding of none: what double precision leaves of sums of equations of order one.
const NO_PIVOT: f64 = 1e-10;
/// Size of a coefficient below which an equation is not solved for its unknown: coefficients of six digits leave less of an equation that
/// follows from others. Where fewer are known it is [`ROUNDINGS`] times what they leave open.
pub(super) const LEAST_PIVOT: f64 = 1e-5;
/// Roundings of its equations that may be left of one that follows from others: a sum of a few of them with factors of order one.
const ROUNDINGS: f64 = 10.0;
/// Size of the coefficient of an unknown, relative to the largest of its equation, from which it is solved for without looking at others.
const FIRM: f64 = 0.1;
/// Entries of C that are rounding of none, where the terms that they are sums of are of order one: they would only fill K.
const NO_ENTRY: f64 = 16.0 * f64::EPSILON;
/// Most entries of a dense block, 128 MB.
const LARGEST_BLOCK: usize = 1 << 24;
/// Most entries of C, 256 MB.
const MOST_ENTRIES: usize = 1 << 24;

/// Unknowns with their coefficients, ascending.
pub(super) type Terms = Vec<(u32, f64)>;

/// Equations solved.
#[derive(Debug, Default)]
pub(super) struct Elimination {
    /// Each dependent unknown with its row of C.
    pub(super) dependent: BTreeMap<u32, Terms>,
    /// The equations that follow from others, by their numbers, ascending.
    pub(super) redundant: Vec<usize>,
}

/// Why equations cannot be solved, with the number of one of them.
#[derive(Debug, PartialEq)]
pub(super) enum Obstacle {
    /// It leaves an equation between unknowns none of which may depend on others.
    Kept(usize),
    /// It follows from others but for the first size of a coefficient, relative to its largest; from the second on it would not.
    NearlyFollows(usize, [f64; 2]),
    /// It is one of a block of so many equations in so many unknowns.
    Block(usize, [usize; 2]),
    /// Solving for its unknown takes C beyond what it may hold.
    Entries(usize),
}

/// Solves the equations A x = 0 given by their rows; `uncertain` says how well the coefficients of each are known, relative to its largest,
/// and is nothing where they are doubles. `costs` says of each unknown what it takes to let it depend on others, or nothing where
/// it must not.
pub(super) fn eliminated(rows: &[Terms], uncertain: &[f64], costs: &[Option<u32>]) -> Result<Elimination, Obstacle> {
    let mut open = Open::of(rows, costs);
    let peeled = open.peeled();
    let mut found = Elimination::default();
    for block in open.blocks() {
        let uncertain = block.iter().map(|row| uncertain[*row]).fold(0.0, f64::max);
        let least_pivot = LEAST_PIVOT.max(ROUNDINGS * uncertain);
        Block::of(rows, costs, block)?.eliminate(least_pivot, &mut found)?;
    }
    let mut n_entries: usize = found.dependent.values().map(Vec::len).sum();
    // Unknowns of an equation that depend on others are those of equations that were solved after it.
    for (row, own) in peeled.into_iter().rev() {
        let pivot = rows[row].iter().find(|(dof, _)| *dof == own).map_or(1.0, |(_, value)| *value);
        let mut terms = Terms::new();
        for (dof, value) in rows[row].iter().filter(|(dof, _)| *dof != own) {
            let factor = -value / pivot;
            match found.dependent.get(dof) {
                Some(others) => terms.extend(others.iter().map(|(other, value)| (*other, factor * value))),
                None => terms.push((*dof, factor)),
            }
            if n_entries + terms.len() > MOST_ENTRIES {
                return Err(Obstacle::Entries(row));
            }
        }
        let terms = summed(terms);
        n_entries += terms.len();
        found.dependent.insert(own, terms);
    }
    found.redundant.sort_unstable();
    Ok(found)
}

/// Terms by their unknowns, those of one unknown added up in their order; sums that are rounding of none are left out.
pub(super) fn summed(mut terms: Terms) -> Terms {
    terms.sort_by_key(|(dof, _)| *dof);
    let of_one = |terms: &[(u32, f64)]| {
        let (sum, size) = terms.iter().fold((0.0, 0.0), |(sum, size), (_, value)| (sum + value, size + value.abs()));
        (sum.abs() > NO_ENTRY * size).then_some((terms[0].0, sum))
    };
    terms.chunk_by(|a, b| a.0 == b.0).filter_map(of_one).collect()
}

/// The equations that have not been solved.
struct Open<'a> {
    rows: &'a [Terms],
    costs: &'a [Option<u32>],
    is_open: Vec<bool>,
    /// The equations of each unknown that may depend on others.
    rows_of: HashMap<u32, Vec<usize>>,
    /// How many of these are open.
    n_open: HashMap<u32, usize>,
}

impl<'a> Open<'a> {
    fn of(rows: &'a [Terms], costs: &'a [Option<u32>]) -> Self {
        let mut rows_of: HashMap<u32, Vec<usize>> = HashMap::new();
        for (number, row) in rows.iter().enumerate() {
            for (dof, _) in row.iter().filter(|(dof, _)| costs[*dof as usize].is_some()) {
                rows_of.entry(*dof).or_default().push(number);
            }
        }
        let n_open = rows_of.iter().map(|(dof, rows)| (*dof, rows.len())).collect();
        Self { rows, costs, is_open: vec![true; rows.len()], rows_of, n_open }
    }

    /// The unknowns of an equation that may depend on others.
    fn candidates(&self, row: usize) -> impl Iterator<Item = &'a (u32, f64)> + use<'a> {
        let costs = self.costs;
        self.rows[row].iter().filter(move |(dof, _)| costs[*dof as usize].is_some())
    }

    /// Closes equations that alone have an unknown, one after the other, and gives them with these unknowns in that order.
    fn peeled(&mut self) -> Vec<(usize, u32)> {
        let mut waiting: VecDeque<usize> = (0..self.rows.len()).collect();
        let mut peeled = Vec::new();
        while let Some(row) = waiting.pop_front() {
            let Some(own) = self.own_unknown(row).filter(|_| self.is_open[row]) else { continue };
            self.is_open[row] = false;
            peeled.push((row, own));
            for (dof, _) in self.candidates(row) {
                let left = self.n_open.entry(*dof).or_default();
                *left -= 1;
                if *left == 1 {
                    waiting.extend(self.rows_of[dof].iter().copied().find(|row| self.is_open[*row]));
                }
            }
        }
        peeled
    }

    /// The unknown that no other open equation has: of those with a firm coefficient that of the largest one, then the cheapest.
    fn own_unknown(&self, row: usize) -> Option<u32> {
        let largest = self.rows[row].iter().fold(0.0f64, |max, (_, value)| max.max(value.abs()));
        let is_firm = |value: f64| value.abs() >= LEAST_PIVOT && value.abs() >= FIRM * largest;
        let own = self.candidates(row).filter(|(dof, value)| self.n_open[dof] == 1 && is_firm(*value));
        let cost = |dof: u32| self.costs[dof as usize];
        own.min_by(|a, b| b.1.abs().total_cmp(&a.1.abs()).then(cost(a.0).cmp(&cost(b.0)))).map(|(dof, _)| *dof)
    }

    /// The open equations in groups that share no unknown that may depend on others.
    fn blocks(&self) -> Vec<Vec<usize>> {
        let mut is_seen = vec![false; self.rows.len()];
        let mut blocks = Vec::new();
        for first in (0..self.rows.len()).filter(|row| self.is_open[*row]) {
            let (mut block, mut next) = (Vec::new(), vec![first]);
            while let Some(row) = next.pop() {
                if std::mem::replace(&mut is_seen[row], true) {
                    continue;
                }
                block.push(row);
                let sharing = self.candidates(row).flat_map(|(dof, _)| &self.rows_of[dof]).copied();
                next.extend(sharing.filter(|row| self.is_open[*row] && !is_seen[*row]));
            }
            if !block.is_empty() {
                block.sort_unstable();
                blocks.push(block);
            }
        }
        blocks
    }
}

/// Equations as a dense matrix.
struct Block {
    /// The numbers of the equations.
    numbers: Vec<usize>,
    /// The unknowns, those that may depend on others first, these by their costs.
    dofs: Vec<u32>,
    n_candidates: usize,
    values: Vec<Vec<f64>>,
}

impl Block {
    fn of(rows: &[Terms], costs: &[Option<u32>], numbers: Vec<usize>) -> Result<Self, Obstacle> {
        let mut dofs: Vec<u32> = numbers.iter().flat_map(|row| rows[*row].iter().map(|(dof, _)| *dof)).collect();
        dofs.sort_unstable();
        dofs.dedup();
        let size = [numbers.len(), dofs.len()];
        if size[0].saturating_mul(size[1]) > LARGEST_BLOCK {
            return Err(Obstacle::Block(numbers[0], size));
        }
        dofs.sort_by_key(|dof| costs[*dof as usize].map_or(u64::MAX, u64::from));
        let n_candidates = dofs.iter().filter(|dof| costs[**dof as usize].is_some()).count();
        let place: HashMap<u32, usize> = dofs.iter().copied().zip(0..).collect();
        let mut values = vec![vec![0.0; dofs.len()]; numbers.len()];
        for (values, number) in values.iter_mut().zip(&numbers) {
            rows[*number].iter().for_each(|(dof, value)| values[place[dof]] = *value);
        }
        Ok(Self { numbers, dofs, n_candidates, values })
    }

    /// Solves for one unknown after the other, the one with the largest coefficient of all that are left.
    fn eliminate(mut self, least_pivot: f64, found: &mut Elimination) -> Result<(), Obstacle> {
        let mut open: Vec<usize> = (0..self.numbers.len()).collect();
        let mut solved: Vec<(usize, usize)> = Vec::new();
        let mut is_candidate = vec![true; self.n_candidates];
        let left = loop {
            let (size, row, column) = self.largest(&open, &is_candidate);
            if size < least_pivot {
                break (size, row);
            }
            self.solve_for(row, column);
            open.retain(|other| *other != row);
            is_candidate[column] = false;
            solved.push((row, column));
        };
        if left.0 >= NO_PIVOT {
            return Err(Obstacle::NearlyFollows(self.numbers[left.1], [left.0, least_pivot]));
        }
        for row in open {
            let kept = self.values[row][self.n_candidates..].iter().fold(0.0f64, |max, value| max.max(value.abs()));
            match kept {
                kept if kept >= least_pivot => return Err(Obstacle::Kept(self.numbers[row])),
                kept if kept >= NO_PIVOT => {
                    return Err(Obstacle::NearlyFollows(self.numbers[row], [kept, least_pivot]));
                }
                _ => found.redundant.push(self.numbers[row]),
            }
        }
        for (row, column) in solved {
            let terms = self.values[row].iter().enumerate().filter(|(other, _)| *other != column);
            let terms =
                terms.filter(|(_, value)| value.abs() > NO_ENTRY).map(|(other, value)| (self.dofs[other], -value));
            let mut terms: Terms = terms.collect();
            terms.sort_unstable_by_key(|(dof, _)| *dof);
            found.dependent.insert(self.dofs[column], terms);
        }
        Ok(())
    }

    /// The largest coefficient of the open equations: its size, and where it is.
    fn largest(&self, open: &[usize], is_candidate: &[bool]) -> (f64, usize, usize) {
        let mut largest = (0.0, 0, 0);
        for row in open {
            for (column, value) in self.values[*row][..self.n_candidates].iter().enumerate() {
                if is_candidate[column] && value.abs() > largest.0 {
                    largest = (value.abs(), *row, column);
                }
            }
        }
        largest
    }

    /// Takes an unknown out of all other equations, solved ones among them.
    fn solve_for(&mut self, row: usize, column: usize) {
        let mut of_pivot = std::mem::take(&mut self.values[row]);
        let pivot = of_pivot[column];
        of_pivot.iter_mut().for_each(|value| *value /= pivot);
        for other in self.values.iter_mut().filter(|other| !other.is_empty() && other[column] != 0.0) {
            let factor = other[column];
            other.iter_mut().zip(&of_pivot).for_each(|(value, of_pivot)| *value -= factor * of_pivot);
            other[column] = 0.0;
        }
        self.values[row] = of_pivot;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;

    fn solved(rows: &[Terms], n: usize, kept: &[u32]) -> Result<Elimination, Obstacle> {
        let costs: Vec<Option<u32>> = (0..n as u32).map(|dof| (!kept.contains(&dof)).then_some(1)).collect();
        eliminated(rows, &vec![0.0; rows.len()], &costs)
    }

    /// Every x = C x_i solves A x = 0, and there are as many independent ones as A leaves: C is a basis of the null space.
    fn assert_null_space(rows: &[Terms], n: usize, found: &Elimination) {
        let a = Mat::from_fn(rows.len().max(n), n, |i, j| {
            let row = rows.get(i).map_or(&[][..], |row| row);
            row.iter().filter(|(dof, _)| *dof == j as u32).map(|(_, value)| value).sum::<f64>()
        });
        let rank = a.singular_values().expect("finite").iter().filter(|value| **value > 1e-9).count();
        assert_eq!(found.dependent.len(), rank);
        assert_eq!(found.redundant.len(), rows.len() - rank);
        for free in (0..n as u32).filter(|dof| !found.dependent.contains_key(dof)) {
            let x = Mat::from_fn(n, 1, |i, _| match found.dependent.get(&(i as u32)) {
                Some(terms) => terms.iter().find(|(dof, _)| *dof == free).map_or(0.0, |(_, value)| *value),
                None => f64::from(u8::from(i as u32 == free)),
            });
            // Sums of n terms of the size of the largest entry, in a block whose pivots are not far below one.
            let left = (&a * &x).norm_max();
            assert!(left <= 1e3 * n as f64 * f64::EPSILON * x.norm_max(), "{free}: {left:e}");
        }
    }

    /// Random equations between few unknowns each, some of which repeat others and some of which close circles.
    #[test]
    fn random_equations_leave_their_null_space() {
        let mut state = 7u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as u32
        };
        for case in 0..40 {
            let n = 12 + random() % 30;
            let mut rows: Vec<Terms> = Vec::new();
            for _ in 0..n / 2 {
                let terms = (0..2 + random() % 3).map(|_| (random() % n, f64::from(random() % 17) - 8.0)).collect();
                rows.push(summed(terms));
            }
            let twice: Terms = rows[0].iter().chain(&rows[1]).map(|(dof, value)| (*dof, 0.5 * value)).collect();
            rows.push(summed(twice));
            let found = solved(&rows, n as usize, &[]).unwrap_or_else(|obstacle| panic!("{case}: {obstacle:?}"));
            assert_null_space(&rows, n as usize, &found);
        }
    }

    /// A slave of each equation is solved for as it stands: no rounding, no term more.
    #[test]
    fn equations_with_unknowns_of_their_own_keep_their_numbers() {
        let rows = [vec![(0, 0.3), (1, -0.1), (2, -0.2)], vec![(3, 1.0), (0, -0.7)], vec![(4, -2.0), (1, 0.1)]];
        let found = solved(&rows, 5, &[1, 2]).expect("solved");
        assert_eq!(found.dependent[&0], [(1, 0.1 / 0.3), (2, 0.2 / 0.3)]);
        assert_eq!(found.dependent[&4], [(1, 0.05)]);
        let factor = 0.7 * (0.1 / 0.3);
        assert!((found.dependent[&3][0].1 - factor).abs() <= f64::EPSILON * factor);
    }

    #[test]
    fn what_cannot_be_solved_is_named() {
        let circle = |last: f64| [vec![(0, 1.0), (1, -1.0)], vec![(1, 1.0), (2, -1.0)], vec![(0, 1.0), (2, last)]];
        assert_eq!(solved(&circle(-1.0), 3, &[]).expect("solved").redundant.len(), 1);
        let nearly = solved(&circle(-1.0 - 3e-7), 3, &[]).expect_err("neither");
        assert!(matches!(nearly, Obstacle::NearlyFollows(_, [left, _]) if (1e-7..4e-7).contains(&left)), "{nearly:?}");
        // All three held: u = 0 is what a regular system says.
        assert_eq!(solved(&circle(1.0), 3, &[]).expect("solved").dependent, (0..3).map(|dof| (dof, vec![])).collect());
        assert_eq!(solved(&circle(-1.0), 3, &[0, 2]).expect_err("kept"), Obstacle::Kept(1));
        // Two dofs that must stay are equal through a third one.
        let through = [vec![(0, 1.0), (1, -1.0)], vec![(1, 1.0), (2, -1.0)]];
        assert!(matches!(solved(&through, 3, &[0, 2]), Err(Obstacle::Kept(_))));
        let n = 5000;
        let dense: Vec<Terms> =
            (0..n).map(|row| vec![(row, 1.0), ((row + 1) % n, 1.0), ((row + 7) % n, 1.0)]).collect();
        assert_eq!(solved(&dense, n as usize, &[]).expect_err("large"), Obstacle::Block(0, [5000, 5000]));
    }
}
