//! Decks of Nastran: how they are recognised, what they include, and where they end.

use std::path::Path;

use supel::error::{Error, Result};
use supel::input::{Allowance, ReadSingle, SingleMatrix, digest_with_included};

use crate::meshes::Folder;

/// K = [2 −1; −1 3] at one grid point: its head, its first column and its second one.
const HEAD: &str = "DMIG,K,0,6,2,0\nDMIG,K,1,1,,1,1,2.0\n";
const SECOND: &str = "DMIG,K,1,2,,1,2,3.\n,1,1,-1.\n";

fn read(file: &Path, dofs: Option<&Path>) -> Result<ReadSingle> {
    let matrix = SingleMatrix { file: file.to_owned(), layout: None, dofs: dofs.map(Path::to_owned) };
    matrix.read(&Allowance::of(None))
}

#[track_caller]
fn assert_whole(deck: &Path) {
    let read = read(deck, None).unwrap_or_else(|error| panic!("{error}"));
    let entries = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(row, col)| read.input.matrix.get(row, col).copied());
    assert_eq!(entries, [2.0, -1.0, -1.0, 3.0].map(Some), "{:?}", std::fs::read_to_string(deck));
}

#[test]
fn decks_are_recognised_by_what_they_begin_with() {
    let folder = Folder::new();
    for begin in [
        "",
        "$ a comment\n\n",
        "\u{feff}",
        "ASSIGN OUTPUT4='part.op4', UNIT=51, FORM=UNFORMATTED, DELETE\nSOL 103\nCEND\nBEGIN BULK\n",
        "NASTRAN SYSTEM(1)=2\nSOL 103\nCEND\nBEGIN BULK\n",
        "INIT MASTER(S)\nSOL 103\nCEND\nBEGIN BULK\n",
        "ID A,B\nTIME 600\nSOL 103\nCEND\nTITLE = A\nBEGIN BULK\n",
        "SOL 103\nCEND\nBEGIN BULK\n",
        "BEGIN BULK\n",
        "PARAM,POST,-1\n",
        "GRDSET,,,,,,,456\n",
        "SPOINT,10,11\n",
        "CORD2R,1\n",
        "MAT1    1       2.1+11          .3\n",
        &"$ nothing but a comment, for longer than formats are recognised by\n".repeat(100),
    ] {
        assert_whole(&folder.write("deck.bdf", format!("{begin}{HEAD}{SECOND}ENDDATA\n")));
    }
}

#[test]
fn decks_go_on_in_the_files_that_they_include() {
    let folder = Folder::new();
    folder.write("parts/second.bdf", SECOND);
    folder.write("nested.bdf", "include \"parts/second.bdf\" $ behind\n");
    let plain = folder.write("plain.bdf", format!("{HEAD}{SECOND}"));
    for include in [
        "INCLUDE 'parts/second.bdf'\n",
        "INCLUDE 'parts/\n         second.bdf'\n",
        "INCLUDE parts/second.bdf\n",
        "INCLUDE 'parts\\second.bdf'\n",
        "INCLUDE 'nested.bdf'\n",
    ] {
        let deck = folder.write("deck.bdf", format!("{HEAD}{include}ENDDATA\n"));
        assert_whole(&deck);
        let before = digest_with_included(&deck).expect("a digest");
        assert_eq!(before, read(&deck, None).expect("a matrix").input.digest);
        folder.write("parts/second.bdf", SECOND.replace("3.", "4."));
        assert_ne!(before, digest_with_included(&deck).expect("a digest"), "what is included counts");
        folder.write("parts/second.bdf", SECOND);
    }
    assert_eq!(
        digest_with_included(&plain).expect("a digest"),
        blake3::hash(&std::fs::read(&plain).expect("a file")).to_hex().as_str()
    );
    // The rows of a deck, of which one grid point is in another file.
    folder.write("grids.bdf", "GRID,9,,0.,0.,0.\n");
    let rows = folder.write("rows.bdf", "GRID,1,,0.,0.,0.\nINCLUDE 'grids.bdf'\nENDDATA\nGRID,5,,0.,0.,0.\n");
    let dofs = read(&plain, Some(&rows)).expect("rows of two grid points").dofs.expect("a dof map");
    assert_eq!(dofs.iter().flatten().map(|dof| dof.node).collect::<Vec<_>>(), [[1; 6], [9; 6]].concat());
}

