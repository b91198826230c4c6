//! Components with something that is nothing: a mode of the interface alone, a whole basis, an interface without stiffness, no
//! elastic coordinate at all. Each is reduced, and what was made is verified by itself and against its job.

use supel::cli::ExitCode;
use supel_models::frame::{Inertia, Section, frame};
use supel_models::model::{Assembler, dot, multiply};
use supel_models::random::SplitMix64;
use supel_models::springs::springs;
use supel_models::transform::{in_local_frames, join, rounded, translated};
use supel_models::{Material, Model, brick};

use crate::place::{Place, assert_close, frequencies_hz, supel};

/// Reduces and verifies in both ways; gives what `verify --job` said.
#[track_caller]
fn agree(place: &Place, flags: &[String], rest: &str) -> String {
    place.reduce(flags, rest).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
    let job = supel(&["inspect", &place.text("x.supel"), "--job"]).expect(ExitCode::Done).out;
    place.write("kept.json", job.as_bytes());
    supel(&["verify", &place.text("x.supel"), "--job", &place.text("kept.json")]).expect(ExitCode::Done).out
}

/// How many coordinates a superelement has and how many columns were left out.
fn sizes(place: &Place) -> (usize, usize) {
    let superelement = place.superelement("x.supel");
    (superelement.n_coordinates(), superelement.metadata().dropped.len())
}

#[test]
fn mode_that_lives_in_the_interface_is_left_out() {
    // The softest oscillator is the interface.
    let place = Place::with(&springs(&[1.0; 5], &[(0, 2.0), (1, 4.0), (2, 5.0), (3, 6.0), (4, 3.0)], &[]));
    agree(&place, &place.matrix_flags(), "--interface r=rows:0 --method herting --modes 4");
    assert_eq!(sizes(&place), (1 + 3, 1));
    // Five of one frequency: whichever modes were found, one combination of them is the interface.
    let place = Place::with(&springs(&[1.0; 5], &[0, 1, 2, 3, 4].map(|row| (row, 4.0)), &[]));
    agree(&place, &place.matrix_flags(), "--interface r=rows:0 --method herting --modes 2");
    assert_eq!(sizes(&place), (1 + 4, 1));
    // A second body is interface altogether. λ is 2 − 2 cos(jπ/12) of the first and 2 − 2 cos(jπ/5) of the second: of the four
    // lowest one is the second's.
    let chain = |from: u32, n: u32| (from..from + n - 1).map(|row| (row, row + 1, 1.0));
    let place = Place::with(&springs(&[1.0; 17], &[], &chain(0, 12).chain(chain(12, 5)).collect::<Vec<_>>()));
    let rows = "--interface r=rows:0,11,12,13,14,15,16 --method herting --modes 4";
    agree(&place, &place.matrix_flags(), rows);
    let kept = place.superelement("x.supel").metadata().coordinates.len();
    // Inertia relief of the first body, three of its modes.
    assert_eq!((kept, sizes(&place).1), (7 + 1 + 3, 2));
}

/// Three beams and masses between them: eighteen motions without energy, more than are looked at first, which one by one have the mass of
/// each beam and no space of their own in M.
#[test]
fn bodies_that_only_the_mass_couples_agree() {
    let nodes = |t: usize| [0.0, 0.1, 0.2].map(|x| [x, 0.05 * t as f64, 0.01 * (t * t) as f64]);
    let section = Section { area: 1e-4, second_moment_y: 1e-9, second_moment_z: 2e-9, torsion: 2e-9 };
    let beam = |t| frame(&nodes(t), &[[0, 1], [1, 2]], &section, &Material::STEEL_SI, Inertia::Consistent);
    let beams = join(&join(&beam(0), &beam(1), &[]), &beam(2), &[]);
    for [own, between] in [[1.0, -1.0], [2.0, 1.0]] {
        let mut mass = Assembler::default();
        mass.extend(beams.mass.iter().copied());
        for (first, second) in (0..6).map(|node| (6 * node, 6 * node + 18)) {
            for [i, j] in [0, 1, 2].map(|direction| [first + direction, second + direction]) {
                for (row, column, value) in [(i, i, own), (j, j, own), (i, j, between), (j, i, between)] {
                    mass.add(row, column, 0.02 * value);
                }
            }
        }
        let place = Place::with(&Model { mass: mass.finish(), ..beams.clone() });
        for method in ["herting", "craig-bampton"] {
            let rest = format!("--interface a=1 --interface b=4 --interface c=7 --method {method} --modes 3");
            agree(&place, &place.model_flags(), &rest);
        }
        if cfg!(feature = "arpack") {
            let rest =
                "--interface a=1 --interface b=4 --interface c=7 --method herting --modes 3 --eigensolver arpack";
            agree(&place, &place.model_flags(), rest);
        }
    }
}

