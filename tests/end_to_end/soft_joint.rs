//! Two stiff blocks and what joins them: too soft for the digits of the stiffness, it is never taken for a hinge in silence.

use supel::cli::ExitCode;
use supel_models::transform::{join, rounded, translated};
use supel_models::{Material, Model, brick};

use crate::place::{Ended, Place, supel};

const CELLS: [usize; 3] = [2, 2, 2];
const SIZE: [f64; 3] = [0.1, 0.06, 0.05];
const METHODS: [&str; 4] = ["guyan", "herting", "craig-bampton", "rubin"];

/// Steel, a block of so many times its Young's modulus, and steel again; free.
fn blocks(share: f64) -> Model {
    let soft = Material { young: share * Material::STEEL_SI.young, ..Material::STEEL_SI };
    let [steel, soft] = [Material::STEEL_SI, soft].map(|material| brick(CELLS, SIZE, &material));
    let pairs = |a: &Model, end: &str, b: &Model| -> Vec<(i64, i64)> {
        a.groups[end].iter().zip(&b.groups["XMIN"]).map(|(a, b)| (*a, *b)).collect()
    };
    let two = join(&steel, &translated(&soft, [SIZE[0], 0.0, 0.0]), &pairs(&steel, "XMAX", &soft));
    join(&two, &translated(&steel, [2.0 * SIZE[0], 0.0, 0.0]), &pairs(&two, "B.XMAX", &steel))
}

fn reduced(place: &Place, model: &Model, (method, coupling): (&str, &str), rest: &str) -> Ended {
    let faces = ["XMIN", "B.XMAX"].map(|name| &model.groups[name]);
    let interface =
        |name: &str, labels: &[i64]| format!("{{ name = \"{name}\", nodes = {labels:?}, coupling = \"{coupling}\" }}");
    let modes = if method == "guyan" { "" } else { ", modes = { count = 5 }" };
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\"{rest} }}\n\
         interface = [{}, {}]\n\
         reduction = {{ method = \"{method}\"{modes} }}\n\
         scene = {{ boundaries = [] }}\n\
         write = {{ superelement = \"x.supel\" }}\n",
        interface("a", faces[0]),
        interface("b", faces[1])
    );
    place.write("job.toml", text.as_bytes());
    supel(&["reduce", &place.text("job.toml")])
}

/// With five digits the joint costs less than rounding of the blocks: nothing of the stiffness between two rigid faces is left.
#[test]
fn a_joint_that_few_digits_lose_is_no_hinge() {
    let model = blocks(1e-6);
    for (digits, codes) in [(5, &["E-DATA-PRECISION"][..]), (17, &[])] {
        let place = Place::with(&if digits == 17 { model.clone() } else { rounded(&model, digits) });
        for method in METHODS {
            for coupling in ["rigid", "average", "direct"] {
                let ended = reduced(&place, &model, (method, coupling), "");
                let what = format!("{digits} digits, {method}, {coupling}: {}{}", ended.out, ended.err);
                match codes {
                    [] => {
                        assert_eq!(ended.code, ExitCode::Done, "{what}");
                        assert!(!ended.out.contains("W-MECHANISM"), "{what}");
                    }
                    codes => {
                        assert_eq!(ended.code, ExitCode::InputData, "{what}");
                        let is_named = codes.iter().chain(&["E-MECHANISM-DIGITS"]).any(|code| ended.err.contains(code));
                        assert!(is_named, "{what}");
                    }
                }
            }
        }
    }
}

/// Rounding of a block makes as much energy of rigid-body motion as a joint of a billionth of its stiffness has of a hundred-thousandth of its
/// motion. No mode with the interface held knows of it: the blocks hardly strain in them. What moves within the joint counts, though it has no
/// stiffness next to that of the blocks: no mode is left out of the basis for it that `verify` would miss.
#[test]
fn a_joint_that_no_digits_lose_is_reduced_by_every_method() {
    let model = blocks(1e-9);
    let place = Place::with(&model);
    for method in METHODS {
        for coupling in ["rigid", "average", "direct"] {
            let ended = reduced(&place, &model, (method, coupling), "");
            assert_eq!(ended.code, ExitCode::Done, "{method}, {coupling}: {}{}", ended.out, ended.err);
            supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
            supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
        }
    }
}

/// A hinge in few digits looks like a soft joint: it is kept where the job says that it is meant.
#[test]
fn a_hinge_of_few_digits_has_to_be_meant() {
    let block = brick(CELLS, SIZE, &Material::STEEL_SI);
    let edge: Vec<i64> =
        block.groups["XMAX"].iter().copied().filter(|label| block.groups["YMIN"].contains(label)).collect();
    let other: Vec<i64> =
        block.groups["XMIN"].iter().copied().filter(|label| block.groups["YMIN"].contains(label)).collect();
    let pairs: Vec<(i64, i64)> = edge.into_iter().zip(other).collect();
    let model = join(&block, &translated(&block, [SIZE[0], 0.0, 0.0]), &pairs);
    let place = Place::with(&rounded(&model, 7));
    for method in METHODS {
        let silent = reduced(&place, &model, (method, "direct"), "");
        assert_eq!(silent.code, ExitCode::InputData, "{method}: {}{}", silent.out, silent.err);
        assert!(silent.err.contains("E-MECHANISM-DIGITS"), "{method}: {}", silent.err);
        assert!(
            silent.err.contains("1 motion inside the component") && silent.err.contains("\"accept\""),
            "{}",
            silent.err
        );
        let meant = reduced(&place, &model, (method, "direct"), ", mechanisms = \"accept\"");
        assert_eq!(meant.code, ExitCode::Done, "{method}: {}{}", meant.out, meant.err);
    }
}
