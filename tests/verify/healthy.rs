//! Files as the program writes them pass every check, with warnings counted as failures.

use supel::cli::ExitCode;
use supel_models::model::Assembler;
use supel_models::springs::springs;
use supel_models::transform::{carrying, grounded, join, rounded, translated};
use supel_models::{Ends, HexMesh, Inertia, Material, Model, Section, Wall, brick, frame, shell, spring};

use crate::place::{Place, supel};

/// Verifies x.supel by itself and against the job kept in it, with warnings as failures.
#[track_caller]
pub(crate) fn passes(place: &Place, what: &str) {
    agrees(place, what, &["--strict"]);
}

/// Verifies x.supel by itself and against the job kept in it.
#[track_caller]
fn agrees(place: &Place, what: &str, flags: &[&str]) {
    let file = place.text("x.supel");
    let alone = supel(&[&["verify", &file], flags].concat());
    assert_eq!(alone.code, ExitCode::Done, "{what}, alone:\n{}{}", alone.out, alone.err);
    let job = supel(&["inspect", &file, "--job"]).expect(ExitCode::Done).out;
    place.write("kept.json", job.as_bytes());
    let compared = supel(&[&["verify", &file, "--job", &place.text("kept.json")], flags].concat());
    assert_eq!(compared.code, ExitCode::Done, "{what}, with the job:\n{}{}", compared.out, compared.err);
    if std::env::var_os("SUPEL_SHOW").is_some() {
        println!("{what}\n{}", compared.out);
    }
}

#[test]
fn solid_by_both_methods_and_all_couplings() {
    let place = Place::with_brick();
    for method in ["herting", "craig-bampton"] {
        for interface in [
            "--interface foot=1,11,31,41",
            "--interface foot=1,11,31,41 --rigid-interface head=5,15,35",
            "--rigid-interface foot=1,11,31 --rigid-interface head=5,15,35",
            // It just holds the component: of its stiffness nothing is left.
            "--interface foot=1,11,31",
        ] {
            let rest = format!("{interface} --method {method} --modes 5");
            place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
            passes(&place, &rest);
        }
    }
}

#[test]
fn rows_without_coordinates() {
    let place = Place::with(&spring(12, Ends::Free));
    for method in ["herting", "craig-bampton"] {
        for rows in ["0,11", "0", "0,1,2,3,7"] {
            let rest = format!("--interface ends=rows:{rows} --method {method} --modes 4");
            place.reduce(&place.matrix_flags(), &rest).expect(ExitCode::Done);
            passes(&place, &rest);
        }
    }
}

#[test]
fn held_component() {
    let place = Place::with(&spring(12, Ends::Fixed));
    for method in ["herting", "craig-bampton"] {
        let rest = format!("--interface ends=rows:0,11 --method {method} --modes 4");
        place.reduce(&place.matrix_flags(), &rest).expect(ExitCode::Done);
        passes(&place, &rest);
    }
}

/// Its columns are its own modes. Scaled amplitudes differ from those in the units of the data.
#[test]
fn a_component_without_interface() {
    let place = Place::with_brick();
    for method in ["herting", "craig-bampton"] {
        place.reduce(&place.model_flags(), &format!("--method {method} --modes 5")).expect(ExitCode::Done);
        passes(&place, "no interface");
    }
}

/// On a slider gravity leaves bending and torsion alone, whose modes are dropped, and the motion that is left deforms nothing: of the damping
/// along it there is rounding, which is another one of the modes that are kept.
#[test]
fn modal_damping_on_a_slider() {
    let place = Place::with(&brick([6, 2, 2], [0.6, 0.06, 0.06], &Material::STEEL_SI));
    for ratio in [0.02, 0.3] {
        let job = format!(
            r#"
model = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
reduction = {{ method = "craig-bampton", modes = {{ count = 12 }} }}
write = {{ superelement = "x.supel" }}
damping = {{ modal = {{ ratio = {ratio} }} }}
[[interface]]
name = "a"
nodes = [1, 8, 15, 22, 29, 36, 43, 50, 57]
coupling = "rigid"
[scene]
grounded = ["a.ux", "a.uy", "a.rx", "a.ry", "a.rz"]
gravity = [0, 0, -1]
outputs = {{ nodes = [1] }}
"#
        );
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        let report = place.report("x.report.json");
        let dropped = report["body"]["reduction"]["dropped"].as_array().expect("a list").len();
        assert!(dropped > 0, "{ratio}: every mode is seen");
        passes(&place, "a slider");
    }
}

