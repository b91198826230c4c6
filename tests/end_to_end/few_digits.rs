//! Free components whose matrices were printed with few digits: right within honest bars, or refused for the digits.
//!
//! What is reduced and verified is verified again by `supel verify --job`: both hold it to the same limits.
//!
//! Every run takes each component at each number of digits once, another way each time; `SUPEL_WHOLE=1 cargo test --test end_to_end
//! few_digits` takes all ways.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::frame::{Inertia, Section, frame};
use supel_models::springs::springs;
use supel_models::transform::{grounded, rounded, supported};
use supel_models::{Family, Material, Model, Part, brick, write};
use supel_testing::chain::certified::eigensolver_words;

use crate::place::{Place, supel};

const N_MODES: usize = 8;
const METHODS: [&str; 2] = ["herting", "craig-bampton"];
const DIGITS: [usize; 9] = [5, 6, 7, 8, 9, 10, 12, 14, 16];

/// A free component and the nodes of its interface.
struct Component {
    name: &'static str,
    model: Model,
    nodes: Vec<i64>,
}

/// A beam, a plate of one layer, a bent rod of beam elements, a block of tetrahedra.
fn components() -> [Component; 4] {
    let beam = brick([6, 2, 2], [6.0, 1.1, 0.9], &Material::UNIT);
    let plate = brick([6, 5, 1], [600.0, 500.0, 6.0], &Material::STEEL_MM_T_S);
    let nodes: Vec<[f64; 3]> = (0..16).map(|i| f64::from(i) / 15.0).map(|t| [t, t * t, 0.3 * t * t * t]).collect();
    let edges: Vec<[usize; 2]> = (0..15).map(|i| [i, i + 1]).collect();
    let rod = frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent);
    let block = Part::new(Family::Bulky, 500).model;
    let base: Vec<i64> = block.groups["BASE"].iter().copied().step_by(3).take(5).collect();
    [
        Component { name: "beam", model: beam, nodes: vec![1, 8, 22, 63] },
        Component { name: "plate", model: plate, nodes: vec![1, 7, 36, 42, 43] },
        Component { name: "rod", model: rod, nodes: vec![1, 16] },
        Component { name: "block", model: block, nodes: base },
    ]
}

/// How the model is told of: with a map of its dofs and the coordinates, or by the rows of its matrices alone.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Told {
    Map,
    Rows,
}

#[derive(Clone, Copy, Debug)]
struct Run {
    digits: usize,
    method: &'static str,
    solver: &'static str,
    told: Told,
}

/// A folder with the matrices of a component at some number of digits, and a job for every run.
fn folder(component: &Component, digits: usize) -> Place {
    let place = Place::with(&component.model);
    let model = rounded(&component.model, digits);
    for (name, entries) in [("K.mtx", &model.stiffness), ("M.mtx", &model.mass)] {
        let mut bytes = Vec::new();
        write::matrix_market(&mut bytes, model.n, entries, "").expect("written");
        place.write(name, &bytes);
    }
    place
}

fn job(place: &Place, component: &Component, run: Run) -> String {
    let Run { method, solver, told, .. } = run;
    let dofs = component.model.dofs.iter().enumerate();
    let rows: Vec<usize> = dofs.filter(|(_, dof)| component.nodes.contains(&dof.0)).map(|(row, _)| row).collect();
    let (map, nodes) = match told {
        Told::Map => (", dofs = \"dofs.txt\", nodes = \"nodes.csv\"", format!("{:?}", component.nodes)),
        Told::Rows => ("", format!("{{ rows = {rows:?} }}")),
    };
    let name = format!("{method}-{solver}-{told:?}");
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\"{map} }}\n\
         interface = [{{ name = \"ends\", nodes = {nodes} }}]\n\
         reduction = {{ method = \"{method}\", modes = {{ count = {N_MODES} }}, eigensolver = \"{solver}\" }}\n\
         scene = {{ boundaries = [] }}\n\
         write = {{ superelement = \"{name}.supel\" }}\n"
    );
    place.write(&format!("{name}.toml"), text.as_bytes());
    name
}

