//! What a run says of its input and of itself: by which names, how often, and with which way round.

use std::fmt::Write;

use supel::cli::ExitCode;
use supel_models::Material;
use supel_models::springs::springs;

use crate::place::{Ended, Place, supel, warnings_of_reduction};

const FOOT: &str = "--interface foot=1,11,31,41 --method herting --modes 5";

#[track_caller]
fn assert_says(ended: &Ended, code: ExitCode, parts: &[&str]) {
    assert_eq!(ended.code, code, "{}{}", ended.out, ended.err);
    for part in parts {
        assert!(ended.err.contains(part), "no {part:?} in {}", ended.err);
    }
}

/// Entries of a Matrix Market file, row and column from one.
fn entries(place: &Place, name: &str) -> Vec<(usize, usize, String)> {
    let text = String::from_utf8(place.bytes(name)).expect("UTF-8");
    let lines = text.lines().filter(|line| !line.starts_with('%')).skip(1);
    let entry = |line: &str| {
        let fields: Vec<&str> = line.split_whitespace().collect();
        (fields[0].parse().expect("a row"), fields[1].parse().expect("a column"), fields[2].to_owned())
    };
    lines.map(entry).collect()
}

fn write_matrix(place: &Place, name: &str, n: usize, entries: &[(usize, usize, String)]) {
    let mut text = format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {}\n", entries.len());
    for (row, col, value) in entries {
        writeln!(text, "{row} {col} {value}").expect("written");
    }
    place.write(name, text.as_bytes());
}

/// The free brick with two empty rows before its own: row 1 of the matrices is row 3 of the files, a dof of node 1.
fn with_empty_rows() -> Place {
    let place = Place::with_brick();
    for name in ["K.mtx", "M.mtx"] {
        let moved: Vec<_> =
            entries(&place, name).into_iter().map(|(row, col, value)| (row + 2, col + 2, value)).collect();
        write_matrix(&place, name, 137, &moved);
    }
    let dofs = String::from_utf8(place.bytes("dofs.txt")).expect("UTF-8");
    place.write("dofs.txt", format!("900.1\n900.2\n{dofs}").as_bytes());
    let nodes = String::from_utf8(place.bytes("nodes.csv")).expect("UTF-8");
    place.write("nodes.csv", format!("{nodes}900,9,9,9\n").as_bytes());
    place
}

/// Makes the diagonal entry of a row of the stiffness another one.
fn with_diagonal(place: &Place, name: &str, row: usize, value: &str) {
    let mut all = entries(place, name);
    let n = all.iter().map(|entry| entry.0).max().expect("entries");
    all.iter_mut().filter(|entry| (entry.0, entry.1) == (row, row)).for_each(|entry| entry.2 = value.to_owned());
    write_matrix(place, name, n, &all);
}

#[test]
fn rows_are_named_by_file_and_label_after_others_are_dropped() {
    let negative = with_empty_rows();
    with_diagonal(&negative, "K.mtx", 10, "-1e9");
    let ended = negative.reduce(&negative.model_flags(), &format!("{FOOT} --drop-empty"));
    assert_says(&ended, ExitCode::ModelPhysics, &["E-NEG-DIAG", "row 10 (node 3 uy)"]);
    let ended =
        negative.reduce(&negative.matrix_flags(), "--interface a=rows:2,3,4 --method herting --modes 5 --drop-empty");
    assert_says(&ended, ExitCode::ModelPhysics, &["E-NEG-DIAG", "row 10 of the stiffness"]);

    let lopsided = with_empty_rows();
    let mut all = entries(&lopsided, "K.mtx");
    let mirrored: Vec<_> = all.iter().filter(|e| e.0 != e.1).map(|e| (e.1, e.0, e.2.clone())).collect();
    all.extend(mirrored);
    let largest = all.iter().position(|entry| (entry.0, entry.1) == (12, 9)).expect("an entry");
    all[largest].2 = "7e10".to_owned();
    write_matrix(&lopsided, "K.mtx", 137, &all);
    let text = String::from_utf8(lopsided.bytes("K.mtx")).expect("UTF-8");
    lopsided.write("K.mtx", text.replace("real symmetric", "real general").as_bytes());
    let ended = lopsided.reduce(&lopsided.model_flags(), &format!("{FOOT} --drop-empty"));
    assert_says(&ended, ExitCode::InputData, &["E-UNSYMMETRIC", "row 12 (node 4 ux)", "column 9 (node 3 ux)"]);
}