/// Guyan's reduction: no mode at all.
#[test]
fn without_modes() {
    let place = Place::with_brick();
    place
        .reduce(&place.model_flags(), "--interface foot=1,11,31,41 --method craig-bampton --modes 0")
        .expect(ExitCode::Done);
    passes(&place, "no modes");
}

#[cfg(feature = "hdf5")]
#[test]
fn the_bundled_example() {
    let place = Place::with_example();
    supel(&["reduce", &place.text("job.toml"), "--output", &place.text("x.supel")]).expect(ExitCode::Done);
    passes(&place, "the bracket");
}

/// Bending about either axis of a section that is square but for its last digits: the two shapes are any two of their plane as far as
/// rounding goes, and so are their error bars.
#[test]
fn modes_that_are_nearly_one_are_verified_with_the_job() {
    for off in [1e-9, 1e-10, 1e-11, 1e-12, 1e-13] {
        let place = Place::with(&brick([6, 2, 2], [0.4, 0.06, 0.06 * (1.0 + off)], &Material::STEEL_SI));
        for method in ["herting", "craig-bampton"] {
            let rest = format!("--rigid-interface foot=1,8,15,22,29,36,43,50,57 --method {method} --modes 8");
            place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
            passes(&place, &format!("off by {off:e}, {method}"));
        }
    }
}

/// Two blocks with one edge in common; the free end of the second one has the nodes 15, 18 and 21.
pub(crate) fn hinged_blocks() -> Model {
    let block = brick([2, 1, 1], [2.0, 1.0, 1.0], &Material::UNIT);
    join(&block, &translated(&block, [2.0, 1.0, 0.0]), &[(6, 1), (12, 7)])
}

/// Mechanisms are zero modes behind the six motions of the body, whose mass the file states all the same.
#[test]
fn two_bodies_with_a_hinge_or_a_ball_joint() {
    let block = brick([2, 1, 1], [2.0, 1.0, 1.0], &Material::UNIT);
    let ball_jointed = join(&block, &translated(&block, [2.0, 1.0, 1.0]), &[(12, 1)]);
    for (model, there) in [(hinged_blocks(), "15,18,21"), (ball_jointed, "17,20,23")] {
        let place = Place::with(&model);
        for method in ["herting", "craig-bampton"] {
            let rest = format!("--interface here=1,2,4,7 --interface there={there} --method {method} --modes 4");
            let ended = place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
            assert!(ended.out.contains("W-MECHANISM"), "{}", ended.out);
            passes(&place, &rest);
        }
        mechanisms_that_are_meant(&place);
    }
}

/// `model.mechanisms = "accept"` takes the warning away, which `--strict` refuses, and stands among the assumptions.
#[track_caller]
fn mechanisms_that_are_meant(place: &Place) {
    let kept = supel(&["inspect", &place.text("x.supel"), "--job"]).expect(ExitCode::Done).out;
    let mut job: serde_json::Value = serde_json::from_str(&kept).expect("a job");
    for (mechanisms, is_warned_of) in [("warn", true), ("accept", false)] {
        job["model"]["mechanisms"] = mechanisms.into();
        place.write("meant.json", job.to_string().as_bytes());
        let ended = supel(&["reduce", &place.text("meant.json"), "--strict", "--allow-unverified"]);
        assert_eq!(ended.out.contains("W-MECHANISM"), is_warned_of, "{}", ended.out);
        let made = place.superelement("x.supel");
        let assumptions = &made.metadata().validity.assumptions;
        assert_eq!(assumptions.iter().any(|assumption| assumption.contains("without strain")), !is_warned_of);
    }
}

