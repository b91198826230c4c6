//! Parts and instances of Abaqus: which scope a line belongs to, and where an instance puts its part.

use std::collections::{HashMap, HashSet};

use super::keyword::Keyword;
use super::lines::DeckLines;
use super::scope::{Added, Face, Scope, SetKind, SetLine, SurfaceLine, of_assembly};
use super::sections::{data_line, member, numbers, wrong_line};
use super::transforms::Transform;
use crate::error::Result;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;
use crate::input::in_line::Off;

/// Bytes of a node or a corner of an element of an instance.
const COPIED: u64 = 64;

/// The scopes of a deck.
#[derive(Debug, Default)]
pub(super) struct Scopes {
    /// What stands in no part and no instance: a flat deck, or the assembly.
    pub(super) outer: Scope,
    /// Instances in the order of the deck.
    pub(super) instances: Vec<Scope>,
    /// Each `*TRANSFORM`.
    pub(super) transforms: Vec<Transform>,
    /// Parts by their names in capitals.
    parts: HashMap<String, Scope>,
    inside: Inside,
}

/// Where the lines of a deck stand.
#[derive(Debug, Default, PartialEq, Eq)]
enum Inside {
    #[default]
    Outer,
    /// In the part of this name.
    Part(String),
    /// In the last instance.
    Instance,
}

impl Scopes {
    /// The scope that a keyword adds to: that of the instance it names, or the one it stands in.
    pub(super) fn of(&mut self, keyword: &Keyword, lines: &DeckLines) -> Result<&mut Scope> {
        if let (Inside::Outer, Some(name)) = (&self.inside, keyword.value("INSTANCE")) {
            let found = self.instances.iter_mut().find(|scope| is_called(scope, name));
            return found.ok_or_else(|| {
                lines.error(format!("the instance {}", excerpt(name.as_bytes())), "an instance that is above")
            });
        }
        Ok(match &self.inside {
            Inside::Outer => &mut self.outer,
            Inside::Part(name) => self.parts.entry(name.clone()).or_default(),
            Inside::Instance => self.instances.last_mut().unwrap_or(&mut self.outer),
        })
    }

    /// Takes the data of a `*TRANSFORM`.
    pub(super) fn transform(&mut self, lines: &mut DeckLines, keyword: &Keyword) -> Result<()> {
        self.transforms.push(Transform::read(lines, keyword)?);
        Ok(())
    }

    /// Whether a keyword of the assembly says of which instance its lines are.
    pub(super) fn names_instance(&self, keyword: &Keyword) -> bool {
        self.inside == Inside::Outer && keyword.value("INSTANCE").is_some()
    }

    /// Hands lines of the assembly that name labels, sets or surfaces of instances down to these: `Part-1.HUB`, `Part-1.17`, or a set of
    /// the assembly that has members there. A line of several is handed to each, and stays where the assembly has a part of it itself.
    pub(super) fn hand_down(&mut self) {
        let Self { outer, instances, .. } = self;
        if instances.is_empty() {
            return;
        }
        // Sets of nodes may be those of sets of elements, surfaces those of either.
        for kind in [SetKind::Elements, SetKind::Nodes] {
            let mut kept: Vec<SetLine> = Vec::new();
            for line in std::mem::take(outer.sets_mut(kind)) {
                let named = match line.added {
                    Added::NodesOf(_) => Named::Set(SetKind::Elements),
                    _ => Named::Set(kind),
                };
                let own = match named {
                    Named::Set(SetKind::Elements) if kind == SetKind::Nodes => names_of(&outer.element_sets),
                    _ => names_of(&kept),
                };
                let (stays, owners) = owners(&line.added, &own, instances, named);
                for (at, added) in owners {
                    let set = of_assembly(&line.set);
                    instances[at].sets_mut(kind).push(SetLine { set, added, place: line.place });
                }
                if stays {
                    kept.push(line);
                }
            }
            *outer.sets_mut(kind) = kept;
        }
        let of_sets = [SetKind::Nodes, SetKind::Elements].map(|kind| names_of(outer.sets(kind)));
        let mut kept: Vec<SurfaceLine> = Vec::new();
        for line in std::mem::take(&mut outer.surfaces) {
            let of_surfaces: HashSet<String> = kept.iter().map(|line| line.surface.to_ascii_uppercase()).collect();
            let (own, named) = match line.face {
                Face::Nodes => (&of_sets[0], Named::Set(SetKind::Nodes)),
                Face::OfSurface => (&of_surfaces, Named::Surface),
                Face::Labelled(_) | Face::Free => (&of_sets[1], Named::Set(SetKind::Elements)),
            };
            let (stays, owners) = owners(&line.of, own, instances, named);
            for (at, of) in owners {
                let surface = of_assembly(&line.surface);
                instances[at].surfaces.push(SurfaceLine { surface, of, ..line.clone() });
            }
            if stays {
                kept.push(line);
            }
        }
        outer.surfaces = kept;
    }

