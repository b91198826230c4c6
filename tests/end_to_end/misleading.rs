//! Numbers that look more precise than they are, or less: what the numbers and their text show, and what only the job can say.

use supel::cli::ExitCode;
use supel_models::{Inertia, Material, Section, frame};

use crate::few_digits::Found;
use crate::fixed_point::{Entry, Held, components, full, hold, matrix_market, printed, verified};
use crate::place::{Place, supel};

/// In fixed point, where small numbers lose digits and large ones never had them, and each number as short as it can be.
#[test]
fn frequencies_of_single_precision_in_any_text_stay_within_their_bars() {
    let in_fixed_point = |value: f64| format!("{:.3}", value as f32);
    let shortest = |value: f64| format!("{:e}", value as f32);
    // A mass of next to one number, which nine digits would not show.
    let in_thirteen_digits = |value: f64| format!("{:.12e}", f64::from(value as f32));
    // Numbers above 2¹⁶ are no shortest form of a single precision number, and smaller ones have no nine digits of it: that all are in fixed
    // point is the one thing that explains them.
    hold([4e5, 0.3], &|model| printed(model, [&in_fixed_point, &full]), "· 7 digits and 3 decimals");
    hold([4e10, 0.3], &|model| printed(model, [&shortest, &full]), "· 7 digits");
    hold([4e10, 0.3], &|model| printed(model, [&full, &in_thirteen_digits]), "· 7 digits");
}

/// As many digits as there is room for in so many characters.
fn filling<const WIDTH: usize>(value: f64) -> String {
    let shortened =
        |text: String| text.replacen("0.", ".", usize::from(text.trim_start_matches('-').starts_with("0.")));
    let forms = |n: usize| [shortened(format!("{value:.n$}")), format!("{value:.n$e}")];
    let fits = |text: &String| text.len() <= WIDTH && text.parse::<f64>().is_ok_and(|read| read != 0.0);
    let best = (0..WIDTH).rev().flat_map(forms).filter(fits).min_by(|a, b| {
        let off = |text: &String| (text.parse::<f64>().expect("a number") - value).abs();
        off(a).total_cmp(&off(b))
    });
    best.unwrap_or_else(|| "0.".to_owned())
}

/// As many digits, decimals or both as the numbers leave.
#[test]
fn frequencies_of_numbers_that_fill_their_fields_stay_within_their_bars() {
    hold([4e3, 0.3], &|model| printed(model, [&filling::<10>, &full]), "");
}

/// Large numbers in seven digits and small ones in nine: all are known to the fewer.
#[test]
fn frequencies_of_numbers_in_two_formats_stay_within_their_bars() {
    let two = |value: f64| if value.abs() > 300.0 { format!("{value:.6e}") } else { format!("{value:.8e}") };
    hold([4e3, 0.3], &|model| printed(model, [&two, &full]), "· 7 digits");
}

/// Of a frame of equal beams a third of the numbers are round, and fill their fields with zeros.
#[test]
fn round_numbers_that_fill_their_fields_show_no_digits() {
    let storey = |k: f64| [[0.0, 0.0], [0.4, 0.0], [0.4, 0.3], [0.0, 0.3]].map(|[x, y]| [x + 0.02 * k, y, 0.35 * k]);
    let mut nodes: Vec<[f64; 3]> = (0..6).flat_map(|k| storey(f64::from(k))).collect();
    let around = (1..6).flat_map(|k| (0..4).map(move |corner| [4 * k + corner, 4 * k + (corner + 1) % 4]));
    let upright = (0..20).map(|corner| [corner, corner + 4]);
    let mut edges: Vec<[usize; 2]> = Vec::new();
    for [a, b] in around.chain(upright) {
        edges.extend([[a, nodes.len()], [nodes.len(), b]]);
        nodes.push([0, 1, 2].map(|d| 0.5 * (nodes[a][d] + nodes[b][d])));
    }
    let section = Section { area: 1e-4, second_moment_y: 1e-9, second_moment_z: 2e-9, torsion: 2e-9 };
    let model = frame(&nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent);
    let interface = "{ name = \"foot\", nodes = [1, 2, 3, 4], coupling = \"rigid\" }".to_owned();
    let held = Held { name: "a frame of equal beams", interface, model };
    let texts = |stiffness: &dyn Fn(f64) -> String| printed(&held.model, [stiffness, &full]);
    let found = |texts: [String; 2]| {
        let (place, _) = verified(&held, &held.model, texts.each_ref().map(String::as_str), "");
        place.report("x.report.json")["body"].clone()
    };
    let exact = Found::of(&found(texts(&full)));
    for (width, digits) in [(13, texts(&filling::<13>)), (14, texts(&filling::<14>)), (15, texts(&filling::<15>))] {
        let body = found(digits);
        let stated = body["model"]["stiffness"]["digits"].as_u64().expect("digits");
        assert!(stated <= width - 2, "{width} characters: {stated} digits");
        let off = Found::of(&body).worst(&exact);
        assert!(off <= 1.0, "{width} characters: off by {off} bars");
    }
}