/// Rows of an interface are those of the files, whatever was dropped before them.
#[test]
fn rows_of_an_interface_are_those_of_the_files() {
    let whole = Place::with_brick();
    let sound = "--interface a=rows:0,1,2,30,31,32,90,91,92 --method herting --modes 5";
    whole.reduce(&whole.matrix_flags(), sound).expect(ExitCode::Done);
    let expected = whole.superelement("x.supel");
    let place = with_empty_rows();
    let moved = "--interface a=rows:2,3,4,32,33,34,92,93,94 --method herting --modes 5 --drop-empty";
    place.reduce(&place.matrix_flags(), moved).expect(ExitCode::Done);
    let found = place.superelement("x.supel");
    assert_eq!(found.tensors().stiffness, expected.tensors().stiffness);
    let rows = serde_json::to_value(&found.metadata().coordinates[..2]).expect("JSON");
    assert_eq!((&rows[0]["row"], &rows[1]["row"]), (&2.into(), &3.into()));

    let dropped = place.reduce(&place.matrix_flags(), &moved.replace("rows:2,", "rows:1,"));
    assert_says(
        &dropped,
        ExitCode::InputData,
        &["E-INTERFACE-ROW", "row 1 has neither stiffness nor mass and was dropped"],
    );
    let beyond = place.reduce(&place.matrix_flags(), &moved.replace("rows:2,", "rows:137,"));
    assert_says(&beyond, ExitCode::InputData, &["E-INTERFACE-ROW", "row 137 does not exist", "0 to 136"]);
}

/// CalculiX repeats labels of expanded shells and makes nodes that the deck does not have.
#[test]
fn maps_that_cannot_be_used_say_which_rows_and_how_to_go_on() {
    let place = Place::with_brick();
    let dofs = String::from_utf8(place.bytes("dofs.txt")).expect("UTF-8");
    let lines: Vec<&str> = dofs.lines().collect();
    let mut repeated = lines.clone();
    repeated.splice(60..72, lines[..12].iter().copied());
    place.write("dofs.txt", repeated.join("\n").as_bytes());
    let by_rows = "give interfaces as rows from zero, as in reduce --interface hub=rows:0,1,2";
    let ended = place.reduce(&place.model_flags(), FOOT);
    let which = "rows 1 and 61 are both ux of node 1, and 12 rows (61, 62, 63, 64, …) repeat a dof";
    assert_says(&ended, ExitCode::InputData, &["E-MAP-REPEATED", which, by_rows]);

    let made: Vec<String> = lines.iter().map(|line| line.replace("45.", "10045.")).collect();
    place.write("dofs.txt", made.join("\n").as_bytes());
    let ended = place.reduce(&place.model_flags(), FOOT);
    let which = "row 133 is at node 10045, which";
    assert_says(
        &ended,
        ExitCode::InputData,
        &["E-MAP-NODE", which, "3 rows (133, 134, 135) have no position", by_rows],
    );
    // The way that both messages show.
    let rows = "--interface foot=rows:0,1,2,30,31,32,90,91,92 --method herting --modes 5";
    place.reduce(&place.matrix_flags(), rows).expect(ExitCode::Done);
}

#[test]
fn one_matrix_in_both_places() {
    let place = Place::with_brick();
    place.write("copy.mtx", &place.bytes("K.mtx"));
    for mass in ["K.mtx", "copy.mtx"] {
        let mut flags = place.model_flags();
        flags[3] = place.text(mass);
        assert_says(&place.reduce(&flags, FOOT), ExitCode::InputData, &["E-SAME-MATRIX", "K.mtx", mass, "one matrix"]);
    }
}

#[test]
fn an_expected_mass_names_the_ratio() {
    let place = Place::with_brick();
    let mass = 7850.0 * 0.31 * 0.23;
    for (expected, parts) in [
        (mass * 1000.0, vec!["M-16", "mass 559.705, expected 559705: ratio 1000, a unit slip?"]),
        (mass / 1000.0, vec!["mass 559.705, expected 0.559705: ratio 1000, a unit slip?"]),
        // A tenth of the mass is missing as well.
        (mass * 1092.0, vec!["mass 559.705, expected 611198: ratio 1092, a unit slip?"]),
        (mass * 1.3, vec!["mass 559.705, expected 727.617: ratio 1.3 –"]),
    ] {
        let job = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\", \
             expect = {{ mass = {expected} }} }}\n\
             interface = [{{ name = \"foot\", nodes = [1, 11, 31, 41] }}]\n\
             reduction = {{ method = \"herting\", modes = {{ count = 5 }} }}\nwrite = {{ superelement = \"x.supel\" }}\n"
        );
        place.write("job.toml", job.as_bytes());
        let ended = supel(&["reduce", &place.text("job.toml"), "--quiet"]);
        // The first check only knows the ratio to three digits, centre and all follow.
        let parts: Vec<String> = parts.iter().map(|part| part.replace(" –", ", centre")).collect();
        assert_says(&ended, ExitCode::CheckFailed, &parts.iter().map(String::as_str).collect::<Vec<_>>());
        // One line for the check, one for the file.
        assert_eq!(ended.err.lines().count(), 2, "{}", ended.err);
        assert!(ended.out.is_empty());
    }
}

