//! Mass matrices: lines MS-01 to MS-08.

use faer::Mat;
use supel::dense;
use supel::error::Error;
use supel::job::{Coupling, InterfaceJob, Origin};
use supel::verification::check::{Check, Verdict};
use supel_models::model::Entry;
use supel_models::transform::{carrying, grounded, join, rounded, scaled, supported, translated};
use supel_models::{Ends, Inertia, Material, Model, Section, brick, frame, spring};

use crate::chain::{Method, Twin, direct, reduce, rows};
use crate::program::{Case, METHODS, bars, eigensolvers, eigenvalues, message_of, n_rigid, warnings, worst_ratio};

/// A bent frame of lumped masses: its rotations have none.
fn lumped_frame() -> Model {
    let nodes = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 2.0, 0.5], [1.0, 2.5, 0.8]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]];
    frame(&nodes, &edges, &Section::round(0.1), &Material::UNIT, Inertia::LumpedTranslations)
}

/// The modes of the finite spectrum, and no others, by both eigensolvers.
#[test]
fn ms_01_lumped_frame_has_its_finite_modes_only() {
    let model = lumped_frame();
    let pins = [direct("ends", &[1, 6])];
    for method in METHODS {
        let twin = Twin::new(&model, &pins, &crate::chain::partition(&model, &pins).expect("a partition"));
        let (exact, n_zero) =
            if method == "herting" { (twin.free_spectrum(), 6) } else { (twin.clamped_spectrum(), 0) };
        let unit = crate::chain::partition(&model, &pins).expect("a partition").scaling.eigenvalue_unit();
        let exact: Vec<f64> = exact[n_zero..].iter().map(|lambda| lambda * unit).collect();
        assert_eq!(exact.len(), 12, "half the rows have mass");
        for eigensolver in eigensolvers() {
            for count in [3, 40] {
                let outcome = Case::new(&model, &pins).method(method).by(eigensolver).count(count).accepted();
                let found = eigenvalues(&outcome);
                let expected = &exact[..count.min(exact.len()).max(found.len())];
                // The twin errs by ε of its largest eigenvalue, near the top by the most.
                assert!(worst_ratio(&found, expected) <= 1e-9, "{method}, {eigensolver}: {found:?} for {expected:?}");
                assert_eq!(warnings(&outcome).contains(&"W-FEWER-MODES"), count > exact.len());
            }
        }
    }
}

/// Mass at the interface alone: nothing inside moves by itself.
#[test]
fn ms_02_massless_interior_has_no_modes_of_its_own() {
    let mut chain = spring(20, Ends::Free);
    chain.mass.retain(|entry| entry.0 == 0 || entry.0 == 19);
    let clamped = Case::new(&chain, &[rows("ends", &[0, 19])]).method("craig-bampton").accepted();
    assert_eq!((eigenvalues(&clamped).len(), warnings(&clamped)), (0, vec!["W-FEWER-MODES"]));
    let free = Case::new(&chain, &[rows("ends", &[0, 19])]).accepted();
    // Two unit masses on nineteen unit springs in series: λ = 2 · 1/19.
    assert!(worst_ratio(&eigenvalues(&free), &[2.0 / 19.0]) <= 1e-13);
    assert_eq!(warnings(&free), ["W-FEWER-MODES"]);
    // What follows the interface statically adds nothing and is left out by name.
    assert_eq!((free.report.body.reduction.dropped.len(), free.report.body.reduction.n_reduced), (2, 2));
    // Nothing inside answers an acceleration, which would take rigid-body motion out of the answers to loads at the interface.
    let error = Case::new(&chain, &[rows("ends", &[0, 19])]).method("rubin").refused(&["attachment modes", "deform"]);
    assert!(matches!(error, Error::NoAttachmentModes), "{error}");
}

