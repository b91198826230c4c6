//! Little or no stiffness next to much: the rounding of large numbers is not taken for it where a superelement is reduced again.

use supel::cli::ExitCode;
use supel_models::transform::{in_local_frames, rounded};
use supel_models::{Material, Model, brick};
use supel_runtime::Superelement;
use supel_testing::place::{Place, assert_close, frequencies_hz, steel_brick, supel};

use super::export;
use super::matrix_market::matrix;

const METHODS: [&str; 4] = ["craig-bampton", "herting", "rubin", "guyan"];

/// Reduces x.supel to what holds against it, of as many coordinates and frequencies as its own.
#[track_caller]
fn again(place: &Place, what: &str) -> Superelement {
    let ended = supel(&["reduce", &place.text("x.supel")]);
    assert_eq!(ended.code, ExitCode::Done, "{what}: {}{}", ended.out, ended.err);
    let ended = supel(&["verify", &place.text("x.again.supel"), "--job", &place.text("x.supel")]);
    assert_eq!(ended.code, ExitCode::Done, "{what}: {}{}", ended.out, ended.err);
    let (found, expected) = (place.superelement("x.again.supel"), place.superelement("x.supel"));
    assert_eq!((found.n_coordinates(), found.n_rigid()), (expected.n_coordinates(), expected.n_rigid()), "{what}");
    assert_close(&frequencies_hz(&found), &frequencies_hz(&expected), 1e-6);
    found
}

/// Three nodes whose plane is nearly across an axis have little stiffness along it, next to rounding of large ones: it is real, and follows
/// from the others by equilibrium.
#[test]
fn a_little_stiffness_next_to_large_ones_is_real() {
    let body = steel_brick();
    // Exactly across the axis there is none.
    for (tilt, n_alone) in [(0.0, 3), (1e-7, 0), (1e-5, 0), (1e-4, 0), (1e-3, 0), (3e-2, 0), (0.15, 0), (0.5, 0)] {
        let (sin, cos) = f64::sin_cos(tilt);
        let frame = [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]];
        let along = |x: &[f64; 3]| frame.map(|axis| (0..3).map(|i| axis[i] * x[i]).sum());
        let turned = in_local_frames(&body, &frame, |_| true);
        let place = Place::with(&Model { nodes: body.nodes.iter().map(along).collect(), ..turned });
        for method in METHODS {
            let what = format!("turned by {tilt}, {method}");
            let modes = if method == "guyan" { "" } else { " --modes 5" };
            let flags = format!("--interface foot=1,11,31 --method {method}{modes}");
            place.reduce(&place.model_flags(), &flags).expect(ExitCode::Done);
            export(&place, "matrix-market", &[]).expect(ExitCode::Done);
            let expected = place.superelement("x.supel");
            assert_eq!(rows_with_stiffness(&place), expected.n_coordinates() - n_alone, "{what}");
            let found = again(&place, &what);
            let [found, expected] = [&found, &expected].map(|superelement| &superelement.tensors().stiffness);
            // Of the three edges between the nodes, to what the rounding of K leaves of the largest of them.
            for (i, j) in (0..9).flat_map(|i| (0..9).map(move |j| (i, j))) {
                let largest = (0..9).map(|i| expected[(i, i)]).fold(0.0, f64::max);
                assert!((found[(i, j)] - expected[(i, j)]).abs() <= 1e-10 * largest, "{what}: ({i}, {j})");
            }
        }
    }
}

/// How many rows of x.stiffness.mtx have an entry.
pub(super) fn rows_with_stiffness(place: &Place) -> usize {
    matrix(place, "x.stiffness.mtx").iter().filter(|row| row.iter().any(|value| *value != 0.0)).count()
}

