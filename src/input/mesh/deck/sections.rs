//! The lines of data below a keyword.

use super::elements::ElementType;
use super::keyword::{Keyword, split_outside_quotes, unquoted};
use super::lines::{DeckLines, is_keyword};
use super::scope::{Added, Face, Scope, SetKind, SetLine, SurfaceLine};
use crate::error::Result;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;
use crate::input::fortran;

/// Bytes that a node takes while a deck is read.
const NODE: u64 = 128;
/// Bytes that a number of an element, a set or a surface takes.
const MEMBER: u64 = 32;
/// Lines after which their memory is claimed.
const LINES_PER_CLAIM: usize = 1 << 10;
/// Nodes of an element of a type that is not known, more than any has.
const MAX_NODES: usize = 1 << 12;

/// `*NODE`: label and up to three coordinates; those that are left out are zero.
pub(super) fn nodes(lines: &mut DeckLines, keyword: &Keyword, scope: &mut Scope, claim: &Claim<'_>) -> Result<()> {
    let system = match keyword.value("SYSTEM").map(str::to_ascii_uppercase).as_deref() {
        None | Some("R") => System::Rectangular,
        Some("C") => System::Cylindrical,
        Some("S") => System::Spherical,
        Some(other) => {
            return Err(lines.error(format!("SYSTEM={}", excerpt(other.as_bytes())), "SYSTEM=R, C or S"));
        }
    };
    let set = keyword.value("NSET").map(str::to_owned);
    while let Some(line) = data_line(lines)? {
        let Some((label, coordinates)) = node(line) else {
            return Err(wrong_line(lines, "a node: its label and up to three finite coordinates"));
        };
        let place = lines.place();
        if scope.nodes.labels.len().is_multiple_of(LINES_PER_CLAIM) {
            claim.add(NODE * LINES_PER_CLAIM as u64)?;
        }
        scope.nodes.labels.push(label);
        scope.nodes.coordinates.push(system.rectangular(coordinates));
        scope.nodes.places.push(place);
        if let Some(set) = &set {
            add_label(&mut scope.node_sets, set, label, place);
        }
    }
    Ok(())
}

/// Adds one label to a set; labels that follow each other become a range.
fn add_label(lines: &mut Vec<SetLine>, set: &str, label: i64, place: super::lines::Place) {
    if let Some(SetLine { set: last_set, added: Added::Range { last, step: 1, .. }, .. }) = lines.last_mut()
        && last_set == set
        && last.checked_add(1) == Some(label)
    {
        *last = label;
        return;
    }
    lines.push(SetLine { set: set.to_owned(), added: one(label), place });
}

/// `*ELEMENT`: label and labels of nodes, on as many lines as the type needs or as end with a comma.
pub(super) fn elements(lines: &mut DeckLines, keyword: &Keyword, scope: &mut Scope, claim: &Claim<'_>) -> Result<()> {
    let name = keyword.value("TYPE").unwrap_or_default().to_owned();
    let kind = ElementType::of(&name);
    let set = keyword.value("ELSET").map(str::to_owned);
    let mut numbers: Vec<i64> = Vec::new();
    while let Some(line) = data_line(lines)? {
        numbers.clear();
        let mut goes_on = whole_numbers(line, &mut numbers);
        let place = lines.place();
        // Programs differ in where they break long lines: behind a comma or not.
        while let Some(comma) = goes_on {
            let is_short = kind.n_nodes().map_or(comma == Ends::Comma, |n| numbers.len() < 1 + n);
            if !is_short || numbers.len() > MAX_NODES {
                break;
            }
            let Some(line) = data_line(lines)? else { break };
            goes_on = whole_numbers(line, &mut numbers);
        }
        // CalculiX leaves out what an element has too many, and decks count on it.
        numbers.truncate(kind.n_nodes().map_or(usize::MAX, |n| 1 + n));
        let is_right = kind.n_nodes().map_or((2..=MAX_NODES).contains(&numbers.len()), |n| numbers.len() == 1 + n);
        if goes_on.is_none() || !is_right {
            let found = if goes_on.is_none() { "a field that is no whole number" } else { "another number of fields" };
            let expected = match kind.n_nodes() {
                Some(n) => format!("an element of type {name}: its label and {n} nodes"),
                None => "an element: its label and its nodes".to_owned(),
            };
            return Err(lines.error_at(place, found, expected));
        }
        let elements = &mut scope.elements;
        if elements.labels.len().is_multiple_of(LINES_PER_CLAIM) {
            claim.add(MEMBER * (4 + numbers.len() as u64) * LINES_PER_CLAIM as u64)?;
        }
        if kind.kind == crate::input::cell_kind::Kind::Unknown {
            elements.unknown.get_or_insert_with(|| name.clone());
        }
        elements.n_incompatible += usize::from(name.eq_ignore_ascii_case("C3D8I"));
        elements.labels.push(numbers[0]);
        elements.types.push(kind);
        elements.starts.push(elements.nodes.len());
        elements.nodes.extend(&numbers[1..]);
        elements.places.push(place);
        if let Some(set) = &set {
            add_label(&mut scope.element_sets, set, numbers[0], place);
        }
    }
    Ok(())
}