#[test]
fn ms_03_massless_mechanisms_are_refused() {
    // A row with neither stiffness nor mass.
    let mut empty = spring(6, Ends::Fixed);
    empty.n = 7;
    empty.dofs.push((7, 0));
    empty.labels.push(7);
    empty.nodes.push([7.0, 0.0, 0.0]);
    let error = Case::new(&empty, &[rows("end", &[0])]).refused(&["1 row has", "node 7 ux"]);
    assert!(matches!(error, Error::EmptyRows { .. }), "{error}");
    // A free body without mass.
    let ghost = scaled(&brick([1, 1, 1], [1.0; 3], &Material::UNIT), 1.0, 0.0);
    let pair = join(&brick([1, 1, 1], [1.0; 3], &Material::UNIT), &ghost, &[]);
    for method in METHODS {
        let error =
            Case::new(&pair, &[direct("pins", &[1, 2, 7, 9, 10, 15])]).method(method).refused(&["moves no mass"]);
        assert!(matches!(error, Error::MasslessRigidMotion { .. }), "{error}");
    }
    // Two interface dofs that move together without stiffness and without mass: K v = 0 and M v = 0, rows not empty.
    let mut slack = spring(6, Ends::Fixed);
    for (i, j, value) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
        slack.stiffness.push((6 + i, 6 + j, value));
    }
    slack.n = 8;
    for label in [7, 8] {
        slack.dofs.push((label, 0));
        slack.labels.push(label);
        slack.nodes.push([f64::from(label as i32), 0.0, 0.0]);
    }
    let anonymous = Model { dofs: Vec::new(), ..slack };
    for method in METHODS {
        let case = Case::new(&anonymous, &[rows("ends", &[0, 6, 7])]).method(method);
        let error = case.run().expect_err("a pencil that is singular at every shift");
        assert!(matches!(error, Error::MasslessMechanism { .. } | Error::NotDefinite { .. }), "{error}");
        let message = error.to_string();
        assert!(message.contains("row 7") || message.contains("row 8"), "{message}");
    }
}

#[test]
fn ms_04_negative_and_indefinite_masses_are_refused() {
    let chain = spring(12, Ends::Fixed);
    let with = |changes: &[Entry]| {
        let mut model = chain.clone();
        for (i, j, value) in changes {
            model.mass.retain(|entry| (entry.0, entry.1) != (*i, *j));
            model.mass.push((*i, *j, *value));
        }
        model
    };
    let end = [rows("end", &[0])];
    for method in METHODS {
        let error =
            Case::new(&with(&[(5, 5, -1e-3)]), &end).method(method).refused(&["row 6 (node 6 ux)", "-1.000e-3"]);
        assert!(matches!(error, Error::NegativeMass { row: 6, .. }), "{error}");
        // A coupling larger than both masses: a pair shows it.
        let pair = with(&[(3, 4, 1.5), (4, 3, 1.5)]);
        let error =
            Case::new(&pair, &end).method(method).refused(&["indefinite", "row 5 (node 5 ux), column 4 (node 4 ux)"]);
        assert!(matches!(error, Error::IndefiniteMass { energy, .. } if (energy + 0.5).abs() < 1e-12), "{error}");
        // A dof without mass and a coupling: no digits make that of a mass that is there.
        let bare = with(&[(3, 3, 0.0), (3, 4, 0.1), (4, 3, 0.1)]);
        Case::new(&bare, &end).method(method).refused(&["indefinite", "has no mass and is coupled to"]);
        // Three masses of one with couplings of 0.8 between neighbours: only the three together show it, λ = 1 − 0.8 √2.
        let three = with(&[(3, 4, -0.8), (4, 3, -0.8), (4, 5, -0.8), (5, 4, -0.8)]);
        let error = Case::new(&three, &end).method(method).refused(&["indefinite", "row 5 (node 5 ux)"]);
        let expected = 1.0 - 0.8 * 2f64.sqrt();
        assert!(matches!(error, Error::IndefiniteMass { energy, .. } if (energy - expected).abs() < 1e-6), "{error}");
    }
    // Consistent masses are definite and pass.
    Case::new(&brick([3, 2, 2], [3.0, 2.1, 1.9], &Material::UNIT), &[direct("pins", &[1, 12, 28])]).clean();
}

