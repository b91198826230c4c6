//! Dof maps that do not fit: I-15.

use super::{assert_done, assert_refused};
use crate::place::Place;

const FOOT: &str = "--interface foot=1,11,31,41 --method herting --modes 5 --threads 1";

/// The block with its dof map changed line by line.
fn with_map(change: impl Fn(&mut Vec<String>)) -> Place {
    let place = Place::with_brick();
    let map = String::from_utf8(place.bytes("dofs.txt")).expect("text");
    let mut lines: Vec<String> = map.lines().map(str::to_owned).collect();
    change(&mut lines);
    place.write("dofs.txt", (lines.join("\n") + "\n").as_bytes());
    place
}

#[track_caller]
fn map_refused(code: &str, parts: &[&str], change: impl Fn(&mut Vec<String>)) {
    let place = with_map(change);
    assert_refused(&place, &place.reduce(&place.model_flags(), FOOT), code, parts);
}

#[test]
fn i_15_maps_that_do_not_fit() {
    let place = with_map(|_| {});
    assert_done(&place, &place.reduce(&place.model_flags(), FOOT), &[]);
    map_refused("E-MAP-NODE", &["dofs.txt: row 7", "node 999", "nodes.csv"], |lines| lines[6] = "999.1".into());
    map_refused("E-MAP-DIRECTION", &["dofs.txt:7", "node 3", "`7`", "1 to 6"], |lines| lines[6] = "3.7".into());
    map_refused("E-MAP-TEXT", &["dofs.txt:7", "`three`"], |lines| lines[6] = "three".into());
    map_refused("E-MAP-REPEATED", &["rows 5 and 7", "node 2"], |lines| lines[6] = lines[4].clone());
    map_refused("E-MAP-COUNT", &["134 rows", "expected 135"], |lines| drop(lines.pop()));
    map_refused("E-MAP-COUNT", &["136 rows", "expected 135"], |lines| lines.push("46.1".into()));
}

/// A map in another order than the matrices: row numbers give it away, and without them the coordinates do.
#[test]
fn i_15_maps_in_another_order() {
    let numbered = |lines: &mut Vec<String>| {
        let rows = lines.iter().enumerate().map(|(row, line)| format!("{row},{}", line.replace('.', ",")));
        *lines = std::iter::once("row,node,dof".to_owned()).chain(rows).collect();
    };
    let place = with_map(numbered);
    assert_done(&place, &place.reduce(&place.model_flags(), FOOT), &[]);
    map_refused("E-MAP-ORDER", &["dofs.txt:8", "`30`", "expected 6"], |lines| {
        numbered(lines);
        lines.swap(7, 31);
    });
    // Two nodes exchanged: every translation still moves the block, no rotation does.
    map_refused("E-COORD", &["node 3 u", "check units, axes"], |lines| {
        (0..3).for_each(|direction| lines.swap(6 + direction, 96 + direction));
    });
}
