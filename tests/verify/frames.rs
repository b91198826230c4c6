//! Slender frames at random, held by one interface node or two: a reduction, its file by itself and its file against the job say the same.

use supel::cli::ExitCode;
use supel_models::random::SplitMix64;
use supel_models::transform::{carrying, rounded};
use supel_models::{Inertia, Material, Model, Section, brick, frame};

use crate::healthy::passes;
use crate::place::{Place, supel};

/// Beams from node to node of a walk at random, of a slenderness of ten to some hundreds.
fn slender(random: &mut SplitMix64) -> Model {
    let n = 5 + random.below(10) as usize;
    let size = 10f64.powf(3.0 * random.uniform() - 1.0);
    let mut at = [0.0; 3];
    let mut nodes = Vec::new();
    for _ in 0..n {
        at = at.map(|x: f64| x + (1e4 * random.normal()).round() * 1e-4 * size);
        nodes.push(at);
    }
    let edges: Vec<[usize; 2]> = (1..n).map(|node| [node - 1, node]).collect();
    let section = Section::round(size * 10f64.powf(-1.0 - 1.5 * random.uniform()));
    frame(&nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent)
}

/// A job with a force and a turn about an axis.
fn job(random: &mut SplitMix64, model: &Model, (interface, reduction): (&str, &str)) -> String {
    let n = model.nodes.len() as u64;
    let [x, y, z] = model.nodes[0].map(|x| x + 3.0 * random.normal());
    format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{interface}]
load      = [
    {{ name = "force", nodes = [{}], force = [{:.3}, 1, -0.5] }},
    {{ name = "turn", rotation = {{ axis = [1, 2, 2], through = [{x:.3}, {y:.3}, {z:.3}] }} }}]
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel", recovery = {{ nodes = [1, {}] }} }}
"#,
        1 + random.below(n),
        random.normal(),
        2 + random.below(n - 1),
    )
}