/// A body that one rigid patch carries has no stiffness there but rounding, which is no size for its forces: next to another body, with few
/// digits and without a mass.
#[test]
fn statics_of_a_carried_body_next_to_another_one() {
    let block = brick([2, 1, 1], [2.0, 1.0, 1.0], &Material::UNIT);
    let two = join(&block, &translated(&block, [5.0, 0.0, 0.0]), &[]);
    for digits in [7, 9, 12, 17] {
        let place = Place::with(&rounded(&two, digits));
        let job = "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\nnodes = \"nodes.csv\"\ndofs = \"dofs.txt\"\n\
                   [[interface]]\nname = \"a\"\nnodes = [1, 4, 7, 10]\ncoupling = \"rigid\"\n\
                   [[interface]]\nname = \"b\"\nnodes = [15, 18, 21, 24]\n\
                   [reduction]\nmethod = \"guyan\"\n[scene]\nanalysis = \"static\"\ngravity = false\n\
                   [write]\nsuperelement = \"x.supel\"\n";
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        for flags in [&[][..], &["--job", &place.text("job.toml")]] {
            let ended = supel(&[&["verify", &place.text("x.supel")], flags].concat());
            assert_eq!(ended.code, ExitCode::Done, "{digits} digits, {flags:?}:\n{}{}", ended.out, ended.err);
        }
    }
}

/// A chain that hangs on a soft spring from a light mass: held there it swings a thousand times slower than the free chain does at
/// least, and rounding that is nothing of the energy of a free mode is 10⁻⁶ of its frequency. A file is judged as its reduction was.
#[test]
fn a_mode_far_below_those_of_the_free_component() {
    const N: u32 = 30;
    // Entries of all digits.
    let uneven = |i: u32| 1.0 + 0.3 * f64::from(i).sin();
    let masses: Vec<f64> = std::iter::once(1e-3).chain((1..=N).map(uneven)).collect();
    let stiff = (1..N).map(|i| (i, i + 1, 3e9 * uneven(i)));
    let between: Vec<(u32, u32, f64)> = std::iter::once((0, 1, 1.0)).chain(stiff).collect();
    let place = Place::with(&springs(&masses, &[], &between));
    let rest = format!("--interface a=rows:0 --interface b=rows:{N} --method mixed-interface --modes 4 --held a");
    place.reduce(&place.matrix_flags(), &rest).expect(ExitCode::Done);
    passes(&place, "a chain on a soft spring");
}

/// What is left of the free motions of a heavy mass is rounding, and no measure of a shift.
#[test]
fn a_heavy_mass_with_part_of_the_interface_held() {
    let block = brick([4, 4, 2], [1.0, 1.0, 1.0], &Material::UNIT);
    for mass in [1e4, 1e6] {
        let place = Place::with(&carrying(&block, &[27], mass));
        let job = "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\nnodes = \"nodes.csv\"\ndofs = \"dofs.txt\"\n\
                   [[interface]]\nname = \"a\"\nnodes = [21, 51, 31]\n\
                   [reduction]\nmethod = \"mixed-interface\"\nmodes = { count = 6 }\nheld = [\"a.ux\"]\n\
                   [write]\nsuperelement = \"x.supel\"\n";
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
        assert_eq!(ended.code, ExitCode::Done, "{mass}:\n{}{}", ended.out, ended.err);
    }
}

/// Springs against rotation alone, so soft that some rotations are zero within rounding and others a little more. K is as it was but for
/// three entries, and what is said of them does not depend on which.
#[test]
fn rotations_held_next_to_nothing() {
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.1, 0.0, 0.0], [2.1, 0.9, 0.0], [2.1, 1.7, 0.3], [2.1, 2.8, 0.3]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5]];
    let free = frame(&nodes, &edges, &Section::round(0.05), &Material::STEEL_SI, Inertia::Consistent);
    for exponent in [-4.4, -3.0, -1.0] {
        // At the third node.
        let springs = (15..18).fold(free.clone(), |model, row| grounded(&model, row, 10f64.powf(exponent)));
        let place = Place::with(&springs);
        for method in ["herting", "craig-bampton"] {
            let rest = format!("--interface a=1 --interface b=6 --method {method} --modes 8");
            let what = format!("springs of 10^{exponent}, {method}");
            let ended = place.reduce(&place.model_flags(), &rest);
            assert_eq!(ended.code, ExitCode::Done, "{what}:\n{}{}", ended.out, ended.err);
            passes(&place, &what);
        }
    }
}

