//! The axes of interface nodes: a label in the file, on which no matrix depends.

use supel::cli::ExitCode;
use supel_models::Material;
use supel_models::frame::{Inertia, Section, frame};
use supel_runtime::Superelement;

use crate::place::{Ended, Place, supel};

/// A brick with two interfaces, one by nodes and one rigid, and their axes.
fn reduced(foot: &str, head: &str) -> (Place, Ended) {
    let place = Place::with_brick();
    let job = format!(
        "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n\
         [[interface]]\nname = \"foot\"\nnodes = [1, 11, 31, 41]\n{foot}\n\
         [[interface]]\nname = \"head\"\nnodes = [5, 15, 35]\ncoupling = \"rigid\"\n{head}\n\
         [reduction]\nmethod = \"herting\"\nmodes = {{ count = 4 }}\n[write]\nsuperelement = \"x.supel\"\n"
    );
    place.write("job.toml", job.as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml")]);
    (place, ended)
}

fn verified(place: &Place) -> [ExitCode; 2] {
    let alone = supel(&["verify", &place.text("x.supel")]);
    [alone.code, supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).code]
}

/// The file with the frame of one node turned by a quarter about z.
fn turn(place: &Place, node: usize) {
    let superelement = place.superelement("x.supel");
    let mut tensors = superelement.tensors().clone();
    tensors.interface_frames[node] = tensors.interface_frames[node].map(|[x, y, z]| [-y, x, z]);
    let turned = Superelement::new(tensors, superelement.metadata().clone()).expect("a superelement");
    place.write("x.supel", &turned.to_bytes().expect("a file").bytes);
}

#[test]
fn axes_are_those_of_the_job_and_move_no_number() {
    let (plain, ended) = reduced("", "");
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    let (place, ended) = reduced("axes = { z = [0, 3, 0], x = [1, 5, 0] }", "axes = { z = [1, 1, 0], x = [0, 0, 2] }");
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    assert!(ended.out.contains("its x along (1, 0, 0), z along (0, 1, 0)"), "{}", ended.out);
    let (mut turned, straight) = (place.superelement("x.supel").tensors().clone(), plain.superelement("x.supel"));
    let s = 0.5_f64.sqrt();
    // y is z × x.
    let foot = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]];
    let head = [[0.0, s, s], [0.0, -s, s], [1.0, 0.0, 0.0]];
    for (found, expected) in turned.interface_frames.iter().zip([foot, foot, foot, foot, head]) {
        for (a, b) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((a - b).abs() <= 2.0 * f64::EPSILON, "{found:?} instead of {expected:?}");
        }
    }
    turned.interface_frames.clone_from(&straight.tensors().interface_frames);
    assert_eq!(&turned, straight.tensors(), "matrices stay in the axes of the model");
    assert_eq!(verified(&place), [ExitCode::Done; 2]);
    turn(&place, 4);
    assert_eq!(verified(&place), [ExitCode::CheckFailed; 2], "other axes than the job gives");
}

/// The bore of the bundled bracket goes along y; x is what is left of an axis of the model.
#[cfg(feature = "hdf5")]
#[test]
fn axes_of_a_hole() {
    let place = Place::with_example();
    let text = std::fs::read_to_string(place.path("job.toml")).expect("a job");
    let along =
        text.replace("nodes    = \"group:EYE\"", "nodes    = \"group:EYE\"\norigin = \"hole\"\naxes = \"hole\"");
    place.write("job.toml", along.replace("bracket.supel", "x.supel").as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    let frame = place.superelement("x.supel").tensors().interface_frames[1];
    let expected = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]];
    for (a, b) in frame.as_flattened().iter().zip(expected.as_flattened()) {
        // The fit converges to rounding of coordinates of 112 on a radius of 18.
        assert!((a - b).abs() < 1e-13, "{frame:?}");
    }
    turn(&place, 1);
    let alone = supel(&["verify", &place.text("x.supel")]);
    assert_eq!(alone.code, ExitCode::Done, "the mesh is not at hand:\n{}{}", alone.out, alone.err);
    assert!(alone.out.contains("interface_frames"), "{}", alone.out);
    let compared = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]);
    assert_eq!(compared.code, ExitCode::CheckFailed, "{}", compared.out);
}