#[test]
fn ms_05_mass_negative_by_rounding_is_set_to_zero() {
    let mut chain = spring(12, Ends::Fixed);
    let at = |model: &mut Model, value: f64| {
        model.mass.retain(|entry| entry.0 != 5);
        model.mass.push((5, 5, value));
        model.mass.sort_by_key(|entry| (entry.0, entry.1));
    };
    at(&mut chain, -1e-18);
    let mut zero = chain.clone();
    at(&mut zero, 0.0);
    for method in METHODS {
        let outcome = Case::new(&chain, &[rows("end", &[0])]).method(method).warned(&["W-NEGATIVE-MASS"]);
        let reference = Case::new(&zero, &[rows("end", &[0])]).method(method).clean();
        assert_eq!(eigenvalues(&outcome), eigenvalues(&reference), "{method}");
        assert!(message_of(&outcome, "W-NEGATIVE-MASS").contains("1 diagonal entry"));
    }
}

#[test]
fn ms_06_no_mass_is_refused() {
    for method in METHODS {
        let error = Case::new(&scaled(&spring(6, Ends::Fixed), 1.0, 0.0), &[rows("end", &[0])])
            .method(method)
            .refused(&["the mass matrix is zero", "give the mass matrix"]);
        assert!(matches!(error, Error::NoMass), "{error}");
    }
}

/// The large-mass method: a mass of 10¹² at the base, which is an interface node. The modes of the free component become
/// those of the component held there.
#[test]
fn ms_07_seismic_mass_at_the_base() {
    let block = brick([3, 2, 2], [3.0, 2.1, 1.9], &Material::UNIT);
    let mut seismic = block.clone();
    for entry in seismic.mass.iter_mut().filter(|entry| entry.0 == entry.1 && entry.0 < 3) {
        entry.2 += 1e12;
    }
    // Node 1 held in its three translations; the rotations about it stay free.
    let pinned = supported(&block, |(label, _)| label == 1);
    let held = Case::new(&pinned, &[direct("pins", &[12, 28, 36])]).accepted();
    let expected = eigenvalues(&held);
    for eigensolver in eigensolvers() {
        let outcome = Case::new(&seismic, &[direct("pins", &[1, 12, 28])]).by(eigensolver).accepted();
        assert_eq!(n_rigid(&outcome), 6);
        let found = eigenvalues(&outcome);
        // A base of 10¹² moves by the mass ratio, 10⁻¹², and the bars of both.
        for ((found, expected), bar) in found.iter().zip(&expected).zip(bars(&outcome)) {
            assert!((found / expected - 1.0).abs() <= 1e-10 + 2.0 * bar, "{eigensolver}: {found} for {expected}");
        }
    }
    let clamped = Case::new(&seismic, &[direct("pins", &[1, 12, 28])]).method("craig-bampton").accepted();
    let light = Case::new(&block, &[direct("pins", &[1, 12, 28])]).method("craig-bampton").accepted();
    // Modes of the interior do not know the mass of the interface.
    assert!(worst_ratio(&eigenvalues(&clamped), &eigenvalues(&light)) <= 1e-13);
    let _ = reduce(&seismic, &[direct("pins", &[1, 12, 28])], Method::Herting, 2).expect("a chain");
}

/// A rotor at two of the interface nodes, as heavy as the component: Craig-Bampton's modes of the interior do not know it,
/// free modes do, and no frequency rises (Rayleigh).
#[test]
fn ms_08_a_mass_added_at_the_interface() {
    let block = brick([3, 2, 2], [3.0, 2.1, 1.9], &Material::UNIT);
    let pins = [direct("pins", &[1, 12, 28])];
    let mut loaded = block.clone();
    for entry in loaded.mass.iter_mut().filter(|entry| entry.0 == entry.1) {
        if [1, 28].contains(&block.dofs[entry.0 as usize].0) {
            entry.2 += 6.0;
        }
    }
    for eigensolver in eigensolvers() {
        let found =
            |model: &Model, method| eigenvalues(&Case::new(model, &pins).method(method).by(eigensolver).accepted());
        let [alone, with_rotor] = [&block, &loaded].map(|model| found(model, "craig-bampton"));
        assert!(worst_ratio(&with_rotor, &alone) <= 1e-13, "{eigensolver}: {with_rotor:?} for {alone:?}");
        let [alone, with_rotor] = [&block, &loaded].map(|model| found(model, "herting"));
        let is_lower = |(with_rotor, alone): (&f64, &f64)| *with_rotor < alone * (1.0 + 1e-12);
        assert!(with_rotor.iter().zip(&alone).all(is_lower), "{eigensolver}: {with_rotor:?} for {alone:?}");
        assert!(with_rotor[0] < 0.9 * alone[0], "{eigensolver}: {with_rotor:?} for {alone:?}");
    }
}

