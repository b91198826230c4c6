//! Decks of Abaqus and CalculiX.

use supel::error::Error;
use supel::input::Faces;

use super::{Folder, faces, group, read, read_text, refused};

/// Two bricks of 8 nodes, one above the other, 1 × 1 × 2.
const BRICKS: &str = "\
*HEADING
anything, * here
** a comment
*Node, NSET=All
1, 0, 0, 0
2, 1., 0.0, 0
3, 1d0, 1, 0
4, , 1
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
11, 0, 0, 2, 7.5, 1
12, 1, 0, 2
13, 1, 1, 2
14, 0, 1, 2
*ELEMENT, type=C3D8R,
 elset=Body
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 5, 6, 7, 8,
   11, 12, 13, 14
";

fn bricks_with(lines: &str) -> supel::error::Result<supel::dofs::Nodes> {
    read_text("deck.inp", format!("{BRICKS}{lines}"))
}

#[test]
fn nodes_elements_and_sets() {
    let nodes = bricks_with(
        "*NSET, NSET=low, GENERATE\n1, 4, 1\n*nset,nset=low\n 5,\n*NSET, NSET=\"odd, name\", GENERATE\n1, 99, 2\n\
         *NSET, NSET=both\nLOW, \"odd, name\", 14\n*ELSET, ELSET=TOP\n2\n*NSET, NSET=of top, ELSET=top\n\
         *ELSET, ELSET=low\n1\n*ELSET, ELSET=each, GENERATE\n1, 1000000000000, 1\n*NSET, NSET=none\n77\n",
    )
    .expect("a deck");
    assert_eq!(nodes.labels, [1, 2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14]);
    assert_eq!(nodes.coordinates[2..4], [[1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(nodes.coordinates[8], [0.0, 0.0, 2.0]);
    assert_eq!(group(&nodes, "All").len(), 12);
    assert_eq!(group(&nodes, "low"), [1, 2, 3, 4, 5]);
    assert_eq!(group(&nodes, "odd, name"), [1, 3, 5, 7, 11, 13]);
    assert_eq!(group(&nodes, "both"), [1, 2, 3, 4, 5, 7, 11, 13, 14]);
    assert_eq!(group(&nodes, "of top"), [5, 6, 7, 8, 11, 12, 13, 14]);
    // A set of elements next to a set of other nodes of its name.
    assert_eq!(group(&nodes, "low (elements)"), [1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(group(&nodes, "TOP"), group(&nodes, "of top"));
    assert_eq!(group(&nodes, "each"), nodes.labels);
    assert!(!nodes.groups.contains_key("none"), "no node has the label");
}

/// Sets and surfaces of an assembly have members in several instances and of its own; sets of a part are told apart from them.
#[test]
fn sets_of_an_assembly_reach_over_its_instances() {
    let part = |name: &str, first: i64, sets: &str| {
        let node = |at: i64, point: &str| format!("{}, {point}\n", first + at);
        let nodes = [node(0, "0, 0, 0"), node(1, "1, 0, 0"), node(2, "0, 1, 0"), node(3, "0, 0, 1")].concat();
        let corners = (first..first + 4).map(|label| label.to_string()).collect::<Vec<_>>().join(", ");
        format!("*PART, NAME={name}\n*NODE\n{nodes}*ELEMENT, TYPE=C3D4\n{first}, {corners}\n{sets}*END PART\n")
    };
    let deck = part("P", 1, "*NSET, NSET=HUB\n1, 2\n")
        + &part("Q", 11, "*NSET, NSET=ONLYQ\n11, 12\n")
        + "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n*END INSTANCE\n*INSTANCE, NAME=Q-1, PART=Q\n*END INSTANCE\n\
           *NODE\n101, 5, 5, 5\n\
           *NSET, NSET=Both, INSTANCE=P-1\n1,\n*NSET, NSET=BOTH, INSTANCE=Q-1\n11,\n\
           *NSET, NSET=MIXED\nP-1.3, Q-1.14, 101\n*NSET, NSET=OFQ\nQ-1.ONLYQ, 101\n*NSET, NSET=OFBOTH\nMIXED, BOTH\n\
           *NSET, NSET=HUB, INSTANCE=P-1\n3,\n\
           *ELSET, ELSET=_S_S1, INTERNAL, INSTANCE=P-1\n1,\n*ELSET, ELSET=_S_S1, INTERNAL, INSTANCE=Q-1\n11,\n\
           *NSET, NSET=ALL, ELSET=_S_S1\n*SURFACE, NAME=S\n_S_S1, S1\n*SURFACE, NAME=T\nQ-1.11, S1\n\
           *SURFACE, NAME=U, COMBINE=UNION\nS, T\n*END ASSEMBLY\n";
    let nodes = read_text("assembly.inp", deck).expect("a deck");
    for (name, expected) in [
        ("Both", &[1i64, 11][..]),
        ("MIXED", &[3, 14, 101]),
        ("OFQ", &[11, 12, 101]),
        ("OFBOTH", &[1, 3, 11, 14, 101]),
        ("HUB", &[3]),
        ("P-1.HUB", &[1, 2]),
        ("ALL", &[1, 2, 3, 4, 11, 12, 13, 14]),
        ("S", &[1, 2, 3, 11, 12, 13]),
        ("T", &[11, 12, 13]),
        ("U", &[1, 2, 3, 11, 12, 13]),
    ] {
        assert_eq!(group(&nodes, name), expected, "{name}");
    }
}

#[test]
fn surfaces_are_groups_of_the_nodes_on_their_faces() {
    let nodes = bricks_with(
        "*ELSET, ELSET=TOP\n2\n*NSET, NSET=N\n1,2\n*SURFACE, NAME=UP, TYPE=ELEMENT\nTOP, S2\n*SURFACE, NAME=SIDE\n1, S3\n2, s3\n\
         *SURFACE, NAME=POINTS, TYPE=NODE\nN, 1.\n3\n*SURFACE, NAME=SKIN\nBody,\n*SURFACE, NAME=UNION, COMBINE=UNION\nUP, SIDE\n\
         *SURFACE, NAME=N\n2, S2\n",
    )
    .expect("a deck");
    assert_eq!(group(&nodes, "UP"), [11, 12, 13, 14]);
    assert_eq!(group(&nodes, "SIDE"), [1, 2, 5, 6, 11, 12]);
    assert_eq!(group(&nodes, "POINTS"), [1, 2, 3]);
    assert_eq!(group(&nodes, "SKIN").len(), 12, "every node of two bricks is outside");
    assert_eq!(group(&nodes, "N (surface)"), [11, 12, 13, 14]);
    assert_eq!(group(&nodes, "UNION"), [1, 2, 5, 6, 11, 12, 13, 14]);

    // A brick of twenty nodes has eight on each face.
    let numbered = (1..=20).map(|label| format!("{label}, {label}, 0, 0\n")).collect::<String>();
    let brick = (1..=20).map(|label| label.to_string()).collect::<Vec<_>>().join(", ");
    let deck = format!("*NODE\n{numbered}*ELEMENT, TYPE=C3D20R\n1, {brick}\n*SURFACE, NAME=UP\n1, S2\n");
    assert_eq!(group(&read_text("quadratic.inp", deck).expect("a deck"), "UP"), [5, 6, 7, 8, 13, 14, 15, 16]);
}

/// Faces of patches come from the cells of the deck.
#[test]
fn faces_of_a_patch() {
    let folder = Folder::new();
    let deck =
        folder.write("deck.inp", format!("{BRICKS}*SURFACE, NAME=UP\n2, S2\n*SURFACE, NAME=SIDE\n1, S3\n2, S3\n"));
    let Some(Faces::Known { faces: found, centroid, areas }) = faces(&deck, "SIDE").expect("faces") else {
        panic!("no faces")
    };
    assert_eq!(found.len(), 2);
    let off = [centroid[0] - 0.5, centroid[1], centroid[2] - 1.0, areas.iter().sum::<f64>() - 2.0];
    // Sums of a few products.
    assert!(off.iter().all(|off| off.abs() <= 16.0 * f64::EPSILON), "{off:?}");
    let deck = folder
        .write("odd.inp", format!("{BRICKS}*ELEMENT, TYPE=U7, ELSET=own\n9, 1, 2\n*NSET,NSET=low,GENERATE\n1,4\n"));
    let Some(Faces::Unknown { reason }) = faces(&deck, "low").expect("faces") else { panic!("faces of unknown cells") };
    assert!(reason.ends_with("elements of type U7"), "{reason}");
    assert_eq!(group(&read(&deck).expect("a deck"), "own"), [1, 2]);
}

/// Nodes in cylindrical coordinates, and elements that break their lines without a comma.
#[test]
fn coordinates_and_line_breaks_of_both_programs() {
    let deck = "*NODE, SYSTEM=C\n1, 2, 90, 5\n*NODE, SYSTEM=S\n2, 2, 90, 90\n*NODE\n3, 1, 1, 1\n4, 0, 0, 1\n*ELEMENT, TYPE=C3D4, ELSET=E\n7, 1, 2\n3, 4\n";
    let nodes = read_text("deck", deck).expect("a deck");
    let expected = [[0.0, 2.0, 5.0], [0.0, 0.0, 2.0], [1.0; 3], [0.0, 0.0, 1.0]];
    for (found, expected) in nodes.coordinates.iter().flatten().zip(expected.iter().flatten()) {
        // Sine and cosine of a right angle, times 2.
        assert!((found - expected).abs() <= 4.0 * f64::EPSILON, "{nodes:?}");
    }
    assert_eq!(group(&nodes, "E"), [1, 2, 3, 4]);
}

#[test]
fn parts_and_instances_are_put_together() {
    let part = "*PART, NAME=P\n*NODE\n1, 1, 0, 0\n2, 2, 0, 0\n*NSET, NSET=ENDS\n1, 2\n*END PART\n";
    let turned = "*INSTANCE, NAME=I, PART=p\n0, 0, 3\n0, 0, 0, 0, 0, 1, 90.\n*END INSTANCE\n";
    let assembly = format!(
        "{part}*ASSEMBLY, NAME=A\n{turned}*NODE\n9, 5, 5, 5\n*NSET, NSET=tip, INSTANCE=i\n2\n*NSET, NSET=ref\n9\n*END ASSEMBLY\n"
    );
    let nodes = read_text("deck.inp", &assembly).expect("a deck");
    assert_eq!(nodes.labels, [1, 2, 9]);
    for (found, expected) in nodes.coordinates.iter().flatten().zip([0.0, 1.0, 3.0, 0.0, 2.0, 3.0, 5.0, 5.0, 5.0]) {
        assert!((found - expected).abs() <= 4.0 * f64::EPSILON, "{nodes:?}");
    }
    assert_eq!((group(&nodes, "ENDS"), group(&nodes, "tip"), group(&nodes, "ref")), (vec![1, 2], vec![2], vec![9]));
    // Rows of matrices cannot tell node 1 of one instance from that of another.
    let twice = format!("{part}*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n*INSTANCE, NAME=B, PART=P\n*END INSTANCE\n");
    let error = refused("deck.inp", twice);
    assert!(matches!(error, Error::DeckUnsupported { .. }), "{error:?}");
    assert!(error.to_string().contains("node 1 is in the instance A and in the instance B"), "{error}");
    let unknown = refused("deck.inp", "*INSTANCE, NAME=A, PART=Q\n");
    assert!(unknown.to_string().contains("found the part Q"), "{unknown}");
}

/// The assembly names sets and labels of an instance with and without its name, as Abaqus/CAE writes them.
#[test]
fn sets_of_an_assembly_are_those_of_its_instance() {
    let deck = format!(
        "*PART, NAME=P\n{}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n*END INSTANCE\n\
         *NSET, NSET=Set-1, INSTANCE=P-1\n1, 2\n*ELSET, ELSET=Set-1, INSTANCE=P-1\n2\n*ELSET, ELSET=_UP_S2, INTERNAL, INSTANCE=P-1\n2\n\
         *SURFACE, TYPE=ELEMENT, NAME=UP\n_UP_S2, S2\n*NSET, NSET=named\nP-1.14, P-1.Set-1\n*END ASSEMBLY\n",
        BRICKS.replace("*HEADING\nanything, * here\n", "")
    );
    let nodes = read_text("deck.inp", deck).expect("a deck");
    assert_eq!((group(&nodes, "Set-1"), group(&nodes, "UP")), (vec![1, 2], vec![11, 12, 13, 14]));
    assert_eq!(group(&nodes, "named"), [1, 2, 14]);
    assert_eq!(group(&nodes, "Set-1 (elements)"), [5, 6, 7, 8, 11, 12, 13, 14]);
}

/// CalculiX reads as many nodes as an element has, and so do decks count on it that have more.
#[test]
fn nodes_that_an_element_has_too_many_are_left_out() {
    let nodes = bricks_with("*ELEMENT, TYPE=C3D4, ELSET=E\n9, 1, 2, 3, 4, 5, 6,\n10, 1, 2, 3, 5, 7\n").expect("a deck");
    assert_eq!(group(&nodes, "E"), [1, 2, 3, 4, 5]);
}

#[test]
fn files_of_the_folder_are_included() {
    let folder = Folder::new();
    folder.write("mesh/nodes.inc", "1, 0, 0, 0\n2, 1, 0, 0\n");
    folder.write("sets.inc", "*NSET, NSET=A\n1\n*INCLUDE, INPUT=mesh/more.inc\n*NSET, NSET=C\n2\n");
    folder.write("mesh/more.inc", "*NSET, NSET=B\n2\n");
    let deck = folder.write("deck.inp", "*NODE, INPUT=mesh/nodes.inc\n3, 2, 0, 0\n*INCLUDE, INPUT=sets.inc\n3\n");
    let nodes = read(&deck).expect("a deck");
    assert_eq!(nodes.labels, [1, 2, 3]);
    assert_eq!((group(&nodes, "A"), group(&nodes, "B"), group(&nodes, "C")), (vec![1], vec![2], vec![2, 3]));
}

/// An include that would leave the folder is refused, by name and through a link, and one that never ends too.
#[test]
fn no_include_leaves_the_folder() {
    let folder = Folder::new();
    folder.write("secret.txt", "1, 0, 0, 0\n");
    let absolute = folder.write("deck/a.inc", "1, 0, 0, 0\n");
    let outside =
        ["../secret.txt", "sub/../../secret.txt", "..\\secret.txt", "C:secret.txt", absolute.to_str().expect("a path")];
    for reference in outside {
        let deck = folder.write("deck/deck.inp", format!("*NODE\n** text\n*INCLUDE, INPUT={reference}\n"));
        match read(&deck) {
            Err(Error::DeckInclude { line: 3, reason, .. }) => assert!(reason.contains("outside"), "{reason}"),
            other => panic!("{reference}: {other:?}"),
        }
    }
    let deck = folder.write("deck/deck.inp", "*INCLUDE, INPUT=there is none\n");
    assert!(matches!(read(&deck), Err(Error::DeckInclude { reason: "which is not there", .. })));
    let deck = folder.write("deck/self.inp", "*NODE\n*INCLUDE, INPUT=self.inp\n");
    let error = read(&deck).expect_err("a circle");
    assert!(error.to_string().contains("by 16 files that include each other"), "{error}");
    assert!(error.to_string().contains("take the line out"), "{error}");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.0.path().join("secret.txt"), folder.0.path().join("deck/link.inc"))
            .expect("a link");
        let deck = folder.write("deck/deck.inp", "*NODE\n*INCLUDE, INPUT=link.inc\n");
        let error = read(&deck).expect_err("a link that leaves");
        assert!(error.to_string().contains("a link to a file outside its folder"), "{error}");
    }
}

/// A thousand inclusions are enough, however few bytes they take.
#[test]
fn inclusions_are_counted() {
    let folder = Folder::new();
    folder.write("empty.inc", "** nothing\n");
    let deck = folder.write("deck.inp", format!("*NODE\n1, 0, 0, 0\n{}", "*INCLUDE, INPUT=empty.inc\n".repeat(2000)));
    assert!(matches!(read(&deck), Err(Error::DeckInclude { line: 1027, .. })), "{:?}", read(&deck));
}

#[test]
fn what_a_deck_cannot_mean_is_refused_with_its_line() {
    let cases = [
        ("*NODE\n1, 0, 0, 0\nx, 1, 2, 3\n", 3, "`x, 1, 2, 3`"),
        ("*NODE\n1, 0, nan, 0\n", 2, "finite"),
        ("*NODE, SYSTEM=Q\n1, 0, 0, 0\n", 1, "SYSTEM=Q"),
        ("*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=C3D4\n5, 1, 1, 1, 2\n", 4, "node 2 in element 5"),
        ("*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=B31\n5\n", 4, "another number"),
        ("*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=C3D4\n5, 1, 1\n*NSET, NSET=A\n1\n", 4, "another number"),
        ("*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=B31\n5, 1\n5, 1\n", 5, "element 5 once more, after line 4"),
        ("*NODE\n1, 0, 0, 0\n*NSET, NSET=A\nB\n", 4, "the set B"),
        ("*NODE\n1, 0, 0, 0\n*NSET\n1\n", 3, "NSET=NAME"),
        ("*NODE\n1, 0, 0, 0\n*NSET, NSET=A, GENERATE\n1, 2, -1\n", 4, "first label"),
        (
            "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=C3D4\n5, 1, 1, 1, 1\n*SURFACE, NAME=A\n5, S9\n",
            6,
            "the face S9 of element 5",
        ),
        ("*NODE\n1, 0, 0, 0\n*TRANSFORM, NSET=NOSET\n1, 0, 0, 0, 1, 0\n", 3, "*TRANSFORM of NOSET, which has no nodes"),
        (
            "*PART, NAME=P\n*NODE\n1, 0, 0, 0\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n0, 0, 0\n\
             .1, .2, .3, .1, .2, .30000000000000004, 90\n*END INSTANCE\n*END ASSEMBLY\n",
            8,
            "which are one point",
        ),
    ];
    for (deck, wanted, words) in cases {
        let error = refused("deck.inp", deck);
        let Error::MeshText { line, .. } = error else { panic!("{error:?}") };
        assert!(line == wanted && error.to_string().contains(words), "{error}");
    }
    let error = refused("deck.inp", "*NODE\n1, 0, 0, 0\n1, 0, 0, 0\n1, 0, 0, 1\n");
    assert!(matches!(error, Error::NodeRepeated { line: 4, first_line: 2, node: 1, .. }), "{error:?}");
    let error = refused("deck.inp", "*NODE\n1, 0, 0, 0\n*NGEN\n1, 2\n");
    assert!(matches!(error, Error::DeckUnsupported { line: 3, .. }), "{error:?}");
    assert!(matches!(refused("deck.inp", "*HEADING\n"), Error::NoData { .. }));
}

/// Two points that are one, or directions that are one, but for the rounding of their numbers give no axes.
#[test]
fn axes_of_rounding_are_refused_with_their_line() {
    let deck = |kind: &str, points: &str| {
        format!("*NODE\n1, 0.5, 0.25, 1\n*NSET, NSET=A\n1\n*TRANSFORM, NSET=A, TYPE={kind}\n{points}\n")
    };
    for (kind, points) in [
        ("R", "1, 2, 4, 2, 4, 8"),
        ("R", "0.1, 0.3, 0.7, 0.2, 0.6, 1.4000000000000001"),
        ("R", "0.333333, 0.666667, 1, 0.666667, 1.333333, 2"),
        ("C", "0.1, 0.2, 0.3, 0.1, 0.2, 0.30000000000000004"),
        ("S", "1, 2, 3, 1, 2, 3"),
    ] {
        let error = refused("deck.inp", deck(kind, points));
        assert!(matches!(error, Error::FrameAxes { line: 5, .. }), "{kind} {points}: {error:?}");
    }
    for (kind, points) in
        [("R", "1, 0, 0, 1, 0.01, 0"), ("C", "100.001, 0, 0, 100.002, 0, 0"), ("S", "0, 0, 0, 0, 0, 1e-9")]
    {
        read_text("deck.inp", deck(kind, points)).unwrap_or_else(|error| panic!("{kind} {points}: {error}"));
    }
}

/// Names of sets count in any case: the elements of a name are not the nodes of it, however either is written.
#[test]
fn sets_whose_names_differ_in_case_alone_are_told_apart() {
    let nodes = bricks_with(
        "*NSET, NSET=hub\n1\n*ELSET, ELSET=HUB\n2\n*SURFACE, NAME=Hub\n1, S1\n*TRANSFORM, NSET=HUB\n0, 1, 0, -1, 0, 0\n",
    )
    .expect("a deck");
    let names: Vec<&String> = nodes.groups.keys().filter(|name| name.to_ascii_lowercase().starts_with("hub")).collect();
    assert_eq!(names, ["HUB (elements)", "Hub (surface)", "hub"]);
    assert_eq!(group(&nodes, "hub"), [1]);
    assert_eq!(group(&nodes, "HUB (elements)"), [5, 6, 7, 8, 11, 12, 13, 14]);
}

/// Sets that name each other over and over do not grow beyond what they hold.
#[test]
fn groups_are_bounded() {
    let mut deck = BRICKS.to_owned();
    for k in 0..40 {
        deck += &format!("*NSET, NSET=S{k}\n1\n");
        deck += &format!("S{k}, S{k}, S{k}, S{}\n", k.max(1) - 1).repeat(50);
    }
    read_text("deck.inp", &deck).expect("a deck");
    let many: String = (0..20_000).map(|k| format!("*NSET, NSET=S{k}, GENERATE\n1, 14\n")).collect();
    assert!(matches!(refused("deck.inp", format!("{BRICKS}{many}")), Error::MeshGroups { limit: 65536, .. }));
}
