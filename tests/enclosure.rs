//! `--certify full`: proven intervals hold the exact eigenvalues, and are as narrow as the theory says.

use serde_json::Value;
use supel::cli::ExitCode;
use supel::eigen::Modes;
use supel::job::Boundary;
use supel::verification::{Enclosures, enclosures};
use supel_models::transform::in_local_frames;
use supel_models::{
    Ends, Inertia, Material, Model, Section, bar, bar_spectrum, brick, frame, known, ring, ring_spectrum, spring,
    spring_spectrum,
};
use supel_testing::{chain, place};

use crate::place::Place;

/// What a run proved.
struct Proved {
    /// λ of each mode as printed, and its interval.
    intervals: Vec<(f64, [f64; 2])>,
    /// The error bar of each mode relative to λ.
    bars: Vec<f64>,
    checks: Value,
}

impl Proved {
    fn check(&self, name: &str) -> &Value {
        let checks = self.checks.as_array().expect("checks");
        checks.iter().find(|check| check["name"] == name).unwrap_or_else(|| panic!("no check {name}: {checks:#?}"))
    }

    /// The largest half-width relative to λ.
    fn width(&self) -> f64 {
        self.check("eigenvalues are enclosed")["value"].as_f64().expect("a number")
    }

    fn is_count_proved(&self) -> bool {
        self.check("count is proven, not only likely")["worst"].as_str().is_some_and(|text| text.contains("proven"))
    }
}

fn prove(model: &Model, flags: &[String], place: &Place, rest: &str) -> Proved {
    assert!(model.n > 0);
    let ended = place.reduce(flags, &format!("{rest} --certify full")).expect(ExitCode::Done);
    if std::env::var_os("SUPEL_SHOW").is_some() {
        println!("{rest}\n{}", ended.out);
    }
    let report = place.report("x.report.json");
    let modes = report["body"]["reduction"]["modes"].as_array().expect("modes").clone();
    let lambda = |value: &Value| (value.as_f64().expect("a number") * std::f64::consts::TAU).powi(2);
    let of = |mode: &Value| {
        let interval = &mode["enclosure_hz"];
        (lambda(&mode["frequency_hz"]), [lambda(&interval[0]), lambda(&interval[1])])
    };
    let bar = |mode: &Value| {
        2.0 * mode["error_bar_hz"].as_f64().expect("a bar") / mode["frequency_hz"].as_f64().expect("a frequency")
    };
    Proved {
        intervals: modes.iter().map(of).collect(),
        bars: modes.iter().map(bar).collect(),
        checks: report["body"]["checks"].clone(),
    }
}

/// From rows, without coordinates.
fn prove_rows(model: &Model, rest: &str) -> Proved {
    let place = Place::with(model);
    prove(model, &place.matrix_flags(), &place, rest)
}

/// Roundings between an eigenvalue and the frequency that a report prints, and of the closed formula: squares, roots and
/// products with 2π, each of half an ε, on both sides.
const CONVERSION: f64 = 16.0 * f64::EPSILON;

/// Asserts that each interval holds its exact eigenvalue, where the matrix itself moves it by `rounding` at most.
#[track_caller]
fn assert_holds(proved: &Proved, exact: &[f64], rounding: f64) {
    assert!(proved.intervals.len() <= exact.len());
    for ((printed, [low, high]), exact) in proved.intervals.iter().zip(exact) {
        assert!((low..=high).contains(&printed), "{printed} is printed, and [{low}, {high}] holds the eigenvalue");
        let slack = CONVERSION * exact + rounding;
        assert!(*low <= exact + slack && exact - slack <= *high, "{exact} not in [{low}, {high}]");
    }
    assert!(proved.is_count_proved(), "{:#}", proved.check("count is proven, not only likely"));
    assert!(proved.check("error bars reach the proven intervals")["verdict"] == "pass");
}

const INTERFACE: &str = "--interface ends=rows:0,1";

