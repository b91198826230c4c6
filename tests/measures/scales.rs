//! What M-05 and M-12 say of a reduced model that has rigid-body motion and nothing else.

use supel::dofs::Direction;
use supel::job::Method;
use supel::modes::Retained;
use supel::reduction::Reduction;
use supel::rigid::RigidBodyModes;
use supel::verification::check::{Check, Verdict};
use supel::verification::{Evidence, Restraint, verify};
use supel_models::frame::{Inertia, Section, frame};
use supel_models::{Material, brick};

use crate::chain::{direct, rigid_group};
use crate::evidence::with_model;

/// The checks of a brick on one rigid interface without any mode: six coordinates for six rigid-body motions.
fn checks(damage: impl Fn(&mut RigidBodyModes, &mut Retained, &mut Reduction)) -> Vec<Check> {
    let model = brick([4, 2, 2], [1.0, 0.31, 0.23], &Material::STEEL_SI);
    with_model(&model, &[rigid_group("XMIN")], (Method::CraigBampton, 0), |evidence| {
        let (mut rigid, mut retained) = (evidence.rigid.clone(), evidence.retained.clone());
        let mut reduction = evidence.reduction.clone();
        damage(&mut rigid, &mut retained, &mut reduction);
        assert_eq!((reduction.n_reduced(), rigid.count(), retained.modes.count()), (6, 6, 0));
        let damaged = Evidence { rigid: &rigid, retained: &retained, reduction: &reduction, ..evidence };
        let findings = verify(&damaged).expect("dense decompositions");
        assert!(findings.rigid_body.grounding.iter().all(|direction| direction.restraint == Restraint::Free));
        findings.checks
    })
}

fn named<'a>(checks: &'a [Check], name: &str) -> &'a Check {
    checks.iter().find(|check| check.name == name).expect("a check of this name")
}

const ENERGY: &str = "rigid-body motion costs no energy";

/// The first eigenvalue with the interface held stands in for the elastic one that the reduced model does not have.
#[test]
fn energy_is_judged_by_the_held_component_where_nothing_elastic_is_left() {
    let sound = checks(|_, _, _| {});
    let energy = named(&sound, ENERGY);
    assert!(energy.value > 0.0 && energy.verdict() == Verdict::Pass, "{energy:?}");
    let grounded = checks(|rigid, retained, _| {
        rigid.energy.largest_quotient = 1e-3 * retained.modes.next.expect("the next eigenvalue");
    });
    let energy = named(&grounded, ENERGY);
    assert!((energy.value / 1e-3 - 1.0).abs() < 1e-14 && energy.verdict() == Verdict::Fail, "{energy:?}");
}

/// With nothing to compare it with the energy is shown and no verdict given.
#[test]
fn energy_is_not_judged_without_any_elastic_mode() {
    let alone = checks(|_, retained, _| retained.modes.next = None);
    let energy = named(&alone, ENERGY);
    assert_eq!(energy.verdict(), Verdict::Info, "{energy:?}");
    assert!(energy.equation.contains("no elastic mode"), "{energy:?}");
}

/// A spring in the reduced stiffness alone takes a rigid-body motion from its zero modes: they are counted, not assumed.
#[test]
fn a_rigid_body_motion_that_the_reduced_stiffness_holds_is_no_zero_mode() {
    const ZERO_MODES: &str = "reduced stiffness has no other zero modes";
    let said = |checks: &[Check]| (named(checks, ZERO_MODES).value, named(checks, ZERO_MODES).worst.clone());
    assert_eq!(said(&checks(|_, _, _| {})), (0.0, Some("6 zero modes, 6 rigid-body modes".into())));
    // Scaled stiffness has entries of order one; that of a patch of nine nodes together some ten.
    let held = checks(|_, _, reduction| reduction.stiffness[(0, 0)] += 1e-3);
    assert_eq!(said(&held), (1.0, Some("5 zero modes, 6 rigid-body modes".into())));
    assert_eq!(named(&held, ZERO_MODES).verdict(), Verdict::Fail);
}

/// A rotation inside that lacks a millionth is off by as much in metres as in millimetres, where displacements of the same motion are a
/// thousand times larger.
#[test]
fn what_the_interface_does_not_carry_of_a_rotation_is_told_alike_in_every_unit() {
    let lacking = |length: f64, material: &Material| {
        let nodes: Vec<[f64; 3]> =
            (0..6).map(|i| [0.1, 0.02 * f64::from(i), 0.03].map(|x| length * x * f64::from(i))).collect();
        let edges: Vec<[usize; 2]> = (0..5).map(|i| [i, i + 1]).collect();
        let model = frame(&nodes, &edges, &Section::round(0.004 * length), material, Inertia::Consistent);
        with_model(&model, &[direct("end", &[1])], (Method::CraigBampton, 2), |evidence| {
            let mut basis = evidence.basis.clone();
            let is_rotation = |row: usize| {
                let site = evidence.partition.dofs[row].site.expect("a place");
                matches!(site.direction, Direction::Rx | Direction::Ry | Direction::Rz)
            };
            let turns = basis.constraint_modes.stored_mut().expect("stored");
            // The rotations of the last row that has them follow those of the interface one to one.
            let row = (0..evidence.partition.n_internal).rev().find(|row| is_rotation(*row)).expect("a rotation");
            let followed = (0..turns.ncols()).filter(|j| is_rotation(evidence.partition.n_internal + j));
            let column = followed.max_by(|a, b| turns[(row, *a)].abs().total_cmp(&turns[(row, *b)].abs()));
            turns[(row, column.expect("a rotation"))] *= 1.0 + 1e-6;
            let findings = verify(&Evidence { basis: &basis, ..evidence }).expect("dense decompositions");
            let check = named(&findings.checks, "interface carries rigid-body motion");
            assert_eq!(check.verdict(), Verdict::Fail, "{check:?}");
            check.value
        })
    };
    let [metres, millimetres] = [lacking(1.0, &Material::STEEL_SI), lacking(1e3, &Material::STEEL_MM_T_S)];
    // The scales are powers of two: each is off by a factor of √2 at most, either way.
    assert!((0.5..=2.0).contains(&(metres / millimetres)), "{metres:e} and {millimetres:e}");
}