/// Frequencies and their bars in Hz, and the number of rigid-body modes.
pub(crate) struct Found {
    pub(crate) frequencies: Vec<[f64; 2]>,
    n_rigid: u64,
}

impl Found {
    pub(crate) fn of(body: &Value) -> Self {
        let number = |value: &Value| value.as_f64().expect("a number");
        let modes = body["reduction"]["modes"].as_array().expect("modes").iter();
        let frequencies = modes.map(|mode| [number(&mode["frequency_hz"]), number(&mode["error_bar_hz"])]).collect();
        Self { frequencies, n_rigid: body["model"]["rigid_body_modes"]["count"].as_u64().expect("a count") }
    }

    /// The largest difference of a frequency over its bar.
    pub(crate) fn worst(&self, reference: &Self) -> f64 {
        let pairs = self.frequencies.iter().zip(&reference.frequencies);
        // Both have the rounding of double precision.
        let off = |([found, bar], [exact, own]): (&[f64; 2], &[f64; 2])| (found - exact).abs() / (bar + own);
        pairs.map(off).fold(0.0, f64::max)
    }
}

/// A check of a residual relative to its terms, which is one at most, whose limit digits or rounding excuse beyond a hundredth.
fn judges_nothing(body: &Value) -> Option<&Value> {
    const OF_TERMS: [&str; 4] = ["M-01", "M-02", "M-05", "M-14"];
    let checks = body["checks"].as_array().expect("checks").iter();
    let mut excused = checks.filter(|check| check["active_limit"] != "engineering" && check["limit"].is_number());
    excused.find(|check| {
        OF_TERMS.iter().any(|id| check["id"] == *id) && check["limit"].as_f64().is_some_and(|limit| limit > 1e-2)
    })
}

/// What comes of a run: nothing where it is as it should be.
fn fault(component: &Component, place: &Place, run: Run, reference: &Found) -> Option<String> {
    let name = job(place, component, run);
    let path = place.text(&format!("{name}.toml"));
    let ended = supel(&["reduce", &path, "--quiet"]);
    let report = place.path(&format!("{name}.report.json"));
    // What K and M do not tell is refused: by name, or by checks that fail with a warning of the digits.
    if !report.exists() {
        let is_for_digits = ended.err.contains("[E-DATA-PRECISION]")
            || ended.err.contains("which the digits of the stiffness do not tell from not at all");
        return (!is_for_digits).then_some(ended.err);
    }
    let body = place.report(&format!("{name}.report.json"))["body"].clone();
    if ended.code == ExitCode::CheckFailed {
        let warnings = body["warnings"].as_array().expect("warnings");
        let is_for_digits = warnings.iter().any(|warning| warning["code"] == "W-DATA-PRECISION");
        return (!is_for_digits).then(|| format!("fails and does not mention the digits: {}", ended.err));
    }
    if let Some(check) = judges_nothing(&body) {
        return Some(format!("a limit that no residual exceeds: {check}"));
    }
    let found = Found::of(&body);
    if found.n_rigid != reference.n_rigid {
        return Some(format!("{} rigid-body modes are verified", found.n_rigid));
    }
    let worst = found.worst(reference);
    if worst > 1.0 {
        return Some(format!("a frequency is off by {worst:.1} bars"));
    }
    if run.solver != "lanczos" {
        // One file is enough: what verifies it does not know who found its modes.
        return None;
    }
    let verified = supel(&["verify", &place.text(&format!("{name}.supel")), "--job", &path]);
    (verified.code != ExitCode::Done).then(|| format!("verified, and then: {}{}", verified.out, verified.err))
}

