//! What results must not depend on, or depend on in a known way: order, units, place, direction, company.

use proptest::prelude::*;
use supel::job::InterfaceJob;
use supel_models::Model;
use supel_models::model::{Assembler, Entry};
use supel_models::transform::{join, scaled, supported};

use crate::chain::{Chain, EPS, Method, reduce};
use crate::component::{Component, Family, component};
use crate::kept;

/// Relative difference of eigenvalues that two ways of rounding may make: of n rows, each ε times how far its terms cancel,
/// and of the eigensolver, which takes a vector at a residual of 16 ε of the largest θ, and so at an angle of that
/// over the gap to the next mode.
fn rounding(chain: &Chain) -> f64 {
    let modes = &chain.modes;
    let bars = modes.errors.iter().map(|error| error.relative_bar).fold(EPS, f64::max);
    let spread = modes.lambda.last().copied().unwrap_or(1.0) / modes.lambda.first().copied().unwrap_or(1.0);
    let gap = modes.next.zip(modes.lambda.last()).map_or(1.0, |(next, last)| (next / last - 1.0).min(1.0));
    chain.partition.n_dofs() as f64 * (bars + EPS * chain.constraint.cancellation + 16.0 * EPS * spread / gap)
}

/// Compares elastic eigenvalues of the free reduced model; `expected` are those of `chain`.
fn same(found: &[f64], expected: &[f64], n_rigid: usize, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected).skip(n_rigid) {
        let difference = (found / expected - 1.0).abs();
        prop_assert!(
            difference <= tolerance,
            "{:e} for {:e}: off {:e}, bound {:e}",
            found,
            expected,
            difference,
            tolerance
        );
    }
    // A bound that allows a millionth would prove nothing.
    prop_assert!(tolerance < 1e-6, "the bound is {:e}", tolerance);
    Ok(())
}

/// `model` with its rows in another order; row k of the old becomes row `place[k]`.
fn permuted(model: &Model, place: &[u32]) -> Model {
    let moved = |entries: &[Entry]| {
        entries.iter().map(|&(i, j, value)| (place[i as usize], place[j as usize], value)).collect()
    };
    let mut dofs = model.dofs.clone();
    for (old, new) in place.iter().enumerate() {
        dofs[*new as usize] = model.dofs[old];
    }
    Model { stiffness: moved(&model.stiffness), mass: moved(&model.mass), dofs, ..model.clone() }
}

/// The model turned: coordinates, and the directions of its dofs with them, three or six to each node.
fn turned(model: &Model, r: &[[f64; 3]; 3]) -> Model {
    // Row i of a block of three is component i % 3 of a vector.
    let turn = |entries: &[Entry]| {
        let mut sum = Assembler::default();
        for &(i, j, value) in entries {
            let (of_i, of_j) = (i - i % 3, j - j % 3);
            for a in 0..3u32 {
                for b in 0..3u32 {
                    let weight = r[a as usize][(i % 3) as usize] * r[b as usize][(j % 3) as usize];
                    sum.add(of_i + a, of_j + b, weight * value);
                }
            }
        }
        sum.finish()
    };
    let nodes = model.nodes.iter().map(|x| r.map(|row| (0..3).map(|axis| row[axis] * x[axis]).sum())).collect();
    Model { stiffness: turn(&model.stiffness), mass: turn(&model.mass), nodes, ..model.clone() }
}

/// A turn about z, then about x.
fn rotation(about_z: f64, about_x: f64) -> [[f64; 3]; 3] {
    let ((s, c), (t, d)) = (about_z.sin_cos(), about_x.sin_cos());
    [[c, -s, 0.0], [d * s, d * c, -t], [t * s, t * c, d]]
}

/// A diagonal block of a reduced matrix in the user's units.
fn interface_block(chain: &Chain, n: usize) -> faer::Mat<f64> {
    chain.reduction.stiffness.submatrix(0, 0, n, n).to_owned() * faer::Scale(chain.partition.scaling.stiffness_unit())
}

/// What rounding may change of K̂_BB: ε times its terms before they cancel.
fn stiffness_rounding(chain: &Chain) -> f64 {
    let partition = &chain.partition;
    let diagonal = (partition.n_internal..partition.n_dofs()).map(|i| *partition.stiffness.get(i, i).expect("stored"));
    let size = diagonal.fold(0.0, f64::max) * partition.scaling.stiffness_unit();
    16.0 * partition.n_dofs() as f64 * EPS * chain.constraint.cancellation * size
}