/// Three chains of springs of 1000, 2.4, 0.24 and 10⁴: an entry of seven digits, 10000.24, is a sum, and no multiple of a quarter.
#[test]
fn sums_of_short_numbers_are_exact() {
    const N_MASSES: usize = 50;
    let springs = [1e4, 0.24, 2e4, 0.48, 3e4, 0.72];
    let row = |mass: usize, direction: usize| (3 * mass + direction) as u32;
    let (mut stiffness, mut mass): (Vec<Entry>, Vec<Entry>) = (Vec::new(), Vec::new());
    for (k, direction) in (0..N_MASSES).flat_map(|k| (0..3).map(move |direction| (k, direction))) {
        let of = |k: usize| springs[(k + direction) % springs.len()];
        let before = if k > 0 { of(k - 1) } else { 0.0 };
        let after = if k + 1 < N_MASSES { of(k) } else { 0.0 };
        stiffness.push((row(k, direction), row(k, direction), before + after));
        if after > 0.0 {
            stiffness.push((row(k + 1, direction), row(k, direction), -after));
        }
        mass.push((row(k, direction), row(k, direction), [1.0, 2.5, 0.25][k % 3]));
    }
    let place = Place::new();
    place.write("K.mtx", matrix_market(3 * N_MASSES, &stiffness, &|value| value.to_string()).as_bytes());
    place.write("M.mtx", matrix_market(3 * N_MASSES, &mass, &full).as_bytes());
    let of = |name: &str, keys: &str| {
        let job = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\"{keys} }}\n\
             interface = [{{ name = \"end\", nodes = {{ rows = [0, 1, 2] }} }}]\n\
             reduction = {{ method = \"herting\", modes = {{ count = 6 }} }}\n\
             write = {{ superelement = \"{name}.supel\" }}\n"
        );
        place.write(&format!("{name}.toml"), job.as_bytes());
        supel(&["reduce", &place.text(&format!("{name}.toml"))]).expect(ExitCode::Done);
        place.report(&format!("{name}.report.json"))["body"].clone()
    };
    let (judged, stated) = (of("judged", ""), of("stated", ", stiffness_digits = 17"));
    assert!(judged["model"]["stiffness"]["digits"] == 17, "{}", judged["model"]["stiffness"]);
    let [judged, stated] = [judged, stated].map(|body| Found::of(&body));
    assert_eq!(judged.frequencies, stated.frequencies);
    assert!(judged.frequencies.iter().all(|[hertz, bar]| *bar < 1e-6 * hertz), "{:?}", judged.frequencies);
}

