//! The axes of grid points of Nastran that have their displacements in a coordinate system of their own: CD of GRID, and the systems.
//!
//! ```text
//! CORD2R, C, S    system, reference system, origin A, B on z, C in the half plane of x and z
//! CORD1R, C, S    the same by three grid points, up to two systems in an entry
//! GRID            grid point, CP, position in CP, CD; GRDSET has CP and CD for those that leave theirs out
//! ```

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::bulk_cards::{Card, Cards, wrong};
use super::bulk_lines::Place;
use super::fortran::{real, whole};
use super::in_line::Off;
use super::local_system::{LocalSystem, SystemKind};
use super::node_frames::NodeFrames;
use crate::dofs::Nodes;
use crate::error::{Error, Result};

/// Fields of GRID and GRDSET behind their names.
const CP: usize = 1;
const POSITION: usize = 2;
const CD: usize = 5;
/// CD of a point in a fluid, which has no displacements.
const FLUID: i64 = -1;
/// Systems that refer to each other, one to the next.
const MAX_CHAIN: usize = 64;

/// The axes of all grid points of a deck, those along the basic system among them; none where it has no grid points.
///
/// # Errors
/// Entries that are not what they should be, systems that are not there or refer to themselves, a file that cannot be read.
pub(super) fn grid_frames(path: &Path) -> Result<Option<NodeFrames>> {
    frames_of(path, &grids(path)?)
}

fn frames_of(path: &Path, grids: &BTreeMap<i64, Grid>) -> Result<Option<NodeFrames>> {
    let turned: Vec<(i64, &Grid)> =
        grids.iter().filter(|(_, grid)| !matches!(grid.cd, 0 | FLUID)).map(|(label, grid)| (*label, grid)).collect();
    let along_model = grids.iter().filter(|(_, grid)| grid.cd == 0).map(|(label, _)| *label).collect();
    let first = turned.iter().map(|(_, grid)| *grid).min_by_key(|grid| grid.place.line);
    let Some(first) = first.or_else(|| grids.values().next()) else { return Ok(None) };
    let place = (first.place.path.to_path_buf(), first.place.line);
    let systems = Systems { defined: systems(path)?, grids, open: RefCell::default() };
    let mut axes = BTreeMap::new();
    for (label, grid) in turned {
        let system = systems.system(grid.cd, &grid.place)?;
        axes.insert(label, system.axes_at(systems.located(label, &grid.place)?.point));
    }
    Ok(Some(NodeFrames { axes, along_model, rounded: BTreeMap::new(), place }))
}

/// Where all grid points of a deck are in the basic system, by their labels, and their axes as [`grid_frames`] has them.
///
/// # Errors
/// Those of [`grid_frames`]; a position that cannot be read.
pub(super) fn grid_points(path: &Path) -> Result<(Nodes, Option<NodeFrames>)> {
    let grids = grids(path)?;
    let is_basic = grids.values().all(|grid| grid.cp == 0);
    let defined = if is_basic { BTreeMap::new() } else { systems(path)? };
    let systems = Systems { defined, grids: &grids, open: RefCell::default() };
    let located = |(label, grid): (&i64, &Grid)| Ok((*label, systems.located(*label, &grid.place)?.point));
    let points = grids.iter().map(located).collect::<Result<Vec<_>>>()?;
    let (labels, coordinates) = points.into_iter().unzip();
    Ok((Nodes { labels, coordinates, ..Nodes::default() }, frames_of(path, &grids)?))
}

/// A grid point.
struct Grid {
    cp: i64,
    /// None where it cannot be read, which matters where the position does.
    position: Option<[f64; 3]>,
    cd: i64,
    place: Place,
}

/// How a system is defined.
enum Defined {
    /// In another system, by three points.
    ByPoints(i64, [[f64; 3]; 3]),
    /// By three grid points.
    ByGrids([i64; 3]),
}

struct Definition {
    kind: SystemKind,
    defined: Defined,
    place: Place,
}

fn field(card: &Card, at: usize) -> &[u8] {
    card.fields.get(at).map_or(&b""[..], Vec::as_slice)
}

/// A whole number, or what stands for it where the field is blank.
fn number(card: &Card, at: usize, blank: Option<i64>, expected: &str) -> Result<i64> {
    let text = field(card, at);
    let value = if text.is_empty() { blank } else { whole(text) };
    value.ok_or_else(|| wrong(&card.place, text, expected))
}

fn point(card: &Card, first: usize) -> Result<[f64; 3]> {
    let mut point = [0.0; 3];
    for (axis, value) in point.iter_mut().enumerate() {
        let text = field(card, first + axis);
        if !text.is_empty() {
            *value =
                real(text).filter(|value| value.is_finite()).ok_or_else(|| wrong(&card.place, text, "a coordinate"))?;
        }
    }
    Ok(point)
}