/// What comes of every item, in threads of their own: a worker of the pool that a run waits in would begin the next one on the same
/// stack.
fn of_all<T: Sync>(items: &[T], look: impl Fn(&T) -> Option<String> + Sync) -> Vec<String> {
    let next = AtomicUsize::new(0);
    let work = || -> Vec<(usize, String)> {
        let taken =
            std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed))).take_while(|at| *at < items.len());
        taken.filter_map(|at| look(&items[at]).map(|text| (at, text))).collect()
    };
    let n_threads = thread::available_parallelism().map_or(1, usize::from);
    let mut found: Vec<(usize, String)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..n_threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("no panic")).collect()
    });
    found.sort();
    found.into_iter().map(|(_, text)| text).collect()
}

#[test]
fn few_digits_give_frequencies_within_their_bars_or_are_refused_for_the_digits() {
    let solvers = eigensolver_words();
    let components = components();
    let is_whole = std::env::var_os("SUPEL_WHOLE").is_some();
    let ways: Vec<(&str, Told, &str)> = METHODS
        .into_iter()
        .flat_map(|method| [Told::Map, Told::Rows].map(|told| (method, told)))
        .flat_map(|(method, told)| solvers.iter().map(move |solver| (method, told, *solver)))
        .collect();
    // Nine numbers of digits go through all eight ways, from another one for each component.
    let is_taken = |at: usize, digits: usize, way: (&str, Told, &str)| {
        let nth = DIGITS.iter().position(|of| *of == digits).expect("a number of digits");
        is_whole || ways[(nth + 3 * at) % ways.len()] == way
    };
    let mut runs = Vec::new();
    let mut references = Vec::new();
    for (at, component) in components.iter().enumerate() {
        let place = folder(component, 17);
        for method in METHODS {
            for told in [Told::Map, Told::Rows] {
                let name = job(&place, component, Run { digits: 17, method, solver: "lanczos", told });
                supel(&["reduce", &place.text(&format!("{name}.toml")), "--quiet"]).expect(ExitCode::Done);
                let reference = Found::of(&place.report(&format!("{name}.report.json"))["body"]);
                let of = |digits| solvers.iter().map(move |solver| Run { digits, method, solver, told });
                let taken =
                    DIGITS.into_iter().flat_map(of).filter(|run| is_taken(at, run.digits, (method, told, run.solver)));
                runs.extend(taken.map(|run| (at, references.len(), run)));
                references.push(reference);
            }
        }
    }
    let places = components.each_ref().map(|component| DIGITS.map(|digits| folder(component, digits)));
    let look = |(at, reference, run): &(usize, usize, Run)| {
        let nth = DIGITS.iter().position(|digits| *digits == run.digits).expect("a number of digits");
        let place = &places[*at][nth];
        let fault = fault(&components[*at], place, *run, &references[*reference])?;
        Some(format!("{}, {run:?}: {fault}", components[*at].name))
    };
    let faults = of_all(&runs, look);
    assert!(faults.is_empty(), "{} of {}:\n{}", faults.len(), runs.len(), faults.join("\n"));
}

/// Three nodes in a row do not react rotation about it. With few digits K_II is then indefinite by its last digits, which is no
/// negative stiffness: what is wrong is the interface, and it is said first.
#[test]
fn an_interface_without_rank_is_named_whatever_the_digits() {
    let [beam, ..] = components();
    let beam = Component { nodes: vec![1, 4, 7], ..beam };
    for digits in [6, 7, 8, 10, 17] {
        let place = folder(&beam, digits);
        for told in [Told::Map, Told::Rows] {
            let name = job(&place, &beam, Run { digits, method: "herting", solver: "lanczos", told });
            let ended = supel(&["reduce", &place.text(&format!("{name}.toml")), "--quiet"]);
            let ended = ended.expect(ExitCode::ModelPhysics);
            assert!(ended.err.contains("[E-INTERFACE-RANK]"), "{digits} digits, {told:?}: {}", ended.err);
        }
    }
}

