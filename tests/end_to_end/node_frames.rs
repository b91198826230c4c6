//! Nodes whose rows are along axes of their own: everything that has rows is turned, and the superelement is that of the model as it is
//! along the axes of the model.

use supel::cli::ExitCode;
use supel_models::transform::{in_local_frames, rounded};
use supel_models::{Inertia, Material, Model, Section, brick, frame};
use supel_runtime::{Matrix, Superelement};
use supel_testing::schema::{assert_follows, validator};

use crate::place::{Ended, Place, steel_brick, supel};

type Axes = [[f64; 3]; 3];
/// Row, column and value.
type Entry = (u32, u32, f64);

const ALONG_THE_MODEL: Axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// x along (2, 2, 1) and y along (-2, 1, 2).
const ASKEW: Axes = {
    let (a, b) = (2.0 / 3.0, 1.0 / 3.0);
    [[a, a, b], [-a, b, a], [b, -a, a]]
};

/// Rows of some nodes along axes of their own.
struct Turned {
    sound: Model,
    nodes: Vec<i64>,
}

impl Turned {
    fn is_turned(&self, node: i64) -> bool {
        self.nodes.contains(&node)
    }

    fn model(&self) -> Model {
        in_local_frames(&self.sound, &ASKEW, |node| self.is_turned(node))
    }

    /// A column of the model along the rows of the files.
    fn column(&self, column: &[f64]) -> Vec<f64> {
        let row_of = |dof| self.sound.dofs.iter().position(|other| *other == dof).expect("a row");
        let along = |(node, direction): &(i64, u8)| {
            let axes = if self.is_turned(*node) { ASKEW } else { ALONG_THE_MODEL };
            let first = direction - direction % 3;
            (0..3u8)
                .map(|axis| axes[usize::from(direction % 3)][usize::from(axis)] * column[row_of((*node, first + axis))])
                .sum()
        };
        self.sound.dofs.iter().map(along).collect()
    }

    fn table(&self) -> String {
        let row = |node: &i64| format!("{node},{},{},{},{},{},{}\n", 2, 2, 1, -2, 1, 2);
        "node,x1,x2,x3,y1,y2,y3\n".to_owned() + &self.nodes.iter().map(row).collect::<String>()
    }
}

/// A frame of beams that is not in one plane, six rows a node.
fn beams() -> Model {
    let nodes = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [1.4, 0.9, 0.2], [0.6, 1.2, 0.9], [0.1, 0.5, 1.3], [0.8, 0.3, 1.0]];
    let edges = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 1], [0, 3]];
    frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent)
}

fn array(n_rows: usize, columns: &[Vec<f64>]) -> String {
    let values: String = columns.iter().flatten().map(|value| format!("{value:e}\n")).collect();
    format!("%%MatrixMarket matrix array real general\n{n_rows} {}\n{values}", columns.len())
}

/// A row of as many columns as the values.
fn row(values: &[f64]) -> String {
    array(1, &values.iter().map(|value| vec![*value]).collect::<Vec<_>>())
}

fn general(n: usize, entries: &[Entry]) -> String {
    let lines: String = entries.iter().map(|(i, j, value)| format!("{} {} {value:e}\n", i + 1, j + 1)).collect();
    format!("%%MatrixMarket matrix coordinate real general\n{n} {n} {}\n{lines}", entries.len())
}

/// Writes the columns of a model: a load, constraints, quantities and a gyroscopic matrix.
fn with_columns(place: &Place, model: &Model, column: impl Fn(&[f64]) -> Vec<f64>, skew: &[Entry]) {
    let n = model.n;
    let numbered = |phase: f64| column(&(0..n).map(|row| (1.3 * row as f64 + phase).sin()).collect::<Vec<f64>>());
    place.write("load.mtx", array(n, &[numbered(0.2)]).as_bytes());
    // Two nodes move alike in one direction across all axes.
    let tie: Vec<f64> = model
        .dofs
        .iter()
        .map(|dof| {
            [1.0, -2.0, 0.5][usize::from(dof.1 % 3)]
                * f64::from((dof.0 == 3) as i8 - (dof.0 == 4) as i8)
                * f64::from(dof.1 < 3)
        })
        .collect();
    place.write("ties.mtx", row(&column(&tie)).as_bytes());
    place.write("stress.mtx", row(&numbered(0.9)).as_bytes());
    place.write("names.csv", b"name,unit\na,MPa\n");
    place.write("gyro.mtx", general(n, skew).as_bytes());
}