#[test]
fn bars_held_by_both_methods() {
    for n in [60, 600] {
        let model = bar(n);
        let exact = bar_spectrum(n);
        let free = prove_rows(&model, &format!("{INTERFACE} --method herting --modes 8"));
        // K is a rounded number times integers; the entries 4h/6 and h/6 of M are rounded apart, which moves λ by as much
        // times the condition of M, which is 3.
        assert_holds(&free, &exact, 4.0 * f64::EPSILON * exact[7]);
        println!("bar {n}: half-width {:e}", free.width());
        // κ = 12 n²/π² = 4e5 for 600; residuals alone would give 1e-12 and wider, their squares are rounding.
        assert!(free.width() <= 1e-14, "{:e}", free.width());
    }
}

#[test]
fn springs_free_and_clamped() {
    let model = spring(200, Ends::Free);
    let free = prove_rows(&model, "--interface ends=rows:0,199 --method herting --modes 6");
    assert_holds(&free, &spring_spectrum(200, Ends::Free)[1..], 0.0);
    let clamped = prove_rows(&model, "--interface ends=rows:0,199 --method craig-bampton --modes 6");
    assert_holds(&clamped, &spring_spectrum(198, Ends::Fixed), 0.0);
    for proved in [free, clamped] {
        println!("spring: half-width {:e}", proved.width());
        assert!(proved.width() <= 1e-14, "{:e}", proved.width());
    }
}

/// Every eigenvalue but the first is double: a pair has the interval that its residuals give.
#[test]
fn rings_of_double_eigenvalues() {
    // A power of two makes 2 + s exact.
    let (n, s) = (240, 1.0 / 128.0);
    let proved = prove_rows(&ring(n, s), "--interface ends=rows:0,80,160 --method herting --modes 7");
    let exact = ring_spectrum(n, s);
    assert_eq!(proved.intervals.len(), 7);
    assert_holds(&proved, &exact, 0.0);
    println!("ring: half-width {:e}", proved.width());
    assert!(proved.width() <= 1e-10, "{:e}", proved.width());
}

/// Clusters of any narrowness: gaps from 10⁻² to 10⁻¹⁴ and multiplicity three.
#[test]
fn known_clusters() {
    let mut lambda: Vec<f64> = (0..80).map(|i| 1.0 + f64::from(i)).collect();
    for (start, gap) in [(2, 1e-2), (4, 1e-6), (6, 1e-10), (8, 1e-14)] {
        lambda[start + 1] = lambda[start] * (1.0 + gap);
    }
    (lambda[11], lambda[12]) = (lambda[10], lambda[10]);
    let model = known(&lambda, 7);
    let proved = prove_rows(&model, "--interface ends=rows:0,1,2 --method herting --modes 14");
    let mut exact = lambda.clone();
    exact.sort_by(f64::total_cmp);
    // The entries of K are sums of a dozen products of eigenvalues with multiples of 1/64: each is rounded by half an ε of
    // at most four times the largest, and ‖C⁻¹‖² ≤ 16 turns that of a row of eleven into one of an eigenvalue.
    let rounding = 16.0 * 11.0 * 2.0 * f64::EPSILON * lambda[79];
    assert_holds(&proved, &exact, rounding);
    println!("known: half-width {:e}", proved.width());
}

fn solid(model: &Model, interface: &str) -> Proved {
    let place = Place::with(model);
    prove(model, &place.model_flags(), &place, &format!("{interface} --method herting --modes 6"))
}

/// Intervals of the same eigenvalues from different factors and vectors have to overlap, and lie within the error bars.
#[track_caller]
fn assert_agree(a: &Proved, b: &Proved) {
    assert_eq!(a.intervals.len(), b.intervals.len());
    for (((first, [low, high]), (_, [other_low, other_high])), bar) in a.intervals.iter().zip(&b.intervals).zip(&a.bars)
    {
        let slack = CONVERSION * first;
        assert!(
            low - slack <= *other_high && *other_low <= high + slack,
            "[{low}, {high}] [{other_low}, {other_high}]"
        );
        assert!((low - first).max(first - high) <= bar * first + slack, "{first} ± {bar:e} and [{low}, {high}]");
    }
}

/// κ = 1.4e10: the printed eigenvalue is right to about ε κ, the interval to far less.
#[test]
fn slender_bar() {
    let model = brick([100, 1, 1], [100.0, 0.1, 0.1], &Material::STEEL_SI);
    let last = 4 * 101;
    let ends = format!("--interface ends=1,102,{},{}", last - 101, last);
    let (a, b) = (solid(&model, &ends), solid(&model, "--interface middle=50,51,152,253"));
    assert_agree(&a, &b);
    println!("slender: half-widths {:e} {:e}", a.width(), b.width());
    assert!(a.is_count_proved() && b.is_count_proved());
}