/// A block of one element after the other with oscillators in three directions on its inner nodes, each of one mass and of the stiffness
/// that belongs to its number.
fn with_oscillators(block: &Model, mass: f64, stiffness_of: impl Fn(usize) -> f64) -> Model {
    let mut model = block.clone();
    let (mut stiffness, mut inertia) = (Assembler::default(), Assembler::default());
    stiffness.extend(block.stiffness.iter().copied());
    inertia.extend(block.mass.iter().copied());
    for (number, host) in [2, 3, 4, 7, 8, 9, 12, 13, 14, 17].into_iter().enumerate() {
        let label = 500_000 + number as i64;
        model.labels.push(label);
        model.nodes.push(block.nodes[host - 1]);
        for direction in 0..3 {
            let (i, j) = (3 * (host as u32 - 1) + u32::from(direction), model.n as u32);
            model.dofs.push((label, direction));
            model.n += 1;
            let k = stiffness_of(number);
            [(i, i, k), (j, j, k), (i, j, -k), (j, i, -k)].into_iter().for_each(|(i, j, k)| stiffness.add(i, j, k));
            inertia.add(j, j, mass);
        }
    }
    Model { stiffness: stiffness.finish(), mass: inertia.finish(), ..model }
}

/// Oscillators of a thousandth of a hertz on a bar of a thousand: eigenvalues twelve powers of ten apart are compared to the last digits
/// of each, whatever the largest of them is.
#[test]
fn frequencies_a_million_times_apart() {
    let block = brick([4, 1, 1], [0.4, 0.06, 0.09], &Material::STEEL_SI);
    let place = Place::with(&with_oscillators(&block, 0.01, |number| 1e-6 * (1.0 + 0.1 * number as f64)));
    for method in ["craig-bampton", "herting"] {
        let rest = format!("--fix wall=1,6,11,16 --rigid-interface b=5,10,15,20 --method {method} --modes 36");
        let ended = place.reduce(&place.model_flags(), &rest);
        assert_eq!(ended.code, ExitCode::Done, "{method}:\n{}{}", ended.out, ended.err);
        passes(&place, method);
    }
}

/// Light oscillators far below the modes of a small part: next to them a residual is nothing in the norms of the whole, and the modes
/// of the part keep their digits row by row all the same.
#[test]
fn oscillators_far_below_the_modes_of_the_part() {
    let block = brick([4, 1, 1], [0.004, 0.0006, 0.0009], &Material::STEEL_SI);
    let omega = std::f64::consts::TAU * 30.0;
    let mass = 2e-11;
    let stiffness = |number| mass * omega * omega * (1.0 + 0.1 * number as f64);
    let place = Place::with(&with_oscillators(&block, mass, stiffness));
    for (method, count) in [("craig-bampton", 42), ("herting", 32)] {
        let rest = format!("--rigid-interface b=5,10,15,20 --method {method} --modes {count}");
        let ended = place.reduce(&place.model_flags(), &rest);
        assert_eq!(ended.code, ExitCode::Done, "{method}:\n{}{}", ended.out, ended.err);
        passes(&place, method);
    }
}

/// A heavy mass on a soft spring to the ground, with light ones in between: the highest frequency is 10⁹ times the lowest, which is
/// known to nine digits all the same and is no rigid-body motion.
#[test]
fn softly_held_masses_next_to_light_ones() {
    let chain = springs(&[1e-3, 1e6, 1e-3, 3.0], &[(3, 1e3)], &[(0, 1, 1e6), (1, 2, 1e8), (2, 3, 1e6)]);
    let place = Place::with(&chain);
    // Three springs in series under the heavy mass; the others add 3e-6 of it to what moves at most.
    let series = 1.0 / (1e-8 + 1e-6 + 1e-3);
    let expected = (series / 1e6_f64).sqrt() / std::f64::consts::TAU;
    for method in ["craig-bampton", "herting"] {
        let flags = format!("--interface b=rows:0 --method {method} --modes 2");
        place.reduce(&place.matrix_flags(), &flags).expect(ExitCode::Done);
        passes(&place, method);
        let superelement = place.superelement("x.supel");
        assert_eq!(superelement.tensors().rigid_body_modes.cols(), 0, "{method}");
        let modes = supel(&["modes", &place.text("x.supel"), "--json"]);
        let document: serde_json::Value = serde_json::from_str(&modes.out).expect("JSON");
        let found = document["modes"][0]["frequency_hz"].as_f64().expect("a frequency");
        assert!((found / expected - 1.0).abs() < 3e-6, "{method}: {found} instead of {expected}");
    }
}