/// Without a mode the residual vectors alone tell what is elastic: of the stiffness at the interface node rounding is left.
#[test]
fn files_without_modes_are_judged_as_their_reduction_was() {
    for seed in 0..10 {
        let mut random = SplitMix64::new(seed);
        let model = slender(&mut random);
        let node = 1 + random.below(model.nodes.len() as u64);
        for coupling in ["direct", "rigid"] {
            let interface = format!(r#"{{ name = "a", nodes = [{node}], coupling = "{coupling}" }}"#);
            let place = Place::with(&model);
            let job = job(&mut random, &model, (&interface, r#"method = "guyan""#));
            place.write("job.toml", job.as_bytes());
            supel(&["reduce", &place.text("job.toml"), "--strict"]).expect(ExitCode::Done);
            passes(&place, &format!("seed {seed}, {coupling}"));
        }
    }
}

/// A heavy mass makes the interior ill-conditioned: static answers of two computations differ by what each of their solves lacks.
#[test]
fn heavy_frames_are_judged_alike_by_all_three() {
    let mut n_passed = 0;
    for seed in 100..130 {
        let mut random = SplitMix64::new(seed);
        let model = slender(&mut random);
        let n = model.nodes.len() as u64;
        let heavy = 1 + random.below(n) as i64;
        let mass = model.total_mass(0) * 10f64.powf(4.0 * random.uniform() - 1.0);
        let model = carrying(&model, &[heavy], mass);
        let (a, coupling) = (1 + random.below(n - 1), ["direct", "rigid"][random.below(2) as usize]);
        let interface = format!(r#"{{ name = "a", nodes = [{a}, {}], coupling = "{coupling}" }}"#, a + 1);
        let method = ["herting", "craig-bampton", "rubin", "macneal"][seed as usize % 4];
        let reduction = format!(r#"method = "{method}", modes = {{ count = {} }}"#, 1 + random.below(8));
        let place = Place::with(&model);
        place.write("job.toml", job(&mut random, &model, (&interface, &reduction)).as_bytes());
        // What a reduction warns of its file may warn of too.
        if supel(&["reduce", &place.text("job.toml"), "--strict"]).code == ExitCode::Done {
            passes(&place, &format!("seed {seed}, {interface}, {reduction}"));
            n_passed += 1;
        }
    }
    assert!(n_passed >= 20, "{n_passed} of 30 without a warning of arithmetic or of too few modes");
}

/// A mass of up to 10⁸ times the frame on its interior is slower than the rest by as much: static answers of the full model are still found
/// again, whatever the inertia in the factor that they start from.
#[test]
fn masses_that_the_frame_hardly_moves_fail_no_file() {
    let mut n_done = 0;
    for seed in 200..224 {
        let mut random = SplitMix64::new(seed);
        let model = slender(&mut random);
        let n = model.nodes.len() as u64;
        let mass = model.total_mass(0) * 10f64.powf(5.0 + 3.0 * random.uniform());
        let model = carrying(&model, &[n as i64], mass);
        let interface = format!(r#"{{ name = "a", nodes = [{}] }}"#, 1 + random.below(n - 2));
        let method = ["guyan", "craig-bampton", "macneal", "mixed-interface"][seed as usize % 4];
        let modes = if method == "guyan" { "" } else { ", modes = { count = 4 }" };
        let held = if method == "mixed-interface" { r#", held = ["a"]"# } else { "" };
        let place = Place::with(&model);
        let reduction = format!(r#"method = "{method}"{modes}{held}"#);
        place.write("job.toml", job(&mut random, &model, (&interface, &reduction)).as_bytes());
        let what = format!("seed {seed}, {method}");
        if supel(&["reduce", &place.text("job.toml"), "--quiet"]).code == ExitCode::Done {
            let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
            assert_eq!(ended.code, ExitCode::Done, "{what}:\n{}{}", ended.out, ended.err);
            n_done += 1;
        }
    }
    assert!(n_done >= 20, "{n_done} of 24");
}

/// A mass on the interior of a free part is far slower with the interface held than the free part is: its frequency keeps its digits, for
/// the file by itself as for the reduction.
#[test]
fn masses_inside_that_are_slower_than_the_free_part_fail_no_file() {
    let part = brick([6, 3, 2], [1.0, 0.3, 0.2], &Material::STEEL_SI);
    for ratio in [1e4, 1e7, 1e10] {
        let model = carrying(&part, &[45], ratio * part.total_mass(0));
        let place = Place::with(&model);
        place
            .reduce(&place.model_flags(), "--interface ends=1,8,15,7,14 --method craig-bampton --modes 6")
            .expect(ExitCode::Done);
        let ended = supel(&["verify", &place.text("x.supel"), "--json"]).expect(ExitCode::Done);
        let report: serde_json::Value = serde_json::from_str(&ended.out).expect("json");
        let checks = report["checks"].as_array().expect("checks");
        let frequencies = checks.iter().find(|check| check["name"] == "reduced matrices have the stated frequencies");
        assert_eq!(frequencies.expect("M-14")["verdict"], "pass", "{ratio:e}: {report:#}");
    }
}

/// Nodes of a walk at random with steps of these sizes.
fn walk(random: &mut SplitMix64, n: usize, step: [f64; 3]) -> Vec<[f64; 3]> {
    let mut at = [0.0; 3];
    (0..n)
        .map(|_| {
            at = [0, 1, 2].map(|axis| at[axis] + step[axis] * random.normal());
            at
        })
        .collect()
}

/// A job without loads.
fn plain(interface: &str, reduction: &str) -> String {
    format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{interface}]
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel" }}
"#
    )
}

/// Reduces and looks at the file by itself and against its job.
#[track_caller]
fn reduces_and_passes(model: &Model, job: &str, what: &str) {
    let place = Place::with(model);
    place.write("job.toml", job.as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml"), "--quiet"]);
    assert_eq!(ended.code, ExitCode::Done, "{what}: {}", ended.err);
    for more in [&[][..], &["--job", &place.text("job.toml")]] {
        let ended = supel(&[&["verify", &place.text("x.supel")][..], more].concat());
        assert_eq!(ended.code, ExitCode::Done, "{what}, {more:?}:\n{}{}", ended.out, ended.err);
    }
}

/// A patch of most nodes of a very slender frame: of K̂ at its node nothing is left but rounding, which is no unit of anything, and without
/// a mode K̂ is nothing.
#[test]
fn one_patch_that_holds_a_frame() {
    for seed in 0..24 {
        let mut random = SplitMix64::new(seed);
        let nodes = walk(&mut random, 5, [0.03, 0.01, 0.01]);
        let section = Section::round(10f64.powf(-3.9 + 0.6 * random.uniform()));
        let edges = [[0, 1], [1, 2], [2, 3], [3, 4], [0, 2]];
        let model = frame(&nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent);
        let patch = [[1, 2, 3, 5], [2, 4, 1, 3], [1, 4, 3, 2], [5, 4, 3, 1]][random.below(4) as usize];
        let interface = format!(r#"{{ name = "a", nodes = {patch:?}, coupling = "rigid" }}"#);
        for method in ["herting", "craig-bampton", "guyan"] {
            let modes = if method == "guyan" { "" } else { ", modes = { count = 2 }" };
            let job = plain(&interface, &format!(r#"method = "{method}"{modes}"#));
            reduces_and_passes(&model, &job, &format!("seed {seed}, {method}"));
        }
    }
}

/// One node cuts a frame in two, and a load acts on the half that a mode leaves at rest: what the mode does there is rounding, and tells
/// no sign.
#[test]
fn a_load_on_the_half_that_a_mode_leaves_at_rest() {
    for seed in 0..12 {
        let mut random = SplitMix64::new(seed);
        let nodes = walk(&mut random, 6, [0.3, 0.1, 0.1]);
        let edges: Vec<[usize; 2]> = (1..6).map(|node| [node - 1, node]).collect();
        let model = frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
        let load = r#"load = [{ name = "l", nodes = [1], force = [1.4, 2.5, 1], residual = false }]"#;
        for count in 1..=3 {
            for held in ["", "\nfixed = [{ nodes = [6] }]"] {
                let job = plain(
                    r#"{ name = "a", nodes = [2] }"#,
                    &format!(r#"method = "craig-bampton", modes = {{ count = {count} }}"#),
                );
                let job = job.replace("interface =", &format!("{load}{held}\ninterface ="));
                reduces_and_passes(&model, &job, &format!("seed {seed}, {count} modes{held}"));
            }
        }
        // Nodes are recovered in the half that the modes leave at rest.
        for (label, count) in [(1, 1), (1, 2), (6, 1), (6, 2)] {
            let reduction = format!(r#"method = "craig-bampton", modes = {{ count = {count} }}"#);
            let kept = format!(r#""x.supel", recovery = {{ nodes = [{label}] }}"#);
            let job = plain(r#"{ name = "a", nodes = [3] }"#, &reduction).replace(r#""x.supel""#, &kept);
            reduces_and_passes(&model, &job, &format!("seed {seed}, {count} modes, node {label} recovered"));
        }
        // One dof held, no interface: five motions are free, seen by gravity and the load alone.
        let free = r#"method = "herting", modes = { count = 3 }"#;
        let held = format!("fixed = [{{ nodes = [2], dofs = [\"ux\"] }}]\n{load}\ninterface =");
        let job = plain("", free).replace("interface =", &held);
        reduces_and_passes(&model, &job, &format!("seed {seed}, one dof held"));
    }
}

/// A load and the same in nine digits: what the second adds to the columns of the first is 10⁻⁹ of it, so that the mixing has entries of 1
/// and of 10¹⁸, and modes come in pairs that only what is seen of them tells apart.
#[test]
fn two_loads_that_are_nearly_one() {
    let model = supel_models::brick([6, 2, 2], [0.2, 0.05, 0.05], &Material::STEEL_SI);
    let mut random = SplitMix64::new(5);
    let force: Vec<f64> = (0..model.n).map(|_| random.normal()).collect();
    for digits in [7, 8, 9] {
        let lines = |text: &dyn Fn(f64) -> String| force.iter().map(|value| text(*value) + "\n").collect::<String>();
        let (exact, printed) =
            (lines(&|value| format!("{value:e}")), lines(&|value| format!("{value:.*e}", digits - 1)));
        let place = Place::with(&model);
        place.write(
            "l.mtx",
            format!("%%MatrixMarket matrix array real general\n{} 2\n{exact}{printed}", model.n).as_bytes(),
        );
        let face = |name: &str, x: f64| {
            format!(
                r#"{{ name = "{name}", nodes = {{ within = {{ box = {{ min = [{}, -9, -9], max = [{}, 9, 9] }} }} }}, coupling = "rigid" }}"#,
                x - 1e-6,
                x + 1e-6
            )
        };
        let loads =
            r#"load = [{ name = "p", file = "l.mtx", column = 0 }, { name = "q", file = "l.mtx", column = 1 }]"#;
        for method in ["craig-bampton", "herting"] {
            let reduction = format!(r#"method = "{method}", modes = {{ count = 6 }}"#);
            let job = plain(&format!("{}, {}", face("a", 0.0), face("b", 0.2)), &reduction);
            let job = job.replace("interface =", &format!("{loads}\ninterface ="));
            place.write("job.toml", job.as_bytes());
            supel(&["reduce", &place.text("job.toml"), "--quiet"]).expect(ExitCode::Done);
            let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
            assert_eq!(ended.code, ExitCode::Done, "{digits} digits, {method}:\n{}{}", ended.out, ended.err);
        }
    }
}

/// Rigid-body motion of a free body costs what its digits leave, and nothing in its file.
#[test]
fn free_bodies_of_few_digits_without_interface() {
    let model = supel_models::brick([3, 2, 2], [0.3, 0.2, 0.2], &Material::STEEL_SI);
    for digits in [7, 9, 12] {
        let printed = |entries: &[(u32, u32, f64)]| {
            entries
                .iter()
                .map(|(i, j, a)| (*i, *j, format!("{a:.*e}", digits - 1).parse().expect("a number")))
                .collect()
        };
        let model = Model { stiffness: printed(&model.stiffness), mass: printed(&model.mass), ..model.clone() };
        for method in ["herting", "craig-bampton"] {
            let job = plain("", &format!(r#"method = "{method}", modes = {{ count = 4 }}"#));
            reduces_and_passes(&model, &job, &format!("{digits} digits, {method}"));
        }
    }
}

/// Slender frames in few digits: where a reduction passes, its file does so by itself and against the job, and one that fails says that the
/// digits come first.
#[test]
fn frames_of_few_digits_are_judged_alike() {
    let mut n_passed = 0;
    for seed in 0..60 {
        let mut random = SplitMix64::new(seed);
        let (digits, exact) = (6 + random.below(4) as usize, slender(&mut random));
        let model = rounded(&exact, digits);
        let all: Vec<usize> = (1..=model.nodes.len()).collect();
        let interface = ["".to_owned(), format!(r#"{{ name = "a", nodes = {all:?} }}"#)][seed as usize % 2].clone();
        let method = if seed % 4 == 3 { "rubin" } else { "herting" };
        let place = Place::with(&model);
        let job = plain(&interface, &format!(r#"method = "{method}", modes = {{ count = {} }}"#, 1 + random.below(6)));
        place.write("job.toml", job.as_bytes());
        let what = format!("seed {seed}, {digits} digits, {interface}, {method}");
        let ended = supel(&["reduce", &place.text("job.toml")]);
        if ended.code != ExitCode::Done {
            let says_why = ended.err.contains("[E-DATA-PRECISION]")
                || ended.out.contains("write them with all their digits first");
            assert!(says_why, "{what}: {}{}", ended.out, ended.err);
            continue;
        }
        n_passed += 1;
        for more in [&[][..], &["--job", &place.text("job.toml")]] {
            let ended = supel(&[&["verify", &place.text("x.supel")][..], more].concat());
            assert_eq!(ended.code, ExitCode::Done, "{what}, {more:?}:\n{}{}", ended.out, ended.err);
        }
    }
    assert!(n_passed >= 30, "{n_passed} of 60 pass");
}

/// A mass far heavier than the frame: its translations of unit mass are so small next to turns about it that a mixture of both would cost the
/// constraint modes, which are made to carry rigid-body motion, most of their digits.
#[test]
fn recovered_rows_next_to_a_heavy_mass_carry_rigid_body_motion() {
    let nodes: Vec<[f64; 3]> = (0..15).map(|node| [-1.7, 2.5, 1.3].map(|step| step * f64::from(node))).collect();
    let edges: Vec<[usize; 2]> = (1..nodes.len()).map(|node| [node - 1, node]).collect();
    let bar = frame(&nodes, &edges, &Section::round(0.3), &Material::STEEL_SI, Inertia::Consistent);
    for (ratio, reduction) in [(7e5, r#"method = "guyan""#), (1e4, r#"method = "herting", modes = { count = 7 }"#)] {
        let place = Place::with(&carrying(&bar, &[8], ratio * bar.total_mass(0)));
        let job = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{{ name = "a", nodes = [15], coupling = "rigid" }}, {{ name = "b", nodes = [1] }}]
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel", recovery = {{ nodes = [2, 3, 5, 8, 11, 14] }} }}
"#
        );
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        let ended = supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
        let carried: Vec<&str> = ended.out.lines().filter(|line| line.contains("recovered rows carry")).collect();
        assert!(matches!(carried[..], [line] if line.contains("pass")), "{reduction}:\n{}", ended.out);
    }
}
