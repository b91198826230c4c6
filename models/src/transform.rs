//! From one model to another: JOIN, SCALE, DOFSCALE, DIGITS, supports and grounding.

use std::collections::BTreeMap;

use crate::model::{Assembler, Entry, Model};

/// JOIN: two models as one; the nodes of each pair (label in `a`, label in `b`) become one, with the position in `a`.
///
/// The rows of `a` come first. Other labels of `b` are raised by the largest of `a`, and its groups take the prefix `B.`.
/// Without pairs it is the direct sum.
///
/// # Panics
/// If a pair names a node that does not exist.
pub fn join(a: &Model, b: &Model, pairs: &[(i64, i64)]) -> Model {
    let offset = a.labels.iter().copied().max().unwrap_or(0);
    let partner: BTreeMap<i64, i64> = pairs.iter().map(|&(in_a, in_b)| (in_b, in_a)).collect();
    for &(in_a, in_b) in pairs {
        assert!(a.labels.contains(&in_a) && b.labels.contains(&in_b), "no nodes {in_a} and {in_b} to join");
    }
    let relabel = |label: i64| partner.get(&label).copied().unwrap_or(label + offset);
    let mut joined = Model { stiffness: Vec::new(), mass: Vec::new(), ..a.clone() };
    let mut row_of: BTreeMap<(i64, u8), u32> = (0..).zip(&a.dofs).map(|(row, &dof)| (dof, row)).collect();
    let mut rows_of_b = Vec::with_capacity(b.n);
    for row in 0..b.n {
        let fresh = joined.n as u32;
        let target = b.dofs.get(row).map(|&(label, direction)| (relabel(label), direction));
        let number = target.map_or(fresh, |dof| *row_of.entry(dof).or_insert(fresh));
        if number == fresh {
            joined.n += 1;
            joined.dofs.extend(target);
        }
        rows_of_b.push(number);
    }
    for (&label, &position) in b.labels.iter().zip(&b.nodes).filter(|(label, _)| !partner.contains_key(label)) {
        joined.labels.push(label + offset);
        joined.nodes.push(position);
    }
    for (name, members) in &b.groups {
        joined.groups.insert(format!("B.{name}"), members.iter().map(|&label| relabel(label)).collect());
    }
    joined.stiffness = direct_sum(&a.stiffness, &b.stiffness, &rows_of_b);
    joined.mass = direct_sum(&a.mass, &b.mass, &rows_of_b);
    joined
}

fn direct_sum(a: &[Entry], b: &[Entry], rows_of_b: &[u32]) -> Vec<Entry> {
    let mut sum = Assembler::default();
    sum.extend(a.iter().copied());
    sum.extend(b.iter().map(|&(i, j, value)| (rows_of_b[i as usize], rows_of_b[j as usize], value)));
    sum.finish()
}

/// `model` with a device that some nodes carry by the mean of their translations: mass alone, with no stiffness between them.
pub fn carrying(model: &Model, labels: &[i64], mass: f64) -> Model {
    let mut with_device = Assembler::default();
    with_device.extend(model.mass.iter().copied());
    let share = mass / (labels.len() * labels.len()) as f64;
    for direction in 0..3 {
        let is_carrier = |dof: &(i64, u8)| labels.contains(&dof.0) && dof.1 == direction;
        let rows = || (0..).zip(&model.dofs).filter(|(_, dof)| is_carrier(dof)).map(|(row, _): (u32, _)| row);
        with_device.extend(rows().flat_map(|i| rows().map(move |j| (i, j, share))));
    }
    Model { mass: with_device.finish(), ..model.clone() }
}

/// `model` at another place.
pub fn translated(model: &Model, by: [f64; 3]) -> Model {
    let nodes = model.nodes.iter().map(|x| std::array::from_fn(|d| x[d] + by[d])).collect();
    Model { nodes, ..model.clone() }
}

/// SCALE(a, b): K times `stiffness`, M times `mass`.
pub fn scaled(model: &Model, stiffness: f64, mass: f64) -> Model {
    map_values(model, |_, value| value * stiffness, |_, value| value * mass)
}