/// Oscillators of a millionth of the component, whose frequencies are one or nearly: the interface hardly sees which of them a mode moves.
#[test]
fn light_oscillators_of_near_frequencies() {
    let block = brick([4, 1, 1], [0.4, 0.06, 0.09], &Material::STEEL_SI);
    let omega = std::f64::consts::TAU * 4000.0;
    for (within, mass, count) in [(0.0, 1e-7, 35), (3e-7, 1e-7, 7), (2e-7, 1e-8, 15)] {
        let stiffness = |number: usize| omega * omega * (1.0 + within * number as f64) * mass;
        let place = Place::with(&with_oscillators(&block, mass, stiffness));
        let rest = format!("--rigid-interface a=1,6,11,16 --interface b=5,10,15,20 --method herting --modes {count}");
        place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
        passes(&place, &format!("{within:e} apart, {mass:e} each"));
    }
}

/// Oscillators of one frequency, of which one is in an average patch with rows 10¹¹ times as stiff: their sum keeps five digits of its
/// spring, and rounding mixes its modes with those of the others, which are known far better.
#[test]
fn one_oscillator_of_many_in_an_average_patch() {
    let block = brick([4, 1, 1], [0.4, 0.06, 0.09], &Material::STEEL_SI);
    let omega = std::f64::consts::TAU * 11.0;
    let place = Place::with(&with_oscillators(&block, 0.1 / (omega * omega), |_| 0.1));
    let job = r#"
        [model]
        stiffness = "K.mtx"
        mass = "M.mtx"
        dofs = "dofs.txt"
        nodes = "nodes.csv"

        [[interface]]
        name = "a"
        nodes = [5, 10, 15, 20, 500000]
        coupling = "average"

        [reduction]
        method = "herting"
        modes = { count = 32 }

        [write]
        superelement = "x.supel"
    "#;
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
}

/// Dense matrices of this order are divided to be decomposed; in SI units their entries may be tiny.
#[test]
fn many_modes_of_a_component_without_interface() {
    let place = Place::with(&brick([4, 2, 2], [0.04, 0.02, 0.02], &Material::STEEL_SI));
    place.reduce(&place.model_flags(), "--method craig-bampton --modes 129").expect(ExitCode::Done);
    passes(&place, "129 modes");
}

/// A mass far heavier than the part, at a corner of a patch whose node is in the middle. Zero modes of the stiffness, attachment modes and the
/// few eigenvalues of an interface of rigid-body motions alone are known by sums over both, and are judged by what these keep.
#[test]
fn a_heavy_mass_at_the_corner_of_a_patch() {
    let block = brick([4, 1, 1], [0.2, 0.03, 0.02], &Material::STEEL_SI);
    for (coupling, method, mass) in
        [("rigid", "guyan", 1e6), ("average", "rubin", 1e8), ("average", "herting", 1e8), ("average", "guyan", 1e8)]
    {
        let place = Place::with(&carrying(&block, &[1], mass));
        let modes = if method == "guyan" { "" } else { "modes = { count = 6 }\n" };
        let job = format!(
            "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\nnodes = \"nodes.csv\"\ndofs = \"dofs.txt\"\n\
             [[interface]]\nname = \"a\"\nnodes = [1, 6, 11, 16]\ncoupling = \"{coupling}\"\n\
             [reduction]\nmethod = \"{method}\"\n{modes}[write]\nsuperelement = \"x.supel\"\n"
        );
        place.write("job.toml", job.as_bytes());
        let what = format!("{coupling}, {method}, {mass:e} kg");
        let made = supel(&["reduce", &place.text("job.toml")]);
        assert_eq!(made.code, ExitCode::Done, "{what}:\n{}{}", made.out, made.err);
        let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
        assert_eq!(ended.code, ExitCode::Done, "{what}:\n{}{}", ended.out, ended.err);
    }
}

