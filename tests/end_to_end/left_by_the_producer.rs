//! Roundings that the program which wrote K left in it, beyond those of its own digits: motions as a whole fall on both sides of zero, and a
//! count finds those below. They are no negative springs, and both programs say the same of them.

use supel::cli::ExitCode;
use supel_models::transform::{grounded, rounded};
use supel_models::{Inertia, Material, Model, Section, SplitMix64, brick, frame, membrane};

use crate::place::{Place, supel};

/// K whose entries are off by up to this share of themselves, each as it happens.
fn off_by(model: &Model, share: f64, seed: u64) -> Model {
    let mut random = SplitMix64::new(seed);
    let mut off = model.clone();
    let mut of_pair = std::collections::BTreeMap::new();
    for (row, col, value) in &mut off.stiffness {
        let pair = (*row.min(col), *row.max(col));
        *value *= 1.0 + share * *of_pair.entry(pair).or_insert_with(|| 2.0 * random.uniform() - 1.0);
    }
    off
}

/// A job of two interfaces of these nodes.
fn job(place: &Place, method: &str, interfaces: [&[i64]; 2]) -> String {
    let modes = if method == "guyan" { "" } else { ", modes = { count = 6 }" };
    let [a, b] = interfaces;
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
         interface = [{{ name = \"a\", nodes = {a:?} }}, {{ name = \"b\", nodes = {b:?} }}]\n\
         reduction = {{ method = \"{method}\"{modes} }}\n\
         scene = {{ boundaries = [] }}\n\
         write = {{ superelement = \"x.supel\" }}\n"
    );
    place.write("job.toml", text.as_bytes());
    place.text("job.toml")
}

/// A part in 10¹² of each entry: −10⁻¹³ of the terms of a rigid-body motion, −10⁻⁶ of the first elastic energy of the plate.
#[test]
fn energies_of_both_signs_by_roundings_of_the_producer_are_none() {
    let block = brick([4, 2, 2], [1.0, 0.3, 0.3], &Material::STEEL_SI);
    let plate = brick([10, 8, 1], [1.0, 0.8, 0.01], &Material::STEEL_SI);
    for (name, sound, interfaces) in
        [("block", block, [&[1, 2, 6, 16][..], &[5, 10, 45]]), ("plate", plate, [&[1, 12, 100], &[11, 22, 99]])]
    {
        for seed in [1, 2, 3] {
            let place = Place::with(&off_by(&sound, 1e-12, seed));
            for method in ["craig-bampton", "herting", "rubin"] {
                let path = job(&place, method, interfaces);
                let what = format!("{name}, seed {seed}, {method}");
                let reduced = supel(&["reduce", &path]);
                assert_eq!(reduced.code, ExitCode::Done, "{what}: {}{}", reduced.out, reduced.err);
                assert!(!reduced.out.contains("W-MECHANISM"), "{what}: {}", reduced.out);
                let verified = supel(&["verify", &place.text("x.supel"), "--job", &path]);
                assert_eq!(verified.code, ExitCode::Done, "{what}: {}{}", verified.out, verified.err);
            }
            // By the matrices alone as well.
            let rows: Vec<i64> = interfaces.concat().iter().flat_map(|label| 3 * (label - 1)..3 * label).collect();
            let text = format!(
                "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\" }}\n\
                 interface = [{{ name = \"all\", nodes = {{ rows = {rows:?} }} }}]\n\
                 reduction = {{ method = \"herting\", modes = {{ count = 6 }} }}\n\
                 scene = {{ boundaries = [] }}\n\
                 write = {{ superelement = \"y.supel\" }}\n"
            );
            place.write("rows.toml", text.as_bytes());
            let path = place.text("rows.toml");
            let reduced = supel(&["reduce", &path]);
            assert_eq!(reduced.code, ExitCode::Done, "{name}, seed {seed}, rows: {}{}", reduced.out, reduced.err);
            let verified = supel(&["verify", &place.text("y.supel"), "--job", &path]);
            assert_eq!(verified.code, ExitCode::Done, "{name}, seed {seed}, rows: {}{}", verified.out, verified.err);
        }
    }
}

/// A negative spring, far below zero compared with those roundings, is refused as one.
#[test]
fn a_negative_spring_is_no_rounding_of_the_producer() {
    let block = brick([4, 2, 2], [1.0, 0.3, 0.3], &Material::STEEL_SI);
    let largest = block.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2));
    let place = Place::with(&grounded(&block, 4, -1e-8 * largest));
    for method in ["craig-bampton", "rubin"] {
        let path = job(&place, method, [&[1, 2, 6, 16], &[5, 10, 45]]);
        let ended = supel(&["reduce", &path, "--quiet"]).expect(ExitCode::ModelPhysics);
        let is_named = ["[E-NEG-RIGID]", "[E-NEGATIVE-STIFFNESS]"].iter().any(|code| ended.err.contains(code));
        assert!(is_named, "{method}: {}", ended.err);
    }
}

