//! Places by what is typed: COMPONENT.INTERFACE, with .NODE and .DOF where less is meant; COMPONENT.rows:0,1 without nodes.

use supel_runtime::{Coordinate, Direction, InterfaceNode};

use super::component::Component;
use super::place::Place;
use crate::error::{Error, Result};
use crate::job::nearest;

/// What a selection is read for: the flag that an error names.
pub(super) struct Selector<'a> {
    pub(super) flag: &'static str,
    pub(super) components: &'a [Component],
}

impl Selector<'_> {
    /// The nodes or rows that a text names, in the order of the component. Where there is only one component its name may be left out.
    ///
    /// # Errors
    /// [`Error::AssemblyName`] for a name that is not there.
    pub(super) fn places(&self, text: &str) -> Result<Vec<Place>> {
        let (index, rest) = self.component(text)?;
        let component = &self.components[index];
        let first = self.components[..index].iter().map(Component::n_coordinates).sum();
        // A name comes first: an interface may be called `rows:1`.
        if let Some(wanted) = Wanted::of(rest, &component.superelement.metadata().interface_nodes) {
            let places = nodes(component, (index, first), &wanted);
            let what = format!("`{rest}` selects no dof of {}", component.name);
            return if places.is_empty() {
                Err(self.unknown(text, what, dofs(component, &wanted), ""))
            } else {
                Ok(places)
            };
        }
        match rest.strip_prefix("rows:") {
            Some(rows) => self.rows(text, (index, first), rows),
            None => Err(self.no_interface(text, component, rest)),
        }
    }

    /// The component of the longest name with which the text begins, and what follows its point.
    fn component<'t>(&self, text: &'t str) -> Result<(usize, &'t str)> {
        let rest = |component: &Component| text.strip_prefix(component.name.as_str())?.strip_prefix('.');
        let found = self.components.iter().enumerate().filter_map(|(index, component)| Some((index, rest(component)?)));
        if let Some(found) = found.min_by_key(|(_, rest)| rest.len()) {
            return Ok(found);
        }
        if self.components.len() == 1 {
            return Ok((0, text));
        }
        if let Some(index) = self.components.iter().position(|component| component.name == text) {
            return Ok((index, ""));
        }
        let name = text.split_once('.').map_or(text, |(name, _)| name);
        let known = self.components.iter().map(|component| component.name.clone()).collect();
        Err(self.unknown(text, format!("no component is called `{name}`"), known, name))
    }

    /// Interface rows by their numbers in the model.
    fn rows(&self, text: &str, (index, first): (usize, usize), rows: &str) -> Result<Vec<Place>> {
        let component = &self.components[index];
        let coordinates = component.superelement.metadata().coordinates.iter().enumerate();
        let known: Vec<(u64, usize)> = coordinates
            .filter_map(|(at, coordinate)| match coordinate {
                Coordinate::InterfaceRow { row } => Some((*row, at)),
                _ => None,
            })
            .collect();
        let place = |word: &str| {
            let found = word.trim().parse().ok().and_then(|row: u64| known.iter().find(|(known, _)| *known == row));
            let Some((row, at)) = found else {
                let known = known.iter().map(|(row, _)| row.to_string()).collect();
                return Err(self.unknown(text, format!("{} has no interface row `{word}`", component.name), known, ""));
            };
            let name = format!("{}.rows:{row}", component.name);
            Ok(Place {
                component: index,
                name,
                position: None,
                frame: None,
                whole: None,
                dofs: vec![(None, first + at)],
            })
        };
        rows.split(',').map(place).collect()
    }

    fn no_interface(&self, text: &str, component: &Component, rest: &str) -> Error {
        let mut known: Vec<String> = Vec::new();
        for node in &component.superelement.metadata().interface_nodes {
            if !known.contains(&node.name) {
                known.push(node.name.clone());
            }
        }
        let rows = |coordinate: &Coordinate| matches!(coordinate, Coordinate::InterfaceRow { .. });
        if component.superelement.metadata().coordinates.iter().any(rows) {
            known.push("rows:NUMBERS".to_owned());
        }
        let name = rest.split_once('.').map_or(rest, |(name, _)| name);
        let what = match rest {
            "" => format!("it names no interface of {}", component.name),
            _ => format!("{} has no interface `{rest}`", component.name),
        };
        self.unknown(text, what, known, name)
    }

    fn unknown(&self, text: &str, what: String, known: Vec<String>, name: &str) -> Error {
        let suggestion = nearest(name, &known.iter().map(String::as_str).collect::<Vec<_>>());
        Error::AssemblyName { typed: format!("{} {text}", self.flag), what, known, suggestion }
    }
}