/// A check that sums over a mass and what it is ten million times heavier than does not pass says why, in the report and with the job.
#[test]
fn a_heavy_mass_is_named_where_a_check_fails() {
    let block = brick([4, 1, 1], [0.2, 0.03, 0.02], &Material::STEEL_SI);
    for (mass, is_named) in [(1e9, true), (1.0, false)] {
        let place = Place::with(&carrying(&block, &[8], mass));
        let rest = "--rigid-interface a=1,6,11,16 --method herting --modes 6 --allow-unverified";
        let made = place.reduce(&place.model_flags(), rest);
        assert_eq!(made.out.contains("W-MASS-HEAVY"), is_named, "{mass:e}:\n{}{}", made.out, made.err);
        assert_eq!(made.out.contains("(node 8 u"), is_named, "{mass:e}:\n{}{}", made.out, made.err);
    }
}

/// Where supports leave one motion and the interface has no part in it, rounding is all that the file has of it there: its rigid-body
/// coordinate is needed.
#[test]
fn a_rigid_body_coordinate_that_the_interface_has_no_part_in() {
    for cells in [[1, 1, 1], [2, 2, 2], [3, 3, 3]] {
        let place = Place::with(&brick(cells, [1.0; 3], &Material::STEEL_SI));
        for dofs in [r#"["ux"]"#, r#"["ux", "ry"]"#] {
            let job = format!(
                "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\nnodes = \"nodes.csv\"\ndofs = \"dofs.txt\"\n\
                 [[fixed]]\nnodes = {{ within = {{ box = {{ min = [1, 0, 0], max = [1, 1, 1] }} }} }}\ndofs = [\"ux\", \"uy\"]\n\
                 [[interface]]\nname = \"a\"\nnodes = {{ within = {{ box = {{ min = [0, 0, 0], max = [0, 1, 1] }} }} }}\n\
                 coupling = \"rigid\"\ndofs = {dofs}\n[reduction]\nmethod = \"rubin\"\nmodes = {{ count = 3 }}\n\
                 [write]\nsuperelement = \"x.supel\"\n"
            );
            place.write("job.toml", job.as_bytes());
            supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
            passes(&place, &format!("{cells:?} {dofs}"));
            supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
        }
    }
}

/// Next to a mass far heavier than the rest all unit motions load the interior of the part alike, and its own motions about the mass do not:
/// Rubin's attachment modes are made of these. Where rounding leaves nothing of them, they are refused by name.
#[test]
fn attachment_modes_next_to_a_heavy_mass() {
    let block = brick([4, 2, 2], [0.3, 0.2, 0.1], &Material::STEEL_SI);
    let mass = block.total_mass(0);
    for (ratio, code) in [(1e2, ExitCode::Done), (4e5, ExitCode::Done), (1e12, ExitCode::ModelPhysics)] {
        let place = Place::with(&carrying(&block, &[23], ratio * mass));
        let rest = "--rigid-interface a=1,6,16 --interface b=5,20,35,45 --method rubin --modes 5";
        let made = place.reduce(&place.model_flags(), rest);
        assert_eq!(made.code, code, "{ratio:e}:\n{}{}", made.out, made.err);
        match code {
            ExitCode::Done => supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done),
            _ => made,
        };
    }
}

/// A rigid patch whose nodes hardly hold the turn about their own line: rounding leaves more of its static answers than of others.
#[test]
fn static_answers_of_an_interface_nearly_in_line() {
    for bump in [1e-3, 5e-4, 3e-4] {
        let along = |[x, y, z]: [f64; 3]| match [x, y, z] {
            [0.5, 0.0, 0.0] => [x, bump, 0.0],
            _ => [x, 0.1 * y, 0.1 * z],
        };
        let mut mesh = HexMesh::structured([6, 2, 2], along, |_| true);
        mesh.add_group("EDGE", |[_, y, z]| y <= bump && z == 0.0);
        let place = Place::with(&mesh.assemble(&Material::STEEL_SI));
        let edge: Vec<String> = mesh.groups["EDGE"].iter().map(|node| (node + 1).to_string()).collect();
        assert_eq!(edge.len(), 7);
        let rest = format!("--rigid-interface edge={} --method guyan", edge.join(","));
        place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
        let job = supel(&["inspect", &place.text("x.supel"), "--job"]).expect(ExitCode::Done).out;
        place.write("kept.json", job.as_bytes());
        let verify = ["verify", &place.text("x.supel"), "--job", &place.text("kept.json"), "--json"];
        let found: serde_json::Value = serde_json::from_str(&supel(&verify).expect(ExitCode::Done).out).expect("JSON");
        let checks = found["checks"].as_array().expect("checks").iter();
        let solves: Vec<_> = checks.filter(|check| check["id"] == "M-10").collect();
        assert!(!solves.is_empty() && solves.iter().all(|check| check["verdict"] == "pass"), "{bump}: {solves:?}");
    }
}