/// Reduces a body with one patch at its end to x.supel; `held` are the directions of its guides, if there are some.
fn reduced_to_a_patch(place: &Place, (coupling, method, held): (&str, &str, &str)) {
    let fixed = match held {
        "" => String::new(),
        held => format!("fixed = [{{ name = \"rail\", nodes = [17, 1, 28, 24], dofs = [{held}] }}]\n"),
    };
    let modes = if method == "guyan" { "" } else { ", modes = { count = 4 }" };
    let job = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
         interface = [{{ name = \"hub\", nodes = [5, 10, 15, 30, 45], coupling = \"{coupling}\" }}]\n{fixed}\
         reduction = {{ method = \"{method}\"{modes} }}\nwrite = {{ superelement = \"x.supel\" }}\n"
    );
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
}

/// A part on guides slides with one coordinate of its patch alone: the others rest but for rounding, which makes no force. The unit of
/// length does not matter.
#[test]
fn a_part_on_guides_slides_without_force() {
    for (size, coupling, origin) in
        [(1.0, "rigid", 0.0), (1.0, "average", 1.0), (3e-4, "rigid", 1.0), (3e-4, "average", 0.0), (10.0, "rigid", 1e2)]
    {
        let mut body = brick([4, 2, 2], [0.2 * size, 0.06 * size, 0.04 * size], &Material::STEEL_SI);
        body.nodes.iter_mut().for_each(|node| *node = node.map(|x| x + 0.2 * origin * size));
        let place = Place::with(&body);
        for (held, n_rigid) in [("\"uy\", \"uz\"", 1), ("\"ux\"", 3)] {
            for method in METHODS {
                reduced_to_a_patch(&place, (coupling, method, held));
                let what = format!("{size} {coupling} {origin} {method} {held}");
                assert_eq!(again(&place, &what).n_rigid(), n_rigid, "{what}");
            }
        }
    }
}

/// A free body of a third of a millimetre that its patch just holds: rotations of unit modal mass are large numbers, and rows without
/// stiffness have no unit but that of their mass.
#[test]
fn a_small_part_that_its_patch_holds_has_no_other_zero_modes() {
    let place = Place::with(&brick([4, 2, 2], [6e-5, 1.9e-5, 1.3e-5], &Material::STEEL_SI));
    for coupling in ["rigid", "average"] {
        for method in ["craig-bampton", "herting"] {
            reduced_to_a_patch(&place, (coupling, method, ""));
            again(&place, &format!("{coupling} {method}"));
        }
    }
}

/// A node of a part on a rail reacts no turn about itself, and to nine digits a little of it: Rubin's method takes that for nothing in the
/// second reduction, too, where the motions come from the matrices.
#[test]
fn digits_are_no_reaction_of_an_interface() {
    let place = Place::with(&rounded(&brick([4, 2, 2], [0.2, 0.06, 0.04], &Material::STEEL_SI), 9));
    let job = "model = { stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }\n\
         interface = [{ name = \"p\", nodes = [21] }]\n\
         fixed = [{ name = \"rail\", nodes = [20, 3, 24, 12], dofs = [\"uy\"] }]\n\
         reduction = { method = \"rubin\", modes = { count = 4 } }\nwrite = { superelement = \"x.supel\" }\n";
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    again(&place, "one node");
}

/// Two nodes that slide with hardly any stiffness of their own: what rounding of their displacements does to dofs next to them that are held
/// is no strain of the sliding.
#[test]
fn rounding_of_what_slides_is_no_strain() {
    let body = steel_brick();
    for tilt in [1e-9, 1e-6, 1e-3] {
        let (sin, cos) = f64::sin_cos(tilt);
        let frame = [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]];
        let along = |x: &[f64; 3]| frame.map(|axis| (0..3).map(|i| axis[i] * x[i]).sum());
        let turned = in_local_frames(&body, &frame, |_| true);
        let place = Place::with(&Model { nodes: body.nodes.iter().map(along).collect(), ..turned });
        let job = "model = { stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }\n\
             interface = [{ name = \"p\", nodes = [1] }, { name = \"q\", nodes = [5] }]\n\
             fixed = [{ name = \"rail\", nodes = [17, 13, 28, 24], dofs = [\"uy\"] }]\n\
             reduction = { method = \"craig-bampton\", modes = { count = 4 } }\nwrite = { superelement = \"x.supel\" }\n";
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        again(&place, &format!("turned by {tilt}"));
    }
}