/// The twist of a plate of 1:1000 is four thousand times softer than its bending as these elements have it, and ten digits round by more
/// than it has: nobody can tell it from a mechanism, and nobody does.
#[test]
fn a_mode_that_rounding_hides_is_no_mechanism() {
    let plate = brick([12, 10, 1], [1200.0, 1000.0, 1.2], &Material::STEEL_MM_T_S);
    let plate = Component { name: "plate", model: plate, nodes: vec![1, 13, 131, 143, 144] };
    let place = folder(&plate, 10);
    for method in METHODS {
        for told in [Told::Map, Told::Rows] {
            let name = job(&place, &plate, Run { digits: 10, method, solver: "lanczos", told });
            let ended = supel(&["reduce", &place.text(&format!("{name}.toml")), "--quiet"]).expect(ExitCode::InputData);
            for said in ["[E-DATA-PRECISION]", "how many motions cost no energy: 7 seem to"] {
                assert!(ended.err.contains(said), "{method}, {told:?}: {}", ended.err);
            }
        }
    }
}

/// Springs to the ground that leave a body at 10⁻⁵ of its first elastic frequency hold it, and with all digits that is known: the
/// reduction says so, and so does whoever looks at its file.
#[test]
fn a_body_on_springs_that_are_known_is_held_for_the_reduction_and_its_file() {
    let [beam, ..] = components();
    // λ of the first bending mode is 0.02, and the mass 6.
    let rows = [1, 7, 57].map(|node: u32| 3 * (node - 1));
    let springs = rows.iter().flat_map(|row| *row..row + 3);
    let model = springs.fold(beam.model.clone(), |model, row| grounded(&model, row as usize, 5e-12));
    let beam = Component { model, ..beam };
    let place = folder(&beam, 17);
    for method in METHODS {
        for told in [Told::Map, Told::Rows] {
            let name = job(&place, &beam, Run { digits: 17, method, solver: "lanczos", told });
            let path = place.text(&format!("{name}.toml"));
            supel(&["reduce", &path, "--quiet"]).expect(ExitCode::Done);
            let found = Found::of(&place.report(&format!("{name}.report.json"))["body"]);
            assert_eq!(found.n_rigid, 0, "{method}, {told:?}");
            supel(&["verify", &place.text(&format!("{name}.supel")), "--job", &path]).expect(ExitCode::Done);
        }
    }
}

/// A thin plate that three of its corners hold: by nine digits rigid-body motion costs 0.3 % of the first elastic energy, and the corners
/// move by so much in the first mode that 4 % of its energy come of that. The check that fails says whose fault it is.
#[test]
fn digits_are_named_where_they_move_a_reduced_frequency() {
    let model = brick([20, 10, 1], [1.0, 0.5, 0.01], &Material::STEEL_SI);
    let plate = Component { name: "thin plate", model, nodes: vec![1, 21, 211] };
    let place = folder(&plate, 9);
    let name = job(&place, &plate, Run { digits: 9, method: "herting", solver: "lanczos", told: Told::Map });
    let ended = supel(&["reduce", &place.text(&format!("{name}.toml"))]);
    assert_eq!(ended.code, ExitCode::CheckFailed, "{}{}", ended.out, ended.err);
    let report = place.report(&format!("{name}.report.json"));
    let checks = report["body"]["checks"].as_array().expect("checks").iter();
    let failed: Vec<&Value> = checks.filter(|check| check["verdict"] == "fail").collect();
    assert_eq!(failed.len(), 1, "{failed:?}");
    assert_eq!(failed[0]["id"], "M-14");
    let worst = failed[0]["worst"].as_str().expect("a place");
    assert!(worst.starts_with("mode 1, as rigid-body motion costs energy by the digits of the stiffness"), "{worst}");
}

/// As streams of C++ write a number by default: six digits without zeros at their end, and an exponent where there are more before the point.
fn streamed(value: f64) -> String {
    let scientific = format!("{value:.5e}");
    let (mantissa, exponent) = scientific.split_once('e').expect("an exponent");
    let exponent: i32 = exponent.parse().expect("a number");
    let cut = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    match exponent {
        -4..6 => cut(&format!("{value:.*}", (5 - exponent) as usize)),
        _ => format!("{}e{}{:02}", cut(mantissa), if exponent < 0 { '-' } else { '+' }, exponent.abs()),
    }
}