/// Strips fifty and a hundred times as long as wide: forces of rigid-body motion by the digits are a hundredth of those of the first mode, and
/// modes that two operators give differ by the square of that, unless each settles what it leaves. What is reduced and verified is verified
/// again.
#[test]
fn slender_strips_of_few_digits_are_verified_alike() {
    let mut n_verified = 0;
    for (cells, width, digits) in [
        ([50, 1], 0.01, 9),
        ([50, 1], 0.02, 9),
        ([50, 2], 0.01, 10),
        ([50, 2], 0.01, 7),
        ([20, 2], 0.01, 9),
        ([50, 1], 0.01, 7),
    ] {
        let sound = membrane(cells, [1.0, width], &Material::STEEL_SI);
        let place = Place::with(&rounded(&sound, digits));
        for method in ["herting", "rubin", "guyan", "craig-bampton"] {
            let path = job(&place, method, [&sound.groups["XMIN"], &sound.groups["XMAX"]]);
            let what = format!("{cells:?}, {width}, {digits} digits, {method}");
            let reduced = supel(&["reduce", &path]);
            if reduced.code != ExitCode::Done {
                let said = format!("{}{}", reduced.out, reduced.err);
                let is_for_digits = ["E-DATA-PRECISION", "W-DATA-PRECISION", "by the digits of the stiffness"];
                assert!(is_for_digits.iter().any(|words| said.contains(words)), "{what}: {said}");
                continue;
            }
            n_verified += 1;
            let verified = supel(&["verify", &place.text("x.supel"), "--job", &path]);
            assert_eq!(verified.code, ExitCode::Done, "{what}: {}{}", verified.out, verified.err);
        }
    }
    assert!(n_verified > 8, "{n_verified}");
}

/// A beam of which one part is 10⁻⁴ as stiff: by eight digits rigid-body motion costs a tenth of the energy of the first mode, whose
/// frequency no error bar of a Guyan reduction tells of. The check that fails says whose fault it is.
#[test]
fn digits_are_named_where_rigid_body_motion_costs_energy_by_them() {
    let nodes: Vec<[f64; 3]> = (0..11).map(|i| [0.1 * f64::from(i), 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..10).map(|i| [i, i + 1]).collect();
    let of = |young: f64, edges: &[[usize; 2]]| {
        let material = Material { young, ..Material::STEEL_SI };
        frame(&nodes, edges, &Section::round(0.01), &material, Inertia::Consistent)
    };
    let stiff: Vec<[usize; 2]> = edges.iter().copied().filter(|edge| *edge != [4, 5]).collect();
    let mut model = of(Material::STEEL_SI.young, &stiff);
    let soft = of(1e-4 * Material::STEEL_SI.young, &[[4, 5]]);
    model.stiffness.extend(soft.stiffness);
    model.mass.extend(soft.mass);
    model.stiffness = summed(&model.stiffness);
    model.mass = summed(&model.mass);
    let place = Place::with(&rounded(&model, 8));
    for method in ["guyan", "craig-bampton"] {
        let path = job(&place, method, [&[1], &[11]]);
        let ended = supel(&["reduce", &path]);
        assert_eq!(ended.code, ExitCode::CheckFailed, "{method}: {}{}", ended.out, ended.err);
        let report = place.report("x.report.json");
        let checks = report["body"]["checks"].as_array().expect("checks").iter();
        let failed: Vec<_> = checks.filter(|check| check["verdict"] == "fail").collect();
        assert!(!failed.is_empty() && failed.iter().any(|check| check["id"] == "M-05"), "{failed:?}");
        for check in failed {
            let worst = check["worst"].as_str().expect("a place");
            assert!(worst.ends_with("by the digits of the stiffness; write it with more"), "{method}: {check}");
        }
    }
}

/// One entry for each row and column.
fn summed(entries: &[(u32, u32, f64)]) -> Vec<(u32, u32, f64)> {
    let mut sums = std::collections::BTreeMap::new();
    entries.iter().for_each(|(row, col, value)| *sums.entry((*row, *col)).or_insert(0.0) += value);
    sums.into_iter().map(|((row, col), value)| (row, col, value)).collect()
}