/// DOFSCALE(D): K → D K D and M → D M D with one factor a row.
///
/// # Panics
/// If the number of factors is not the number of rows.
pub fn dof_scaled(model: &Model, factors: &[f64]) -> Model {
    assert_eq!(factors.len(), model.n, "one factor a row");
    // The product of the factors first: the same for (i, j) and (j, i), so that symmetry stays exact.
    let scale = |(i, j): (u32, u32), value: f64| value * (factors[i as usize] * factors[j as usize]);
    map_values(model, scale, scale)
}

/// DIGITS(d): every entry rounded to d significant decimal digits.
///
/// # Panics
/// If `digits` is zero.
pub fn rounded(model: &Model, digits: usize) -> Model {
    assert!(digits > 0, "at least one digit");
    let round = |_, value: f64| format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    map_values(model, round, round)
}

/// The model without the rows whose dof satisfies a condition: rows tied to the ground.
pub fn supported(model: &Model, is_tied: impl Fn((i64, u8)) -> bool) -> Model {
    let mut rows = Vec::with_capacity(model.n);
    let mut dofs = Vec::new();
    for &dof in &model.dofs {
        if is_tied(dof) {
            rows.push(None);
        } else {
            rows.push(Some(dofs.len() as u32));
            dofs.push(dof);
        }
    }
    let keep = |entries: &[Entry]| {
        entries.iter().filter_map(|&(i, j, v)| Some((rows[i as usize]?, rows[j as usize]?, v))).collect()
    };
    Model { n: dofs.len(), stiffness: keep(&model.stiffness), mass: keep(&model.mass), dofs, ..model.clone() }
}

/// The model with a spring from one row to the ground.
pub fn grounded(model: &Model, row: usize, stiffness: f64) -> Model {
    let mut sum = Assembler::default();
    sum.extend(model.stiffness.iter().copied());
    sum.add(row as u32, row as u32, stiffness);
    Model { stiffness: sum.finish(), ..model.clone() }
}

/// The model with the rows of some nodes, counted from 0, along axes turned by 90° about z: ux takes the place of uy, uy that of −ux.
pub fn turned(model: &Model, is_turned: impl Fn(usize) -> bool) -> Model {
    const QUARTER: [[f64; 3]; 3] = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    in_local_frames(model, &QUARTER, |label| is_turned((label - 1) as usize))
}

/// TKTᵀ and TMTᵀ: the rows of some nodes, displacements and rotations, along the axes that are the rows of `frame`.
///
/// # Panics
/// If such a node has some directions only, and the frame mixes them with others.
pub fn in_local_frames(model: &Model, frame: &[[f64; 3]; 3], is_turned: impl Fn(i64) -> bool) -> Model {
    let row_of: BTreeMap<(i64, u8), u32> = model.dofs.iter().copied().zip(0..).collect();
    // The column of T that belongs to a row.
    let shares: Vec<Vec<(u32, f64)>> = (0u32..)
        .zip(&model.dofs)
        .map(|(row, &(label, direction))| match is_turned(label) {
            false => vec![(row, 1.0)],
            true => {
                let (first, axis) = (direction - direction % 3, usize::from(direction % 3));
                let along = (0u8..).zip(frame).map(|(local, axes)| (first + local, axes[axis]));
                along.filter(|part| part.1 != 0.0).map(|(local, share)| (row_of[&(label, local)], share)).collect()
            }
        })
        .collect();
    let of = |entries: &[Entry]| {
        let mut sum = Assembler::default();
        for &(row, col, value) in entries {
            for (to, share) in &shares[row as usize] {
                shares[col as usize].iter().for_each(|(across, other)| sum.add(*to, *across, share * other * value));
            }
        }
        sum.finish()
    };
    Model { stiffness: of(&model.stiffness), mass: of(&model.mass), ..model.clone() }
}

fn map_values(
    model: &Model,
    stiffness: impl Fn((u32, u32), f64) -> f64,
    mass: impl Fn((u32, u32), f64) -> f64,
) -> Model {
    Model {
        stiffness: model.stiffness.iter().map(|&(i, j, v)| (i, j, stiffness((i, j), v))).collect(),
        mass: model.mass.iter().map(|&(i, j, v)| (i, j, mass((i, j), v))).collect(),
        ..model.clone()
    }
}
