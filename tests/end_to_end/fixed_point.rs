//! Matrices that were printed with a fixed count of decimals, in single precision, or as parts to be added: frequencies stay within
//! honest bars, and exact numbers stay exact.
//!
//! Every sample multiplies a matrix by another factor, so that all its entries round anew. The bars hold the frequencies of the matrices
//! in full precision, and are not a thousand times wider than what the roundings make.

use std::fmt::Write as _;

use supel::cli::ExitCode;
use supel::sparse::{Leading, Rounding, SparseMatrix};
use supel_models::model::{dot, multiply};
use supel_models::transform::{scaled, supported, translated};
use supel_models::{Family, Material, Model, Part, Wall, brick, shell};

use crate::few_digits::Found;
use crate::place::{Place, supel};

const SAMPLES: usize = 3;
/// How much wider than the worst rounding of a component bars may be.
const WIDEST: f64 = 1e3;

/// Row, column, value.
pub(crate) type Entry = (u32, u32, f64);

/// A component that is held, and its interface.
pub(crate) struct Held {
    pub(crate) name: &'static str,
    pub(crate) model: Model,
    pub(crate) interface: String,
}

pub(crate) fn components() -> [Held; 2] {
    // Elements of different lengths: entries over three decades.
    let mut bar = brick([6, 2, 2], [6.0, 1.1, 0.9], &Material::UNIT);
    bar = supported(&bar, |(node, _)| (node - 1) % 7 == 0);
    let face: Vec<i64> = (0..9).map(|k| 7 * (k + 1)).collect();
    let block = Part::new(Family::Bulky, 150).model;
    let base = block.groups["BASE"].clone();
    let tip: Vec<i64> = block.groups["TIP"].to_vec();
    let block = supported(&block, |(node, _)| base.contains(&node));
    let rigid = |nodes: &[i64]| format!("{{ name = \"tip\", nodes = {nodes:?}, coupling = \"rigid\" }}");
    [
        Held { name: "bar", model: bar, interface: rigid(&face) },
        Held { name: "block", model: block, interface: format!("{{ name = \"tip\", nodes = {:?} }}", &tip[..3]) },
    ]
}

/// The largest entry of a matrix.
fn largest(entries: &[Entry]) -> f64 {
    entries.iter().fold(0.0, |max, entry| max.max(entry.2.abs()))
}

/// One triangle, each number as `print` has it.
pub(crate) fn matrix_market(n: usize, entries: &[Entry], print: &dyn Fn(f64) -> String) -> String {
    let lower: Vec<&Entry> = entries.iter().filter(|(row, column, _)| row >= column).collect();
    let mut text = format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {}\n", lower.len());
    for (row, column, value) in lower {
        writeln!(text, "{} {} {}", row + 1, column + 1, print(*value)).expect("written");
    }
    text
}

/// Reduces and verifies a model by the texts of its two matrices, with more keys of `model`; the folder, and what was said.
pub(crate) fn verified(held: &Held, model: &Model, texts: [&str; 2], keys: &str) -> (Place, String) {
    let (place, out) = reduced(held, model, texts, keys);
    supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    (place, out)
}

fn reduced(held: &Held, model: &Model, [stiffness, mass]: [&str; 2], keys: &str) -> (Place, String) {
    let place = Place::with(model);
    place.write("K.mtx", stiffness.as_bytes());
    place.write("M.mtx", mass.as_bytes());
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\"{keys} }}\n\
         interface = [{}]\n\
         reduction = {{ method = \"herting\", modes = {{ count = 6 }} }}\n\
         scene = {{ boundaries = [] }}\n\
         write = {{ superelement = \"x.supel\" }}\n",
        held.interface
    );
    place.write("job.toml", text.as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    (place, ended.out)
}

pub(crate) fn full(value: f64) -> String {
    format!("{value:e}")
}

/// The texts of the two matrices of a model.
pub(crate) type Texts<'a> = &'a dyn Fn(&Model) -> [String; 2];

pub(crate) fn printed(model: &Model, [stiffness, mass]: [&dyn Fn(f64) -> String; 2]) -> [String; 2] {
    [matrix_market(model.n, &model.stiffness, stiffness), matrix_market(model.n, &model.mass, mass)]
}