/// Without coordinates the zero modes are looked for as any others, six at first, and what follows them may be one more: that is no frequency to
/// put a shift next to, which would be factored in vain.
#[test]
fn more_free_bodies_than_modes_are_looked_for() {
    let nodes = [0.0, 1.0, 2.0].map(|t| [0.1 * t, 0.02 * t * t, 0.0]);
    let section = Section { area: 1e-4, second_moment_y: 1e-9, second_moment_z: 2e-9, torsion: 2e-9 };
    let beam = |stiffer: f64, heavier: f64| {
        let Material { young, density, .. } = Material::STEEL_SI;
        let material = Material { young: stiffer * young, density: heavier * density, ..Material::STEEL_SI };
        frame(&nodes, &[[0, 1], [1, 2]], &section, &material, Inertia::Consistent)
    };
    let place = Place::with(&join(&join(&beam(1e4, 1e4), &beam(1.0, 1.0), &[]), &beam(1.0, 1e4), &[]));
    let rows: Vec<String> =
        [0, 18, 36].into_iter().flat_map(|first| first..first + 6).map(|row| row.to_string()).collect();
    for method in ["herting", "craig-bampton"] {
        let rest = format!("--interface a=rows:{} --method {method} --modes 3", rows.join(","));
        let ended = place.reduce(&place.matrix_flags(), &rest).expect(ExitCode::Done);
        assert!(ended.out.contains("work              4 factorisations"), "{method}: {}", ended.out);
    }
}

/// An L of beams, `n` along and `n` up, with consistent mass.
fn long_frame(n: usize, radius: f64) -> Model {
    let along = (0..=n).map(|i| [0.1 * i as f64, 0.0, 0.0]);
    let up = (1..=n).map(|i| [0.1 * n as f64, 0.1 * i as f64, 0.02 * i as f64]);
    let nodes: Vec<[f64; 3]> = along.chain(up).collect();
    let edges: Vec<[usize; 2]> = (1..nodes.len()).map(|i| [i - 1, i]).collect();
    frame(&nodes, &edges, &Section::round(radius), &Material::STEEL_SI, Inertia::Consistent)
}

/// A long part that two nodes or patches next to each other hold: the correction of rigid-body motion (24) puts rounding of some columns
/// into others, times the length of the part over their distance.
#[test]
fn long_part_on_a_short_interface() {
    for (n, radius) in [(6, 0.003), (6, 0.01), (20, 0.01)] {
        let place = Place::with(&long_frame(n, radius));
        for method in ["herting", "rubin", "macneal", "craig-bampton"] {
            let rest = format!("--interface a={},{} --method {method} --modes 3", 2 * n, 2 * n + 1);
            let said = agree(&place, &place.model_flags(), &rest);
            assert!(!said.contains("! warn"), "{method}, {n} beams, radius {radius}: {said}");
        }
    }
    let bar = brick([20, 1, 1], [1.0, 0.02, 0.02], &Material::STEEL_SI);
    let patch = |x: usize| (0..4).map(|row| (21 * row + x + 1).to_string()).collect::<Vec<_>>().join(",");
    let place = Place::with(&bar);
    for method in ["herting", "craig-bampton"] {
        let [a, b] = [patch(0), patch(1)];
        let rest = format!("--rigid-interface a={a} --rigid-interface b={b} --method {method} --modes 3");
        let said = agree(&place, &place.model_flags(), &rest);
        assert!(!said.contains("! warn"), "{method}: {said}");
    }
}