/// `*NSET` and `*ELSET`: labels and names of sets, with `GENERATE` ranges of labels.
pub(super) fn set(
    lines: &mut DeckLines,
    keyword: &Keyword,
    (kind, scope): (SetKind, &mut Scope),
    claim: &Claim<'_>,
) -> Result<()> {
    let parameter = if kind == SetKind::Nodes { "NSET" } else { "ELSET" };
    let Some(name) = keyword.value(parameter).map(str::to_owned) else {
        return Err(lines.error(keyword.shown(), format!("the name of the set, {parameter}=NAME")));
    };
    let place = lines.place();
    let known = scope.sets_mut(kind);
    known.push(SetLine { set: name.clone(), added: Added::Nothing, place });
    if kind == SetKind::Nodes
        && let Some(elements) = keyword.value("ELSET")
    {
        known.push(SetLine { set: name.clone(), added: Added::NodesOf(elements.to_owned()), place });
    }
    let is_range = keyword.parameter("GENERATE").is_some();
    while let Some(line) = data_line(lines)? {
        let text = String::from_utf8_lossy(line).into_owned();
        let place = lines.place();
        let added = if is_range { range(&text).map(|range| vec![range]) } else { members(&text) };
        let Some(added) = added else {
            let expected = if is_range { "first label, last label and step" } else { "labels and names of sets" };
            return Err(wrong_line(lines, expected));
        };
        claim.add(4 * MEMBER * added.len() as u64)?;
        known.extend(added.into_iter().map(|added| SetLine { set: name.clone(), added, place }));
    }
    Ok(())
}

/// `*SURFACE`: faces of elements by label or set, or nodes.
pub(super) fn surface(lines: &mut DeckLines, keyword: &Keyword, scope: &mut Scope, claim: &Claim<'_>) -> Result<()> {
    let kind = keyword.value("TYPE").unwrap_or("ELEMENT").to_ascii_uppercase();
    let combined = keyword.parameter("COMBINE").is_some();
    let is_union = keyword.value("COMBINE").is_some_and(|how| how.eq_ignore_ascii_case("UNION"));
    let is_known = matches!(kind.as_str(), "ELEMENT" | "NODE") && (is_union || !combined);
    let Some(name) = keyword.value("NAME").filter(|_| is_known).map(str::to_owned) else {
        // Analytical and cut surfaces list nothing of the mesh, and what others have in common is not told by their nodes.
        return skip(lines);
    };
    while let Some(line) = data_line(lines)? {
        let text = String::from_utf8_lossy(line).into_owned();
        if is_union {
            let place = lines.place();
            claim.add(4 * MEMBER)?;
            let names = split_outside_quotes(&text).map(unquoted).filter(|name| !name.is_empty());
            let of = |name: &str| Added::Set(name.to_owned());
            scope.surfaces.extend(names.map(|other| SurfaceLine {
                surface: name.clone(),
                of: of(other),
                face: Face::OfSurface,
                place,
            }));
            continue;
        }
        let mut fields = split_outside_quotes(&text).map(unquoted);
        let of = fields.next().filter(|of| !of.is_empty()).map(member);
        let face = match (kind.as_str(), fields.next().unwrap_or_default()) {
            ("NODE", _) => Face::Nodes,
            (_, "") => Face::Free,
            (_, face) => Face::Labelled(face.to_owned()),
        };
        let place = lines.place();
        let Some(of) = of else { return Err(wrong_line(lines, "an element, a node or a set")) };
        claim.add(4 * MEMBER)?;
        scope.surfaces.push(SurfaceLine { surface: name.clone(), of, face, place });
    }
    Ok(())
}