/// Masses that the job adds at interface nodes: as heavy as the component, and that of a base that nothing moves. Modes that hold these nodes
/// stay what they are, and so does the stiffness.
#[test]
fn ms_07_ms_08_masses_of_the_job_at_the_interface() {
    let block = brick([3, 2, 2], [3.0, 2.1, 1.9], &Material::UNIT);
    let pins = [direct("pins", &[1, 12]), direct("tip", &[28])];
    for method in ["craig-bampton", "mixed-interface"] {
        let case = |mass: f64, nodes: &[i64]| {
            let of_node = |node: &i64| format!("[[added_mass]]\nnode = {node}\nmass = {mass:e}\n");
            let masses: Vec<String> = nodes.iter().map(of_node).collect();
            Case { tables: masses.concat(), held: "\"pins\"", ..Case::new(&block, &pins).method(method) }
        };
        let alone = Case::new(&block, &pins).method(method);
        let alone = Case { held: "\"pins\"", ..alone }.accepted();
        for (mass, nodes) in [(6.0, &[1, 12][..]), (1e12, &[1])] {
            let outcome = case(mass, nodes).accepted();
            let ratio = worst_ratio(&eigenvalues(&outcome), &eigenvalues(&alone));
            assert!(ratio <= 1e-13, "{method}, {mass:e}: {ratio:e}");
            let (found, expected) = (outcome.superelement.tensors(), alone.superelement.tensors());
            for i in 0..3 * nodes.len() {
                let difference = found.mass[(i, i)] - expected.mass[(i, i)];
                // Two sums, each rounded in units of the larger.
                assert!(
                    (difference / mass - 1.0).abs() <= 1e-14 * (1.0 + expected.mass[(i, i)] / mass),
                    "{difference}"
                );
                assert!(
                    (found.stiffness[(i, i)] / expected.stiffness[(i, i)] - 1.0).abs() <= 1e-13,
                    "{method}, {mass:e}"
                );
            }
        }
    }
}

/// λ of the six motions of a model as a rigid body.
fn of_rigid_body(model: &Model) -> Vec<f64> {
    let motion = |row: usize, j: usize| {
        let (label, direction) = (model.dofs[row].0, usize::from(model.dofs[row].1));
        let x = model.nodes[model.labels.iter().position(|own| *own == label).expect("a node")];
        let (from, to) = ((j + 1) % 3, (j + 2) % 3);
        match j {
            0..=2 => f64::from(u8::from(j == direction)),
            // e_j × x.
            _ if direction == from => -x[to],
            _ if direction == to => x[from],
            _ => 0.0,
        }
    };
    let form = |entries: &[Entry]| {
        let mut sum = Mat::<f64>::zeros(6, 6);
        for &(row, col, value) in entries {
            for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
                sum[(i, j)] += motion(row as usize, i) * value * motion(col as usize, j);
            }
        }
        Mat::from_fn(6, 6, |i, j| 0.5 * (sum[(i, j)] + sum[(j, i)]))
    };
    let (masses, axes) = dense::symmetric_eigen(form(&model.mass).as_ref()).expect("six masses");
    let unit = Mat::from_fn(6, 6, |i, j| axes[(i, j)] / masses[j].sqrt());
    let energies =
        dense::product(unit.transpose(), dense::product(form(&model.stiffness).as_ref(), unit.as_ref()).as_ref());
    dense::symmetric_eigen(energies.as_ref()).expect("six eigenvalues").0
}

/// Labels of the nodes with such an x, in their order.
fn labels_at(model: &Model, is_there: impl Fn(f64) -> bool) -> Vec<i64> {
    let nodes = model.labels.iter().zip(&model.nodes);
    nodes.filter(|(_, place)| is_there(place[0])).map(|(label, _)| *label).collect()
}