/// A bar a thousand times as long as its one interface is wide: M̂ holds its mass on levers of that length, and mass properties and loads of
/// gravity are what is left of a million times larger terms.
#[test]
fn long_bars_on_one_end() {
    let place = Place::with(&brick([100, 1, 1], [10.0, 0.01, 0.01], &Material::STEEL_SI));
    for method in ["herting", "craig-bampton"] {
        let said =
            agree(&place, &place.model_flags(), &format!("--interface a=1,102,203,304 --method {method} --modes 3"));
        assert!(!said.contains("! warn"), "{method}: {said}");
    }
}

/// An interface of more dofs than verification solves one by one: random mixtures of them put the correction of rigid-body motion (24) into
/// other columns than the reduction does, and K of five digits makes it large.
#[test]
fn correction_of_few_digits_on_a_large_interface() {
    let mut model = brick([10, 2, 2], [1.0, 0.2, 0.2], &Material::STEEL_SI);
    for (_, _, value) in &mut model.stiffness {
        *value = format!("{value:.4e}").parse().expect("a number");
    }
    let place = Place::with(&model);
    let labels: Vec<String> = (2..=89).map(|label| label.to_string()).collect();
    let rest = format!("--interface most={} --method herting --modes 3", labels.join(","));
    agree(&place, &place.model_flags(), &rest);
}

/// The last node but one of a frame carries all before it, and nothing inside follows the last one: M̂_BB is known. With solves of κ(K_II)ε
/// = 2e-7 the columns of the last node but one may be that far off, and those of the last one are exact.
#[test]
fn correction_leaves_exact_columns_alone() {
    let n = 20;
    let model = long_frame(n, 0.01);
    let place = Place::with(&model);
    let (held, last) = (2 * n as i64, 2 * n as i64 + 1);
    let rest = format!("--interface a={held},{last} --method craig-bampton --modes 1");
    place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
    let about = translated(&model, model.nodes[held as usize - 1].map(|x| -x)).rigid_body_modes();
    let column = |(node, direction): (i64, u8)| -> Vec<f64> {
        let moved = |(row, dof): (usize, &(i64, u8))| match node == last || dof.0 == last {
            true => f64::from(u8::from(*dof == (node, direction))),
            false => about[usize::from(direction)][row],
        };
        model.dofs.iter().enumerate().map(moved).collect()
    };
    let columns: Vec<Vec<f64>> =
        [held, last].into_iter().flat_map(|node| (0..6).map(move |direction| (node, direction))).map(column).collect();
    let expected = |i: usize, j: usize| dot(&columns[i], &multiply(&model.mass, &columns[j]));
    let mass = place.superelement("x.supel").tensors().mass.clone();
    for j in 0..12 {
        for i in 0..=j {
            let size = (expected(i, i) * expected(j, j)).sqrt();
            let error = (mass[(i, j)] - expected(i, j)).abs() / size;
            assert!(error < 2e-7, "entry {i}, {j}: off by {error:e}");
        }
    }
}

/// The smallest share of its length that a named column keeps without those before it. Stored columns are orthonormal, and named ones are
/// they by the inverse R of the mixing T, a triangle: |R_jj| / ‖R e_j‖.
fn least_share(place: &Place) -> f64 {
    let superelement = place.superelement("x.supel");
    let mixing = superelement.tensors().mixing.as_ref().expect("mixing");
    let share = |j: usize| {
        let mut column = vec![0.0; j + 1];
        for i in (0..=j).rev() {
            let below: f64 = (i + 1..=j).map(|k| mixing[(i, k)] * column[k]).sum();
            column[i] = (f64::from(u8::from(i == j)) - below) / mixing[(i, i)];
        }
        column[j].abs() / dot(&column, &column).sqrt()
    };
    (0..mixing.cols()).map(share).fold(1.0, f64::min)
}