/// A row that nothing ties to others is named where no coordinates give its motion words.
#[test]
fn row_without_stiffness_is_named() {
    let place = Place::new();
    let banner = "%%MatrixMarket matrix coordinate real symmetric\n";
    place.write("K.mtx", format!("{banner}3 3 3\n1 1 1.0\n2 1 -1.0\n2 2 1.0\n").as_bytes());
    place.write("M.mtx", format!("{banner}3 3 3\n1 1 1.0\n2 2 1.0\n3 3 1.0\n").as_bytes());
    let ended = place.reduce(&place.matrix_flags(), "--interface a=rows:0 --method herting --modes 1");
    let words = ["E-INTERFACE-RANK", "only 1 of the 2", "1 row has mass and no stiffness, the first is row 3"];
    assert_says(&ended, ExitCode::ModelPhysics, &words);
}

#[test]
fn interfaces_of_flags_replace_or_are_added_by_name() {
    let place = Place::with_brick();
    let job = "model = { stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }\n\
               interface = [{ name = \"foot\", nodes = [1, 11, 31, 41] }, { name = \"tip\", nodes = [45] }]\n\
               reduction = { method = \"herting\", modes = { count = 5 } }\nwrite = { superelement = \"x.supel\" }\n";
    place.write("job.toml", job.as_bytes());
    let job = place.text("job.toml");
    let names = || -> Vec<(String, usize)> {
        let report = place.report("x.report.json");
        let interfaces = report["body"]["reduction"]["interfaces"].as_array().expect("interfaces").clone();
        let of = |interface: &serde_json::Value| {
            let n_nodes = interface["n_nodes"].as_u64().expect("a number") as usize;
            (interface["name"].as_str().expect("a name").to_owned(), n_nodes)
        };
        interfaces.iter().map(of).collect()
    };
    let pair = |name: &str, n_nodes| (name.to_owned(), n_nodes);
    let ended = supel(&["reduce", &job, "--interface", "tip=44,45", "--interface", "side=21"]).expect(ExitCode::Done);
    assert!(ended.err.contains("the flag replaces interface \"tip\" of the job"), "{}", ended.err);
    assert!(ended.err.contains("the flag adds interface \"side\" to the 2 of the job"), "{}", ended.err);
    assert_eq!(names(), [pair("foot", 4), pair("tip", 2), pair("side", 1)]);
    let ended = supel(&["reduce", &job, "--interface", "tip=44", "--quiet"]).expect(ExitCode::Done);
    assert_eq!(ended.err, "");
    let twice = supel(&["reduce", &job, "--interface", "a=44", "--interface", "a=45"]).expect(ExitCode::Usage);
    assert!(twice.err.contains("E-INTERFACE-NAME"), "{}", twice.err);
    let twice =
        supel(&["reduce", &job, "--interface", "tip=44", "--rigid-interface", "tip=45"]).expect(ExitCode::Usage);
    assert!(twice.err.contains("E-INTERFACE-NAME"), "one flag would replace the other unseen: {}", twice.err);
}

/// A table of nodes has no groups to name.
#[test]
fn a_group_of_a_table_of_nodes() {
    let place = Place::with_brick();
    let ended = place.reduce(&place.model_flags(), "--interface foot=group:BASE --method herting --modes 5");
    assert_says(&ended, ExitCode::InputData, &["E-GROUP", "no group \"BASE\"", "has no groups", "list node labels"]);
}

/// Places of interfaces are in the summary, the document and the page, with where they come from.
#[test]
fn interfaces_say_where_they_are() {
    let place = Place::with_brick();
    let page = place.text("x.html");
    let flags =
        format!("--rigid-interface foot=1,11,31,41 --interface tip=45 --method herting --modes 5 --html {page}");
    let ended = place.reduce(&place.model_flags(), &flags).expect(ExitCode::Done);
    let report = place.report("x.report.json");
    let interfaces = report["body"]["reduction"]["interfaces"].as_array().expect("interfaces").clone();
    let at = |name: &str| {
        let interface = interfaces.iter().find(|interface| interface["name"] == name).expect("an interface");
        interface["at"][0].clone()
    };
    let (foot, tip) = (at("foot"), at("tip"));
    assert_eq!((&foot["node"], &foot["origin"]), (&serde_json::Value::Null, &"mean-of-nodes".into()));
    assert_eq!((&tip["node"], &tip["origin"]), (&45.into(), &"node".into()));
    assert_eq!(tip["position"], serde_json::json!([1.0, 0.31, 0.23]));
    let html = String::from_utf8(place.bytes("x.html")).expect("UTF-8");
    for text in [&ended.out, &html] {
        assert!(text.contains("at (1, 0.31, 0.23)"), "{text}");
        assert!(text.contains(", the mean of its nodes"), "{text}");
    }
}

