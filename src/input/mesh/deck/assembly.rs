//! Parts and instances of Abaqus: which scope a line belongs to, and where an instance puts its part.

use std::collections::{HashMap, HashSet};

use super::keyword::Keyword;
use super::lines::DeckLines;
use super::scope::{Added, Face, Scope, SetLine};
use super::sections::{SetKind, data_line, member, numbers, wrong_line};
use super::transforms::Transform;
use crate::error::Result;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;

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

    /// Hands lines of the assembly that name labels or sets of an instance down to that instance: `Part-1.HUB`, `Part-1.17`, or a set that
    /// the assembly has for this instance.
    pub(super) fn hand_down(&mut self) {
        let Self { outer, instances, .. } = self;
        if instances.is_empty() {
            return;
        }
        let [of_nodes, of_elements] = [&outer.node_sets, &outer.element_sets].map(|lines| names_of(lines));
        let mut kept = Vec::new();
        for mut line in std::mem::take(&mut outer.surfaces) {
            let (own, kind) = match line.face {
                Face::Nodes => (&of_nodes, SetKind::Nodes),
                _ => (&of_elements, SetKind::Elements),
            };
            match owner(&line.of, own, instances, kind) {
                Some((at, of)) => {
                    line.of = of;
                    instances[at].surfaces.push(line);
                }
                None => kept.push(line),
            }
        }
        outer.surfaces = kept;
        for kind in [SetKind::Nodes, SetKind::Elements] {
            let (lines, own) = match kind {
                SetKind::Nodes => (&mut outer.node_sets, &of_nodes),
                SetKind::Elements => (&mut outer.element_sets, &of_elements),
            };
            let mut kept = Vec::new();
            for mut line in std::mem::take(lines) {
                match owner(&line.added, own, instances, kind) {
                    Some((at, added)) => {
                        line.added = added;
                        let of_instance = &mut instances[at];
                        let lines = match kind {
                            SetKind::Nodes => &mut of_instance.node_sets,
                            SetKind::Elements => &mut of_instance.element_sets,
                        };
                        lines.push(line);
                    }
                    None => kept.push(line),
                }
            }
            *lines = kept;
        }
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
        let mut motion = Vec::new();
        while let Some(line) = data_line(lines)? {
            match numbers(line) {
                Some(numbers) if motion.len() < 2 => motion.push(numbers),
                _ => return Err(wrong_line(lines, "a translation, and below it two points and an angle")),
            }
        }
        let translation: [f64; 3] =
            std::array::from_fn(|axis| motion.first().and_then(|numbers| numbers.get(axis)).copied().unwrap_or(0.0));
        let rotation = match motion.get(1).map(Vec::as_slice) {
            None => None,
            Some(&[a, b, c, d, e, f, angle, ..]) => Some(([a, b, c], [d, e, f], angle)),
            Some(_) => return Err(lines.error("another number of fields", "two points of an axis and an angle")),
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

/// The instance whose label or set is named, and what it is called there; none where it is one of the assembly.
fn owner(added: &Added, own: &HashSet<String>, instances: &[Scope], kind: SetKind) -> Option<(usize, Added)> {
    let Added::Set(name) = added else { return None };
    if own.contains(&name.to_ascii_uppercase()) {
        return None;
    }
    if let Some((instance, rest)) = name.rsplit_once('.')
        && let Some(at) = instances.iter().position(|scope| is_called(scope, instance))
    {
        return Some((at, member(rest)));
    }
    let has = |scope: &Scope| {
        let lines = match kind {
            SetKind::Nodes => &scope.node_sets,
            SetKind::Elements => &scope.element_sets,
        };
        lines.iter().any(|line| line.set.eq_ignore_ascii_case(name))
    };
    let mut with = (0..instances.len()).filter(|at| has(&instances[*at]));
    let only = with.next().filter(|_| with.next().is_none())?;
    Some((only, added.clone()))
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
    if length == 0.0 {
        return point;
    }
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
        assert_eq!(rotated([2.0, 0.0, 5.0], ([1.0; 3], [1.0; 3], 90.0)), [2.0, 0.0, 5.0]);
    }
}