/// All modes of a bar of square section: pairs of one frequency, and interfaces that leave fewer dofs than there are modes. Of a block
/// columns are left out that keep 3·10⁻⁵ of their length, since others span the interior more clearly.
#[test]
fn whole_basis_is_verified_whatever_was_left_out() {
    let bar = Place::with(&brick([4, 2, 2], [0.2, 0.06, 0.06], &Material::STEEL_SI));
    let block = Place::with(&brick([2, 2, 1], [0.2, 0.07, 0.05], &Material::STEEL_SI));
    let job = |[a, b]: [&str; 2]| {
        format!(
            "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n\
             [[interface]]\nname = \"a\"\n{a}\n[[interface]]\nname = \"b\"\n{b}\n\
             [reduction]\nmethod = \"herting\"\nmodes = {{ up_to_hz = 1e9 }}\n[write]\nsuperelement = \"x.supel\"\n"
        )
    };
    let two_rotations = "nodes = [5, 10, 15, 20, 25, 30, 35, 40, 45]\ncoupling = \"rigid\"\ndofs = [\"rx\", \"ry\"]\n\
                         origin = [-0.428182, 0.880638, -0.736914]";
    let few_directions = "nodes = [10, 5, 20, 45, 25, 40]\ncoupling = \"direct\"\ndofs = [\"uz\", \"uy\"]";
    let end = "nodes = [1, 6, 11, 16, 21, 26, 31, 36, 41]\ncoupling = \"rigid\"";
    let scattered =
        ["nodes = [10, 11, 2, 15, 14]\ncoupling = \"direct\"", "nodes = [4, 9, 1, 17]\ncoupling = \"rigid\""];
    for (place, interfaces, n) in [
        (&bar, [end, two_rotations], 135 - 54 + 12),
        (&bar, [end, few_directions], 135 - 27 + 6),
        (&block, scattered, 54 - 12 + 6),
    ] {
        place.write("job.toml", job(interfaces).as_bytes());
        let path = place.text("job.toml");
        supel(&["reduce", &path]).expect(ExitCode::Done);
        assert_eq!(sizes(place).0, n, "as many coordinates as the model has dofs");
        // The first limit of columns that are clearly independent, which leaves enough of them in each.
        let least = least_share(place);
        assert!(least > 1e-4, "a column keeps {least:e} of its length");
        supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
        supel(&["verify", &place.text("x.supel"), "--job", &path]).expect(ExitCode::Done);
    }
}

/// All modes of short chains that an end holds: with the columns of the interface there is one more than there are dofs, and rounding of it
/// is no coordinate.
#[test]
fn no_more_coordinates_than_dofs() {
    for seed in 0..24 {
        let mut random = SplitMix64::new(seed);
        let n = 3 + seed as usize % 4;
        let masses: Vec<f64> = (0..n).map(|_| 10f64.powf(3.0 * random.uniform() - 1.0)).collect();
        let between: Vec<(u32, u32, f64)> =
            (1..n as u32).map(|row| (row - 1, row, 10f64.powf(3.0 + 4.0 * random.uniform()))).collect();
        let place = Place::with(&springs(&masses, &[(0, 1e5)], &between));
        let rest = format!("--interface end=rows:{} --method herting --modes {n}", n - 1);
        agree(&place, &place.matrix_flags(), &rest);
        assert!(sizes(&place).0 <= n, "{seed}: {:?} of {n}", sizes(&place));
    }
}

#[test]
fn interface_with_mass_and_no_stiffness_agrees() {
    let chain: Vec<_> = (0..11).map(|row| (row, row + 1, 1.0)).collect();
    let place = Place::with(&springs(&[1.0; 13], &[], &chain));
    for method in ["herting", "craig-bampton"] {
        let rest = format!("--interface ends=rows:0,11 --interface free=rows:12 --method {method} --modes 3");
        agree(&place, &place.matrix_flags(), &rest);
    }
}

#[test]
fn rigid_body_motion_alone_is_a_superelement() {
    let place = Place::with_brick();
    for flags in [place.model_flags(), place.matrix_flags()] {
        for method in ["herting", "craig-bampton"] {
            agree(&place, &flags, &format!("--method {method} --modes 0"));
            assert_eq!(sizes(&place), (6, 0));
        }
    }
}

