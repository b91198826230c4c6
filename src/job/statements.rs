//! What the scene says of interface dofs: which are connected, unloaded, grounded, or parts of one rigid body.
//!
//! Only statements leave interface dofs out; nothing is inferred.

use std::collections::BTreeSet;

use super::interface::InterfaceJob;
use super::interface_part::InterfacePart;
use super::scene::SceneJob;
use crate::dofs::Direction;
use crate::error::{Error, Result};

/// What becomes of an interface dof in the simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DofUse {
    /// Something may be connected to it, or load it: it is a coordinate.
    Connected,
    /// Nothing acts on it: it follows the others as an internal dof does.
    Unloaded,
    /// It is at rest.
    Grounded,
    /// It moves with a rigid body, by its number in the scene.
    Prescribed(usize),
}

impl DofUse {
    /// What it is in words, after "is".
    pub fn words(self) -> &'static str {
        match self {
            Self::Connected => "connected",
            Self::Unloaded => "unloaded",
            Self::Grounded => "grounded",
            Self::Prescribed(_) => "prescribed",
        }
    }
}

/// A statement: the part of an interface that it names, by interface and direction, and what it says.
type Statement<'a> = ((&'a str, Option<Direction>), DofUse);

impl SceneJob {
    /// What the scene says of a dof of an interface; rows have no direction.
    pub fn use_of(&self, interfaces: &[InterfaceJob], dof: (&str, Option<Direction>)) -> DofUse {
        let is_meant =
            |(name, direction): (&str, Option<Direction>)| name == dof.0 && (direction.is_none() || direction == dof.1);
        let stated = self.statements(interfaces).find(|(part, _)| is_meant(*part)).map(|(_, of)| of);
        stated.unwrap_or(if self.connected.is_some() { DofUse::Unloaded } else { DofUse::Connected })
    }

    /// Whether the scene says anything of interface dofs.
    pub fn has_statements(&self) -> bool {
        let is_any_listed = !(self.unloaded.is_empty() && self.grounded.is_empty() && self.prescribed.is_empty());
        self.connected.is_some() || is_any_listed
    }

    /// The scene without what merely leaves dofs out: dofs at rest and rigid bodies are part of the mechanical problem, and without them another
    /// component would be reduced.
    #[must_use]
    pub fn with_every_dof(&self) -> Self {
        Self { connected: None, unloaded: Vec::new(), ..self.clone() }
    }

    /// What the scene says of a whole interface; none where directions of it differ.
    pub fn use_of_whole(&self, interfaces: &[InterfaceJob], name: &str) -> Option<DofUse> {
        let of_whole = self.use_of(interfaces, (name, None));
        let parts = Direction::ALL.map(|direction| self.use_of(interfaces, (name, Some(direction))));
        parts.iter().all(|part| *part == of_whole).then_some(of_whole)
    }

    /// Every statement, in the order of its keys.
    fn statements<'a>(&'a self, interfaces: &'a [InterfaceJob]) -> impl Iterator<Item = Statement<'a>> {
        let is_interface = move |name: &str| interfaces.iter().any(|interface| interface.name == name);
        let lists = [
            (self.connected.as_deref().unwrap_or_default(), DofUse::Connected),
            (self.unloaded.as_slice(), DofUse::Unloaded),
            (self.grounded.as_slice(), DofUse::Grounded),
        ];
        let of_parts = lists
            .into_iter()
            .flat_map(move |(parts, of)| parts.iter().filter_map(move |part| Some((part.of(is_interface)?, of))));
        let carried = self.prescribed.iter().enumerate().flat_map(|(number, carrier)| {
            carrier.interfaces.iter().map(move |name| ((name.as_str(), None), DofUse::Prescribed(number)))
        });
        of_parts.chain(carried)
    }
}