proptest! {
    #![proptest_config(kept!("invariance"))]

    #[test]
    fn order_of_rows_does_not_matter(component in component(), seed in any::<u64>()) {
        let model = component.model();
        // Families without coordinates name their interface by rows, which would move.
        prop_assume!(component.n_rigid() > 1);
        let mut place: Vec<u32> = (0..model.n as u32).collect();
        let mut random = supel_models::SplitMix64::new(seed);
        (1..place.len()).rev().for_each(|i| place.swap(i, random.below(i as u64 + 1) as usize));
        let (before, after) = (component.reduce(), component.reduced_from(&permuted(&model, &place)));
        let expected = Component::eigenvalues(&before);
        same(&Component::eigenvalues(&after), &expected, component.n_rigid(), rounding(&before))?;
    }

    #[test]
    fn units_that_are_powers_of_two_change_no_bit(component in component(), a in -80i32..80, b in -80i32..80) {
        let before = component.reduce();
        let after = component.reduced_from(&scaled(&component.model(), 2f64.powi(a), 2f64.powi(b)));
        prop_assert_eq!(&after.reduction.stiffness, &before.reduction.stiffness);
        prop_assert_eq!(&after.reduction.mass, &before.reduction.mass);
        prop_assert_eq!(&after.modes.lambda, &before.modes.lambda);
        prop_assert_eq!(after.partition.scaling.stiffness, before.partition.scaling.stiffness + a);
        prop_assert_eq!(after.partition.scaling.mass, before.partition.scaling.mass + b);
    }

    #[test]
    fn other_units_scale_eigenvalues(component in component(), a in -9f64..9.0, b in -9f64..9.0) {
        let (a, b) = (10f64.powf(a), 10f64.powf(b));
        let before = component.reduce();
        let after = component.reduced_from(&scaled(&component.model(), a, b));
        let expected: Vec<f64> = Component::eigenvalues(&before).iter().map(|lambda| lambda * a / b).collect();
        same(&Component::eigenvalues(&after), &expected, component.n_rigid(), rounding(&before))?;
    }

    /// Coordinates and dofs turned together: the same eigenvalues, and K̂_BB turned.
    #[test]
    fn a_component_may_be_turned(component in component(), about_z in -3.0..3.0, about_x in -3.0..3.0) {
        // Plane models have no dof to turn out of their plane with.
        prop_assume!(component.n_rigid() == 6);
        let r = rotation(about_z, about_x);
        let before = component.reduce();
        let after = component.reduced_from(&turned(&component.model(), &r));
        let expected = Component::eigenvalues(&before);
        same(&Component::eigenvalues(&after), &expected, component.n_rigid(), rounding(&before))?;
        let n = before.partition.n_interface();
        let q = faer::Mat::from_fn(n, n, |i, j| if i / 3 == j / 3 { r[i % 3][j % 3] } else { 0.0 });
        let expected = &q * interface_block(&before, n) * q.transpose();
        let error = (interface_block(&after, n) - expected).norm_max();
        prop_assert!(error <= 4.0 * stiffness_rounding(&before), "off {:e}, bound {:e}", error, stiffness_rounding(&before));
    }

    /// Interfaces in another order: the same matrix with its rows in that order.
    #[test]
    fn the_order_of_interfaces_permutes_the_reduced_stiffness(component in component()) {
        let interfaces = split(&component);
        prop_assume!(interfaces.len() > 1);
        let model = component.model();
        let reversed: Vec<InterfaceJob> = interfaces.iter().rev().cloned().collect();
        let by = |interfaces: &[InterfaceJob]| {
            reduce(&model, interfaces, component.method, component.count).expect("a component")
        };
        let (before, after) = (by(&interfaces), by(&reversed));
        let n = before.partition.n_interface();
        let each = n / interfaces.len();
        let place = |i: usize| (interfaces.len() - 1 - i / each) * each + i % each;
        let (k, expected) = (interface_block(&after, n), interface_block(&before, n));
        for i in 0..n {
            for j in 0..n {
                let error = (k[(place(i), place(j))] - expected[(i, j)]).abs();
                prop_assert!(error <= stiffness_rounding(&before), "({}, {}) is off by {:e}", i, j, error);
            }
        }
        let expected = Component::eigenvalues(&before);
        same(&Component::eigenvalues(&after), &expected, component.n_rigid(), rounding(&before))?;
    }

    /// Two bodies that do not touch: K̂_BB and M̂_BB are the direct sum, without a single coupling.
    #[test]
    fn the_union_of_two_bodies_is_their_direct_sum(a in component(), b in component()) {
        prop_assume!(a.n_rigid() == 6 && b.n_rigid() == 6);
        let (first, second) = (a.model(), b.model());
        // A frame has six directions a node and a solid three; one model must have the same for all.
        prop_assume!((first.dofs.len() / first.labels.len()) == (second.dofs.len() / second.labels.len()));
        let both = join(&first, &second, &[]);
        let offset = first.labels.iter().copied().max().expect("nodes");
        let mut interfaces = a.interfaces();
        interfaces.extend(b.interfaces().into_iter().map(|job| of_second(job, offset)));
        let whole = reduce(&both, &interfaces, Method::CraigBampton, a.count + b.count).expect("two bodies");
        let parts = [&a, &b].map(Component::reduce);
        let sizes = parts.each_ref().map(|part| part.partition.n_interface());
        let found = interface_block(&whole, sizes[0] + sizes[1]);
        let coupling = found.submatrix(0, sizes[0], sizes[0], sizes[1]).norm_max();
        // The correction of Ψ_S goes by U_B⁺ of both bodies together, whose rows know of the other to rounding.
        prop_assert!(coupling <= stiffness_rounding(&parts[0]), "the bodies are coupled by {:e}", coupling);
        for (part, start) in parts.iter().zip([0, sizes[0]]) {
            let n = part.partition.n_interface();
            let error = (found.submatrix(start, start, n, n) - interface_block(part, n)).norm_max();
            prop_assert!(error <= stiffness_rounding(part), "off {:e}, bound {:e}", error, stiffness_rounding(part));
        }
    }

    /// K + aM: every clamped eigenvalue rises by a, the shapes stay.
    #[test]
    fn a_shift_of_the_stiffness_shifts_the_eigenvalues(component in component(), share in 1e-3f64..1e3) {
        prop_assume!(component.n_rigid() == 6);
        // Held at its first node, so that K + aM and K have the same rigid-body modes: none.
        let component = Component { method: Method::CraigBampton, ..component };
        let held = supported(&component.model(), |(label, _)| label == 2);
        let before = component.reduced_from(&held);
        let unit = before.partition.scaling.eigenvalue_unit();
        let a = share * before.modes.lambda[0] * unit;
        let mut sum = Assembler::default();
        sum.extend(held.stiffness.iter().copied());
        sum.extend(held.mass.iter().map(|&(i, j, value)| (i, j, a * value)));
        let after = component.reduced_from(&Model { stiffness: sum.finish(), ..held.clone() });
        let unit_after = after.partition.scaling.eigenvalue_unit();
        for (j, (found, lambda)) in after.modes.lambda.iter().zip(&before.modes.lambda).enumerate() {
            let (found, expected) = (found * unit_after, lambda * unit + a);
            // Each carries its own bar; rounding of the sum K + aM is one more.
            let bars = 2.0 * (after.modes.errors[j].relative_bar + before.modes.errors[j].relative_bar) + 2.0 * EPS;
            prop_assert!((found / expected - 1.0).abs() <= bars, "{:e} for {:e}, bars {:e}", found, expected, bars);
        }
    }
}