/// Two bending modes 7·10⁻⁶ apart, of which one is asked for: there are shifts between them.
#[test]
fn count_between_two_near_frequencies() {
    let nodes: Vec<[f64; 3]> = (0..13).map(|i| [f64::from(i) / 12.0, 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (0..12).map(|i| [i, i + 1]).collect();
    let round = Section::round(0.01);
    let section = Section { second_moment_z: round.second_moment_y * (1.0 + 7e-6), ..round };
    let place = Place::with(&frame(&nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent));
    let rest = "--interface a=1 --interface b=13 --method herting --modes 1";
    agree(&place, &place.model_flags(), rest);
    // Both ends and inertia relief: the pair is no cluster.
    assert_eq!(sizes(&place), (12 + 6 + 1, 0));
}

/// Light oscillators whose frequencies are near and no cluster: their accelerated columns keep 10⁻⁴ to 10⁻⁵ of their length, and the
/// amplitudes of a mode are known to what the inverse of that mixing leaves.
#[test]
fn modes_of_short_columns_are_judged_by_what_the_mixing_leaves() {
    for (n, within, stiffness, count) in
        [(6u32, 2e-6, 1e-3, 9), (12, 2e-6, 1e-3, 15), (8, 5e-6, 1e-4, 13), (8, 2e-5, 1e-3, 13)]
    {
        let mut between: Vec<(u32, u32, f64)> = (0..n - 1).map(|row| (row, row + 1, 1.0)).collect();
        between.extend((0..n).map(|at| (at, n + at, stiffness * (1.0 + within * f64::from(at)))));
        let masses: Vec<f64> = (0..2 * n).map(|row| if row < n { 1.0 } else { 1e-6 }).collect();
        let place = Place::with(&springs(&masses, &[], &between));
        agree(&place, &place.matrix_flags(), &format!("--interface r=rows:0 --method herting --modes {count}"));
    }
}

/// Forty oscillators that are one cluster, which ARPACK does not find its way out of.
#[test]
fn cluster_that_the_other_eigensolver_fails_on_is_verified_by_the_same() {
    let between: Vec<_> = (0..39).map(|row| (row, row + 1, 1e-3)).collect();
    let grounded: Vec<_> = (0..40).map(|row| (row, 1e6)).collect();
    let place = Place::with(&springs(&[1.0; 40], &grounded, &between));
    let told = agree(&place, &place.matrix_flags(), "--interface r=rows:0 --method herting --modes 3");
    if cfg!(feature = "arpack") {
        assert!(told.contains("the modes were found again"), "{told}");
    }
    assert!(told.contains("modes of one cluster may turn without the interface seeing it"), "{told}");
}

/// Forty light oscillators far above a bar, each on a mass of its own: chains of eight neighbours a share of λ apart. A search meets the
/// end of its space inside of them, and estimates of an iteration decide differently on where a cluster ends than quotients do.
#[test]
fn chains_of_near_frequencies_far_above_the_others_are_counted_alike() {
    const N: u32 = 40;
    for (within, rest) in [
        (3e-7, "--method craig-bampton --modes 44"),
        (1e-9, "--method craig-bampton --modes 44"),
        (3e-7, "--method herting --modes 45"),
    ] {
        let mut between: Vec<(u32, u32, f64)> = (0..N - 1).map(|row| (row, row + 1, 1.0)).collect();
        let mut above = 0.0;
        for at in 0..N {
            between.push((at, N + at, 0.1 * (1.0 + above)));
            above += if at % 8 == 7 { 3e-6 } else { within };
        }
        let masses: Vec<f64> = (0..2 * N).map(|row| if row < N { 1.0 } else { 1e-6 }).collect();
        let place = Place::with(&springs(&masses, &[(0, 1.0)], &between));
        agree(&place, &place.matrix_flags(), &format!("--interface r=rows:0 {rest}"));
        // Held, the bar has 39 modes and the first oscillator, whose mass is held, comes with the other seven of its chain. Free, the
        // bar has forty; the first chain is the next eight.
        let superelement = place.superelement("x.supel");
        let n_modes = superelement.tensors().frequencies.len();
        let expected = if rest.contains("herting") { 40 + 8 } else { 39 + 8 };
        assert_eq!(n_modes, expected, "{within:e}, {rest}");
    }
}

/// A job by its text, reduced and verified in both ways.
#[track_caller]
pub(super) fn agree_by_job(model: &Model, of_reduction: &str) -> Place {
    let place = Place::with(model);
    let files = "model = { stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }";
    let job = format!("{files}\nwrite = {{ superelement = \"x.supel\" }}\n{of_reduction}\n");
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    place
}

const ALONG_X: [f64; 3] = [1.0, 0.0, 0.0];

/// A straight beam of so many elements whose masses are lumped, without inertia of rotations.
fn straight_beam(n: i32, axis: [f64; 3]) -> Model {
    let nodes: Vec<[f64; 3]> = (0..=n).map(|i| axis.map(|cosine| 0.1 * f64::from(i) * cosine)).collect();
    let edges: Vec<[usize; 2]> = (0..n as usize).map(|i| [i, i + 1]).collect();
    frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::LumpedTranslations)
}

/// A straight beam of lumped masses turns about its axis without energy and without inertia, whatever its direction is and how many elements it
/// has: what rounding leaves of that inertia is none for the file as for the model.
#[test]
fn straight_beams_of_lumped_masses_agree() {
    for (n, axis) in [1, 2, 10].into_iter().flat_map(|n| [(n, ALONG_X), (n, [0.6, 0.64, 0.48])]) {
        let model = straight_beam(n, axis);
        for method in ["guyan", "craig-bampton --modes 3"] {
            let place = Place::with(&model);
            let ends = format!("--interface a=1 --interface b={}", n + 1);
            agree(&place, &place.model_flags(), &format!("{ends} --method {method}"));
        }
    }
}

/// One end holds such a beam, and about its axis neither the stiffness nor the inertia has more than rounding: no unit, in which rounding would
/// be a force as large as any.
#[test]
fn straight_beams_of_lumped_masses_agree_where_one_end_holds_them() {
    // How much rounding leaves of the inertia depends on the number of elements and on the end: of all but six, something.
    for n in [3, 4, 6, 7, 19] {
        let place = Place::with(&straight_beam(n, ALONG_X));
        for end in [1, n + 1] {
            for method in ["guyan", "guyan --inertia-relief", "craig-bampton --modes 4"] {
                agree(&place, &place.model_flags(), &format!("--interface a={end} --method {method}"));
            }
        }
    }
}

/// Rotations without inertia of a frame that is not straight: M̂ is singular, and what rounding squared leaves on its diagonal is no unit of
/// anything.
#[test]
fn a_frame_of_lumped_masses_agrees() {
    let nodes = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 0.8],
        [1.0, 0.0, 0.8],
        [1.0, 1.0, 0.8],
        [0.0, 1.0, 0.8],
        [0.5, 0.5, 0.9],
        [0.5, 0.52, 1.2],
    ];
    let edges: Vec<[usize; 2]> = (0..4)
        .flat_map(|i| [[i, (i + 1) % 4], [i, i + 4], [i + 4, (i + 1) % 4 + 4], [i + 4, 8]])
        .chain([[8, 9]])
        .collect();
    let model = frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::LumpedTranslations);
    let place = Place::with(&model);
    let feet = "--interface a=1 --interface b=2 --interface c=3 --interface d=4 --interface e=5 --interface f=6";
    agree(&place, &place.model_flags(), &format!("{feet} --method guyan"));
}

