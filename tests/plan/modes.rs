//! K-11 to K-14: how many modes are kept, and which accelerations have a column.

use supel_runtime::Coordinate;

use crate::{CRAIG_BAMPTON, Case, HERTING, PATCHES, part};

/// The band decides where the job names no number: as if the job had asked for twice its end, or four times with the interface held.
#[test]
fn the_band_decides_how_many_modes_are_kept() {
    for (method, of_band, asked) in [
        ("method = \"herting\"", "band_hz = [0, 1500]", "method = \"herting\", modes = { up_to_hz = 3000 }"),
        (
            "method = \"craig-bampton\"",
            "band_hz = [0, 1500]",
            "method = \"craig-bampton\", modes = { up_to_hz = 6000 }",
        ),
    ] {
        let chosen = Case::new(PATCHES, method, of_band).made();
        let by_hand = Case::new(PATCHES, asked, of_band).made();
        assert_eq!(chosen.file.tensors(), by_hand.file.tensors(), "{method}");
        assert!(!chosen.file.tensors().frequencies.is_empty());
        for id in ["M-06", "M-20", "M-24"] {
            assert!(chosen.checks().contains(&id), "{method}: {id}");
        }
        // A larger cut-off leaves every mode of the smaller one as it is.
        let more = Box::leak(asked.replace("000 }", "500 }").into_boxed_str());
        let more = Case::new(PATCHES, more, of_band).made();
        let [few, many] = [&chosen, &more].map(|made| &made.file.tensors().frequencies);
        assert!(few.iter().zip(many).all(|(a, b)| (a / b - 1.0).abs() < 1e-9), "{method}");
    }
}

fn relief(made: &crate::Made) -> Vec<usize> {
    let of = |coordinate: &Coordinate| match coordinate {
        Coordinate::InertiaRelief { index } => Some(*index),
        _ => None,
    };
    made.file.metadata().named_columns().filter_map(of).collect()
}

const RELIEVED: &str = "method = \"craig-bampton\", modes = { count = 6 }, inertia_relief = true";

/// Without gravity there is no inertia relief, and what is left has every bit of what it had; Herting's method has it in any case.
#[test]
fn inertia_relief_without_gravity() {
    let none = Case::new(PATCHES, RELIEVED, "gravity = false").made();
    let all = Case::new(PATCHES, RELIEVED, "gravity = false").made_with(&["--no-skip"]);
    let plain = Case::new(PATCHES, CRAIG_BAMPTON, "").made();
    assert_eq!((relief(&none), relief(&all).len()), (vec![], 6));
    assert_eq!(none.file.tensors(), plain.file.tensors());
    let interface: Vec<usize> = (0..12).collect();
    for (a, b) in [(none.stiffness(), all.stiffness()), (none.mass(), all.mass())] {
        assert_eq!(part(&a, &interface, &interface), part(&b, &interface, &interface));
    }
    assert_eq!(none.file.tensors().frequencies, all.file.tensors().frequencies);
    assert_eq!(none.file.tensors().gravity, plain.file.tensors().gravity);
    assert!(none.assumptions()[0].contains("neither gravity"), "{:?}", none.assumptions());
    assert!(none.checks().contains(&"M-18"), "what is lacking is shown");
    assert_eq!(all.work("n_solves") - none.work("n_solves"), 6);
    assert_eq!(none.file.metadata().validity.gravity, Some([0.0; 3]));
    let herting = Case::new(PATCHES, HERTING, "gravity = false").made();
    assert_eq!(herting.file.metadata().validity.gravity, None, "it has what gravity needs");
    assert_eq!((relief(&herting).len(), herting.assumptions().len()), (6, 0));
}

/// Gravity along one axis has the column of that translation alone, and deflects the component exactly.
#[test]
fn inertia_relief_along_gravity() {
    for (scene, axes) in [
        ("gravity = [0, 0, -2]", vec![2]),
        ("gravity = [1, 0, 1]", vec![0, 2]),
        ("gravity = true", vec![0, 1, 2, 3, 4, 5]),
    ] {
        let some = Case::new(PATCHES, RELIEVED, scene).made();
        assert_eq!(relief(&some), axes, "{scene}");
        let interface: Vec<usize> = (0..12).collect();
        let all = Case::new(PATCHES, RELIEVED, scene).made_with(&["--no-skip"]);
        for (a, b) in [(some.stiffness(), all.stiffness()), (some.mass(), all.mass())] {
            assert_eq!(part(&a, &interface, &interface), part(&b, &interface, &interface), "{scene}");
        }
        // The column is the one that every acceleration has.
        let mixing = |made: &crate::Made| made.file.tensors().mixing.clone().expect("mixing");
        if axes == [0, 2] {
            assert_eq!(mixing(&some)[(0, 0)].to_bits(), mixing(&all)[(0, 0)].to_bits(), "{scene}");
        }
        assert_eq!(all.work("n_solves") - some.work("n_solves"), 6 - axes.len() as u64, "{scene}");
    }
}