#[test]
fn no_deck_includes_a_file_outside_its_folder_or_itself() {
    let folder = Folder::new();
    folder.write("second.bdf", SECOND);
    for (reference, words) in [
        ("../second.bdf", "outside its folder"),
        ("..\\second.bdf", "outside its folder"),
        ("\\second.bdf", "outside its folder"),
        ("C:\\second.bdf", "outside its folder"),
        ("LOGICAL:second.bdf", "outside its folder"),
        ("absent.bdf", "which is not there"),
        ("deck.bdf", "by 16 files that include each other – expected files that do not include themselves"),
    ] {
        let deck = folder.write("decks/deck.bdf", format!("BEGIN BULK\n$\nINCLUDE '{reference}'\n{HEAD}"));
        let error = read(&deck, None).err().unwrap_or_else(|| panic!("{reference} was read"));
        assert!(matches!(error, Error::DeckInclude { line: 3, .. }), "{error}");
        assert!(error.to_string().contains(words), "{error}");
    }
    // A fault is told where it is.
    folder.write("decks/part.bdf", "$\nDMIG,K,1,2,,1,2,x\n");
    let deck = folder.write("decks/deck.bdf", format!("{HEAD}INCLUDE 'part.bdf'\n"));
    let error = read(&deck, None).expect_err("no number").to_string();
    assert!(error.contains("part.bdf") && error.contains("line 2"), "{error}");
}

/// Nastran reads nothing behind ENDDATA.
#[test]
fn decks_end_at_enddata() {
    let folder = Folder::new();
    for end in ["ENDDATA", "enddata", "  ENDDATA $ the end"] {
        assert_whole(&folder.write("deck.bdf", format!("{HEAD}{SECOND}{end}\nDMIG,K,1,2,,1,2,77.\n")));
    }
    folder.write("end.bdf", format!("{SECOND}ENDDATA\n"));
    assert_whole(&folder.write("deck.bdf", format!("{HEAD}INCLUDE 'end.bdf'\nDMIG,K,1,2,,1,2,77.\n")));
}

/// Nastran reads nothing behind a dollar, in whatever fields.
#[test]
fn comments_behind_fields_are_passed_over() {
    let folder = Folder::new();
    for deck in [
        "DMIG,K,0,6,2,0 $ head\nDMIG,K,1,1,,1,1,2.0 $ the first, of two\nDMIG,K,1,2,,1,2,3.$\n  $ between\n,1,1,-1.,$ last\n".to_owned(),
        format!(
            "{}{}{}{}",
            small(&["DMIG", "K", "0", "6", "2", "0", "$ head"]),
            small(&["DMIG", "K", "1", "1", "", "1", "1", "2.0$", "short"]),
            small(&["DMIG", "K", "1", "2", "", "1", "2", "3.", "", "$ next"]),
            small(&["", "1", "1", "-1.", "$ a comment that goes on for more than a field"]),
        ),
        "DMIG*   K                              0               6               2 $\nDMIG*   K                              1               1 $ column\n\
         *                      1               1 2.0$\n$\nDMIG*   K                              1               2\n\
         *                      1               2 3. $ value\n*                      1               1 -1. $\n"
            .to_owned(),
    ] {
        assert_whole(&folder.write("deck.bdf", deck));
    }
    let grid = "GRID,1,,0.,0.,0.,40 $ ,9\nCORD2R,40,,0.,0.,0.,0.,0.,1. $ ,9\n,1.,0.,0.$\n";
    let rows = folder.write("rows.bdf", format!("{grid}SPOINT,7 $ ,8\n"));
    assert_eq!(
        read(&folder.write("deck.bdf", format!("{HEAD}{SECOND}")), Some(&rows)).expect("rows").input.matrix.rows(),
        7
    );
}

/// A card of fields of eight columns.
fn small(fields: &[&str]) -> String {
    fields.iter().map(|field| format!("{field:<8}")).collect::<String>() + "\n"
}

/// Names of continuations that no line has say nothing, in a head neither.
#[test]
fn names_of_continuations_that_nothing_has_are_passed_over() {
    let folder = Folder::new();
    let head = small(&["DMIG", "K", "0", "6", "2", "0", "", "", "", "+HEAD"]);
    let first = small(&["DMIG", "K", "1", "1", "", "1", "1", "2.", "", "+FIRST"]);
    assert_whole(&folder.write("deck.bdf", format!("{head}{first}{SECOND}")));
}