/// Files of formats that are not read are recognised, whatever they are called and wherever they are given.
#[test]
fn formats_that_are_not_read_are_named() {
    let place = Place::with_brick();
    let mut zip = b"PK\x03\x04".to_vec();
    zip.extend(b"\x14\0\0\0\0\0indices.npy");
    let table = "write the numbers as a table";
    let utf16 = |text: &str| -> Vec<u8> { text.encode_utf16().flat_map(u16::to_le_bytes).collect() };
    let (marked, bare) = (utf16("\u{feff}%%MatrixMarket matrix"), utf16("<Xdmf>"));
    let output2 = b"\x04\0\0\0\x03\0\0\0\x04\0\0\0\x0c\0\0\0\x06\0\0\0";
    let output2_wide = b"\x08\0\0\0\x03\0\0\0\0\0\0\0\x08\0\0\0\x18\0\0\0\x06\0\0\0";
    let ansys = b"\x64\0\0\0\0\0\0\x80\x04\0\0\0\xff\xff\xff\xff";
    let files: [(&str, &[u8], &str, [&str; 2]); 14] = [
        ("shell.txt", &marked, "text in UTF-16", ["write it as UTF-8", "write it as UTF-8"]),
        ("mesh.txt", &bare, "text in UTF-16", ["write it as UTF-8", "write it as UTF-8"]),
        ("K.npz", &zip, "a NumPy archive (.npz)", ["", table]),
        ("K.npy", b"\x93NUMPY\x01\0v\0", "a NumPy array", ["", table]),
        ("K.mat", b"MATLAB 5.0 MAT-file, Platform: GLNXA64", "a MATLAB file of version 7 or older", ["", table]),
        ("deck.inp", b"** by hand\n*NODE, NSET=ALL\n1, 0, 0, 0\n", "an input deck", ["MATRIXSTORAGE", "model.nodes"]),
        ("part.msh", b"$MeshFormat\n4.1 0 8\n", "a Gmsh mesh", ["no assembled matrices", "model.nodes"]),
        ("job.frd", b"    1C\n    1UUSER\n", "a CalculiX result file", ["no assembled matrices", "model.nodes"]),
        (
            "flow.msh",
            b"(1 \"by hand\")\n(2 3)\n(10 (0 1 8 0))\n",
            "a mesh of Fluent",
            ["no assembled matrices", "write it as VTK"],
        ),
        ("wing.bdf", b"$ by hand\nSOL 103\nCEND\nBEGIN BULK\n", "a Nastran deck", ["", ""]),
        ("part.op2", output2, "a file of Nastran's OUTPUT2", ["with pyYeti", "as a dof map with pyYeti"]),
        ("wide.op2", output2_wide, "a file of Nastran's OUTPUT2", ["with pyYeti", "as a dof map with pyYeti"]),
        ("part.full", ansys, "a binary file of Ansys", ["`supel recipe ansys`", "the mapping that HBMAT writes"]),
        ("model.zip", b"PK\x03\x04\x14\0\0\0\0\0model.mtx", "a zip archive", ["unpack it", "unpack it"]),
    ];
    for (name, bytes, found, advice) in files {
        place.write(name, bytes);
        for (flag, other) in
            [("--stiffness", "K.mtx"), ("--mass", "M.mtx"), ("--dofs", "dofs.txt"), ("--nodes", "nodes.csv")]
        {
            let is_matrix = matches!(other, "K.mtx" | "M.mtx");
            let flags: Vec<String> =
                place.model_flags().iter().map(|text| text.replace(&place.text(other), &place.text(name))).collect();
            assert!(flags.contains(&place.text(name)), "{flag}");
            let ended = place.reduce(&flags, FOOT);
            // What is empty here is read, and has not what is wanted of it.
            let advice = advice[usize::from(!is_matrix)];
            if other == "nodes.csv" && advice == "model.nodes" {
                // It is read, and does not fit.
                assert_says(&ended, ExitCode::InputData, &[]);
            } else if advice.is_empty() {
                assert_says(&ended, ExitCode::InputData, &[name]);
            } else {
                assert_says(&ended, ExitCode::InputData, &["E-FORMAT", name, found, "– not read – expected", advice]);
            }
        }
    }
}

#[test]
fn an_output_without_its_folder_names_it() {
    let place = Place::with_brick();
    let flags = place.model_flags();
    let mut args = vec!["reduce".to_owned(), "--output".to_owned(), place.text("no/such/x.supel")];
    args.extend(flags);
    args.extend(FOOT.split_whitespace().map(str::to_owned));
    let ended = supel(&args.iter().map(String::as_str).collect::<Vec<_>>());
    let folder = format!("the folder {} does not exist", place.text("no/such"));
    assert_says(&ended, ExitCode::Io, &["E-FOLDER", "x.supel", &folder]);
}