const JOB: &str = r#"
interface = [{ name = "hub", nodes = [1] }, { name = "tip", nodes = [3, 6] }]
load = [{ name = "f", file = "load.mtx" }]
matrix = [{ name = "g", file = "gyro.mtx", kind = "gyroscopic" }]
reduction = { method = "craig-bampton", modes = { count = 4 } }

[model]
stiffness = "K.mtx"
mass = "M.mtx"
dofs = "dofs.txt"
nodes = "nodes.csv"
constraints = "ties.mtx"
constraints_to_ground = "accept"
FRAMES

[write]
superelement = "x.supel"
quantities = { matrix = "stress.mtx", names = "names.csv" }
recovery = { nodes = [2, 4, 5] }
"#;

fn reduce(place: &Place, frames: &str) -> Ended {
    place.write("job.toml", JOB.replace("FRAMES", frames).as_bytes());
    supel(&["reduce", &place.text("job.toml")])
}

fn made(place: &Place, frames: &str) -> Superelement {
    reduce(place, frames).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    place.superelement("x.supel")
}

/// The largest difference of moduli, relative to the largest entry: modes have either sign.
fn difference(a: &Matrix, b: &Matrix) -> f64 {
    assert_eq!([a.rows(), a.cols()], [b.rows(), b.cols()]);
    let places = || (0..a.rows()).flat_map(|i| (0..a.cols()).map(move |j| (i, j)));
    let size = places().map(|at| a[at].abs()).fold(0.0, f64::max);
    places().map(|at| (a[at].abs() - b[at].abs()).abs()).fold(0.0, f64::max) / size
}

/// Turning rounds entries to 10⁻¹⁶ of the stiffness of a node; the softest of these few modes is 10⁻⁵ of that, and leaves 10⁻¹¹. A matrix
/// that was not turned, or a row of it, is off by all of its digits.
const ALIKE: f64 = 1e-9;

/// The superelement in a folder is that of a model along its own axes, by the same reduction.
#[track_caller]
pub(crate) fn assert_is_that_of(place: &Place, sound: &Model, reduction: &str) {
    let expected = Place::with(sound);
    expected.reduce(&expected.model_flags(), reduction).expect(ExitCode::Done);
    let [expected, found] = [&expected, place].map(|place| place.superelement("x.supel"));
    let difference = difference(&expected.tensors().stiffness, &found.tensors().stiffness);
    assert!(difference < ALIKE, "{difference:e}");
}

#[test]
fn everything_that_has_rows_is_turned_to_the_axes_of_the_model() {
    for (name, sound, nodes) in [("beams", beams(), vec![1, 3, 4]), ("solid", steel_brick(), vec![1, 3, 4, 6, 20, 33])]
    {
        let turned = Turned { sound, nodes };
        // Skew: what spins about all axes.
        let skew = {
            let upper = turned.sound.mass.iter().filter(|(i, j, _)| i > j);
            upper.flat_map(|(i, j, value)| [(*i, *j, *value), (*j, *i, -*value)]).collect::<Vec<Entry>>()
        };
        let as_it_is = Place::with(&turned.sound);
        with_columns(&as_it_is, &turned.sound, <[f64]>::to_vec, &skew);
        let place = Place::with(&turned.model());
        let local_skew =
            in_local_frames(&Model { stiffness: skew, ..turned.sound.clone() }, &ASKEW, |node| turned.is_turned(node));
        with_columns(&place, &turned.sound, |column| turned.column(column), &exactly_skew(&local_skew.stiffness));
        place.write("frames.csv", turned.table().as_bytes());

        let (expected, found) = (made(&as_it_is, ""), made(&place, "frames = \"frames.csv\""));
        let (a, b) = (expected.tensors(), found.tensors());
        assert_eq!(expected.metadata().coordinates.len(), found.metadata().coordinates.len(), "{name}");
        let some = |matrix: &Option<Matrix>| matrix.clone().expect("a matrix");
        let recovered =
            |superelement: &Superelement| superelement.tensors().recovery.clone().expect("rows").rows().clone();
        for (what, a, b) in [
            ("stiffness", &a.stiffness, &b.stiffness),
            ("mass", &a.mass, &b.mass),
            ("loads", &some(&a.load_vectors), &some(&b.load_vectors)),
            ("quantities", &some(&a.quantities), &some(&b.quantities)),
            ("recovery", &recovered(&expected), &recovered(&found)),
            ("gyroscopic", &a.matrices[0], &b.matrices[0]),
        ] {
            let difference = difference(a, b);
            assert!(difference < ALIKE, "{name}, {what}: {difference:e}");
        }
        let notes = place.report("x.report.json").to_string();
        assert!(
            notes.contains(&format!("frames.csv: {} nodes have rows along axes of their own", turned.nodes.len())),
            "{notes}"
        );
        assert_follows(&validator("report"), &place.report("x.report.json"));

        // Without the axes the rows are not those of any component, and with those of other nodes neither.
        reduce(&place, "").expect(ExitCode::InputData);
        let others = Turned { sound: turned.sound.clone(), nodes: vec![2, 5] };
        place.write("frames.csv", others.table().as_bytes());
        let ended = reduce(&place, "frames = \"frames.csv\"").expect(ExitCode::InputData);
        assert!(ended.err.contains("E-COORD"), "{}", ended.err);
    }
}