/// Rigid patches of the nodes at x = 0 and at the other end.
fn rigid_ends(model: &Model, length: f64) -> [InterfaceJob; 2] {
    let rigid = |name, end| InterfaceJob { coupling: Coupling::Rigid, ..direct(name, &labels_at(model, |x| x == end)) };
    [rigid("left", 0.0), rigid("right", length)]
}

/// Three springs to the ground, so soft that next to a heavy mass rounding of rotations about it, of unit modal mass, is more than what they
/// make of its translations. They hold the body all the same: its lowest six modes are those of a rigid body on them.
#[test]
fn soft_springs_hold_a_part_with_a_heavy_mass() {
    let block = brick([4, 4, 1], [1.0, 1.0, 0.4], &Material::UNIT);
    let ends = rigid_ends(&block, 1.0);
    let inside = labels_at(&block, |x| x > 0.0 && x < 1.0);
    let held = [inside[0], inside[inside.len() / 2], inside[inside.len() - 1]];
    for (digits, softness, mass) in [(17, 1e-8, 1e4), (17, 1e-6, 1e7), (12, 1e-6, 1e4), (9, 1e-4, 1e7), (9, 1e-4, 1e3)]
    {
        let is_held = |row: &usize| held.contains(&block.dofs[*row].0);
        // E and L are one: a spring between neighbours has about the length of an element for stiffness.
        let model =
            (0..block.n).filter(is_held).fold(block.clone(), |model, row| grounded(&model, row, 0.25 * softness));
        let model = rounded(&carrying(&model, &[inside[1]], mass), digits as usize);
        let expected = of_rigid_body(&model);
        for method in ["herting", "craig-bampton"] {
            let found = Case::new(&model, &ends).method(method).accepted();
            assert_eq!(n_rigid(&found), 0, "{method}, {digits} digits, springs of {softness:e}, mass of {mass:e}");
        }
        let found = eigenvalues(&Case::new(&model, &ends).accepted());
        // An element gives way to a spring by about the ratio of the two, and moving the body as a whole adds up some hundred entries for
        // each spring, 1/softness times as large and each off by its rounding.
        let rounding = 0.1f64.powi(digits).max(f64::EPSILON);
        let tolerance = 10.0 * softness + 100.0 * rounding / softness;
        assert!(worst_ratio(&found[..6], &expected) <= tolerance, "{digits}: {found:?} for {expected:?}");
    }
}

/// A mass at a corner of a patch, described by the motion of a node at its middle and by that of the corner itself: the same modes within
/// the bars of both. About the middle terms m r² are all but what is left of them, and hundreds of small ones are added to them.
#[test]
fn ms_07_a_heavy_mass_away_from_the_node_of_its_patch() {
    let block = brick([3, 9, 9], [1.0, 1.3, 1.1], &Material::UNIT);
    let about_middle = rigid_ends(&block, 1.0);
    let corner = labels_at(&block, |x| x == 0.0)[0];
    let at = block.nodes[block.labels.iter().position(|label| *label == corner).expect("a node")];
    let mut about_mass = about_middle.clone();
    about_mass[0].origin = Origin::Point(at);
    for mass in [1e3, 1e4, 1e6, 1e7] {
        let model = carrying(&block, &[corner], mass);
        for method in ["herting", "craig-bampton"] {
            let found = Case::new(&model, &about_middle).method(method).count(8).accepted();
            let is_told = warnings(&found).contains(&"W-MASS-FAR");
            assert_eq!(is_told, mass >= 1e6, "{method}, {mass}");
            let expected = Case::new(&model, &about_mass).method(method).count(8).clean();
            let with_bars = eigenvalues(&found).into_iter().zip(bars(&found));
            for ((found, bar), (expected, other)) in with_bars.zip(eigenvalues(&expected).iter().zip(bars(&expected))) {
                assert!(
                    (found / expected - 1.0).abs() <= bar + other,
                    "{method}, {mass}: {found} ± {bar} for {expected}"
                );
            }
        }
    }
}