/// κ = 2e11: a plate of a thousandth.
#[test]
fn thin_plate() {
    let model = brick([14, 14, 1], [1.0, 1.0, 1e-3], &Material::STEEL_SI);
    let (a, b) = (solid(&model, "--interface corners=1,15,211,225"), solid(&model, "--interface middle=30,38,150,201"));
    assert_agree(&a, &b);
    println!("plate: half-widths {:e} {:e}", a.width(), b.width());
}

/// The modes of a free spring chain, altered before they are enclosed.
fn enclosed(alter: impl FnOnce(&mut Modes)) -> Enclosures {
    let chain = chain::reduce(&spring(80, Ends::Free), &[chain::rows("ends", &[0, 79])], chain::Method::Herting, 6);
    let mut chain = chain.expect("a sound model");
    alter(&mut chain.modes);
    enclosures(&chain.partition, &chain.rigid, &chain.modes, Boundary::FreeInterface).expect("a metric")
}

/// λ of a chain of springs in the scaled units of the partition, which divide K by two and M by one.
fn scaled_spectrum() -> Vec<f64> {
    spring_spectrum(80, Ends::Free)[1..7].iter().map(|lambda| lambda / 2.0).collect()
}

#[test]
fn a_mode_left_out_leaves_the_count_unproved() {
    assert!(enclosed(|_| {}).count.is_proved());
    let lacking = enclosed(|modes| {
        modes.lambda.remove(2);
        modes.errors.remove(2);
        let shapes = modes.shapes.clone();
        modes.shapes = faer::Mat::from_fn(80, 5, |i, j| shapes[(i, if j < 2 { j } else { j + 1 })]);
    });
    assert!(!lacking.count.is_proved(), "{:?}", lacking.count);
    assert_eq!(lacking.count.counted, lacking.count.enclosed + 1);
    assert!(lacking.angles.iter().all(Option::is_none));
}

/// A disturbed vector has a wider interval, which still holds its eigenvalue; the angle says how far it lies off.
#[test]
fn a_disturbed_mode_is_seen_and_still_enclosed() {
    let disturbed = enclosed(|modes| {
        let other = modes.shapes.clone();
        for i in 0..80 {
            modes.shapes[(i, 3)] += 1e-4 * other[(i, 4)];
        }
    });
    let (exact, [low, high]) = (scaled_spectrum()[3], disturbed.intervals[3].expect("enclosed"));
    assert!(low <= exact && exact <= high, "{exact} not in [{low}, {high}]");
    // The Rayleigh quotient is off by the square of the disturbance times the distance of the eigenvalues.
    assert!(high - low > 1e-9 * exact, "[{low}, {high}]");
    let angle = disturbed.angles[3].expect("a proved count");
    assert!((1e-5..1e-2).contains(&angle), "{angle}");
    assert!(disturbed.angles[1].expect("a proved count") < 1e-9);
}

/// Two modes that are one: as a group of two they would need two eigenvalues, and nothing is claimed of them.
#[test]
fn a_mode_given_twice_proves_nothing() {
    let twice = enclosed(|modes| {
        modes.lambda[3] = modes.lambda[2];
        let shapes = modes.shapes.clone();
        for i in 0..80 {
            modes.shapes[(i, 3)] = shapes[(i, 2)];
        }
    });
    assert!(!twice.count.is_proved(), "{:?}", twice.count);
}

/// Without the word nothing is enclosed and nothing is said of it.
#[test]
fn only_where_asked() {
    let model = spring(30, Ends::Free);
    let place = Place::with(&model);
    place.reduce(&place.matrix_flags(), "--interface ends=rows:0,29 --method herting --modes 3").expect(ExitCode::Done);
    let report = place.report("x.report.json");
    assert!(report["body"]["reduction"]["modes"][0]["enclosure_hz"].is_null());
    let checks = report["body"]["checks"].as_array().expect("checks");
    assert!(checks.iter().all(|check| check["id"] != "M-07" && check["id"] != "M-08"));
}