/// Two rings around an axis that rounding takes off y: which of x and z it leaves most of is no reason to turn the axes over.
#[test]
fn rounding_turns_no_axes_over() {
    let around = |k: usize| std::f64::consts::TAU / 8.0 * (k % 8) as f64;
    let edges: Vec<[usize; 2]> =
        (0..16).map(|k| [k, 8 * (k / 8) + (k + 1) % 8]).chain((0..8).map(|k| [k, k + 8])).collect();
    for [about_z, about_x] in [[1e-6, 0.0], [-1e-6, 1e-9], [0.0, 1e-6], [1e-9, -1e-6]] {
        let at = |k: usize| {
            let (y, (z, x)) = (0.1 * (k / 8) as f64, around(k).sin_cos());
            [0.05 * x + about_z * y, y, 0.05 * z + about_x * y]
        };
        let nodes: Vec<[f64; 3]> = (0..16).map(at).collect();
        let model = frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
        let place = Place::with(&model);
        let job = "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n\
             [[interface]]\nname = \"bore\"\nnodes = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]\ncoupling = \"average\"\norigin = \"hole\"\n\
             axes = \"hole\"\n[reduction]\nmethod = \"herting\"\nmodes = { count = 4 }\n[write]\nsuperelement = \"x.supel\"\n";
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        let [x, y, z] = place.superelement("x.supel").tensors().interface_frames[0];
        // The columns are x, −z and y of the model, but for the angles.
        for (row, expected) in [(x, [1.0, 0.0, 0.0]), (y, [0.0, 0.0, 1.0]), (z, [0.0, -1.0, 0.0])] {
            (0..3).for_each(|j| assert!((row[j] - expected[j]).abs() < 1e-5, "{about_z} {about_x}: {row:?}"));
        }
    }
}

#[test]
fn axes_that_are_none_are_refused() {
    let (data, usage) = (ExitCode::InputData, ExitCode::Usage);
    for (foot, head, code, words) in [
        ("", "axes = { z = [0, 0, 1], x = [0, 0, -2] }", data, ["E-AXES", "which are parallel"]),
        ("axes = { z = [0, 0, 1], x = [1e-9, 0, 1] }", "", data, ["E-AXES", "foot"]),
        ("axes = { z = [0, 0, 0], x = [1, 0, 0] }", "", usage, ["interface[0].axes.z", "a vector with a direction"]),
        ("axes = \"hole\"", "", usage, ["axes", "set coupling = \"rigid\""]),
        ("", "axes = \"hole\"", data, ["E-ORIGIN-FIT", "its origin or its axes"]),
        ("axes = \"round\"", "", usage, ["axes", "expected"]),
    ] {
        let (place, ended) = reduced(foot, head);
        assert_eq!(ended.code, code, "{foot}{head}: {}{}", ended.out, ended.err);
        words.iter().for_each(|word| assert!(ended.err.contains(word), "{word:?} is not in {}", ended.err));
        assert!(!place.path("x.supel").exists());
    }
    let place = Place::with_brick();
    for (model, nodes, words) in [
        ("dofs = \"dofs.txt\"\n", "[1, 11, 31, 41]", "nodes without coordinates"),
        ("", "{ rows = [0, 1, 2] }", "rows, which have no axes"),
    ] {
        let job = format!(
            "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\n{model}[[interface]]\nname = \"foot\"\nnodes = {nodes}\n\
             axes = {{ z = [0, 0, 1], x = [1, 0, 0] }}\n[reduction]\nmethod = \"herting\"\nmodes = {{ count = 4 }}\n\
             [write]\nsuperelement = \"x.supel\"\n"
        );
        place.write("job.toml", job.as_bytes());
        let ended = supel(&["reduce", &place.text("job.toml")]);
        assert!(ended.code != ExitCode::Done && ended.err.contains(words), "{}", ended.err);
    }
}