#[test]
fn text_is_no_superelement_and_is_shown() {
    let place = Place::with_brick();
    place.write("job.toml", b"[model]\nstiffness = \"K.mtx\"\n");
    for command in ["inspect", "verify"] {
        let ended = supel(&[command, &place.text("job.toml")]);
        assert_says(&ended, ExitCode::InputData, &["not a superelement file: found text that begins `[model]`"]);
    }
}

/// A table may have columns named like the cards of a deck.
#[test]
fn a_table_with_a_column_named_grid_is_read() {
    let place = Place::with_brick();
    let dofs = String::from_utf8(place.bytes("dofs.txt")).expect("UTF-8");
    let rows: Vec<String> = dofs.lines().map(|line| line.replace('.', ",")).collect();
    place.write("dofs.txt", format!("grid,component\n{}\n", rows.join("\n")).as_bytes());
    place.reduce(&place.model_flags(), FOOT).expect(ExitCode::Done);
    place.write("dofs.txt", b"GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n");
    assert_says(&place.reduce(&place.model_flags(), FOOT), ExitCode::InputData, &["E-MAP-COUNT", "dofs.txt"]);
}

/// A document was asked for, and nothing else.
#[test]
fn json_and_quiet_go_together() {
    let place = Place::with_brick();
    let ended = place.reduce(&place.model_flags(), &format!("{FOOT} --json --quiet")).expect(ExitCode::Done);
    assert!(ended.out.starts_with('{') && ended.err.is_empty(), "{}", ended.err);
    let ended = supel(&["verify", &place.text("x.supel"), "--json", "-q"]).expect(ExitCode::Done);
    assert!(ended.out.starts_with('{') && ended.err.is_empty(), "{}", ended.err);
}

/// Supports as some programs export them: springs of 1e36 on rows that stay in.
#[test]
fn penalties_are_mentioned() {
    let place = Place::with_brick();
    for row in [1, 2, 3] {
        with_diagonal(&place, "K.mtx", row, "1e36");
    }
    let ended =
        place.reduce(&place.matrix_flags(), "--interface a=rows:30,31,32,90,91,92 --method craig-bampton --modes 5");
    assert!(matches!(ended.code, ExitCode::Done | ExitCode::CheckFailed), "{}{}", ended.out, ended.err);
    let report = place.report("x.report.json");
    let warnings = report["body"]["warnings"].as_array().expect("warnings").clone();
    let penalty = warnings.iter().find(|warning| warning["code"] == "W-PENALTY").expect("a warning");
    let message = penalty["message"].as_str().expect("a text");
    assert!(message.contains("3 rows") && message.contains("at row ") && message.contains("e25 times"), "{message}");
}

/// The mean of the nodes of a patch counts each once; the faces of the mesh tell how far it is from the centroid.
#[cfg(feature = "hdf5")]
#[test]
fn the_origin_of_a_patch_is_told_with_its_distance_from_the_faces() {
    let place = Place::with_example();
    let (job, page) = (place.text("job.toml"), place.text("x.html"));
    let ended = supel(&["reduce", &job, "--html", &page]).expect(ExitCode::Done);
    let report = place.report("bracket.report.json");
    let interfaces = report["body"]["reduction"]["interfaces"].as_array().expect("interfaces");
    let page = String::from_utf8(place.bytes("x.html")).expect("UTF-8");
    for interface in interfaces {
        let at = &interface["at"][0];
        let vector = |value: &serde_json::Value| -> Vec<f64> {
            value.as_array().expect("a vector").iter().map(|x| x.as_f64().expect("a number")).collect()
        };
        let (position, centroid) = (vector(&at["position"]), vector(&at["faces"]["centroid"]));
        let distance = position.iter().zip(&centroid).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
        assert_eq!(at["faces"]["distance"].as_f64(), Some(distance));
        let words = format!("its {} faces", at["faces"]["count"]);
        let summary: String = ended.out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(summary.contains(&words) && page.contains(&words), "{words}: {}", ended.out);
    }
    // A superelement is the same whatever the mesh says of its faces.
    let told = place.bytes("bracket.supel");
    let nodes = supel::input::hdf5::read_nodes(&place.path("bracket.med")).expect("a mesh");
    let mut table = "node,x,y,z\n".to_owned();
    for (label, [x, y, z]) in nodes.labels.iter().zip(&nodes.coordinates) {
        writeln!(table, "{label},{x},{y},{z}").expect("written");
    }
    place.write("nodes.csv", table.as_bytes());
    let text = String::from_utf8(place.bytes("job.toml")).expect("UTF-8").replace("bracket.med", "nodes.csv");
    let labels =
        |group: &str| format!("{:?}", nodes.groups[group].iter().map(|node| nodes.labels[*node]).collect::<Vec<_>>());
    let text = text.replace("\"group:BASE\"", &labels("BASE")).replace("\"group:EYE\"", &labels("EYE"));
    place.write("job.toml", text.as_bytes());
    let ended = supel(&["reduce", &job]).expect(ExitCode::Done);
    assert!(ended.out.contains("the mean of its nodes\n") && !ended.out.contains("centroid"), "{}", ended.out);
    let report = place.report("bracket.report.json");
    assert!(report["body"]["reduction"]["interfaces"][0]["at"][0]["faces"].is_null());
    let (with, without) = (supel_runtime::Superelement::from_bytes(&told), place.superelement("bracket.supel"));
    assert_eq!(with.expect("a superelement").tensors(), without.tensors());
}