/// The rows of a frame in the plane of x and y that move across it.
fn across(nodes: &[[f64; 3]], edges: &[[usize; 2]], section: &Section) -> Model {
    let space = frame(nodes, edges, section, &Material::STEEL_SI, Inertia::Consistent);
    supported(&space, |(_, direction)| [0, 1, 5].contains(&direction))
}

/// The model with its stiffness as streams write it, without what rounding leaves of forces that cancel.
fn by_streams(model: &Model) -> Place {
    let largest = model.stiffness.iter().fold(0.0f64, |max, (_, _, value)| max.max(value.abs()));
    let lines = model.stiffness.iter().filter(|(i, j, value)| i >= j && value.abs() > 1e-12 * largest);
    let lines: Vec<String> = lines.map(|(i, j, value)| format!("{} {} {}", i + 1, j + 1, streamed(*value))).collect();
    let (n, n_lines, lines) = (model.n, lines.len(), lines.join("\n"));
    let place = Place::with(model);
    let text = format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {n_lines}\n{lines}\n");
    place.write("K.mtx", text.as_bytes());
    place
}

#[track_caller]
fn assert_six_digits(place: &Place, last: usize) {
    let flags = format!("--interface a=1 --interface b={last} --method herting --modes 6");
    let ended = place.reduce(&place.model_flags(), &flags);
    assert_eq!(ended.code, ExitCode::Done, "{}", ended.err);
    let report = place.report("x.report.json");
    assert_eq!(report["body"]["model"]["stiffness"]["digits"], 6);
    assert_eq!(report["body"]["model"]["rigid_body_modes"]["count"], 3, "{}", report["body"]["model"]);
}

/// A regular grillage has few different numbers, and six digits of them ground its rotations: they are seen, and its rigid-body motions are free.
#[test]
fn a_grillage_as_streams_write_it() {
    for [dx, dy] in [[0.3, 0.25], [0.37, 0.23]] {
        let at = |k: usize| [dx * (k % 7) as f64, dy * (k / 7) as f64, 0.0];
        let nodes: Vec<[f64; 3]> = (0..35).map(at).collect();
        let along = (0..35).filter(|k| k % 7 < 6).map(|k| [k, k + 1]);
        let edges: Vec<[usize; 2]> = along.chain((0..28).map(|k| [k, k + 7])).collect();
        let model = across(&nodes, &edges, &Section::round(0.02));
        assert_six_digits(&by_streams(&model), 35);
        assert_six_digits(&Place::with(&rounded(&model, 6)), 35);
    }
}

/// A line of equal beams has too few different numbers for their digits to tell, and the text tells them.
#[test]
fn a_line_of_beams_as_streams_write_it() {
    assert_eq!(
        [5_169_230.769, -145_152.4, 0.000_012_34, 1.26e7, 3.5].map(streamed),
        ["5.16923e+06", "-145152", "1.234e-05", "1.26e+07", "3.5"]
    );
    let nodes: Vec<[f64; 3]> = (0..7).map(|k| [0.3 * f64::from(k), 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (1..7).map(|k| [k - 1, k]).collect();
    assert_six_digits(&by_streams(&across(&nodes, &edges, &Section::round(0.025))), 7);
}

/// Springs of three digits need no more, and the format that wrote them may have kept six.
#[test]
fn exact_springs_as_streams_write_them() {
    let chain = springs(&[1.0, 2.0, 1.0, 3.0], &[], &[(0, 1, 1.25e6), (1, 2, 3.75e6), (2, 3, 2.25e6)]);
    let place = by_streams(&chain);
    let ended = place.reduce(&place.matrix_flags(), "--interface ends=rows:0,3 --method craig-bampton --modes 2");
    assert_eq!(ended.code, ExitCode::Done, "{}", ended.err);
    assert_eq!(place.report("x.report.json")["body"]["model"]["stiffness"]["digits"], 17);
}