/// The mean motion of all nodes moves the component as a whole: nothing of its stiffness is left there but rounding, which is no size.
#[test]
fn an_average_over_all_nodes_agrees() {
    let zigzag: Vec<[f64; 3]> =
        (0..8).map(|i| [0.12 * f64::from(i), 0.03 * f64::from(i % 3), 0.05 * f64::from(i % 2)]).collect();
    let edges: Vec<[usize; 2]> = (0..7).map(|i| [i, i + 1]).collect();
    let chain = frame(&zigzag, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
    let all = "[1, 2, 3, 4, 5, 6, 7, 8]";
    for method in ["craig-bampton", "herting"] {
        let interface = format!("interface = [{{ name = \"mean\", nodes = {all}, coupling = \"average\" }}]");
        let reduction = format!("reduction = {{ method = \"{method}\", modes = {{ count = 3 }} }}");
        agree_by_job(&chain, &format!("{interface}\n{reduction}"));
    }
}

/// Of seven elements not even rounding is left about the axis, neither of the stiffness nor of the inertia: what moves there is compared all
/// the same.
#[test]
fn a_straight_beam_of_which_nothing_is_left_about_its_axis_agrees() {
    let place = Place::with(&straight_beam(7, ALONG_X));
    for method in ["guyan --inertia-relief", "craig-bampton --modes 3"] {
        agree(&place, &place.model_flags(), &format!("--interface a=1 --method {method}"));
    }
}

/// One layer between a rigid face and one whose mean motion weighs its nodes as their mass does: translations, and on few cells rotations, load
/// the interface alone. What rounding leaves of their load deflects the interior by nothing that a column would have to answer.
#[test]
fn accelerations_that_rest_on_the_interface_deflect_nothing() {
    for [nx, ny] in [[2, 2], [4, 3]] {
        let model = brick([nx, ny, 1], [0.05 * nx as f64, 0.04 * ny as f64, 0.01], &Material::STEEL_SI);
        // The share of a node in the area: one for each of its faces.
        let faces = |at: usize, n: usize| if at == 0 || at == n { 1 } else { 2 };
        let weights: Vec<usize> = (0..=ny).flat_map(|j| (0..=nx).map(move |i| faces(i, nx) * faces(j, ny))).collect();
        let interface = format!(
            "interface = [{{ name = \"in\", nodes = {:?}, coupling = \"rigid\" }}, \
             {{ name = \"out\", nodes = {:?}, coupling = \"average\", weights = {weights:?} }}]",
            model.groups["ZMIN"], model.groups["ZMAX"]
        );
        for method in ["\"herting\"", "\"macneal\"", "\"craig-bampton\", inertia_relief = true"] {
            let reduction = format!("reduction = {{ method = {method}, modes = {{ count = 3 }} }}");
            let place = agree_by_job(&model, &format!("{interface}\n{reduction}"));
            let n_dropped = place.superelement("x.supel").metadata().dropped.len();
            assert!(n_dropped >= 3, "{method}: {n_dropped} left out");
            let (value, verdict) = checked(&place, "deflection under unit accelerations");
            assert!(value < 1e-9 && verdict == "pass", "{method}: {value} {verdict}");
        }
    }
}

/// An interface that a unit translation leaves at rest: the amplitude of that motion has no stiffness, and its rounding is no size.
#[test]
fn rubin_where_the_interface_leaves_a_translation_alone_agrees() {
    let model = brick([2, 1, 1], [0.2, 0.1, 0.1], &Material::STEEL_SI);
    for (nodes, dofs) in [("[1]", "[\"ux\", \"uy\"]"), ("[1]", "[\"uy\"]"), ("[1, 5, 9]", "[\"uy\"]")] {
        let interface = format!("interface = [{{ name = \"i\", nodes = {nodes}, dofs = {dofs} }}]");
        agree_by_job(&model, &format!("{interface}\nreduction = {{ method = \"rubin\", modes = {{ count = 4 }} }}"));
    }
}

/// Few digits leave forces of rigid-body motion that no solve takes out, and next to a heavy mass as much of the flexibility open as they leave
/// of its energy.
#[test]
fn rubin_by_few_digits_agrees() {
    let block = brick([4, 1, 1], [1.0, 0.2, 0.15], &Material::STEEL_SI);
    let cases = (0..24)
        .map(|k| (0.3 + 0.37 * f64::from(k), [7, 6, 7, 8][k as usize % 4], [4000.0, 0.0, 400.0][k as usize % 3]));
    for (angle, digits, heavy) in cases {
        let (s, c) = f64::sin_cos(angle);
        // About z, and then by a third of a turn about the diagonal.
        let axes = [[0.0, 0.0, 1.0], [c, s, 0.0], [-s, c, 0.0]];
        let turned = in_local_frames(&block, &axes, |_| true);
        let nodes = block.nodes.iter().map(|x| axes.map(|axis| dot(&axis, x))).collect();
        let model = rounded(&Model { nodes, ..turned }, digits);
        let added = if heavy > 0.0 { format!("added_mass = [{{ node = 14, mass = {heavy} }}]") } else { String::new() };
        let job =
            "interface = [{ name = \"i\", nodes = [20] }]\nreduction = { method = \"rubin\", modes = { count = 4 } }";
        agree_by_job(&model, &format!("{added}\n{job}"));
    }
}

/// A mode of heavy interface nodes is the static answer to their inertia: what it has besides is small, and known to few digits.
#[test]
fn rubin_with_a_mode_of_heavy_interface_nodes_agrees() {
    let block = brick([6, 2, 2], [1.2, 0.55, 0.31], &Material::STEEL_SI);
    for mass in [3e4, 5e4] {
        let added = [1, 63].map(|node| format!("{{ node = {node}, mass = {mass} }}")).join(", ");
        let interface = "interface = [{ name = \"i\", nodes = [1, 63] }]";
        let reduction = "reduction = { method = \"rubin\", modes = { count = 4 } }";
        let place = agree_by_job(&block, &format!("added_mass = [{added}]\n{interface}\n{reduction}"));
        let ended = supel(&["verify", &place.text("x.supel"), "--json"]).expect(ExitCode::Done);
        let audit: serde_json::Value = serde_json::from_str(&ended.out).expect("JSON");
        assert_eq!(audit["verdict"], "pass", "{mass}: {}", ended.out);
    }
}

/// Two nodes at one place and what joins them, without stiffness about z.
fn joint_about_z() -> Model {
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for (row, value) in (0u32..).zip([1e6, 1e6, 3e6, 1e3, 1e3, 0.0]) {
        stiffness.extend([(row, row, value), (row, row + 6, -value), (row + 6, row + 6, value)]);
    }
    let masses = [2.0, 2.0, 2.0, 0.01, 0.01, 0.01, 5.0, 5.0, 5.0, 0.02, 0.02, 0.03];
    mass.extend((0u32..).zip(masses).map(|(row, mass)| (row, row, mass)));
    Model::node_major(vec![[0.0; 3]; 2], &[0, 1, 2, 3, 4, 5], stiffness, mass)
}

/// The value and the verdict of a check.
fn checked(place: &Place, name: &str) -> (f64, String) {
    let report = place.report("x.report.json");
    let checks = report["body"]["checks"].as_array().expect("checks").clone();
    let check = checks.into_iter().find(|check| check["name"] == name).expect("a check");
    (check["value"].as_f64().expect("a value"), check["verdict"].as_str().expect("a verdict").to_owned())
}

/// A joint that is free about its axis has rows without stiffness, or with that of a thin shaft alone: what turns there is no force, and
/// the rounding of rows that rest is none either.
#[test]
fn what_is_free_about_an_axis_makes_no_force_there() {
    let section = Section { area: 1e-4, second_moment_y: 2e-9, second_moment_z: 1e-9, torsion: 3e-9 };
    let nodes = [[0.0; 3], [0.0, 0.0, 0.5]];
    let shaft = frame(&nodes, &[[0, 1]], &section, &Material::STEEL_SI, Inertia::Consistent);
    for (model, end) in [(joint_about_z(), 2), (join(&joint_about_z(), &shaft, &[(2, 1)]), 4)] {
        let place = Place::with(&model);
        for method in ["guyan", "herting --modes 3", "craig-bampton --modes 3"] {
            let rest = format!("--interface a=1 --interface b={end} --method {method}");
            let said = agree(&place, &place.model_flags(), &rest);
            assert!(!said.contains("! warn"), "{said}");
            let (value, verdict) = checked(&place, "rigid-body motion makes no force");
            // K R is zero to the last bit of what is summed.
            assert!(value < 1e-15 && verdict == "pass", "{method}, {end}: {value} {verdict}");
        }
    }
}

/// Patches that have all nodes and whose origins were fitted to one point: what rounding left between the two is no length of the body.
#[test]
fn patches_about_one_point_but_for_rounding_agree() {
    let model = brick([1, 2, 2], [0.1, 0.06, 0.05], &Material::STEEL_SI);
    let place = Place::with(&model);
    let mut of_one_point = Vec::new();
    for apart in [0.0, 1e-30, 1e-19, 1e-18, 1e-16] {
        for method in ["herting", "craig-bampton"] {
            let patch = |name: &str, group: &str, y: f64| {
                format!(
                    "{{ name = \"{name}\", nodes = {:?}, coupling = \"rigid\", origin = [0.05, {y:e}, 0.03] }}",
                    model.groups[group]
                )
            };
            let text = format!(
                "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
                 interface = [{}, {}]\n\
                 reduction = {{ method = \"{method}\", modes = {{ up_to_hz = 1e5 }} }}\n\
                 write = {{ superelement = \"x.supel\" }}\n",
                patch("a", "XMIN", 0.0),
                patch("b", "XMAX", apart)
            );
            place.write("job.toml", text.as_bytes());
            supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
            supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
            supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
            let found = frequencies_hz(&place.superelement("x.supel"));
            match apart {
                0.0 => of_one_point.push(found),
                _ => assert_close(&found, &of_one_point[usize::from(method != "herting")], 1e-9),
            }
        }
    }
}