/// Leaves out the lines below a keyword.
pub(super) fn skip(lines: &mut DeckLines) -> Result<()> {
    while data_line(lines)?.is_some() {}
    Ok(())
}

/// The next line of data; none before a keyword and at the end.
pub(super) fn data_line(lines: &mut DeckLines) -> Result<Option<&[u8]>> {
    match lines.next()? {
        Some(line) if is_keyword(line) => {}
        Some(_) => return Ok(Some(lines.text())),
        None => return Ok(None),
    }
    lines.hold();
    Ok(None)
}

/// The error of a line that is not what belongs there.
pub(super) fn wrong_line(lines: &DeckLines, expected: &str) -> crate::error::Error {
    lines.error(format!("`{}`", excerpt(lines.text())), expected)
}

/// The numbers of a line; fields that are left out are zero.
pub(super) fn numbers(line: &[u8]) -> Option<Vec<f64>> {
    line.split(|byte| *byte == b',').map(number).collect()
}

fn number(field: &[u8]) -> Option<f64> {
    match field.trim_ascii() {
        b"" => Some(0.0),
        field => fortran::real(field).filter(|value| value.is_finite()),
    }
}

fn node(line: &[u8]) -> Option<(i64, [f64; 3])> {
    let mut fields = line.split(|byte| *byte == b',');
    let label = whole_number(fields.next()?)?;
    let mut coordinates = [0.0; 3];
    for (coordinate, field) in coordinates.iter_mut().zip(fields) {
        *coordinate = number(field)?;
    }
    Some((label, coordinates))
}

/// How a line ends.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ends {
    Comma,
    Number,
}

/// Takes the whole numbers of a line; none where a field is something else.
fn whole_numbers(line: &[u8], numbers: &mut Vec<i64>) -> Option<Ends> {
    let (line, ends) = match line.trim_ascii_end() {
        [line @ .., b','] => (line, Ends::Comma),
        line => (line, Ends::Number),
    };
    for field in line.split(|byte| *byte == b',') {
        numbers.push(whole_number(field)?);
    }
    Some(ends)
}

fn whole_number(field: &[u8]) -> Option<i64> {
    let field = field.trim_ascii();
    // Most labels are short runs of digits.
    if (1..=18).contains(&field.len()) && field.iter().all(u8::is_ascii_digit) {
        return Some(field.iter().fold(0, |number, digit| 10 * number + i64::from(digit - b'0')));
    }
    std::str::from_utf8(field).ok()?.parse().ok()
}

fn range(text: &str) -> Option<Added> {
    let mut fields = text.split(',').map(|field| field.trim().parse::<i64>());
    let first = fields.next()?.ok()?;
    let last = fields.next()?.ok()?;
    let step = fields.next().map_or(Some(1), |step| step.ok().or(Some(1)))?;
    (step > 0).then_some(Added::Range { first, last, step })
}

fn members(text: &str) -> Option<Vec<Added>> {
    let fields = split_outside_quotes(text).map(unquoted).filter(|field| !field.is_empty());
    let found: Vec<Added> = fields.map(member).collect();
    (!found.is_empty()).then_some(found)
}

/// A label or the name of a set.
pub(super) fn member(field: &str) -> Added {
    field.parse().map_or_else(|_| Added::Set(field.to_owned()), one)
}

fn one(label: i64) -> Added {
    Added::Range { first: label, last: label, step: 1 }
}

/// What the coordinates of a node are.
#[derive(Clone, Copy)]
enum System {
    Rectangular,
    /// Radius, angle in degrees, height.
    Cylindrical,
    /// Radius, angle in degrees about z, angle in degrees from the xy plane.
    Spherical,
}

impl System {
    fn rectangular(self, [a, b, c]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Rectangular => [a, b, c],
            Self::Cylindrical => [a * b.to_radians().cos(), a * b.to_radians().sin(), c],
            Self::Spherical => {
                let in_plane = a * c.to_radians().cos();
                [in_plane * b.to_radians().cos(), in_plane * b.to_radians().sin(), a * c.to_radians().sin()]
            }
        }
    }
}