/// The lower entries and their negatives: what two sums leave differs in the last bit.
fn exactly_skew(entries: &[Entry]) -> Vec<Entry> {
    let lower = entries.iter().filter(|(i, j, _)| i > j);
    lower.flat_map(|(i, j, value)| [(*i, *j, *value), (*j, *i, -*value)]).collect()
}

/// Matrices of few digits stay verified, with a warning of the digits where there are six; axes of few digits are told from wrong ones.
#[test]
fn few_digits_of_matrices_and_of_axes() {
    let turned = Turned { sound: steel_brick(), nodes: (1..=20).collect() };
    let reduction = "--interface hub=5,15,45 --method herting --modes 3";
    for (digits, strict) in [(6, ""), (10, " --strict")] {
        let place = Place::with(&rounded(&turned.model(), digits));
        place.write("frames.csv", turned.table().as_bytes());
        let mut flags = place.model_flags();
        flags.extend(["--frames".to_owned(), place.text("frames.csv")]);
        place.reduce(&flags, &format!("{reduction}{strict}")).expect(ExitCode::Done);
        let table = turned.table().replace("2,2,1,-2,1,2", "0.66667,0.66667,0.33333,-0.66667,0.33333,0.66667");
        place.write("frames.csv", table.as_bytes());
        place.reduce(&flags, reduction).expect(ExitCode::Done);
        let wrong = table.replace("0.66667,0.66667,0.33333", "0.70000,0.66667,0.33333");
        place.write("frames.csv", wrong.as_bytes());
        let ended = place.reduce(&flags, reduction);
        assert_ne!(ended.code, ExitCode::Done, "{digits} digits: {}", ended.out);
    }
}

/// Axes turned about a line that is along no axis, by an angle.
fn turned_by(angle: f64) -> Axes {
    let ([x, y, z], (s, c)) = ([2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0], angle.sin_cos());
    let d = 1.0 - c;
    [
        [c + d * x * x, d * x * y + s * z, d * x * z - s * y],
        [d * x * y - s * z, c + d * y * y, d * y * z + s * x],
        [d * x * z + s * y, d * y * z - s * x, c + d * z * z],
    ]
}

/// A brick with each of some nodes along axes of its own, and the table of these axes in a form.
fn each_in_its_own(nodes: &[(i64, Axes)], form: impl Fn(f64) -> String) -> (Place, Vec<String>) {
    let mut model = steel_brick();
    let mut table = "node,x1,x2,x3,y1,y2,y3\n".to_owned();
    for (node, axes) in nodes {
        model = in_local_frames(&model, axes, |other| other == *node);
        let row: Vec<String> = axes[..2].iter().flatten().map(|value| form(*value)).collect();
        table += &format!("{node},{}\n", row.join(","));
    }
    let place = Place::with(&model);
    place.write("frames.csv", table.as_bytes());
    let mut flags = place.model_flags();
    flags.extend(["--frames".to_owned(), place.text("frames.csv")]);
    (place, flags)
}

const FREE: &str = "--interface hub=5,15,45 --method craig-bampton --modes 3";

