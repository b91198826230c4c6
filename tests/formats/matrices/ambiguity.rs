//! A file whose content fits two formats.

use supel::error::Error;
use supel::input::read;
use supel::job::{Layout, ModelJob};

use super::{fixture, job, pair, stiffness};

/// The title of a Harwell-Boeing file may be anything, the start of a DMIG entry for instance.
#[test]
fn the_candidates_are_listed_and_a_layout_decides() {
    let text = std::fs::read_to_string(fixture("k.rsa")).expect("a fixture");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.txt");
    std::fs::write(&path, text.replacen("Stiffness matrix", "DMIG    K2GG    ", 1)).expect("written");
    let error = read(&job(&path, &fixture("m.mtx"))).expect_err("two formats");
    assert!(
        matches!(&error, Error::FormatAmbiguous { formats, .. } if formats == &["dmig", "harwell-boeing"]),
        "{error}"
    );
    assert!(error.to_string().contains("--layout dmig"), "{error}");
    let read_as = |layout| read(&ModelJob { layout: Some(layout), ..job(&path, &path) });
    let reference = pair("k.mtx", "k.mtx").expect("the reference");
    let input = read_as(Layout::HarwellBoeing).expect("as it is named");
    assert!(input.stiffness.matrix == reference.stiffness.matrix);
    assert!(read_as(Layout::Dmig).is_err());
}

/// A format that is named reads nothing else.
#[test]
fn a_layout_overrides_what_the_content_says() {
    let path = fixture("k.mtx");
    for layout in [Layout::Op4, Layout::Npz, Layout::Npy, Layout::Matlab5, Layout::HarwellBoeing, Layout::AbaqusLabels]
    {
        assert!(read(&ModelJob { layout: Some(layout), ..job(&path, &path) }).is_err(), "{layout:?}");
    }
    assert!(read(&ModelJob { layout: Some(Layout::MatrixMarket), ..job(&path, &path) }).is_ok());
}

/// What a second run appends to a file has the names of the first.
#[test]
fn of_two_matrices_with_one_name_none_is_taken() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, member) in [("dense_text.op4", "KAA"), ("dense_little.op4", "KAA")] {
        let mut content = std::fs::read(fixture(name)).expect("a fixture");
        content.extend_from_within(..);
        std::fs::write(folder.path().join(name), content).expect("written");
        for named in [name.to_owned(), format!("{name}:{member}")] {
            let error = stiffness(&folder.path().join(named)).expect_err("two matrices");
            assert!(matches!(&error, Error::MatrixNameTwice { name, n: 2, .. } if name == member), "{error}");
        }
    }
}