/// Single precision in other units has all digits of a double, and exact numbers may have seven.
#[test]
fn stated_digits_replace_those_that_the_numbers_show() {
    const FOOT: f64 = 0.3048;
    let [held, _] = components();
    let of = |stiffness: &dyn Fn(f64) -> String, keys: &str| {
        let texts = printed(&held.model, [stiffness, &full]);
        let (place, out) = verified(&held, &held.model, texts.each_ref().map(String::as_str), keys);
        let found = Found::of(&place.report("x.report.json")["body"]);
        (found, out, place)
    };
    let in_feet = |value: f64| full(FOOT * value);
    let single_in_feet = |value: f64| full(FOOT * f64::from(value as f32));
    let (exact, ..) = of(&in_feet, "");
    let (judged, out, _) = of(&single_in_feet, "");
    assert!(judged.worst(&exact) > 1.0 && out.contains("17 digits"), "{out}");
    let (stated, out, place) = of(&single_in_feet, ", stiffness_digits = 7");
    assert!(stated.worst(&exact) <= 1.0 && out.contains("7 digits as the job states"), "{out}");
    let matrices = &place.report("x.report.json")["body"]["model"];
    assert!(matrices["stiffness"]["digits"] == 7 && matrices["stiffness"]["digits_by"] == "job", "{matrices}");
    assert!(matrices["mass"]["digits"] == 17 && matrices["mass"]["digits_by"].is_null(), "{matrices}");

    let in_seven = |value: f64| format!("{value:.6e}");
    let bar = |found: &Found| found.frequencies[0][1] / found.frequencies[0][0];
    let (rounded, ..) = of(&in_seven, "");
    let (stated, out, place) = of(&in_seven, ", stiffness_digits = 17");
    assert!(bar(&stated) < 1e-3 * bar(&rounded), "{out}");
    // Digits decide which motions are free: another job than the one that the file was made by.
    let job = String::from_utf8(place.bytes("job.toml")).expect("text").replace(", stiffness_digits = 17", "");
    place.write("other.toml", job.as_bytes());
    let ended = supel(&["verify", &place.text("x.supel"), "--job", &place.text("other.toml")]);
    let ended = ended.expect(ExitCode::CheckFailed);
    assert!(ended.out.contains("model.stiffness_digits"), "{}", ended.out);
}

/// A band between two frequencies of the full model, into which one of the reduced model has moved up: a resonance of the band that the
/// component does not have.
#[test]
fn a_resonance_that_moved_into_the_band_is_no_empty_band() {
    let place = Place::with_brick();
    let ended = |modes: &str, band: [f64; 2]| {
        let text = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
             interface = [{{ name = \"a\", nodes = [1, 11, 31, 41] }}, {{ name = \"b\", nodes = [5, 15, 45] }}]\n\
             reduction = {{ method = \"herting\", modes = {modes} }}\n\
             scene = {{ band_hz = {band:?}, boundaries = [\"fix:a\"], accept = {{ frequency = 1e-3 }} }}\n\
             write = {{ superelement = \"x.supel\" }}\n"
        );
        place.write("job.toml", text.as_bytes());
        supel(&["reduce", &place.text("job.toml")])
    };
    let wide = ended("{ count = 1 }", [0.0, 2e4]);
    assert!(matches!(wide.code, ExitCode::Done | ExitCode::CheckFailed), "{}", wide.err);
    let report = place.report("x.report.json");
    let pairs = report["body"]["preservation"]["boundaries"][0]["frequencies"].as_array().expect("pairs").clone();
    let hertz = |at: usize, key: &str| pairs[at][key].as_f64().expect("a frequency");
    let moved = (0..pairs.len() - 1)
        .find(|at| {
            let [full, reduced, next] = [hertz(*at, "full_hz"), hertz(*at, "reduced_hz"), hertz(at + 1, "full_hz")];
            reduced > 1.003 * full && reduced < 0.99 * next
        })
        .expect("a mode that the reduction moves");
    // The band begins between the frequencies of the two models, and ends below the next one.
    let from = 0.5 * (hertz(moved, "full_hz") + hertz(moved, "reduced_hz"));
    let band = [from, 0.5 * (hertz(moved, "reduced_hz") + hertz(moved + 1, "full_hz"))];
    let ended = ended("{ count = 1 }", band);
    assert_eq!(ended.code, ExitCode::CheckFailed, "{}", ended.out);
    assert!(ended.out.contains("M-29"), "{}", ended.out);
    let report = place.report("x.report.json");
    let accuracy = report["body"]["preservation"]["accuracy"][0].to_string();
    assert!(accuracy.contains(&format!("mode {}", moved + 1)), "{accuracy}");
}
