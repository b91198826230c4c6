//! A part that stands elsewhere than the coordinates say, behind springs that hardly feel it, and rows along axes that are hardly off.

use supel::cli::ExitCode;
use supel_models::transform::{in_local_frames, join, translated};
use supel_models::{Assembler, Inertia, Material, Model, Section, brick, frame};

use crate::place::Place;

const PLATE: [f64; 3] = [1.0, 0.4, 0.05];
const ALUMINIUM: Material = Material { young: 7e10, poisson: 0.3, density: 2700.0 };

/// A light plate that carries a heavy block on soft springs between nodes at one place.
fn plate_with_block() -> Model {
    let plate = brick([4, 2, 1], PLATE, &ALUMINIUM);
    let block = translated(&brick([2, 2, 1], [0.5, 0.4, 0.25], &Material::STEEL_SI), [0.25, 0.0, PLATE[2]]);
    let mut whole = join(&plate, &block, &[]);
    let at = |label: i64| whole.nodes[label as usize - 1];
    let row =
        |label: i64, direction: u8| whole.dofs.iter().position(|dof| *dof == (label, direction)).expect("a row") as u32;
    let mut stiffness = Assembler::default();
    stiffness.extend(whole.stiffness.iter().copied());
    let is_there = |a: &i64, b: &i64| at(*a).iter().zip(at(*b)).all(|(x, y)| (x - y).abs() < 1e-9);
    for a in &whole.groups["ZMAX"] {
        let Some(b) = whole.groups["B.ZMIN"].iter().find(|b| is_there(a, b)) else { continue };
        for direction in 0..3 {
            let [i, j] = [*a, *b].map(|label| row(label, direction));
            for (i, j, k) in [(i, i, 1e6), (j, j, 1e6), (i, j, -1e6), (j, i, -1e6)] {
                stiffness.add(i, j, k);
            }
        }
    }
    whole.stiffness = stiffness.finish();
    whole
}

/// A node of a patch is where the coordinates have it, and so are its stiffness and mass, whatever other part stands a thousandth too high. A
/// part that stands a hundredth too high is none of rounding.
#[test]
fn a_part_out_of_place_moves_no_patch() {
    let sound = plate_with_block();
    let reduced = |height: f64| {
        let mut model = sound.clone();
        let n_plate = model.nodes.len() - 18;
        model.nodes[n_plate..].iter_mut().for_each(|x| x[2] += height);
        let place = Place::with(&model);
        let of = |name: &str| sound.groups[name].iter().map(i64::to_string).collect::<Vec<_>>().join(",");
        let flags = format!("--rigid-interface a={} --rigid-interface b={} --method guyan", of("XMIN"), of("XMAX"));
        let ended = place.reduce(&place.model_flags(), &flags);
        (place, ended)
    };
    let (place, ended) = reduced(0.0);
    ended.expect(ExitCode::Done);
    let expected = place.superelement("x.supel");
    let (place, ended) = reduced(1e-3);
    assert!(ended.expect(ExitCode::Done).out.contains("W-COORD-ROUNDED"));
    let found = place.superelement("x.supel");
    // Zero modes of K are known to the rounding of K over the first elastic eigenvalue, some 10⁻⁹ here.
    for (name, [a, b]) in [
        ("stiffness", [&expected.tensors().stiffness, &found.tensors().stiffness]),
        ("mass", [&expected.tensors().mass, &found.tensors().mass]),
    ] {
        for i in 0..a.rows() {
            for j in 0..a.cols() {
                let off = (a[(i, j)] - b[(i, j)]).abs() / (a[(i, i)] * a[(j, j)]).sqrt();
                assert!(off < 1e-8, "{name} {i} {j}: {off:e}");
            }
        }
    }
    for height in [5e-3, 1e-2, 3e-2] {
        let (_, ended) = reduced(height);
        assert_eq!(ended.code, ExitCode::InputData, "{height}: {}", ended.out);
        assert!(ended.err.contains("E-COORD"), "{height}: {}", ended.err);
    }
}

/// A thin rod between stiff ends, its rows along axes that are off by some thousandths: the forces of that are nothing next to those of the
/// ends, and six motions are still without energy. They are no mechanisms.
#[test]
fn rows_of_a_thin_rod_along_turned_axes() {
    let line = |from: f64| -> Vec<[f64; 3]> {
        let node = |k: u32| [from + 0.1 * f64::from(k), 0.02 * f64::from(k * k), 0.01 * f64::from(k)];
        (0..5).map(node).collect()
    };
    let chain: Vec<[usize; 2]> = (1..5).map(|node| [node - 1, node]).collect();
    let beam = |from: f64, diameter: f64| {
        frame(&line(from), &chain, &Section::round(diameter), &Material::STEEL_SI, Inertia::Consistent)
    };
    let up = |model: Model, by: f64| translated(&model, [0.0, by, by / 8.0]);
    let (first, rod) = (beam(0.0, 0.1), up(beam(0.4, 0.004), 0.32));
    let ends = join(&first, &rod, &[(5, 1)]);
    let sound = join(&ends, &up(beam(0.8, 0.1), 0.64), &[(10, 1)]);
    let flags = "--interface a=1 --interface b=15 --method herting --modes 4";
    for angle in [0.0_f64, 1e-5, 1e-4, 1e-3, 3e-3, 8e-3] {
        let (sine, cosine) = angle.sin_cos();
        let axes = [[1.0, 0.0, 0.0], [0.0, cosine, -sine], [0.0, sine, cosine]];
        let place = Place::with(&in_local_frames(&sound, &axes, |label| (7..10).contains(&label)));
        let ended = place.reduce(&place.model_flags(), flags);
        let expected = if angle == 0.0 { ExitCode::Done } else { ExitCode::InputData };
        assert_eq!(ended.code, expected, "{angle}: {}{}", ended.out, ended.err);
        assert!(angle == 0.0 || ended.err.contains("E-COORD"), "{angle}: {}", ended.err);
    }
}
