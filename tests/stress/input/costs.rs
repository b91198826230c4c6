//! Small files that would cost much: what is held is bounded by what differs, lines and rows by what the format needs, and everything
//! together by the memory allowed.

use std::io::Write;
use std::path::PathBuf;

use supel::error::Error;
use supel::input::{Allowance, read_within};
use supel::job::ModelJob;
use supel_models::{Ends, spring};

use super::{assert_done, assert_refused, chain};
use crate::place::Place;

const MIB: u64 = 1 << 20;

fn gzip(write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Vec<u8> {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    write(&mut encoder).and_then(|()| encoder.finish()).expect("compression in memory")
}

/// Memory that reading a model claims at its end or where it is refused.
fn needed(place: &Place, nodes: Option<&str>, allowed: u64) -> Result<(), (u64, PathBuf)> {
    let model = ModelJob {
        stiffness: place.path("K.mtx"),
        mass: Some(place.path("M.mtx")),
        nodes: nodes.map(|name| place.path(name)),
        ..ModelJob::default()
    };
    match read_within(&model, &Allowance::of(Some(allowed))) {
        Err(Error::MemoryRead { path, needed, available }) => {
            assert_eq!(available, allowed);
            Err((needed, path))
        }
        // Whether the nodes fit the matrices is found later.
        Ok(_) | Err(Error::DofOrderUnknown { .. }) => Ok(()),
        Err(error) => panic!("{error}"),
    }
}

/// Twelve million lines that repeat five positions need what some four million need, whatever the file says of itself, and give the sums of
/// all.
#[test]
fn repeated_entries_cost_what_different_ones_cost() {
    const LINES: usize = 12_000_000;
    let place = chain();
    let text = gzip(|out| {
        writeln!(out, "%%MatrixMarket matrix coordinate real general\n5 5 {LINES}")?;
        let block = b"1 1 2\n2 2 2\n3 3 2\n4 4 2\n5 5 2\n".repeat(1000);
        (0..LINES / 5000).try_for_each(|_| out.write_all(&block))
    });
    place.write("K.mtx", &text);
    // All lines take 28 bytes each with the matrix made of them: 320 MiB.
    assert_eq!(needed(&place, None, 160 * MIB), Ok(()));
    let model = ModelJob { stiffness: place.path("K.mtx"), mass: Some(place.path("M.mtx")), ..ModelJob::default() };
    let read = read_within(&model, &Allowance::of(None)).expect("a matrix");
    assert_eq!(read.stiffness.matrix.get(3, 3), Some(&(2.0 * LINES as f64 / 5.0)));
    assert_eq!(read.stiffness.notes.n_duplicates, LINES - 5);
}

/// The memory allowed holds while files are read, and the message says which one and how much.
#[test]
fn what_is_read_stays_within_the_memory_allowed() {
    let place = Place::with(&spring(30_000, Ends::Free));
    // 60,000 entries of K and 30,000 of M, in one triangle: 40 bytes each before both are assembled.
    let (needed_at_most, path) = needed(&place, None, MIB).expect_err("too little");
    assert!(needed_at_most > MIB && needed_at_most < 5 * MIB, "{needed_at_most}");
    assert!(path == place.path("K.mtx") || path == place.path("M.mtx"));
    assert_eq!(needed(&place, None, 8 * MIB), Ok(()));

    // The nodes take another 4.6 MiB.
    let nodes: String = (0..100_000).map(|node| format!("{node},0,0,{node}\n")).collect();
    place.write("nodes.csv", format!("node,x,y,z\n{nodes}").as_bytes());
    let (_, path) = needed(&place, Some("nodes.csv"), 7 * MIB).expect_err("too little for the nodes");
    assert_eq!(path, place.path("nodes.csv"));
    assert_eq!(needed(&place, Some("nodes.csv"), 16 * MIB), Ok(()));

    let place = chain();
    let flags = place.matrix_flags();
    let ended = place.reduce(&flags, &format!("{} --memory-gib 1e-7", super::CHAIN));
    assert_refused(&place, &ended, "E-MEM-READ", &["bytes of memory is available", "run.memory_gib"]);
}

/// Zeros compress a thousandfold; positions of nodes need memory all the same.
#[cfg(feature = "hdf5")]
#[test]
fn what_is_inflated_stays_within_the_memory_allowed() {
    let place = chain();
    let file = hdf5_metno::File::create(place.path("zeros.hmf")).expect("a file");
    let grid = file.create_group("domain").and_then(|domain| domain.create_group("grid")).expect("groups");
    let zeros = vec![[0.0; 3]; 1 << 20];
    let builder = grid.new_dataset_builder().deflate(9).chunk((1 << 16, 3));
    builder.with_data::<_, f64, _>(zeros.as_slice()).create("Geometry").expect("a dataset");
    drop(grid);
    file.close().expect("closed");
    assert!(std::fs::metadata(place.path("zeros.hmf")).expect("a file").len() < MIB / 8);
    let (_, path) = needed(&place, Some("zeros.hmf"), 32 * MIB).expect_err("too little");
    assert_eq!(path, place.path("zeros.hmf"));
    assert_eq!(needed(&place, Some("zeros.hmf"), 128 * MIB), Ok(()));
}

#[test]
fn lines_and_rows_are_as_long_as_a_format_needs() {
    let refused = |name: &str, text: &[u8], flag: &str, code: &str, parts: &[&str]| {
        let place = chain();
        place.write(name, text);
        let mut flags = place.matrix_flags();
        flags.extend([flag.to_owned(), place.text(name)]);
        assert_refused(&place, &place.reduce(&flags, super::CHAIN), code, parts);
    };
    let long = |start: &str, filling: &str, end: &str| [start, &filling.repeat(1 << 17), end].concat().into_bytes();
    let nodes = "node,x,y,z\n1,0,0,0\n";
    let limit = "longer than 65536 bytes";
    refused("n.csv", &long(&format!("{nodes}2,0,0,"), "0", "\n"), "--nodes", "E-LINE", &["n.csv:3:", limit]);
    refused("n.csv", &long(&format!("{nodes}2,0,0,0"), ",", "\n"), "--nodes", "E-LINE", &["n.csv:3:", limit]);
    refused("n.csv", &long(&format!("{nodes}2,0,\"0"), "\n", "\",0\n"), "--nodes", "E-LINE", &[limit]);
    refused("n.csv", &long("", "x", "\n"), "--nodes", "E-LINE", &["n.csv:1:", limit]);
    refused("d.csv", &long("node,dof\n1,1\n2,", "1", "\n"), "--dofs", "E-LINE", &["d.csv:3:", limit]);
    refused("d.txt", &long("1.1\n2.1", " ", "3.1\n"), "--dofs", "E-LINE", &["d.txt:2:", "longer than 256 bytes"]);
    // A decimal comma makes a field more, and would move all that follow.
    refused(
        "n.csv",
        b"node,x,y,z\n1,0,5,0,0\n",
        "--nodes",
        "E-TABLE-ROW",
        &["n.csv:2:", "row of 5 fields", "expected 4"],
    );
    refused("n.csv", b"node,x,y,z\n1,0,5,0,\n", "--nodes", "E-TABLE-ROW", &["row of 5 fields"]);
    refused("d.csv", b"node,dof\n1,1,7\n", "--dofs", "E-TABLE-ROW", &["d.csv:2:", "row of 3 fields", "expected 2"]);
    refused("n.csv", b"node,x,y,z\n1,0,0\n", "--nodes", "E-TABLE-ROW", &["row of 3 fields"]);
}

/// A map longer than the matrices is counted to its end, not kept.
#[test]
fn a_map_of_many_rows_is_counted() {
    let place = chain();
    let map: String = (1..=200_000).map(|node| format!("{node}.1\n")).collect();
    for (name, text) in [("d.txt", map.clone()), ("d.csv", format!("node,dof\n{}", map.replace('.', ",")))] {
        place.write(name, text.as_bytes());
        let mut flags = place.matrix_flags();
        flags.extend(["--dofs".to_owned(), place.text(name)]);
        let ended = place.reduce(&flags, super::CHAIN);
        assert_refused(&place, &ended, "E-MAP-COUNT", &["has 200,000 rows", "expected 5,"]);
    }
    let place = chain();
    assert_done(&place, &super::reduce_chain(&place), &[]);
}

/// More threads than processors only wait for each other.
#[test]
fn threads_are_as_many_as_are_of_use() {
    let place = chain();
    let ended = place.reduce(&place.matrix_flags(), &super::CHAIN.replace("--threads 1", "--threads 60000"));
    let used = place.report("x.report.json")["run"]["n_threads"].as_u64().expect("a number");
    let processors = std::thread::available_parallelism().expect("a number").get() as u64;
    assert_eq!(used, (4 * processors).max(8));
    assert_eq!(
        ended.err,
        format!("supel: {used} threads work, not 60000: more only wait for each other on this machine\n")
    );
}
