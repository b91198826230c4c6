//! `supel recipe`: what can be run here is run, as it is printed. What cannot says so in its second line.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use supel::cli::ExitCode;
use supel_models::{Material, brick};
use supel_testing::place::{Place, steel_brick, supel};

const PROGRAMS: [&str; 8] = ["abaqus", "ansys", "nastran", "calculix", "code_aster", "gmsh", "scipy", "matlab"];

fn recipe(program: &str) -> String {
    supel(&["recipe", program]).expect(ExitCode::Done).out
}

/// The lines of a recipe that are for another program, without their margin, part by part.
fn parts(text: &str) -> Vec<String> {
    let mut parts = vec![String::new()];
    for line in text.lines() {
        match line.strip_prefix("    ") {
            Some(line) => parts.last_mut().expect("a part").push_str(&format!("{line}\n")),
            // Empty lines belong to the part that they interrupt.
            None if line.is_empty() => parts.last_mut().expect("a part").push('\n'),
            None => parts.push(String::new()),
        }
    }
    parts.retain(|part| !part.trim().is_empty());
    parts.iter().map(|part| part.trim().to_owned() + "\n").collect()
}

/// The parts of a recipe that are not commands of this program.
fn foreign(text: &str) -> Vec<String> {
    let is_own = |line: &&str| line.starts_with("supel ") || line.starts_with("pip ");
    let others =
        |part: &String| part.lines().filter(|line| !is_own(line)).map(|line| format!("{line}\n")).collect::<String>();
    parts(text).iter().map(others).filter(|part| !part.trim().is_empty()).collect()
}

/// The commands of this program in a recipe.
fn commands(text: &str) -> Vec<String> {
    text.lines().filter_map(|line| line.trim().strip_prefix("supel ")).map(str::to_owned).collect()
}

#[test]
fn every_recipe_says_how_it_was_tried_and_what_goes_wrong() {
    for program in PROGRAMS {
        let text = recipe(program);
        let second = text.lines().nth(1).expect("a second line");
        let is_run = ["calculix", "gmsh", "scipy"].contains(&program);
        assert_eq!(second.starts_with("Run by the tests of supel with "), is_run, "{program}: {second}");
        assert_eq!(second.starts_with("Not run by us: "), !is_run, "{program}: {second}");
        assert!(text.contains("\nTraps\n") && text.contains("supel doctor "), "{program}");
        assert!(text.lines().all(|line| line.chars().count() <= 170), "{program}");
        // Codes that a recipe names are codes.
        let is_code = |word: &&str| word.len() > 3 && (word.starts_with("E-") || word.starts_with("W-"));
        for code in text.split(|c: char| !(c.is_ascii_uppercase() || c == '-')).filter(is_code) {
            supel(&["explain", code]).expect(ExitCode::Done);
        }
    }
    let ended = supel(&["recipe", "abacus"]).expect(ExitCode::Usage);
    assert!(ended.err.contains("abaqus"), "{}", ended.err);
}

/// The flags of every command that a recipe prints are flags.
#[test]
fn commands_of_recipes_can_be_read() {
    for program in PROGRAMS {
        for command in commands(&recipe(program)) {
            let words: Vec<&str> = command.split_whitespace().filter(|word| !["[", "]"].contains(word)).collect();
            let ended = supel(&words);
            assert!(!ended.err.contains("E-USAGE"), "{command}: {}", ended.err);
        }
    }
}