/// Plates whose drilling stiffness is soft have more modes of it, nearer to each other, than there are of bending. A node of the interface that
/// turns about the normal turns the whole plate in the answer of the held one, and rounding of that is no part of a mode.
#[test]
fn plates_with_soft_drilling_stiffness() {
    // Unit vectors along a plate and across it.
    let turned = [[0.48, 0.6, 0.64], [0.788_5, -0.614_7, -0.015_1]];
    let flat = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for (cells, width, thickness, drilling, [along, across]) in [
        ([3, 2], 0.06, 0.009, 1e-5, turned),
        ([3, 4], 0.15, 0.02, 1e-4, flat),
        ([3, 4], 0.28, 0.03, 1e-5, turned),
        ([3, 4], 0.05, 0.02, 3e-4, turned),
        ([3, 4], 0.06, 0.02, 2e-4, turned),
        ([3, 2], 0.06, 0.03, 2e-5, turned),
        ([3, 2], 0.1, 0.02, 2e-5, turned),
        ([3, 3], 0.06, 0.009, 2e-5, turned),
        ([3, 4], 0.17, 0.02, 5e-5, turned),
        ([3, 3], 0.22, 0.01, 2e-5, flat),
        ([3, 3], 0.09, 0.01, 4e-5, flat),
        ([3, 4], 0.05, 0.01, 2e-5, flat),
        ([3, 2], 0.09, 0.03, 9e-5, flat),
    ] {
        let wall = Wall { material: Material::UNIT, thickness, drilling };
        let at = |[x, y]: [f64; 2]| std::array::from_fn(|i| x * along[i] + width * y * across[i]);
        let place = Place::with(&shell(cells, at, &wall));
        place.reduce(&place.model_flags(), "--interface a=2 --method herting --modes 8").expect(ExitCode::Done);
        agrees(&place, &format!("{cells:?}, {width}, {thickness}, {drilling:e}"), &[]);
    }
}

/// A thin plate on two hinges can turn about their line, and moves so far that few digits of K make forces of it. The columns of the interface
/// take these over, and what they would do on the modes is left out of the reduced stiffness: the residual of a mode in it is what the block
/// that was set to zero would take away.
#[test]
fn a_thin_plate_on_hinges_with_few_digits() {
    for ([length, width], thickness, pair) in [
        ([2.0, 0.8], 0.001, "4,5"),
        ([2.0, 0.8], 0.001, "16,22"),
        ([0.5, 0.6], 0.001, "5,23"),
        ([1.0, 0.6], 0.001, "9,12"),
    ] {
        let wall = Wall { material: Material::STEEL_SI, thickness, drilling: 1e-3 };
        let plate = shell([5, 3], |[x, y]| [length * x, width * y, 0.0], &wall);
        for digits in [10, 11, 12] {
            let place = Place::with(&rounded(&plate, digits));
            for method in ["herting", "rubin"] {
                let rest = format!("--fix hinge=1,19:ux,uy,uz --interface a={pair} --method {method} --modes 5");
                place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
                agrees(&place, &format!("{digits} digits, {rest}"), &[]);
            }
        }
    }
    // Where all that few digits do to rigid-body motion is less than what they put into the block.
    for ([length, width], thickness, rest, digits) in [
        ([1.0, 0.6], 0.003, "--fix hinge=1,6:ux,uy,uz --interface a=21,19 --method macneal --modes 5", 10),
        ([1.5, 1.5], 0.002, "--fix hinge=13,18:ux,uy,uz --interface a=5,6 --method rubin --modes 8", 9),
    ] {
        let wall = Wall { material: Material::STEEL_SI, thickness, drilling: 1e-6 };
        let plate = shell([5, 3], |[x, y]| [length * x, width * y, 0.0], &wall);
        let place = Place::with(&rounded(&plate, digits));
        place.reduce(&place.model_flags(), rest).expect(ExitCode::Done);
    }
}