/// The node of a rigid patch is where it is described: another one has the same exact frequencies, by other levers that are rounded, too.
#[test]
fn intervals_know_the_rounding_of_patches() {
    use supel::job::{Coupling, InterfaceJob, Origin};
    let block = brick([4, 3, 2], [1.0, 0.7, 0.4], &Material::UNIT);
    let labels = |at: f64| -> Vec<i64> {
        let nodes = block.labels.iter().zip(&block.nodes);
        nodes.filter(|(_, place)| place[0] == at).map(|(label, _)| *label).collect()
    };
    let ends = [("left", 0.0), ("right", 1.0)]
        .map(|(name, at)| InterfaceJob { coupling: Coupling::Rigid, ..chain::direct(name, &labels(at)) });
    let corner = labels(0.0)[0];
    for mass in [0.0, 1e3] {
        let model = supel_models::transform::carrying(&block, &[corner], mass);
        let intervals = |origin: [f64; 3]| {
            let mut ends = ends.clone();
            ends[0].origin = Origin::Point(origin);
            let chain = chain::reduce(&model, &ends, chain::Method::Herting, 6).expect("a sound model");
            let unit = chain.partition.scaling.eigenvalue_unit();
            let found = enclosures(&chain.partition, &chain.rigid, &chain.modes, Boundary::FreeInterface);
            let found = found.expect("a metric").intervals.into_iter().map(|interval| interval.expect("proved"));
            found.map(|[low, high]| [low * unit, high * unit]).collect::<Vec<_>>()
        };
        let expected = intervals([0.0, 0.35, 0.2]);
        for origin in [[0.0777, -0.4044, -0.2753], [3.3, 0.1, 0.7], [-0.123, 5.1, -2.3]] {
            for (mode, (found, expected)) in intervals(origin).iter().zip(&expected).enumerate() {
                let is_shared = found[0] <= expected[1] && expected[0] <= found[1];
                assert!(is_shared, "mass {mass}, {origin:?}, mode {}: {found:?} and {expected:?}", mode + 1);
                // Far narrower than the bar of M-09 that practice asks for.
                assert!(found[1] / found[0] - 1.0 < 1e-7, "mass {mass}, {origin:?}: {found:?}");
            }
        }
    }
}

/// A frame of thin beams, whose terms are 10⁸ times the energy of its first modes.
fn thin_frame() -> Model {
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [1.4, 0.9, 0.2], [0.6, 1.2, 0.9], [0.1, 0.5, 1.3]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 4]];
    frame(&nodes, &edges, &Section::round(1e-3), &Material::STEEL_SI, Inertia::Consistent)
}

/// Free modes do not depend on axes: those of the numbers in the files are those of the matrices turned to the axes of the model.
#[test]
fn intervals_know_the_rounding_of_rows_that_were_turned() {
    const ASKEW: [[f64; 3]; 3] =
        [[2.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0], [-2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0], [1.0 / 3.0, -2.0 / 3.0, 2.0 / 3.0]];
    let sound = thin_frame();
    let model = in_local_frames(&sound, &ASKEW, |_| true);
    let place = Place::with(&model);
    let axes = |label: &i64| format!("{label},2,2,1,-2,1,2\n");
    let table = "node,x1,x2,x3,y1,y2,y3\n".to_owned() + &model.labels.iter().map(axes).collect::<String>();
    place.write("frames.csv", table.as_bytes());
    let frames = format!("--interface hub=1 --method herting --modes 6 --frames {}", place.text("frames.csv"));
    let turned = prove(&model, &place.model_flags(), &place, &frames);
    let rows = "--interface hub=rows:0,1,2,3,4,5 --method herting --modes 6";
    let as_read = prove(&model, &place.matrix_flags(), &place, rows);
    assert_agree(&turned, &as_read);
    // What is left out across a beam, as rounding of the stiffness along it, counts with all entries.
    assert!(turned.width() < 1e-4 && as_read.width() < turned.width(), "{:e} {:e}", as_read.width(), turned.width());
}