/// Runs all samples of a way to print, and holds bars to what they promise. `sizes` are those of the largest entries.
pub(crate) fn hold(sizes: [f64; 2], texts: Texts<'_>, said: &str) {
    for held in components() {
        let units = [sizes[0] / largest(&held.model.stiffness), sizes[1] / largest(&held.model.mass)];
        let mut worst = 0.0f64;
        for sample in 0..SAMPLES {
            let factor = 1.0 + 2.0 * (0.618_033_988_749_895 * (sample as f64 + 0.5)).fract();
            let model = scaled(&held.model, units[0] * factor, units[1] * factor);
            let found = |place: &Place| Found::of(&place.report("x.report.json")["body"]);
            let exact = printed(&model, [&full, &full]);
            let (exact, _) = reduced(&held, &model, exact.each_ref().map(String::as_str), "");
            let (rounded, out) = verified(&held, &model, texts(&model).each_ref().map(String::as_str), "");
            assert!(out.contains(said), "{}: {out}", held.name);
            let off = found(&rounded).worst(&found(&exact));
            if std::env::var_os("SHOW").is_some() {
                println!("{said}, {}: {off:.1e} of a bar", held.name);
            }
            assert!(off <= 1.0, "{}, sample {sample}: off by {off} bars", held.name);
            worst = worst.max(off);
        }
        assert!(WIDEST * worst >= 1.0, "{}: at most {worst:e} of a bar", held.name);
    }
}

#[test]
fn frequencies_of_a_stiffness_in_fixed_point_stay_within_their_bars() {
    hold([100.0, 1.0], &|model| printed(model, [&|value| format!("{value:.4}"), &full]), "4 decimals");
}

#[test]
fn frequencies_of_a_mass_in_fixed_point_stay_within_their_bars() {
    hold([100.0, 0.3], &|model| printed(model, [&full, &|value| format!("{value:.4}")]), "4 decimals");
}

/// Whole numbers of nine digits, small ones among them.
#[test]
fn frequencies_of_whole_numbers_stay_within_their_bars() {
    let whole = |value: f64| format!("{value:.0}");
    hold([4e8, 3e8], &|model| printed(model, [&whole, &whole]), "0 decimals");
}

/// In SI units, where they are whole numbers of ten digits, and in nine digits, which read back as the same numbers.
#[test]
fn frequencies_of_single_precision_written_as_doubles_stay_within_their_bars() {
    let as_doubles = |value: f64| format!("{:e}", f64::from(value as f32));
    let in_nine_digits = |value: f64| format!("{:.8e}", value as f32);
    hold([4e10, 0.3], &|model| printed(model, [&as_doubles, &as_doubles]), "7 digits");
    hold([4e10, 0.3], &|model| printed(model, [&in_nine_digits, &full]), "7 digits");
}

/// Springs of whole numbers, quarters and multiples of 0.2 that are all there is to know of them, printed with decimals to spare.
#[test]
fn exact_numbers_in_fixed_point_stay_exact() {
    for (name, unit, print) in [
        ("whole", 3.0, (|value| format!("{value:.4}")) as fn(f64) -> String),
        ("as whole numbers", 1000.0, |value| format!("{value:.0}.")),
        ("quarters", 0.25, |value| format!("{value:.3}")),
        ("multiples of 0.2", 0.2, |value| format!("{value:.1}")),
    ] {
        let n = 40;
        let springs = (0..n).flat_map(|i| {
            let of = |k: usize| unit * (1 + k) as f64;
            let own = of(i) + if i + 1 < n { of(i + 1) } else { 0.0 };
            let row = i as u32;
            [Some((row, row, own)), (i + 1 < n).then(|| (row + 1, row, -of(i + 1)))].into_iter().flatten()
        });
        let springs: Vec<Entry> = springs.collect();
        let masses: Vec<Entry> = (0..n as u32).map(|row| (row, row, unit * f64::from(1 + row % 4))).collect();
        let place = Place::new();
        place.write("K.mtx", matrix_market(n, &springs, &print).as_bytes());
        place.write("M.mtx", matrix_market(n, &masses, &print).as_bytes());
        let [stiffness, mass, output] = ["K.mtx", "M.mtx", "x.supel"].map(|file| place.text(file));
        let args = [
            "reduce",
            "--stiffness",
            &stiffness,
            "--mass",
            &mass,
            "--interface",
            "end=rows:39",
            "--method",
            "herting",
            "--modes",
            "4",
        ];
        supel(&[&args[..], &["--output", &output]].concat()).expect(ExitCode::Done);
        let body = &place.report("x.report.json")["body"];
        for matrix in ["stiffness", "mass"] {
            let found = &body["model"][matrix];
            assert!(found["digits"] == 17 && found["decimals"].is_null(), "{name}: {found}");
        }
    }
}

/// A sum of numbers of six digits has seven, or all that a double has.
#[test]
fn parts_to_be_added_have_the_digits_of_the_parts() {
    let in_parts = |model: &Model| {
        let at = std::cell::Cell::new(0);
        let print = |value: f64| {
            at.set(at.get() + 1);
            let share = 0.3 + 0.05 * (0.618_033_988_749_895 * f64::from(at.get())).fract();
            [share * value, 0.9 * value, (0.1 - share) * value].map(|part| format!("{part:.5e}")).join(" ")
        };
        let [stiffness, mass] = printed(model, [&print, &full]);
        [spread(&stiffness), mass]
    };
    hold([4e10, 0.3], &in_parts, "6 digits");
}

