//! Outputs that would be written over something, or that have no place.

use supel::cli::ExitCode;

use crate::place::{Ended, Place, steel_brick, supel};

const JOB: &str = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }
interface = [{ name = "foot", nodes = [1, 11, 31, 41] }]
reduction = { method = "herting", modes = { count = 4 } }
write     = { superelement = "x.supel" }
"#;

/// A brick whose files have names that outputs may have too.
fn place() -> Place {
    let place = Place::with(&steel_brick());
    for (file, name) in
        [("K.mtx", "K.supel"), ("M.mtx", "M.html"), ("dofs.txt", "dofs.xml"), ("nodes.csv", "nodes.json")]
    {
        std::fs::rename(place.path(file), place.path(name)).expect("renamed");
    }
    let job = JOB.replace("K.mtx", "K.supel").replace("M.mtx", "M.html").replace("dofs.txt", "dofs.xml");
    place.write("job.toml", job.replace("nodes.csv", "nodes.json").as_bytes());
    place
}

/// Everything in the folder, to see that nothing was touched.
fn contents(place: &Place) -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(place.path("")).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    let mut files: Vec<(String, Vec<u8>)> =
        names.filter(|name| place.path(name).is_file()).map(|name| (name.clone(), place.bytes(&name))).collect();
    files.sort();
    files
}

#[track_caller]
fn refused(place: &Place, args: &[&str], code: &str, parts: &[&str]) -> Ended {
    let before = contents(place);
    let ended = supel(args).expect(ExitCode::Usage);
    assert!(ended.err.starts_with(&format!("supel: error[{code}]: ")), "{}", ended.err);
    assert!(parts.iter().all(|part| ended.err.contains(part)), "{}", ended.err);
    assert!(contents(place) == before, "{args:?}: a file was changed");
    ended
}

/// Each input under its own name, through a link to it, as another name of it, and through a link to its folder.
#[cfg(unix)]
#[test]
fn an_output_that_is_an_input() {
    let place = place();
    std::os::unix::fs::symlink(place.path(""), place.path("folder")).expect("a link");
    let job = place.text("job.toml");
    let json = supel(&["reduce", &job]).expect(ExitCode::Done);
    assert!(json.err.is_empty());
    let shown = supel(&["inspect", &place.text("x.supel"), "--job"]).out;
    place.write("job.json", shown.as_bytes());
    for (flag, input, role) in [
        ("--output", "K.supel", "the stiffness"),
        ("--html", "M.html", "the mass"),
        ("--junit", "dofs.xml", "the dof map"),
        ("--report", "nodes.json", "the nodes"),
        ("--report", "job.json", "the job document"),
    ] {
        let ending = input.rsplit_once('.').expect("an ending").1;
        let (link, twin) = (format!("link.{ending}"), format!("twin.{ending}"));
        std::os::unix::fs::symlink(place.path(input), place.path(&link)).expect("a link");
        std::fs::hard_link(place.path(input), place.path(&twin)).expect("a name");
        for name in [input, &link, &twin, &format!("folder/{input}"), &format!("../{}/{input}", folder_name(&place))] {
            let path = place.text(name);
            // The message names the real folder.
            let real = if name.contains('/') { place.text(input) } else { path.clone() };
            refused(&place, &["reduce", &place.text("job.json"), flag, &path], "E-OVERWRITE", &[role, &real]);
        }
        std::fs::remove_file(place.path(&link)).expect("removed");
        std::fs::remove_file(place.path(&twin)).expect("removed");
    }
    supel(&["reduce", &place.text("job.json")]).expect(ExitCode::Done);
}

fn folder_name(place: &Place) -> String {
    let path = place.path("x");
    path.parent().and_then(|folder| folder.file_name()).expect("a name").to_string_lossy().into_owned()
}

/// The data file that a mesh refers to is an input as much as the mesh.
#[cfg(all(unix, feature = "hdf5"))]
#[test]
fn an_output_that_is_the_data_of_a_mesh() {
    let place = place();
    let text = "<Xdmf><Domain><Grid><Geometry GeometryType=\"XYZ\"><DataItem Format=\"HDF\" Dimensions=\"45 3\">data.supel:/x\
                </DataItem></Geometry></Grid></Domain></Xdmf>";
    place.write("mesh.xdmf", text.as_bytes());
    place.write("data.supel", b"data");
    let (job, mesh, path) = (place.text("job.toml"), place.text("mesh.xdmf"), place.text("data.supel"));
    refused(
        &place,
        &["reduce", &job, "--nodes", &mesh, "--output", &path],
        "E-OVERWRITE",
        &["the data of the nodes", &path],
    );
}

/// Names must differ in their endings, so that only links make two outputs one.
#[cfg(unix)]
#[test]
fn two_outputs_that_are_one_file() {
    let place = place();
    place.write("x.html", b"old");
    std::os::unix::fs::symlink(place.path("x.html"), place.path("x.xml")).expect("a link");
    let (job, html, junit) = (place.text("job.toml"), place.text("x.html"), place.text("x.xml"));
    refused(
        &place,
        &["reduce", &job, "--html", &html, "--junit", &junit],
        "E-OUTPUT-TWICE",
        &["write.html", "write.junit"],
    );
}

#[test]
fn a_folder_in_the_place_of_an_output() {
    let place = place();
    for (flag, name) in [("--output", "a.supel"), ("--report", "a.json"), ("--html", "a.html"), ("--junit", "a.xml")] {
        std::fs::create_dir(place.path(name)).expect("a folder");
        let ended = supel(&["reduce", &place.text("job.toml"), flag, &place.text(name)]).expect(ExitCode::Io);
        assert!(ended.err.starts_with("supel: error[E-OUTPUT-KIND]: "), "{}", ended.err);
        assert!(ended.err.contains(&place.text(name)), "{}", ended.err);
    }
}
