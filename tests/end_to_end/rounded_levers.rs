//! Sound components whose coordinates, axes or entries of K are rounded by as much as double precision rounds: long beams that lie askew or
//! have rows along axes of their own, and parts far from the origin. They make no force but what that rounding makes.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::transform::in_local_frames;
use supel_models::{HexMesh, Inertia, Material, Model, Section, frame};

use crate::place::{Place, supel};

/// What practice accepts of M-05.
const ASKED: f64 = 1e-14;

/// A round bar of length one along a direction, in n − 1 beams.
fn beam(direction: [f64; 3], n: usize, radius: f64) -> Model {
    let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
    let node = |i: usize| direction.map(|x| x / length * i as f64 / (n - 1) as f64);
    let (nodes, edges): (Vec<_>, Vec<_>) = ((0..n).map(node).collect(), (1..n).map(|i| [i - 1, i]).collect());
    frame(&nodes, &edges, &Section::round(radius), &Material::STEEL_SI, Inertia::Consistent)
}

/// The report of a reduction with the ends as interfaces, which the verification against the job passes.
fn reduced(place: &Place, method: &str, [a, b]: [&str; 2], more: &str) -> Value {
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\"{more} }}\n\
         interface = [{{ name = \"a\", nodes = {a} }}, {{ name = \"b\", nodes = {b} }}]\n\
         reduction = {{ method = \"{method}\", modes = {{ count = 4 }} }}\n\
         scene = {{ boundaries = [] }}\n\
         write = {{ superelement = \"x.supel\" }}\n"
    );
    place.write("job.toml", text.as_bytes());
    supel(&["reduce", &place.text("job.toml"), "--quiet"]).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    place.report("x.report.json")["body"].clone()
}

fn check<'a>(body: &'a Value, id: &str, name: &str) -> &'a Value {
    let mut checks = body["checks"].as_array().expect("checks").iter();
    checks.find(|check| check["id"] == id && check["name"] == name).expect("a check")
}

/// M-05, the force of rigid-body motion: value and limit of one that passes.
#[track_caller]
fn passed(body: &Value, what: &str) -> [f64; 2] {
    let force = check(body, "M-05", "rigid-body motion makes no force");
    assert_eq!(force["verdict"], "pass", "{what}: {force}");
    ["value", "limit"].map(|key| force[key].as_f64().expect("a number"))
}

/// Along such a beam the stiffness is 10⁶ times that across it, and lies in every entry: coordinates that are known to ε turn it by as much.
#[test]
fn long_beams_askew_make_no_force() {
    let mut largest = 0.0f64;
    for (n, thinness) in [(12, 3e3), (17, 3e3), (12, 5e3), (17, 5e3)] {
        let place = Place::with(&beam([2.0, -1.0, 0.7], n, 1.0 / thinness));
        for method in ["herting", "craig-bampton"] {
            let body = reduced(&place, method, ["[1]", &format!("[{n}]")], "");
            largest = largest.max(passed(&body, &format!("{n} nodes, 1:{thinness}, {method}"))[0]);
        }
    }
    assert!(largest > ASKED, "{largest:e} needs no excuse");
}

/// Rows along axes that lie askew are turned to those of the model, by cosines that are known to ε: of the stiffness along the beam as much
/// is left across it, where translations feel it too.
#[test]
fn long_beams_with_rows_along_axes_askew_make_no_force() {
    let (a, b) = (2.0 / 3.0, 1.0 / 3.0);
    let askew = [[a, a, b], [-a, b, a], [b, -a, a]];
    let is_turned = |node: i64| node % 3 == 2;
    let mut largest = 0.0f64;
    for n in [11, 12, 13, 14, 15, 16] {
        let place = Place::with(&in_local_frames(&beam([1.0, 0.0, 0.0], n, 1.0 / 2e3), &askew, is_turned));
        let rows = (1..=n as i64).filter(|node| is_turned(*node)).map(|node| format!("{node},2,2,1,-2,1,2\n"));
        place.write("frames.csv", ("node,x1,x2,x3,y1,y2,y3\n".to_owned() + &rows.collect::<String>()).as_bytes());
        let body = reduced(&place, "herting", ["[1]", &format!("[{n}]")], ", frames = \"frames.csv\"");
        largest = largest.max(passed(&body, &format!("{n} nodes"))[0]);
    }
    assert!(largest > ASKED, "{largest:e} needs no excuse");
}

/// A block at a distance, made of the coordinates in the file.
fn far_block(distance: f64) -> Place {
    let (size, way) = ([1.0, 0.31, 0.23], [0.6, -0.64, 0.48]);
    let at = |t: [f64; 3]| std::array::from_fn::<f64, 3, _>(|axis| t[axis] * size[axis] + way[axis] * distance);
    Place::with(&HexMesh::structured([4, 2, 2], at, |_| true).assemble(&Material::STEEL_SI))
}

/// Coordinates are rounded to the distance from the origin, and elements are made of their differences. All these roundings with one sign
/// make several times the force that they make as they are.
#[test]
fn blocks_far_from_the_origin_make_no_force() {
    for distance in [9e2, 3e3, 3e4, 1e5] {
        let place = far_block(distance);
        for method in ["herting", "rubin"] {
            let body = reduced(&place, method, ["[1, 11, 31, 41]", "[5, 15, 35]"], "");
            let [value, limit] = passed(&body, &format!("{distance} away, {method}"));
            assert!(value > ASKED, "{distance} away, {method}: {value:e}");
            assert!(limit > 4.0 * value, "{distance} away, {method}: {value:e} of {limit:e}");
        }
    }
}

/// Free modes have as much of a motion that makes forces as the loads that they are found by are balanced with.
#[test]
fn modes_far_from_the_origin_satisfy_the_model_to_its_coordinates() {
    let place = far_block(1e5);
    let body = reduced(&place, "herting", ["[1, 11, 31, 41]", "[5, 15, 35]"], "");
    let residual = check(&body, "M-01", "modes satisfy the full model");
    assert_eq!(residual["verdict"], "pass", "{residual}");
    assert_eq!(residual["active_limit"], "arithmetic", "{residual}");
}