/// One line for each of the three numbers of a line.
fn spread(text: &str) -> String {
    let lines: Vec<&str> = text.lines().skip(2).collect();
    let n = text.lines().nth(1).and_then(|line| line.split(' ').next()).expect("an order");
    let mut spread = format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {}\n", 3 * lines.len());
    for line in lines {
        let fields: Vec<&str> = line.split(' ').collect();
        fields[2..].iter().for_each(|part| writeln!(spread, "{} {} {part}", fields[0], fields[1]).expect("written"));
    }
    spread
}

/// [16 1; 1 4] in fixed point, in parts, and entry by entry.
#[test]
fn an_entry_is_known_to_its_decimals_or_to_its_parts() {
    let matrix = SparseMatrix::new((2, 2), vec![0, 2, 4], vec![0, 1, 0, 1], vec![16.0, 1.0, 1.0, 4.0]);
    let leading = Leading::from(&matrix);
    let x = faer::Mat::from_fn(2, 1, |i, _| [1.0, -2.0][i]);
    let terms = |rounding: Rounding| {
        let terms = rounding.terms(leading, x.as_ref());
        [terms[(0, 0)], terms[(1, 0)]]
    };
    let each = Rounding::relative(0.5);
    let fixed = Rounding { absolute: 0.5, ..Rounding::BINARY };
    let parts = Rounding { is_of_parts: true, ..each };
    assert_eq!(terms(each), [9.0, 4.5]);
    assert_eq!(terms(fixed), [1.5, 1.5]);
    // √(16 · 4) = 8 stands for the parts of the entry that couples.
    assert_eq!(terms(parts), [16.0, 8.0]);
    assert_eq!(fixed.measured(leading).share, 1.0 / 5.0);
    assert_eq!(each.measured(leading).share, 0.5);
    assert_eq!(parts.measured(leading).share, 1.0);
    assert!(each.is_coarse() && fixed.is_coarse() && !Rounding::BINARY.is_coarse());
}

/// Whole numbers of 8 to 16 digits, as `%.0f` writes a stiffness in small units.
#[test]
fn rounded_whole_numbers_of_all_sizes_are_in_fixed_point() {
    let value = |k: usize| ((k as f64 + 1.0) * 0.618_033_988_749_894_9).fract() * 10_f64.powi((k % 9) as i32 + 8);
    let of_all_sizes: Vec<f64> = (0..5000).map(|k| value(k).round()).collect();
    assert_eq!(supel::input::digits_of(&of_all_sizes).decimals, Some(0));
    // Computed ones, and whole ones of sizes at which doubles have no decimals.
    assert_eq!(supel::input::digits_of(&(0..5000).map(value).collect::<Vec<f64>>()), supel::input::Digits::DOUBLE);
    assert_eq!(
        supel::input::digits_of(&(0..5000).map(|k| 1e9 * value(k)).collect::<Vec<f64>>()),
        supel::input::Digits::DOUBLE
    );
}

/// Entries of rotations have three digits, but translations make nearly all of the inertia of a plate.
#[test]
fn fixed_decimals_leave_the_inertia_of_a_plate_known() {
    let wall = Wall { material: Material::STEEL_SI, thickness: 0.01, drilling: 1e-3 };
    let model = shell([6, 3], |[x, y]| [x, 0.4 * y, 0.0], &wall);
    let decimals = |value: f64| format!("{value:.8}");
    let interface = format!("{{ name = \"edge\", nodes = {:?}, coupling = \"rigid\" }}", model.groups["XMIN"]);
    let held = Held { name: "plate", model, interface };
    let texts = printed(&held.model, [&full, &decimals]);
    let (place, _) = verified(&held, &held.model, texts.each_ref().map(String::as_str), "");
    let report = place.report("x.report.json");
    let checks = report["body"]["checks"].as_array().expect("checks");
    let inertia = checks.iter().find(|check| check["name"] == "inertia about the centre is known").expect("M-16");
    assert_eq!(inertia["verdict"], "pass", "{inertia}");
    // What the roundings make of the moments about the centre is less than the check says.
    let centred = translated(&held.model, [-0.5, -0.2, 0.0]);
    let rotations = centred.rigid_body_modes()[3..].to_vec();
    let rounded: Vec<Entry> =
        centred.mass.iter().map(|(i, j, value)| (*i, *j, decimals(*value).parse().expect("a number"))).collect();
    let moment = |entries: &[Entry], rotation: &[f64]| dot(rotation, &multiply(entries, rotation));
    let exact: Vec<f64> = rotations.iter().map(|rotation| moment(&centred.mass, rotation)).collect();
    let off = rotations.iter().zip(&exact).map(|(rotation, exact)| (moment(&rounded, rotation) - exact).abs());
    let off = off.fold(0.0, f64::max) / (exact.iter().sum::<f64>() / 3.0);
    let said = inertia["value"].as_f64().expect("a number");
    assert!(0.0 < off && off <= said, "{off:e}, said {said:e}");
}