/// A chain whose springs come in parts that add up to one exactly, and not in double precision.
#[test]
fn intervals_know_the_rounding_of_entries_that_were_added_up() {
    let n = 200;
    let (mut entries, mut n_off) = (Vec::new(), 0);
    for (row, col, value) in spring(n, Ends::Free).stiffness {
        let part = |k: u32| value * (0.2 + 0.03 * f64::from((row + col) * 7 + 3 * k).sin());
        let mut parts: Vec<f64> = (0..6).map(part).collect();
        // Their sum, and what it has lost (Knuth), exactly: the rest of the value comes before the loss.
        let (mut sum, mut lost) = (0.0, 0.0);
        for part in &parts {
            let (before, after) = (sum, sum + part);
            lost += (before - (after - (after - before))) + (part - (after - before));
            sum = after;
        }
        parts.extend([value - sum, -lost]);
        parts.rotate_left(3);
        n_off += i32::from(parts.iter().fold(0.0, |sum, part| sum + part) != value);
        entries.extend(parts.into_iter().map(|part| format!("{} {} {part:e}\n", row + 1, col + 1)));
    }
    assert!(n_off > 20, "{n_off}");
    let place = Place::with(&spring(n, Ends::Free));
    let text =
        format!("%%MatrixMarket matrix coordinate real general\n{n} {n} {}\n{}", entries.len(), entries.concat());
    place.write("K.mtx", text.as_bytes());
    let rest = "--interface ends=rows:0,199 --method herting --modes 6";
    let proved = prove(&spring(n, Ends::Free), &place.matrix_flags(), &place, rest);
    assert_holds(&proved, &spring_spectrum(n, Ends::Free)[1..], 0.0);
}

/// A mass away from a node is that of a node there that constraints tie to it.
#[test]
fn intervals_know_the_rounding_of_added_masses() {
    let sound = thin_frame();
    let ([x, y, z], mass) = ([0.37, -0.21, 0.73], 1e4);
    let job = |place: &Place, rest: &str| {
        let text = format!(
            "interface = [{{ name = \"hub\", nodes = [1] }}]\nreduction = {{ method = \"craig-bampton\", modes = {{ count = 5 }} }}\n\
             run = {{ certify = \"full\" }}\nwrite = {{ superelement = \"x.supel\" }}\n{rest}"
        );
        place.write("job.toml", text.as_bytes());
        vec![place.text("job.toml")]
    };
    let model = "stiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n";
    let added = Place::with(&sound);
    let rest = format!("added_mass = [{{ node = 5, mass = {mass}, offset = [{x}, {y}, {z}] }}]\n[model]\n{model}");
    let flags = job(&added, &rest);
    let added = prove(&sound, &flags, &added, "");

    let mut with_node = sound.clone();
    let at = [0, 1, 2].map(|axis| sound.nodes[4][axis] + [x, y, z][axis]);
    with_node.nodes.push(at);
    with_node.labels.push(6);
    for direction in 0..3 {
        with_node.mass.push((with_node.n as u32, with_node.n as u32, mass));
        with_node.dofs.push((6, direction));
        with_node.n += 1;
    }
    // u₆ = u₅ + θ₅ × r
    let row_of = |direction: u8| sound.dofs.iter().position(|dof| *dof == (5, direction)).expect("a row") + 1;
    let levers = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]];
    let mut terms = Vec::new();
    for (axis, levers) in levers.iter().enumerate() {
        terms.push(format!("{} {} 1\n", axis + 1, sound.n + axis + 1));
        terms.push(format!("{} {} -1\n", axis + 1, row_of(axis as u8)));
        let rotations = levers.iter().enumerate().filter(|(_, lever)| **lever != 0.0);
        terms
            .extend(rotations.map(|(about, lever)| format!("{} {} {:e}\n", axis + 1, row_of(3 + about as u8), -lever)));
    }
    let tied = Place::with(&with_node);
    let n = with_node.n;
    let text = format!("%%MatrixMarket matrix coordinate real general\n3 {n} {}\n{}", terms.len(), terms.concat());
    tied.write("ties.mtx", text.as_bytes());
    let flags =
        job(&tied, &format!("[model]\n{model}constraints = \"ties.mtx\"\nconstraints_to_ground = \"accept\"\n"));
    let tied = prove(&with_node, &flags, &tied, "");
    assert_agree(&added, &tied);
    // The mass rests in these modes while its node turns: J is rounded to ε/2 of what is many times the modal mass.
    assert!(added.width() > 1e-13, "{:e}", added.width());
}