pub(super) fn validate(scene: &SceneJob, interfaces: &[InterfaceJob]) -> Result<()> {
    let names: BTreeSet<&str> = interfaces.iter().map(|interface| interface.name.as_str()).collect();
    let known = || names.iter().map(|name| (*name).to_owned()).collect();
    let lists: [(&str, &[InterfacePart]); 3] = [
        ("connected", scene.connected.as_deref().unwrap_or_default()),
        ("unloaded", &scene.unloaded),
        ("grounded", &scene.grounded),
    ];
    for (key, parts) in lists {
        if let Some(part) = parts.iter().find(|part| part.of(|name| names.contains(name)).is_none()) {
            return Err(Error::ScenePart { key, part: part.0.clone(), known: known() });
        }
    }
    for (number, carrier) in scene.prescribed.iter().enumerate() {
        if let Some(part) = carrier.interfaces.iter().find(|name| !names.contains(name.as_str())) {
            return Err(Error::ScenePart { key: "prescribed", part: part.clone(), known: known() });
        }
        let wrong = |found: &str| Err(Error::SceneCarrier { name: carrier.name.clone(), found: found.to_owned() });
        if carrier.name.trim().is_empty() {
            return wrong("has no name");
        }
        if carrier.interfaces.is_empty() {
            return wrong("has no interfaces");
        }
        let is_taken = names.contains(carrier.name.as_str()) && !carrier.interfaces.contains(&carrier.name);
        if is_taken || scene.prescribed[..number].iter().any(|other| other.name == carrier.name) {
            return wrong("has the name of another interface");
        }
    }
    if scene.connected.as_ref().is_some_and(Vec::is_empty) {
        return Err(Error::JobEmpty { key: "scene.connected".to_owned(), expected: "interfaces, or the key left out" });
    }
    if scene.connected.is_some() && !scene.unloaded.is_empty() {
        let part = scene.unloaded[0].0.clone();
        return Err(Error::SceneConflict { part, first: "listed as unloaded", second: "unlisted as connected" });
    }
    let statements: Vec<Statement<'_>> = scene.statements(interfaces).collect();
    for (at, ((name, direction), of)) in statements.iter().enumerate() {
        let meets = |((other, its), _): &&Statement<'_>| {
            other == name && (direction.is_none() || its.is_none() || direction == its)
        };
        if let Some((_, before)) = statements[..at].iter().find(meets) {
            let part = direction.map_or_else(|| (*name).to_owned(), |direction| format!("{name}.{direction}"));
            let second = if before == of { "listed twice" } else { of.words() };
            return Err(Error::SceneConflict { part, first: before.words(), second });
        }
    }
    Ok(())
}

/// Refuses to hold for modes what the scene leaves out: an interface, or a direction of one.
pub(super) fn refuse_held(scene: &SceneJob, interfaces: &[InterfaceJob], held: &InterfacePart) -> Result<()> {
    const KEY: &str = "reduction.held";
    match held.of(|name| interfaces.iter().any(|interface| interface.name == name)) {
        Some((name, None)) => refuse_left_out(scene, interfaces, (&held.0, KEY), Some(name)),
        Some((name, direction)) => match scene.use_of(interfaces, (name, direction)) {
            DofUse::Connected => Ok(()),
            of => {
                let (said, name) = (held.0.clone(), held.0.clone());
                Err(Error::SceneLeftOut { key: KEY, said, name, of: of.words() })
            }
        },
        None => Ok(()),
    }
}

/// Refuses what names an interface that the scene leaves out as a whole; `from` is what is said and its key.
pub(super) fn refuse_left_out(
    scene: &SceneJob,
    interfaces: &[InterfaceJob],
    (said, key): (&str, &'static str),
    name: Option<&str>,
) -> Result<()> {
    let Some(name) = name.filter(|name| !scene.prescribed.iter().any(|carrier| carrier.name == *name)) else {
        return Ok(());
    };
    match scene.use_of_whole(interfaces, name) {
        None | Some(DofUse::Connected) => Ok(()),
        Some(of) => {
            let (said, name) = (said.to_owned(), name.to_owned());
            Err(Error::SceneLeftOut { key, said, name, of: of.words() })
        }
    }
}