/// A tab fills up to the next field, in every line of a deck.
#[test]
fn decks_with_tabs_are_those_with_blanks() {
    let folder = Folder::new();
    let small = "DMIG\tK\t0\t6\t2\t0\nDMIG\tK\t1\t1\t\t1\t1\t2.\nDMIG\tK\t1\t2\t\t1\t2\t3.\n\t1\t1\t-1.\n";
    let by_eight = "DMIG*\tK\t\t1\t\t1\n*\t1\t\t1\t\t2.\nDMIG*\tK\t\t1\t\t2\n*\t1\t\t2\t\t3.\n*\t1\t\t1\t\t-1.\n";
    let by_fields = "DMIG*\tK\t1\t1\n*\t1\t1\t2.\nDMIG*\tK\t1\t2\n*\t1\t2\t3.\n*\t1\t1\t-1.\n";
    let head = "DMIG\tK\t0\t6\t2\t0\n";
    let rows = folder.write("rows.bdf", "GRID\t1\t\t0.\t0.\t0.\nSPOINT\t7\t8\nGRID\t9\t\t0.\t0.\t1.\n");
    for text in [small.to_owned(), format!("{head}{by_eight}"), format!("{head}{by_fields}")] {
        let deck = folder.write("deck.bdf", format!("SOL\t103\nCEND\nBEGIN BULK\n{text}"));
        assert_whole(&deck);
        let deck = folder.write("deck.bdf", text);
        assert_whole(&deck);
        let dofs = read(&deck, Some(&rows)).expect("rows of two grid points").dofs.expect("a dof map");
        assert_eq!(dofs.iter().flatten().map(|dof| dof.node).collect::<Vec<_>>(), [[1; 6], [9; 6]].concat());
    }
}

/// A line continues the one before it. Where names say that it belongs to another one, nothing is read.
#[test]
fn continuations_belong_to_the_line_before_them() {
    let folder = Folder::new();
    let first = |next| small(&["DMIG", "K", "1", "1", "", "1", "1", "4.", "", next]);
    let column = |next| small(&["DMIG", "K", "2", "1", "", "2", "1", "5.", "", next]);
    let more = |name| small(&[name, "2", "1", "-1."]);
    let free = "DMIG,K,1,1,,1,1,4.,,+A1\n";
    let large = "DMIG*   K                              1               1                *C1\n\
                 *C2                    1               1 4.\n";
    let written = |cards: &[String]| folder.write("k.bdf", format!("DMIG,K,0,6,1\n{}", cards.concat()));
    let kept = |next, name| [first(next), more(name), column("")];
    let mut decks: Vec<Vec<String>> = [("+A1", "+A1"), ("", ""), ("+", "+"), ("", "+A1"), ("+A1", ""), ("+A1", "+")]
        .map(|(a, b)| kept(a, b).to_vec())
        .to_vec();
    decks.push(vec![free.into(), "+A1,2,1,-1.\n".into(), column("")]);
    decks.push(vec![first("+A1"), more("+A1"), column("+UNUSED")]);
    decks.push(vec![first("+A1"), small(&["+A1", "2", "1", "-1.", "", "", "", "", "", "+UNUSED"]), column("")]);
    decks.push(vec![first("+A1"), "$\n\n".into(), more("+A1"), column("")]);
    for cards in decks {
        let entries = read(&written(&cards), None).unwrap_or_else(|error| panic!("{cards:?}: {error}")).input.matrix;
        assert_eq!(
            [(0, 0), (0, 1), (1, 1)].map(|(row, col)| entries.get(row, col).copied()),
            [Some(4.0), Some(-1.0), Some(5.0)]
        );
    }
    for (cards, line) in [
        (vec![first("+A1"), column(""), more("+A1")], 2),
        (vec![more("+A1"), first("+A1"), column("")], 3),
        (vec![first("+A1"), column("+B1"), more("+A1")], 2),
        (vec![first("+A1"), more("+ZZ"), column("")], 3),
        (vec![free.into(), column(""), "+A1,2,1,-1.\n".into()], 2),
        (vec![large.into(), column("")], 3),
        (vec![first("+A1"), small(&["GRID", "7", "", "", "", "", "", "", "", "+a1"]), more("+a1"), column("")], 2),
    ] {
        let error = read(&written(&cards), None).expect_err("a continuation of another line").to_string();
        assert!(
            error.contains(&format!("line {line}")) && error.contains("write them behind their entries"),
            "{error}"
        );
    }
}