fn grids(path: &Path) -> Result<BTreeMap<i64, Grid>> {
    let (mut cp, mut cd) = (0, 0);
    let mut cards = Cards::open(path, "GRDSET")?;
    while let Some(card) = cards.advance()? {
        cp = number(&card, CP, Some(0), "a coordinate system (CP)")?;
        cd = number(&card, CD, Some(0), "a coordinate system (CD)")?;
    }
    let mut grids = BTreeMap::new();
    let mut cards = Cards::open(path, "GRID")?;
    while let Some(card) = cards.advance()? {
        let label = number(&card, 0, None, "the label of a grid point")?;
        let (cp, cd) = (
            number(&card, CP, Some(cp), "a coordinate system (CP)")?,
            number(&card, CD, Some(cd), "a coordinate system (CD)")?,
        );
        // Only a point whose system matters needs a position that can be read.
        let position =
            if matches!(cd, 0 | FLUID) { point(&card, POSITION).ok() } else { Some(point(&card, POSITION)?) };
        grids.insert(label, Grid { cp, position, cd, place: card.place });
    }
    Ok(grids)
}

/// The entries that define systems by points, and by grid points.
const KINDS: [([&str; 2], SystemKind); 3] = [
    (["CORD2R", "CORD1R"], SystemKind::Rectangular),
    (["CORD2C", "CORD1C"], SystemKind::Cylindrical),
    (["CORD2S", "CORD1S"], SystemKind::Spherical),
];

fn systems(path: &Path) -> Result<BTreeMap<i64, Definition>> {
    const LABEL: &str = "the label of a coordinate system";
    let mut systems = BTreeMap::new();
    for ([by_points, by_grids], kind) in KINDS {
        let mut cards = Cards::open(path, by_points)?;
        while let Some(card) = cards.advance()? {
            let reference = number(&card, 1, Some(0), "a reference coordinate system (RID)")?;
            let defined = Defined::ByPoints(reference, [point(&card, 2)?, point(&card, 5)?, point(&card, 8)?]);
            systems.insert(number(&card, 0, None, LABEL)?, Definition { kind, defined, place: card.place });
        }
        let mut cards = Cards::open(path, by_grids)?;
        while let Some(card) = cards.advance()? {
            for first in [0, 4].into_iter().filter(|first| !field(&card, *first).is_empty()) {
                let grid = |at: usize| number(&card, first + at, None, "a grid point");
                let defined = Defined::ByGrids([grid(1)?, grid(2)?, grid(3)?]);
                let place = card.place.clone();
                systems.insert(number(&card, first, None, LABEL)?, Definition { kind, defined, place });
            }
        }
    }
    Ok(systems)
}

/// A point in the basic system, and by how much it may be off.
struct Located {
    point: [f64; 3],
    off: Off,
}

/// Coordinate systems and what they are defined by.
struct Systems<'a> {
    defined: BTreeMap<i64, Definition>,
    grids: &'a BTreeMap<i64, Grid>,
    /// Systems that are being worked out, one for the next.
    open: RefCell<BTreeSet<i64>>,
}

impl Systems<'_> {
    /// A system in the basic one; 0 is the basic one. `place` is that of the entry that refers to it.
    fn system(&self, label: i64, place: &Place) -> Result<LocalSystem> {
        if label == 0 {
            return Ok(LocalSystem::of_the_model());
        }
        let Some(Definition { kind, defined, place: own }) = self.defined.get(&label) else {
            return Err(wrong(
                place,
                label.to_string().as_bytes(),
                "a coordinate system that CORD1 or CORD2 entries of the deck define, or the axes of nodes in `model.frames`",
            ));
        };
        let is_new = self.open.borrow_mut().insert(label);
        if !is_new || self.open.borrow().len() > MAX_CHAIN {
            return Err(wrong(own, label.to_string().as_bytes(), "a coordinate system that does not refer to itself"));
        }
        let [a, b, c] = match defined {
            Defined::ByPoints(reference, points) => {
                let reference = self.system(*reference, own)?;
                points.map(|point| Located { point: reference.point(point), off: reference.off(point) })
            }
            Defined::ByGrids(grids) => {
                [self.located(grids[0], own)?, self.located(grids[1], own)?, self.located(grids[2], own)?]
            }
        };
        self.open.borrow_mut().remove(&label);
        let (points, off) = ([a.point, b.point, c.point], a.off.or(b.off).or(c.off));
        LocalSystem::by_points(*kind, points, off).ok_or_else(|| {
            let [a, b, c] = points;
            let found =
                format!("coordinate system {label} by the points {a:?}, {b:?} and {c:?}, which are on one line");
            Error::FrameAxes { path: own.path.to_path_buf(), line: own.line, found }
        })
    }

    /// Where a grid point is in the basic system.
    fn located(&self, label: i64, place: &Place) -> Result<Located> {
        let Some(grid) = self.grids.get(&label) else {
            return Err(wrong(place, label.to_string().as_bytes(), "a grid point of the deck"));
        };
        let position = grid.position.ok_or_else(|| wrong(&grid.place, b"", "three coordinates of a grid point"))?;
        let system = self.system(grid.cp, &grid.place)?;
        Ok(Located { point: system.point(position), off: system.off(position) })
    }
}