    pub(super) fn start_part(&mut self, keyword: &Keyword, lines: &DeckLines) -> Result<()> {
        let name = keyword.value("NAME").map(str::to_ascii_uppercase);
        let name = name.ok_or_else(|| lines.error(keyword.shown(), "the name of the part, NAME=PART"))?;
        if self.parts.insert(name.clone(), Scope::default()).is_some() {
            return Err(
                lines.error(format!("the part {}, a second time", excerpt(name.as_bytes())), "one part of a name")
            );
        }
        self.inside = Inside::Part(name);
        Ok(())
    }

    pub(super) fn end(&mut self) {
        self.inside = Inside::Outer;
    }

    /// `*INSTANCE, NAME=, PART=` with the lines that move it.
    pub(super) fn start_instance(&mut self, lines: &mut DeckLines, keyword: &Keyword, claim: &Claim<'_>) -> Result<()> {
        let Some(name) = keyword.value("NAME").map(str::to_owned) else {
            return Err(lines.error(keyword.shown(), "the name of the instance, NAME=INSTANCE"));
        };
        if self.instances.iter().any(|scope| is_called(scope, &name)) {
            let found = format!("the instance {}, a second time", excerpt(name.as_bytes()));
            return Err(lines.error(found, "one instance of a name"));
        }
        let part = keyword.value("PART").map(str::to_ascii_uppercase).unwrap_or_default();
        let mut scope = self.parts.get(&part).cloned().unwrap_or_default();
        if keyword.value("PART").is_some() && !self.parts.contains_key(&part) {
            return Err(lines.error(format!("the part {}", excerpt(part.as_bytes())), "a part that is above"));
        }
        claim.add(COPIED * (scope.nodes.labels.len() + scope.elements.nodes.len()) as u64)?;
        scope.instance = Some(name);
        let (mut motion, mut place) = (Vec::new(), lines.place());
        while let Some(line) = data_line(lines)? {
            match numbers(line) {
                Some(numbers) if motion.len() < 2 => {
                    motion.push(numbers);
                    place = lines.place();
                }
                _ => return Err(wrong_line(lines, "a translation, and below it two points and an angle")),
            }
        }
        let translation: [f64; 3] =
            std::array::from_fn(|axis| motion.first().and_then(|numbers| numbers.get(axis)).copied().unwrap_or(0.0));
        let rotation = match motion.get(1).map(Vec::as_slice) {
            None => None,
            Some(&[_, _, _, _, _, _, 0.0, ..]) => None,
            Some(numbers @ &[a, b, c, d, e, f, angle, ..]) => {
                if !Off::of_text(&numbers[..6]).tells([d - a, e - b, f - c]) {
                    let found = format!("an axis from {:?} to {:?}, which are one point", [a, b, c], [d, e, f]);
                    return Err(lines.error_at(place, found, "two points of an axis and an angle"));
                }
                Some(([a, b, c], [d, e, f], angle))
            }
            Some(_) => {
                return Err(lines.error_at(place, "another number of fields", "two points of an axis and an angle"));
            }
        };
        for point in &mut scope.nodes.coordinates {
            *point = std::array::from_fn(|axis| point[axis] + translation[axis]);
            if let Some(rotation) = rotation {
                *point = rotated(*point, rotation);
            }
        }
        self.instances.push(scope);
        self.inside = Inside::Instance;
        Ok(())
    }
}