/// Cells that refer to nodes that are not there are damage, not a matter of taste.
#[cfg(feature = "hdf5")]
#[test]
fn damaged_cells_are_refused() {
    let place = Place::with_example();
    let file = hdf5_metno::File::open_rw(place.path("bracket.med")).expect("a mesh");
    let mut kinds = Vec::new();
    file.group("ENS_MAA").expect("meshes").groups().expect("meshes").iter().for_each(|mesh| {
        kinds.extend(mesh.groups().expect("steps").iter().filter_map(|step| step.group("MAI").ok()));
    });
    let cells = kinds[0].groups().expect("kinds")[0].dataset("NOD").expect("cells");
    let mut numbers: Vec<i64> = cells.read_raw().expect("numbers");
    numbers[5] = 1_000_000;
    cells.write_raw(&numbers).expect("written");
    drop((cells, kinds, file));
    let ended = supel(&["reduce", &place.text("job.toml")]);
    assert_says(&ended, ExitCode::InputData, &["E-HDF5-INDEX", "entry 5 is 1000000"]);
    assert!(!place.path("bracket.supel").exists());
}

/// A block of bricks that are finer towards y = 0, with its mesh as XDMF; its faces at x = 0 have their centroid at (0, 0.5, 0.25).
#[cfg(feature = "hdf5")]
fn graded_block() -> Place {
    use supel_models::{HexMesh, Material};
    let mesh = HexMesh::structured([3, 4, 2], |[x, y, z]| [2.0 * x, y * y, 0.5 * z], |_| true);
    let place = Place::with(&mesh.assemble(&Material::STEEL_SI));
    let cells = mesh.elements.iter().map(|corners| corners.iter().map(|corner| *corner as usize).collect()).collect();
    place.write("mesh.xdmf", crate::place::xdmf(&mesh.nodes, &[("Hexahedron", cells)]).as_bytes());
    place
}

/// The job of a graded block whose patch at x = 0 has more keys.
#[cfg(feature = "hdf5")]
fn patch_of_block(place: &Place, keys: &str) -> Ended {
    reduced_block(place, "method = \"herting\", modes = { count = 5 }", keys)
}

#[cfg(feature = "hdf5")]
fn reduced_block(place: &Place, reduction: &str, keys: &str) -> Ended {
    let text = format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "mesh.xdmf" }}
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel" }}

[[interface]]
name  = "foot"
nodes = {{ within = {{ plane = {{ point = [0, 0, 0], normal = [1, 0, 0], tolerance = 1e-9 }} }} }}
{keys}
"#
    );
    place.write("job.toml", text.as_bytes());
    supel(&["reduce", &place.text("job.toml")])
}

#[cfg(feature = "hdf5")]
#[test]
fn origin_at_the_centroid_of_faces() {
    let place = graded_block();
    let at = |origin: &str| {
        let ended =
            patch_of_block(&place, &format!("coupling = \"rigid\"\norigin = \"{origin}\"")).expect(ExitCode::Done);
        let at = place.report("x.report.json")["body"]["reduction"]["interfaces"][0]["at"][0].clone();
        let of = |value: &serde_json::Value| [0, 1, 2].map(|axis| value[axis].as_f64().expect("a number"));
        (of(&at["position"]), at["origin"].clone(), ended.out)
    };
    let (mean, origin, _) = at("centroid");
    assert_eq!(origin, "mean-of-nodes");
    // The mean of 0, 1/16, 1/4, 9/16 and 1.
    assert!((mean[1] - 0.375).abs() < 4.0 * f64::EPSILON, "{mean:?}");
    let (area, origin, said) = at("area");
    assert_eq!(origin, "centroid-of-faces");
    for (found, expected) in area.iter().zip([0.0, 0.5, 0.25]) {
        assert!((found - expected).abs() < 16.0 * f64::EPSILON, "{area:?}");
    }
    assert!(said.contains("at (0, 0.5, 0.25), the centroid of its faces"), "{said}");
    assert_says(
        &patch_of_block(&place, "coupling = \"rigid\"\norigin = \"hole\""),
        ExitCode::InputData,
        &["error[E-ORIGIN-FIT]"],
    );
}