/// Every node of a direct interface, and every patch, as an interface of its own; all of the same number of dofs.
fn split(component: &Component) -> Vec<InterfaceJob> {
    use supel::job::NodeSelection;
    let jobs = component.interfaces().into_iter();
    let single = |job: InterfaceJob| match &job.nodes {
        NodeSelection::Labels(labels) => labels
            .iter()
            .map(|label| InterfaceJob {
                name: format!("{} {label}", job.name),
                nodes: NodeSelection::Labels(vec![*label]),
                ..job.clone()
            })
            .collect(),
        _ => vec![job],
    };
    jobs.flat_map(single).collect()
}

/// The interface of a model that was joined as the second one.
fn of_second(job: InterfaceJob, offset: i64) -> InterfaceJob {
    use supel::job::NodeSelection;
    let nodes = match &job.nodes {
        NodeSelection::Labels(labels) => NodeSelection::Labels(labels.iter().map(|label| label + offset).collect()),
        NodeSelection::Group(group) => NodeSelection::Group(group.replace("group:", "group:B.")),
        other => other.clone(),
    };
    InterfaceJob { name: format!("second {}", job.name), nodes, ..job }
}

/// A twist of a bar of two elements leaves the nodes in the middle at rest, as its constraint modes do: the mode adds nothing
/// inside. What is left of the difference is rounding, which once was scaled to a column of unit length.
#[test]
fn a_mode_that_only_follows_the_interface_adds_no_column() {
    let family = Family::Patches { cells: [2, 1, 1], sixteenths: [24, 15, 15] };
    let chain = Component { family, method: Method::Herting, count: 1 }.reduce();
    assert_eq!(chain.basis.dropped.len(), 1, "{:?}", chain.basis.dropped);
    assert_eq!(chain.reduction.n_reduced(), 12 + 6);
}