/// The table is at fault where its decimals leave more open than K does: few of the nodes, most of them, or all of them alike.
#[test]
fn axes_of_few_decimals_are_refused_by_table_and_node() {
    let one = vec![(15, turned_by(0.7))];
    let most: Vec<(i64, Axes)> =
        (1..=45).filter(|node| node % 3 < 2).map(|node| (node, turned_by(node as f64))).collect();
    let about_z: Axes = {
        let (s, c) = 30f64.to_radians().sin_cos();
        [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
    };
    let alike: Vec<(i64, Axes)> = (1..=45).map(|node| (node, about_z)).collect();
    for nodes in [&one, &most, &alike] {
        for decimals in 1..=4 {
            let (place, flags) = each_in_its_own(nodes, |value| format!("{value:.decimals$}"));
            let ended = place.reduce(&flags, FREE).expect(ExitCode::InputData);
            // Zeros at the ends of numbers tell nothing: half is 0.5 in however many decimals.
            let shown = if nodes.len() == 45 { decimals.min(3) } else { decimals };
            let expected = ["E-FRAME-DIGITS".to_owned(), "frames.csv:".to_owned(), format!("have {shown} decimal")];
            for expected in expected {
                assert!(ended.err.contains(&expected), "{} nodes, {decimals}: {}", nodes.len(), ended.err);
            }
        }
        let (place, flags) = each_in_its_own(nodes, |value| format!("{value:e}"));
        let ended = place.reduce(&flags, FREE).expect(ExitCode::Done);
        assert!(!ended.out.contains("W-GROUNDED") && !ended.out.contains("W-FRAME"), "{}", ended.out);
    }
}

/// Five significant digits are five decimals of what is large, however many small components have.
#[test]
fn axes_of_five_significant_digits_are_known_to_five_decimals() {
    for nodes in
        [vec![(15, turned_by(0.7))], vec![(15, turned_by(3.0)), (20, turned_by(0.1))], vec![(23, turned_by(6.2))]]
    {
        let form = |value: f64| format!("{value:.4e}").parse::<f64>().expect("a number").to_string();
        let (place, flags) = each_in_its_own(&nodes, form);
        let ended = place.reduce(&flags, FREE).expect(ExitCode::Done);
        assert!(ended.out.contains("W-FRAME-DIGITS") && ended.out.contains("to 5 decimals"), "{}", ended.out);
    }
}

/// Where K couples a row of a node with its own axis alone, as in the middle of a block of cubes, a tilt that the decimals do not show makes no
/// force but by shortening that axis.
#[test]
fn axes_that_tilt_by_less_than_their_decimals_are_refused() {
    let block = brick([2, 2, 2], [0.2; 3], &Material::STEEL_SI);
    for (decimals, tilt) in [(1, 0.04), (2, 0.004), (2, 0.008), (3, 0.0004), (3, 0.0008)] {
        let ((s, c), (about_x, upright)) = (0.3f64.sin_cos(), f64::sin_cos(tilt));
        let axes: Axes = [[c, s, 0.0], [-upright * s, upright * c, about_x], [about_x * s, -about_x * c, upright]];
        let place = Place::with(&in_local_frames(&block, &axes, |node| node == 14));
        let row: Vec<String> = axes[..2].iter().flatten().map(|value| format!("{value:.decimals$}")).collect();
        place.write("frames.csv", format!("node,x1,x2,x3,y1,y2,y3\n14,{}\n", row.join(",")).as_bytes());
        let mut flags = place.model_flags();
        flags.extend(["--frames".to_owned(), place.text("frames.csv")]);
        let ended = place.reduce(&flags, "--interface foot=1,3,7 --method craig-bampton --modes 3");
        let ended = ended.expect(ExitCode::InputData);
        assert!(ended.err.contains("E-FRAME-DIGITS"), "{decimals} decimals, {tilt}: {}", ended.err);
    }
}

/// Axes of five decimals and more are right but for their digits: these turn the mass of a node as well, which is none of another order.
#[test]
fn axes_of_enough_decimals_turn_no_mass() {
    for (nodes, decimals) in [(vec![(15, turned_by(0.7))], 5), (vec![(15, turned_by(0.7)), (20, turned_by(1.9))], 6)] {
        let (place, flags) = each_in_its_own(&nodes, |value| format!("{value:.decimals$}"));
        let ended = place.reduce(&flags, FREE).expect(ExitCode::Done);
        assert!(ended.out.contains("W-FRAME-DIGITS"), "{}", ended.out);
        assert!(!ended.out.contains("W-MASS-DIRECTION"), "{}", ended.out);
        // Inertia relief answers the motions as zero modes mend them, in the file and with the job.
        let herting = "--rigid-interface hub=5,10,45 --interface foot=1,31 --method herting --modes 4";
        place.reduce(&flags, herting).expect(ExitCode::Done);
        let job = supel(&["inspect", &place.text("x.supel"), "--job"]).expect(ExitCode::Done).out;
        place.write("kept.json", job.as_bytes());
        supel(&["verify", &place.text("x.supel"), "--job", &place.text("kept.json")]).expect(ExitCode::Done);
    }
}

/// A block that is its own mirror image couples rows of one node with single axes of another, which five decimals shorten and do not turn. One
/// node or many, mid of the block or corner: what roundings of axes leave is no mechanism.
#[test]
fn axes_of_five_decimals_make_no_mechanism() {
    let block = brick([2, 2, 2], [0.2, 0.3, 0.25], &Material::STEEL_SI);
    let bar = brick([6, 2, 2], [1.0, 0.3, 0.25], &Material::STEEL_SI);
    for (model, chosen, foot) in [(&block, vec![14], "1,3,7"), (&bar, vec![32], "1,15,43"), (&block, vec![1], "2,3,7")]
    {
        for step in 0..4 {
            let mut turned = model.clone();
            let mut table = "node,x1,x2,x3,y1,y2,y3\n".to_owned();
            for node in &chosen {
                let axes = turned_by(0.3 + 1.3 * f64::from(step) + *node as f64);
                turned = in_local_frames(&turned, &axes, |other| other == *node);
                let row: Vec<String> = axes[..2].iter().flatten().map(|value| format!("{value:.5}")).collect();
                table += &format!("{node},{}\n", row.join(","));
            }
            let place = Place::with(&turned);
            place.write("frames.csv", table.as_bytes());
            let mut flags = place.model_flags();
            flags.extend(["--frames".to_owned(), place.text("frames.csv")]);
            let reduction = format!("--interface foot={foot} --method craig-bampton --modes 3");
            let ended = place.reduce(&flags, &reduction).expect(ExitCode::Done);
            assert!(ended.out.contains("W-FRAME-DIGITS"), "{chosen:?}, {step}: {}", ended.out);
            assert!(!ended.out.contains("W-MECHANISM"), "{chosen:?}, {step}: {}", ended.out);
        }
    }
}

/// Directions of few decimals may be exact, and K tells.
#[test]
fn axes_that_few_decimals_tell_exactly_are_taken() {
    let nodes: Vec<(i64, Axes)> = (1..=45)
        .filter(|node| node % 2 == 0)
        .map(|node| {
            (node, {
                let h = 0.5f64.sqrt();
                [[h, h, 0.0], [-h, h, 0.0], [0.0, 0.0, 1.0]]
            })
        })
        .collect();
    for decimals in [1, 2, 4] {
        let (place, flags) = each_in_its_own(&nodes, |value| format!("{value:.decimals$}"));
        let ended = place.reduce(&flags, FREE).expect(ExitCode::Done);
        assert!(!ended.out.contains("W-GROUNDED") && !ended.out.contains("W-FRAME"), "{}", ended.out);
    }
}

/// Error bars hold what six decimals leave open, and the warning names the table.
#[test]
fn the_digits_of_axes_are_named_where_error_bars_hold_them() {
    let nodes: Vec<(i64, Axes)> = (1..=20).map(|node| (node, turned_by(node as f64))).collect();
    let (place, flags) = each_in_its_own(&nodes, |value| format!("{value:.6}"));
    place.reduce(&flags, FREE).expect(ExitCode::Done);
    let said = place.report("x.report.json").to_string();
    assert!(
        said.contains("W-FRAME-DIGITS") && said.contains("frames.csv:2: the axes of node 1 are given to 6 decimals"),
        "{said}"
    );
    assert!(!said.contains("W-DATA-PRECISION"), "{said}");
}

/// Axes with all their digits that are slightly off at most nodes look like soft supports of a body that has six motions all the same.
#[test]
fn axes_that_are_off_at_most_nodes_are_no_supports() {
    let most: Vec<(i64, Axes)> =
        (1..=45).filter(|node| node % 3 < 2).map(|node| (node, turned_by(node as f64))).collect();
    let (place, flags) = each_in_its_own(&most, |value| format!("{value:e}"));
    let off = |node: &i64| turned_by(*node as f64 * (1.0 + 4e-3 / 45.0));
    let row = |axes: Axes| axes[..2].iter().flatten().map(|value| format!(",{value:e}")).collect::<String>();
    let rows: String = most.iter().map(|(node, _)| format!("{node}{}\n", row(off(node)))).collect();
    place.write("frames.csv", ("node,x1,x2,x3,y1,y2,y3\n".to_owned() + &rows).as_bytes());
    let ended = place.reduce(&flags, FREE).expect(ExitCode::InputData);
    assert!(ended.err.contains("E-COORD") && ended.err.contains("6 motions without energy"), "{}", ended.err);
}

#[test]
fn tables_that_are_no_axes_are_refused_by_line_and_node() {
    let turned = Turned { sound: steel_brick(), nodes: vec![7] };
    let place = Place::with(&turned.model());
    let mut flags = place.model_flags();
    flags.extend(["--frames".to_owned(), place.text("frames.csv")]);
    let sound = turned.table();
    for (table, expected) in [
        (sound.replace("-2,1,2", "4,4,2"), ["E-FRAME-AXES", "frames.csv:2: node 7 has x along"]),
        (sound.replace("2,2,1", "0,0,0"), ["E-FRAME-AXES", "which span no plane"]),
        (
            sound.replace("2,2,1", "0.333333,0.666667,1").replace("-2,1,2", "0.666667,1.333333,2"),
            ["E-FRAME-AXES", "frames.csv:2: node 7 has x along"],
        ),
        (
            sound.replace("y3\n", "y3,z1,z2,z3\n").replace("-2,1,2", "-2,1,2,-1,2,-2"),
            ["E-FRAME-AXES", "where x and y make it"],
        ),
        (sound.clone() + "7,1,0,0,0,1,0\n", ["E-NODE-REPEATED", "frames.csv:3"]),
        (sound.replace("7,2", "700,2"), ["E-FRAME-NODES", "axes of 1 node, of which none has rows"]),
        (sound.replace("x1,", "a,"), ["E-TABLE-COLUMN", "x1"]),
        ("node,x1,x2,x3,y1,y2,y3\n".to_owned(), ["E-NO-DATA", "frames.csv"]),
    ] {
        place.write("frames.csv", table.as_bytes());
        let ended = place.reduce(&flags, "--interface hub=5,15,45 --method guyan").expect(ExitCode::InputData);
        for expected in expected {
            assert!(ended.err.contains(expected), "{table}: {}", ended.err);
        }
    }
    // A support took a row of the node out of the matrices: the two that are left cannot be turned.
    let held = supel_models::transform::supported(&turned.model(), |dof| dof == (7, 2));
    let place = Place::with(&held);
    place.write("frames.csv", sound.as_bytes());
    let mut flags = place.model_flags();
    flags.extend(["--frames".to_owned(), place.text("frames.csv")]);
    let ended = place.reduce(&flags, "--interface hub=5,15,45 --method guyan").expect(ExitCode::InputData);
    assert!(
        ended.err.contains("E-FRAME-ROWS")
            && ended.err.contains("node 7 has axes of its own, and only the rows ux, uy"),
        "{}",
        ended.err
    );
}

/// Eigenpairs in the rows of the files are held against the model along its own axes.
#[test]
fn modes_of_another_program_are_turned_with_the_matrices() {
    let turned = Turned { sound: beams(), nodes: vec![2, 5] };
    let place = Place::with(&turned.model());
    place.write("frames.csv", turned.table().as_bytes());
    let model = turned.sound.clone();
    let [k, m] = supel_testing::pencil::matrices(&model);
    let (lambda, shapes) = supel_testing::pencil::eigen(k.as_ref(), m.as_ref(), 1e4);
    let columns: Vec<Vec<f64>> =
        (0..9).map(|j| turned.column(&shapes.col(j).iter().copied().collect::<Vec<f64>>())).collect();
    place.write("modes.mtx", array(model.n, &columns).as_bytes());
    place.write(
        "lambda.txt",
        lambda[..9].iter().map(|value| format!("{:e}\n", value.max(0.0))).collect::<String>().as_bytes(),
    );
    let files = ["K.mtx", "M.mtx", "modes.mtx"].map(|name| place.text(name));
    let (dofs, nodes, frames, values) =
        (place.text("dofs.txt"), place.text("nodes.csv"), place.text("frames.csv"), place.text("lambda.txt"));
    let mut args =
        vec!["certify", &files[0], &files[1], &files[2], "--eigenvalues", &values, "--dofs", &dofs, "--nodes", &nodes];
    args.extend(["--frames", &frames]);
    supel(&args).expect(ExitCode::Done);
}

/// Radial and tangential directions about a line, in a system that refers to another.
#[test]
fn systems_of_nastran_are_taken_from_the_deck() {
    let sound = steel_brick();
    // The line through (0.2, 0.1) along z; the second system is given in the first, and grid points in it too.
    let systems = "CORD2R,3,,0.2,0.1,0.,0.2,0.1,1.\n,0.2,1.1,0.\n\
                   CORD2C,7,3,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n\
                   CORD1R,9,1,2,6\n";
    let mut model = sound.clone();
    let mut deck = "BEGIN BULK\n".to_owned() + systems;
    for (label, [x, y, z]) in (1i64..).zip(&sound.nodes) {
        let system = match label % 5 {
            0 => 7,
            3 => 9,
            _ => 0,
        };
        deck += &format!("GRID,{label},,{x:?},{y:?},{z:?},{system}\n");
        let (dx, dy) = (x - 0.2, y - 0.1);
        let r = dx.hypot(dy);
        let axes = match system {
            7 => [[dx / r, dy / r, 0.0], [-dy / r, dx / r, 0.0], [0.0, 0.0, 1.0]],
            // Origin at node 1, z towards node 2, which is along x; node 6 is along y, in the plane of z and x.
            9 => [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
            _ => continue,
        };
        model = in_local_frames(&model, &axes, |node| node == label);
    }
    let place = Place::with(&model);
    place.write("part.bdf", (deck.clone() + "ENDDATA\n").as_bytes());
    // All of the g-set, of which solids have three rows: rows as EXTRN lists them.
    let rows: String = (1..=sound.nodes.len()).map(|label| format!("EXTRN,{label},123\n")).collect();
    place.write("rows.pch", (deck + &rows).as_bytes());
    let mut flags = place.matrix_flags();
    flags.extend(["--dofs".into(), place.text("rows.pch"), "--nodes".into(), place.text("nodes.csv")]);
    let reduction = "--interface hub=5,15,45 --method herting --modes 3 --strict";
    let ended = place.reduce(&flags, reduction).expect(ExitCode::Done);
    assert!(ended.out.contains("nodes have rows along axes of their own"), "{}", ended.out);
    assert_is_that_of(&place, &sound, reduction);
    // A system that is not there, and one that refers to itself.
    for (from, to, message) in [
        (
            "CORD1R,9,",
            "CORD1R,8,",
            "\"9\" – expected a coordinate system that CORD1 or CORD2 entries of the deck define",
        ),
        ("CORD2C,7,3,", "CORD2C,7,7,", "\"7\" – expected a coordinate system that does not refer to itself"),
    ] {
        let text = String::from_utf8(place.bytes("rows.pch")).expect("text").replace(from, to);
        place.write("wrong.pch", text.as_bytes());
        let mut flags = place.matrix_flags();
        flags.extend(["--dofs".into(), place.text("wrong.pch"), "--nodes".into(), place.text("nodes.csv")]);
        let ended = place.reduce(&flags, reduction).expect(ExitCode::InputData);
        assert!(ended.err.contains(message), "{}", ended.err);
    }
}

/// Wrong axes leave every frequency what it is: without coordinates nothing tells them, and the run says so.
#[test]
fn axes_without_coordinates_are_said_to_be_untested() {
    let sound = steel_brick();
    let place = Place::with(&sound);
    place.write("frames.csv", b"node,x1,x2,x3,y1,y2,y3\n5,1,1,0,-1,1,0\n");
    let of_deck: String = (1i64..)
        .zip(&sound.nodes)
        .map(|(label, [x, y, z])| format!("GRID,{label},,{x:?},{y:?},{z:?},{}\n", if label == 5 { "7" } else { "" }))
        .chain((1..=sound.nodes.len()).map(|label| format!("EXTRN,{label},123\n")))
        .collect();
    place.write("rows.pch", format!("BEGIN BULK\nCORD2R,7,,0.,0.,0.,0.,1.,2.\n,1.,0.,0.\n{of_deck}").as_bytes());
    let text = |name: &str| place.text(name);
    for (flags, file) in [
        (["--dofs".to_owned(), text("dofs.txt"), "--frames".to_owned(), text("frames.csv")].to_vec(), "frames.csv"),
        (["--dofs".to_owned(), text("rows.pch")].to_vec(), "rows.pch"),
    ] {
        let with_nodes =
            [place.matrix_flags(), flags.clone(), ["--nodes".to_owned(), text("nodes.csv")].to_vec()].concat();
        let reduction = "--interface hub=5,15,45 --method guyan";
        let ended = place.reduce(&with_nodes, reduction).expect(ExitCode::InputData);
        assert!(ended.err.contains("E-COORD"), "{}", ended.err);
        place.reduce(&[place.matrix_flags(), flags].concat(), reduction).expect(ExitCode::Done);
        let warnings = place.report("x.report.json")["body"]["warnings"].to_string();
        assert!(warnings.contains("W-FRAME-UNTESTED") && warnings.contains(file), "{warnings}");
    }
}

/// The axes of three points in line but for rounding would be those of the rounding.
#[test]
fn systems_of_nastran_by_points_in_line_are_refused_by_line() {
    let sound = steel_brick();
    let place = Place::with(&sound);
    let grids: String = (1i64..)
        .zip(&sound.nodes)
        .map(|(label, [x, y, z])| format!("GRID,{label},,{x:?},{y:?},{z:?},{}\n", if label == 5 { "7" } else { "" }))
        .collect();
    let rows: String = (1..=sound.nodes.len()).map(|label| format!("EXTRN,{label},123\n")).collect();
    let flags = |system: &str| {
        place.write("rows.pch", format!("BEGIN BULK\n{system}\n{grids}{rows}").as_bytes());
        let mut flags = place.matrix_flags();
        flags.extend(["--dofs".into(), place.text("rows.pch"), "--nodes".into(), place.text("nodes.csv")]);
        flags
    };
    let reduction = "--interface hub=5,15,45 --method guyan";
    for system in [
        "CORD2R,7,,.1,-.2,.3,.2,.1,.9\n,.3,.4,1.5",
        "CORD2C,7,,.1,-.2,.3,.2,.1,.9\n,.3,.4,1.5",
        "CORD2S,7,,0.,0.,0.,.333333,.666667,1.\n,.666667,1.333333,2.",
        // Six digits: in line but for the last of them.
        "CORD2R,7,,0.,0.,0.,.00333333,.00666667,.01\n,.00666667,.0133333,.02",
        "CORD2R,7,8,1.,20.,.1,1.,20.,.3\n,1.,20.,.7\nCORD2C,8,,.1,.2,.3,.2,.7,.9\n,1.3,.4,1.5",
        "CORD1R,7,91,92,93\nGRID,91,,.1,-.2,.3\nGRID,92,,.2,.1,.9\nGRID,93,,.3,.4,1.5",
    ] {
        let ended = place.reduce(&flags(system), reduction).expect(ExitCode::InputData);
        assert!(
            ended.err.contains("E-FRAME-AXES") && ended.err.contains("rows.pch:2: coordinate system 7"),
            "{}",
            ended.err
        );
    }
    // One unit of the last digit apart, at a right angle: meant so. The rows are along other axes then.
    let ended = place.reduce(&flags("CORD2R,7,,9.99901,0.,0.,9.99901,0.,.00001\n,9.99902,0.,0."), reduction);
    let ended = ended.expect(ExitCode::Done);
    assert!(ended.out.contains("1 node has rows along axes of their own"), "{}", ended.out);
}

/// Abaqus writes its labelled rows along the axes of `*TRANSFORM`.
#[test]
fn transforms_of_abaqus_are_taken_from_the_deck() {
    let sound = steel_brick();
    let mut model = sound.clone();
    let mut deck = "*NODE\n".to_owned();
    for (label, [x, y, z]) in (1i64..).zip(&sound.nodes) {
        deck += &format!("{label}, {x:?}, {y:?}, {z:?}\n");
    }
    deck += "*NSET, NSET=RING\n5, 10, 15, 20\n*TRANSFORM, NSET=Ring, TYPE=C\n0.2, 0.1, 0, 0.2, 0.1, 1\n\
             *NSET, NSET=EDGE\n7, 8\n*TRANSFORM, NSET=EDGE\n2, 2, 1, -2, 1, 2\n*TRANSFORM, NSET=9, TYPE=S\n0.2, 0.1, 0, 0.2, 0.1, 1\n";
    for label in [5i64, 10, 15, 20, 7, 8, 9] {
        let [x, y, z] = sound.nodes[label as usize - 1];
        let (dx, dy) = (x - 0.2, y - 0.1);
        let r = dx.hypot(dy);
        let (radial, tangential) = ([dx / r, dy / r, 0.0], [-dy / r, dx / r, 0.0]);
        let axes = match label {
            7 | 8 => ASKEW,
            9 => {
                let outward = r.hypot(z);
                // Towards the pole: what is left of z across the radius.
                [
                    [dx / outward, dy / outward, z / outward],
                    tangential,
                    [-z * radial[0] / outward, -z * radial[1] / outward, r / outward],
                ]
            }
            _ => [radial, tangential, [0.0, 0.0, 1.0]],
        };
        model = in_local_frames(&model, &axes, |node| node == label);
    }
    let place = Place::with(&model);
    place.write("part.inp", deck.as_bytes());
    let labelled = |entries: &[Entry]| -> String {
        let name = |row: u32| format!("{}, {}", model.dofs[row as usize].0, model.dofs[row as usize].1 + 1);
        entries
            .iter()
            .filter(|(i, j, _)| i >= j)
            .map(|(i, j, value)| format!("{}, {}, {value:e}\n", name(*i), name(*j)))
            .collect()
    };
    place.write("K.mtx", labelled(&model.stiffness).as_bytes());
    place.write("M.mtx", labelled(&model.mass).as_bytes());
    let mut flags = place.matrix_flags();
    flags.extend(["--nodes".into(), place.text("part.inp")]);
    let reduction = "--interface hub=5,15,45 --method herting --modes 3 --strict";
    place.reduce(&flags, reduction).expect(ExitCode::Done);
    assert_is_that_of(&place, &sound, reduction);
}