/// Python with these modules; otherwise it is said that a test was skipped.
fn python(modules: &str, test: &str) -> Option<String> {
    let python = std::env::var("SUPEL_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let check = format!("import {modules}");
    let has = Command::new(&python).args(["-c", &check]).output().is_ok_and(|ended| ended.status.success());
    if !has {
        println!("skipped: {test}: {python} has not all of {modules}; set SUPEL_PYTHON");
    }
    has.then_some(python)
}

#[track_caller]
fn run(program: &str, args: &[&str], folder: &Path) -> String {
    let ended = Command::new(program).args(args).current_dir(folder).output().expect(program);
    let (out, err) = (String::from_utf8_lossy(&ended.stdout), String::from_utf8_lossy(&ended.stderr));
    assert!(ended.status.success(), "{program}: {out}\n{err}");
    out.into_owned()
}

/// Runs a command of a recipe on the files of a folder.
#[track_caller]
fn own(place: &Place, command: &str, code: ExitCode) -> String {
    let word = |word: &str| if word.contains('.') { place.text(word) } else { word.to_owned() };
    let words: Vec<String> = command.split_whitespace().map(word).collect();
    supel(&words.iter().map(String::as_str).collect::<Vec<_>>()).expect(code).out
}

/// A block as a CalculiX deck, exported as the recipe says.
#[test]
fn calculix() {
    let has = |program: &str| {
        Command::new("sh")
            .args(["-c", &format!("command -v {program}")])
            .output()
            .is_ok_and(|ended| ended.status.success())
    };
    if !has("ccx") {
        println!("skipped: calculix: no ccx");
        return;
    }
    let text = recipe("calculix");
    let [step, ccx, step_of_modes, ccx_of_modes] = &foreign(&text)[..] else { panic!("{text}") };
    let place = Place::new();
    let cells = [4usize, 2, 2];
    let model = brick(cells, [0.1, 0.03, 0.02], &Material::STEEL_SI);
    let mut deck = "*NODE, NSET=ALL\n** one node on each line\n".to_owned();
    for (label, [x, y, z]) in model.labels.iter().zip(&model.nodes) {
        let _ = writeln!(deck, "{label}, {x}, {y}, {z}");
    }
    deck += "*ELEMENT, TYPE=C3D8, ELSET=SOLID\n";
    for (number, corners) in hexahedra(&model.nodes, cells, [0.1, 0.03, 0.02]).iter().enumerate() {
        let corners: Vec<String> = corners.iter().map(|corner| model.labels[*corner].to_string()).collect();
        let _ = writeln!(deck, "{}, {}", number + 1, corners.join(", "));
    }
    deck +=
        "*MATERIAL, NAME=STEEL\n*ELASTIC\n210e9, 0.3\n*DENSITY\n7850\n*SOLID SECTION, ELSET=SOLID, MATERIAL=STEEL\n";
    place.write("part.inp", (deck.clone() + step).as_bytes());
    place.write("modes.inp", (deck + step_of_modes).as_bytes());
    for (ccx, written) in [(ccx, "part.sti"), (ccx_of_modes, "modes.frd")] {
        // It may end with 201.
        let ended = Command::new("sh").args(["-c", ccx]).current_dir(place.path("")).output().expect("a shell");
        assert!(place.path(written).exists(), "{}", String::from_utf8_lossy(&ended.stdout));
    }
    let [doctor, certify] = &commands(&text)[..] else { panic!("{text}") };
    let told = own(&place, doctor, ExitCode::Done);
    assert!(told.contains("six free") && told.contains("45 nodes"), "{told}");
    let told = own(&place, certify, ExitCode::Done);
    assert!(told.contains("10 shapes") && told.contains("written by CalculiX"), "{told}");
}

/// The corners of the cells of a block, by their places.
fn hexahedra(nodes: &[[f64; 3]], cells: [usize; 3], size: [f64; 3]) -> Vec<[usize; 8]> {
    let at = |place: [usize; 3]| {
        let wanted: [f64; 3] = std::array::from_fn(|axis| size[axis] * place[axis] as f64 / cells[axis] as f64);
        let is_there = |node: &[f64; 3]| (0..3).all(|axis| (node[axis] - wanted[axis]).abs() < 1e-9);
        nodes.iter().position(is_there).expect("a node")
    };
    let corner = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let places = (0..cells[0]).flat_map(|x| (0..cells[1]).flat_map(move |y| (0..cells[2]).map(move |z| [x, y, z])));
    places.map(|[x, y, z]| corner.map(|[dx, dy, dz]| at([x + dx, y + dy, z + dz]))).collect()
}

/// The matrices of a Python program, and the modes that SciPy finds of them.
#[test]
fn scipy() {
    let Some(python) = python("numpy, scipy", "scipy") else { return };
    let text = recipe("scipy");
    let place = Place::with(&steel_brick());
    let before = "import numpy, scipy.io, scipy.sparse.linalg\n\
         K, M = (scipy.io.mmread(f'{name}.mtx').tocsr() for name in 'KM')\n\
         dofs = [tuple(map(int, line.split('.'))) for line in open('dofs.txt')]\n\
         nodes = [(int(w[0]), tuple(map(float, w[1:]))) for w in (line.split(',') for line in list(open('nodes.csv'))[1:])]\n\
         eigenvalues, vectors = scipy.sparse.linalg.eigsh(K, 16, M, sigma=-1e6)\n";
    let blocks = foreign(&text);
    run(&python, &["-c", &format!("{before}{}", blocks.join("\n"))], &place.path(""));
    let [doctor, certify] = &commands(&text)[..] else { panic!("{text}") };
    assert!(own(&place, doctor, ExitCode::Done).contains("✓ nothing"));
    assert!(own(&place, certify, ExitCode::Done).contains("a Sturm count finds 16 modes"));
}

/// A geometry becomes a model with interfaces, which reduces.
#[test]
fn gmsh() {
    let Some(python) = python("gmsh, skfem, scipy, meshio", "gmsh") else { return };
    let text = recipe("gmsh");
    let place = Place::new();
    let interfaces = run(&python, &["-c", &foreign(&text).join("\n")], &place.path(""));
    for command in commands(&text) {
        let told = own(&place, &command, ExitCode::Done);
        assert!(told.contains("six free") && told.contains("m, kg, s"), "{told}");
    }
    let lines: Vec<&str> = interfaces.lines().filter(|line| line.starts_with("--rigid-interface")).collect();
    assert_eq!(lines.len(), 2, "{interfaces}");
    let [base, tip] = [lines[0], lines[1]].map(|line| line.split_once(' ').expect("a flag").1);
    let paths = ["K.mtx", "M.mtx", "dofs.txt", "nodes.csv", "part.supel"].map(|name| place.text(name));
    let [k, m, dofs, nodes, output] = &paths;
    let args = ["reduce", "--stiffness", k, "--mass", m, "--dofs", dofs, "--nodes", nodes, "--method", "craig-bampton"];
    let rest = ["--modes", "8", "--rigid-interface", base, "--rigid-interface", tip, "--output", output, "--quiet"];
    supel(&[&args[..], &rest[..]].concat()).expect(ExitCode::Done);
}