/// All of S is within its rounding then, which is no reason to look for mechanisms among rigid-body motions.
#[test]
fn few_digits_and_a_heavy_mass_make_no_massless_mechanism() {
    let beam = brick([3, 2, 2], [3.0, 0.05, 0.05], &Material::UNIT);
    let ends = rigid_ends(&beam, 3.0);
    // 10³ and 10⁴ of what the beam weighs.
    for (mass, digits) in [(7.5, 7), (75.0, 7), (75_000.0, 9)] {
        let model = rounded(&carrying(&beam, &labels_at(&beam, |x| x == 1.0)[..1], mass), digits);
        // Whether the digits suffice for frequencies is for the checks to say.
        let found =
            Case::new(&model, &ends).method("craig-bampton").run().unwrap_or_else(|error| panic!("refused: {error}"));
        assert_eq!(n_rigid(&found), 6, "{mass}, {digits} digits");
    }
}

/// A weak spring to the ground in the middle of a slender bar is told whatever rounding in its rigid ends would hide: five motions are free,
/// and the sixth is held.
#[test]
fn a_spring_to_the_ground_is_told_beside_rigid_patches() {
    let bar = brick([12, 2, 2], [10.0, 0.05, 0.05], &Material::STEEL_SI);
    let label = labels_at(&bar, |x| (x - 5.0).abs() < 1e-9)[0];
    let row = bar.dofs.iter().position(|dof| *dof == (label, 1)).expect("uy in the middle");
    let own = bar.stiffness.iter().find(|(i, j, _)| (*i, *j) == (row as u32, row as u32)).expect("its stiffness").2;
    let held = grounded(&bar, row, 1e-9 * own);
    let outcome = Case::new(&held, &rigid_ends(&bar, 10.0)).method("herting").count(6).accepted();
    assert_eq!(n_rigid(&outcome), 5);
    assert!(message_of(&outcome, "W-GROUNDED").contains("nearly free but not quite"), "{:?}", warnings(&outcome));
}

/// A bent frame next to the origin, of the size of a metre.
fn steel_frame() -> Model {
    let nodes = [[0.0; 3], [0.4, 0.0, 0.0], [0.4, 0.5, 0.0], [0.9, 0.5, 0.3], [0.9, 0.9, 0.7]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 4]];
    frame(&nodes, &edges, &Section::round(0.05), &Material::STEEL_SI, Inertia::Consistent)
}

/// What the report says of the inertia about the centre.
fn of_inertia(model: &Model) -> Option<Check> {
    let found = Case::new(model, &[direct("ends", &[1, 5])]).method("craig-bampton").count(4).run().expect("a result");
    found.report.body.checks.into_iter().find(|check| check.name == "inertia about the centre is known")
}

/// A frame a hundred times its size away from the origin, M of six digits: nothing is left of its inertia about its centre, which is the
/// difference of numbers ten thousand times as large. Next to the origin, and with all digits, it is known.
#[test]
fn ms_09_an_inertia_far_from_the_origin() {
    let near = steel_frame();
    let far = translated(&near, [60.0, -80.0, 30.0]);
    let verdict = |model: &Model| of_inertia(model).as_ref().map(Check::verdict);
    let mass_of = |model: &Model, digits: usize| Model { mass: rounded(model, digits).mass, ..model.clone() };
    assert_eq!(verdict(&mass_of(&far, 6)), Some(Verdict::Fail));
    assert_eq!(verdict(&mass_of(&near, 6)), Some(Verdict::Pass));
    assert_eq!(verdict(&far), Some(Verdict::Pass));
}

/// Ten million times its size away from the origin rounding of doubles leaves a frame no inertia. M-16 says so, and does not take the frame for
/// a point, which has none.
#[test]
fn ms_09_an_inertia_lost_far_from_the_origin() {
    for distance in [6e6, 6e7, 6e8] {
        let check = of_inertia(&translated(&steel_frame(), [distance, -distance, 0.5 * distance]));
        assert_eq!(check.as_ref().map(Check::verdict), Some(Verdict::Fail), "{distance}: {check:?}");
    }
}
