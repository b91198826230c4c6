//! Files mutated at random, thousands of them: every outcome is a result or an error of the table (property P11).
//!
//! The cases are the same on every machine. `SUPEL_CASES=100000 cargo test --test stress mutated` runs more of them.

use std::panic::catch_unwind;

use supel::error::Error;
use supel::job::{Job, Method};
use supel::memory_forecast::Resources;
use supel_models::{Material, SplitMix64, brick, fnv1a};

use crate::place::Place;

/// Cases without `SUPEL_CASES`: some seconds.
const N_CASES: u64 = 3000;
const FILES: [&str; 5] = ["K.mtx", "M.mtx", "dofs.txt", "nodes.csv", "job.toml"];
/// What mutations put in: numbers at the ends of their ranges, and words that mean something somewhere.
const WORDS: [&[u8]; 28] = [
    b"nan",
    b"-inf",
    b"0",
    b"-0",
    b"1e308",
    b"1e-320",
    b"-1",
    b"2147483648",
    b"18446744073709551616",
    b"1e999",
    b"\n",
    b"\r",
    b"\t",
    b" ",
    b",",
    b";",
    b"\"",
    b"%",
    b"#",
    b"{",
    b"]",
    b"=",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\0",
    b"group:",
    b"rows",
    b"general",
];

fn below(random: &mut SplitMix64, bound: usize) -> usize {
    random.below(bound.max(1) as u64) as usize
}

/// A range of bytes, short ones more often.
fn range(random: &mut SplitMix64, length: usize) -> std::ops::Range<usize> {
    let longest = 1 << below(random, 7);
    let start = below(random, length);
    start..(start + 1 + below(random, longest)).min(length)
}

fn mutate(random: &mut SplitMix64, bytes: &mut Vec<u8>) {
    let range = range(random, bytes.len());
    let word = WORDS[below(random, WORDS.len())];
    match random.below(9) {
        _ if bytes.is_empty() => bytes.extend_from_slice(word),
        0 => bytes[range.start] ^= 1 << random.below(8),
        1 => bytes[range.start] = random.below(256) as u8,
        2 => drop(bytes.drain(range)),
        3 => {
            let copy = bytes[range.clone()].to_vec();
            drop(bytes.splice(range.end..range.end, copy));
        }
        4 => drop(bytes.splice(range.start..range.start, word.iter().copied())),
        5 => drop(bytes.splice(range, word.iter().copied())),
        6 => bytes.truncate(range.start),
        7 => exchange_lines(random, bytes),
        _ => exchange_digit(random, bytes),
    }
}

fn exchange_lines(random: &mut SplitMix64, bytes: &mut Vec<u8>) {
    let mut lines: Vec<&[u8]> = bytes.split_inclusive(|byte| *byte == b'\n').collect();
    let (a, b) = (below(random, lines.len()), below(random, lines.len()));
    lines.swap(a, b);
    *bytes = lines.concat();
}

fn exchange_digit(random: &mut SplitMix64, bytes: &mut [u8]) {
    let digits: Vec<usize> = (0..bytes.len()).filter(|at| bytes[*at].is_ascii_digit()).collect();
    if let Some(at) = digits.get(below(random, digits.len())) {
        bytes[*at] = b'0' + random.below(10) as u8;
    }
}

#[test]
fn p11_mutated_files_are_refused_by_name() {
    let n_cases = std::env::var("SUPEL_CASES").map_or(N_CASES, |text| text.parse().expect("SUPEL_CASES: a number"));
    let model = brick([1, 1, 1], [1.1, 1.3, 1.7], &Material::UNIT);
    let place = Place::with(&model);
    let job = r#"
[model]
stiffness = "K.mtx"
mass      = "M.mtx"
dofs      = "dofs.txt"
nodes     = "nodes.csv"
drop_empty = false

[[interface]]
name     = "foot"
nodes    = [1, 2, 3]

[[interface]]
name     = "head"
nodes    = { within = { box = { min = [1.0, 1.0, 1.0], max = [2.0, 2.0, 2.0] } } }
dofs     = ["ux"]

[reduction]
method = "herting"
modes  = { count = 2 }

[write]
superelement = "x.supel"
"#;
    place.write("job.toml", job.as_bytes());
    let originals = FILES.map(|name| place.bytes(name));
    let mut n_done = 0;
    for case in 0..n_cases {
        let mut random = SplitMix64::new(fnv1a("p11").wrapping_add(case));
        let n_files = 1 + below(&mut random, 2);
        for _ in 0..n_files {
            let file = below(&mut random, FILES.len());
            let mut bytes = originals[file].clone();
            for _ in 0..=random.below(4) {
                mutate(&mut random, &mut bytes);
            }
            place.write(FILES[file], &bytes);
        }
        let method = [Method::Herting, Method::CraigBampton][below(&mut random, 2)];
        // Without the writing, whose names a mutated job could lead anywhere.
        let ended = catch_unwind(|| {
            let mut job = Job::read(&place.path("job.toml"))?;
            job.reduction.method = method;
            supel::reduce(&job, Resources::default(), &mut ())
        });
        let ended = ended.unwrap_or_else(|_| panic!("case {case} panicked"));
        if let Err(error) = &ended {
            assert!(
                Error::CODES.iter().any(|entry| entry.code == error.code()) && error.to_string().len() > 10,
                "case {case}: {error}"
            );
        }
        n_done += u64::from(ended.is_ok());
        FILES.iter().zip(&originals).for_each(|(name, bytes)| place.write(name, bytes));
    }
    // Some changes change nothing and some nothing that matters; if none did, the cases would test the first reader only.
    eprintln!("{n_done} of {n_cases} mutated models were reduced");
    assert!(n_done * 100 > n_cases && n_done * 2 < n_cases, "{n_done} of {n_cases} were reduced");
}
