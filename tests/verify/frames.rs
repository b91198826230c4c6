//! Slender frames at random, held by one interface node or two: a reduction, its file by itself and its file against the job say the same.

use supel::cli::ExitCode;
use supel_models::random::SplitMix64;
use supel_models::transform::carrying;
use supel_models::{Inertia, Material, Model, Section, frame};

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
        let method = ["herting", "craig-bampton", "rubin"][seed as usize % 3];
        let reduction = format!(r#"method = "{method}", modes = {{ count = {} }}"#, 1 + random.below(8));
        let place = Place::with(&model);
        place.write("job.toml", job(&mut random, &model, (&interface, &reduction)).as_bytes());
        // What a reduction warns of its file may warn of too.
        if supel(&["reduce", &place.text("job.toml"), "--strict"]).code == ExitCode::Done {
            passes(&place, &format!("seed {seed}, {interface}, {reduction}"));
            n_passed += 1;
        }
    }
    assert!(n_passed >= 24, "{n_passed} of 30 without a warning");
}