/// A superelement of a mean motion passes every check, against its model as well, and modes are counted and enclosed; the report names
/// the coupling.
#[cfg(feature = "hdf5")]
#[test]
fn an_average_is_verified() {
    let place = graded_block();
    let keys = "coupling = \"average\"\nweights = \"area\"\norigin = \"area\"\n[run]\ncertify = \"full\"";
    for method in ["herting", "craig-bampton", "rubin", "macneal", "guyan"] {
        let modes = if method == "guyan" { "" } else { ", modes = { count = 5 }" };
        let tip = "[[interface]]\nname = \"tip\"\ncoupling = \"rigid\"\nnodes = { within = { plane = { point = [2, 0, 0], \
            normal = [1, 0, 0], tolerance = 1e-9 } } }\n";
        let keys = keys.replace("[run]", &format!("{tip}[run]"));
        let ended = reduced_block(&place, &format!("method = \"{method}\"{modes}"), &keys).expect(ExitCode::Done);
        let report = place.report("x.report.json");
        assert_eq!(report["body"]["reduction"]["interfaces"][0]["coupling"], "average");
        let file = place.superelement("x.supel");
        assert_eq!(file.metadata().verification.verdict, supel_runtime::Verdict::Pass, "{method}: {}", ended.out);
        supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    }
    let both = "coupling = \"average\"\n[[interface]]\nname = \"other\"\ncoupling = \"average\"\nnodes = { within = { box = { \
        min = [0, 0, 0], max = [0.1, 0.1, 1] } } }";
    let ended = patch_of_block(&place, both);
    assert_says(&ended, ExitCode::InputData, &["node 1 ux", "\"foot\"", "\"other\"", "take it out of one"]);
    let far = "coupling = \"average\"\nweights = \"area\"";
    let model = "nodes = \"mesh.xdmf\"";
    let text = String::from_utf8(place.bytes("job.toml")).expect("UTF-8");
    place.write("job.toml", text.replace(model, "nodes = \"nodes.csv\"").replace(both, far).as_bytes());
    let ended = supel(&["reduce", &place.text("job.toml")]);
    assert_says(&ended, ExitCode::InputData, &["error[E-PATCH-FACES]", "`weights = \"area\"`"]);
}