/// Names of sets in capitals.
fn names_of(lines: &[SetLine]) -> HashSet<String> {
    lines.iter().map(|line| line.set.to_ascii_uppercase()).collect()
}

/// What a line names.
#[derive(Clone, Copy)]
enum Named {
    /// Sets, or labels of what they list.
    Set(SetKind),
    Surface,
}

impl Named {
    /// Whether a scope has something of this name.
    fn is_in(self, scope: &Scope, name: &str) -> bool {
        match self {
            Self::Set(kind) => scope.sets(kind).iter().any(|line| line.set.eq_ignore_ascii_case(name)),
            Self::Surface => scope.surfaces.iter().any(|line| line.surface.eq_ignore_ascii_case(name)),
        }
    }
}

/// Whether a line stays in the assembly, and the instances that it is of, with what it adds there. A name without an instance is one of the
/// assembly; where that has none, one of the only instance that has it.
fn owners(added: &Added, own: &HashSet<String>, instances: &[Scope], named: Named) -> (bool, Vec<(usize, Added)>) {
    let (Added::Set(name) | Added::NodesOf(name)) = added else { return (true, Vec::new()) };
    let renamed = |name: String| match added {
        Added::NodesOf(_) => Added::NodesOf(name),
        _ => Added::Set(name),
    };
    let dotted = name
        .rsplit_once('.')
        .and_then(|(instance, rest)| Some((instances.iter().position(|scope| is_called(scope, instance))?, rest)));
    let is_own = own.contains(&name.to_ascii_uppercase());
    if let Some((at, rest)) = dotted.filter(|_| !is_own) {
        let added = if matches!(added, Added::NodesOf(_)) { renamed(rest.to_owned()) } else { member(rest) };
        return (false, vec![(at, added)]);
    }
    let of_instances = of_assembly(name);
    let with: Vec<usize> = (0..instances.len()).filter(|at| named.is_in(&instances[*at], &of_instances)).collect();
    if is_own || !with.is_empty() {
        return (is_own, with.into_iter().map(|at| (at, renamed(of_instances.clone()))).collect());
    }
    let mut with = (0..instances.len()).filter(|at| named.is_in(&instances[*at], name));
    match (with.next(), with.next()) {
        (Some(only), None) => (false, vec![(only, added.clone())]),
        _ => (true, Vec::new()),
    }
}

fn is_called(scope: &Scope, name: &str) -> bool {
    scope.instance.as_ref().is_some_and(|known| known.eq_ignore_ascii_case(name))
}

/// A point turned about the axis from one point to another by an angle in degrees.
fn rotated(point: [f64; 3], (from, to, angle): ([f64; 3], [f64; 3], f64)) -> [f64; 3] {
    use supel_runtime::motion::{cross, dot};
    let minus = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|axis| a[axis] - b[axis]) };
    let axis = minus(to, from);
    let length = dot(&axis, &axis).sqrt();
    let axis = axis.map(|x| x / length);
    let arm = minus(point, from);
    let (sin, cos) = angle.to_radians().sin_cos();
    let (across, along) = (cross(&axis, &arm), dot(&axis, &arm));
    std::array::from_fn(|at| from[at] + cos * arm[at] + sin * across[at] + (1.0 - cos) * along * axis[at])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_an_axis_away_from_the_origin() {
        let turned = rotated([2.0, 0.0, 5.0], ([1.0, 0.0, 0.0], [1.0, 0.0, 3.0], 90.0));
        // Sine and cosine of a right angle, and a few products.
        for (found, expected) in turned.into_iter().zip([1.0, 1.0, 5.0]) {
            assert!((found - expected).abs() <= 8.0 * f64::EPSILON, "{turned:?}");
        }
    }
}