/// An interface, one of its nodes where only that is meant, one of its directions where only that is meant.
struct Wanted<'t> {
    interface: &'t str,
    label: Option<i64>,
    direction: Option<Direction>,
}

impl<'t> Wanted<'t> {
    /// What a text means; names are taken at full length first, so that they may have points in them.
    fn of(text: &'t str, nodes: &[InterfaceNode]) -> Option<Self> {
        let is_known = |name: &str| nodes.iter().any(|node| node.name == name);
        let (without_dof, direction) = match text.rsplit_once('.').map(|(rest, last)| (rest, direction(last))) {
            Some((rest, Some(direction))) if !is_known(text) => (rest, Some(direction)),
            _ => (text, None),
        };
        let (interface, label) = match without_dof.rsplit_once('.').map(|(rest, last)| (rest, last.parse().ok())) {
            Some((rest, Some(label))) if !is_known(without_dof) => (rest, Some(label)),
            _ => (without_dof, None),
        };
        is_known(interface).then_some(Self { interface, label, direction })
    }
}

fn direction(word: &str) -> Option<Direction> {
    Direction::ALL.into_iter().find(|direction| direction.to_string() == word)
}

/// The nodes of an interface that are wanted, with the directions that are wanted of each.
fn nodes(component: &Component, (index, first): (usize, usize), wanted: &Wanted<'_>) -> Vec<Place> {
    let superelement = &component.superelement;
    let all = &superelement.metadata().interface_nodes;
    let n_alike = all.iter().filter(|node| node.name == wanted.interface).count();
    let mut places = Vec::new();
    let mut at = first;
    for ((number, node), frame) in all.iter().enumerate().zip(&superelement.tensors().interface_frames) {
        let coordinates = node.dofs.iter().zip(at..);
        at += node.dofs.len();
        if node.name != wanted.interface || (wanted.label.is_some() && node.label != wanted.label) {
            continue;
        }
        let is_wanted = |direction: &Direction| wanted.direction.is_none_or(|wanted| wanted == *direction);
        let dofs: Vec<_> = coordinates.filter(|(d, _)| is_wanted(d)).map(|(d, at)| (Some(*d), at)).collect();
        let label = node.label.filter(|_| n_alike > 1).map(|label| format!(".{label}")).unwrap_or_default();
        if !dofs.is_empty() {
            let name = format!("{}.{}{label}", component.name, node.name);
            let (position, frame) = (Some(node.position), Some(*frame));
            let whole = wanted.direction.is_none().then_some(number);
            places.push(Place { component: index, name, position, frame, whole, dofs });
        }
    }
    places
}

/// The nodes and directions that an interface has, for a message.
fn dofs(component: &Component, wanted: &Wanted<'_>) -> Vec<String> {
    let all = &component.superelement.metadata().interface_nodes;
    let of_interface = all.iter().filter(|node| node.name == wanted.interface);
    let words = of_interface.flat_map(|node| {
        let label = node.label.map(|label| format!(".{label}")).unwrap_or_default();
        node.dofs.iter().map(move |direction| format!("{}{label}.{direction}", node.name))
    });
    words.collect()
}