/// Weights by area are those that the sizes of the faces give by hand: a quarter of each face for each of its corners.
#[cfg(feature = "hdf5")]
#[test]
fn weights_by_area_are_those_of_the_faces() {
    let place = graded_block();
    let stiffness = || place.superelement("x.supel").tensors().stiffness.clone();
    let keys = |weights: &str| {
        let wall = "nodes = { within = { plane = { point = [2, 0, 0], normal = [1, 0, 0], tolerance = 1e-9 } } }";
        format!("coupling = \"average\"\norigin = [0, 0.5, 0.25]\nweights = {weights}\n[[fixed]]\n{wall}")
    };
    patch_of_block(&place, &keys("\"area\"")).expect(ExitCode::Done);
    let by_area = stiffness();
    patch_of_block(&place, &keys("\"uniform\"")).expect(ExitCode::Done);
    let uniform = stiffness();
    // Nodes at y = 0, 1/16, 1/4, 9/16, 1 and z = 0, 1/4, 1/2; halves of the cells on either side of each.
    let along_y = [1.0, 4.0, 8.0, 12.0, 7.0];
    let weights = [1.0, 2.0, 1.0].map(|along_z: f64| along_y.map(|along_y| along_y * along_z)).concat();
    let labels: Vec<usize> = (0..15).map(|node| 1 + 4 * node).collect();
    let region = "nodes = { within = { plane = { point = [0, 0, 0], normal = [1, 0, 0], tolerance = 1e-9 } } }";
    patch_of_block(&place, &keys(&format!("{weights:?}")));
    let text = String::from_utf8(place.bytes("job.toml")).expect("UTF-8");
    assert!(text.contains(region), "{text}");
    place.write("job.toml", text.replace(region, &format!("nodes = {labels:?}")).as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    let by_hand = stiffness();
    let at_node = || (0..6).flat_map(|i| (0..6).map(move |j| (i, j)));
    let difference = |other: &supel_runtime::Matrix| {
        let size = at_node().fold(0.0f64, |max, at| max.max(by_area[at].abs()));
        at_node().fold(0.0f64, |max, at| max.max((by_area[at] - other[at]).abs())) / size
    };
    // Weights are the same but for the rounding of areas, which conditions of some 1e4 enlarge.
    assert!(difference(&by_hand) < 1e4 * 100.0 * f64::EPSILON, "{:e}", difference(&by_hand));
    assert!(difference(&uniform) > 1e-3, "{:e}", difference(&uniform));
}

/// An average over faces with nodes in the middles of their edges says that equal weights are poor, unless the job names its weights.
#[cfg(feature = "hdf5")]
#[test]
fn equal_weights_of_quadratic_faces() {
    use crate::place::{bricks_of_27, bricks_of_eight, xdmf};
    let model = crate::place::steel_brick();
    let place = Place::with(&model);
    let warned = |keys: &str| {
        patch_of_block(&place, keys).expect(ExitCode::Done);
        let warnings = place.report("x.report.json")["body"]["warnings"].as_array().expect("warnings").clone();
        let ours = warnings.into_iter().find(|warning| warning["code"] == "W-WEIGHTS");
        ours.map(|warning| warning["message"].as_str().expect("words").to_owned())
    };
    place.write("mesh.xdmf", xdmf(&model.nodes, &[bricks_of_27()]).as_bytes());
    let said = warned("coupling = \"average\"").expect("a warning");
    assert!(said.starts_with("interface \"foot\":") && said.contains("weights = \"area\""), "{said}");
    assert!(warned("coupling = \"average\"\norigin = [0, 0, 0]").is_some(), "wherever the node sits");
    for keys in ["weights = \"area\"", "weights = \"uniform\""] {
        assert_eq!(warned(&format!("coupling = \"average\"\n{keys}")), None, "{keys}");
    }
    assert_eq!(warned("coupling = \"rigid\""), None, "a rigid patch has no weights");
    place.write("mesh.xdmf", xdmf(&model.nodes, &[bricks_of_eight()]).as_bytes());
    assert_eq!(warned("coupling = \"average\""), None, "corners alone");
}

/// What is below a limit as it is printed is below it: a step of the largest explicit one in the summary is stable.
#[test]
fn the_largest_explicit_step_is_not_rounded_up() {
    for stiffness in [1e3, 2e3, 3e3, 4e3, 5e3, 7e3] {
        let place = Place::with(&springs(&[1.0, 2.0, 1.0], &[(0, stiffness)], &[(0, 1, stiffness), (1, 2, stiffness)]));
        let text = "model = { stiffness = \"K.mtx\", mass = \"M.mtx\" }\n\
             interface = [{ name = \"end\", nodes = { rows = [0] } }]\n\
             reduction = { method = \"craig-bampton\", modes = { count = 1 } }\n\
             write = { superelement = \"x.supel\" }\n";
        place.write("job.toml", text.as_bytes());
        let said = supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done).out;
        let limit = &place.report("x.report.json")["body"]["preservation"]["highest"]["explicit_step_s"];
        let limit = limit.as_f64().expect("a step");
        let printed = said.split("explicit steps below ").nth(1).and_then(|rest| rest.split(' ').next());
        let printed: f64 = printed.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{said}"));
        assert!(printed <= limit && printed > 0.9 * limit, "{printed:e} for {limit:e}");
    }
}

/// Triplets without a size, of which those of the mass end early: what is left of it is half of the component.
#[test]
fn a_mass_that_ends_before_its_elements_do() {
    let place = Place::with_brick();
    let mass = entries(&place, "M.mtx");
    let expected = format!("expect = {{ mass = {} }}", 0.31 * 0.23 * Material::STEEL_SI.density);
    let said = |last: usize, expect: &str| {
        let mut text = String::new();
        for (row, col, value) in mass.iter().filter(|(row, col, _)| (*row).max(*col) <= last) {
            writeln!(text, "{row} {col} {value}").expect("written");
        }
        place.write("M.txt", text.as_bytes());
        let job = format!(
            "[model]\nstiffness = \"K.mtx\"\nmass = \"M.txt\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n{expect}\n\
             [[interface]]\nname = \"foot\"\nnodes = [1, 11, 31, 41]\n\
             [reduction]\nmethod = \"craig-bampton\"\nmodes = {{ count = 3 }}\n[write]\nsuperelement = \"x.supel\"\n"
        );
        place.write("job.toml", job.as_bytes());
        let ended = supel(&["reduce", &place.text("job.toml")]);
        (ended.code, warnings_of_reduction(&place.report("x.report.json")))
    };
    let warned = vec!["W-MASS-ENDS".to_owned()];
    assert_eq!(said(135, ""), (ExitCode::Done, Vec::new()));
    // The last node, whose neighbours have mass, may be one that a spring holds.
    assert_eq!(said(132, ""), (ExitCode::Done, Vec::new()));
    assert_eq!(said(60, ""), (ExitCode::Done, warned));
    // What the job expects is compared.
    assert_eq!(said(135, &expected), (ExitCode::Done, Vec::new()));
    let (code, warnings) = said(60, &expected);
    assert!(code == ExitCode::CheckFailed && !warnings.contains(&"W-MASS-ENDS".to_owned()), "{code:?} {warnings:?}");
}
