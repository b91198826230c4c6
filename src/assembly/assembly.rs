//! Components, what joins, holds and loads them, and the matrices of the whole.

use std::collections::BTreeSet;

use faer::Mat;
use serde::Serialize;
use supel_runtime::Direction;

use super::absence::{Absence, absence};
use super::component::Component;
use super::joint::{Pair, pairs, turned};
use super::place::Place;
use super::rigid::{Ties, rigid_motions};
use super::selection::Selector;
use super::spectrum::Pencil;
use crate::dense::{self, NOISE_FACTOR};
use crate::error::{Error, Result};
use crate::number::quantity;

/// Components joined at nodes.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// The components.
    pub components: Vec<Component>,
    /// What was joined.
    pub joints: Vec<Joint>,
    /// What is held.
    pub held: Vec<Held>,
    /// Masses that were added.
    pub loaded: Vec<Loaded>,
    /// What the user should know of it.
    pub notes: Vec<String>,
    /// Pairs of coordinates that are one.
    joined: Vec<[usize; 2]>,
    /// The largest distance of two joined nodes, relative to the smaller component.
    distance: f64,
    held_coordinates: BTreeSet<usize>,
    /// Coordinate and what is added to its mass.
    added: Vec<(usize, f64)>,
}

/// Two interfaces that became one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Joint {
    /// The first, as it was named.
    pub a: String,
    /// The second.
    pub b: String,
    /// Pairs of nodes, or of rows.
    pub n_nodes: usize,
    /// Pairs of dofs.
    pub n_dofs: usize,
    /// The largest distance between the nodes of a pair; none for rows.
    pub distance: Option<f64>,
    /// Numbers of the components.
    #[serde(skip)]
    pub components: [usize; 2],
}

/// Dofs that are held.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Held {
    /// The selection.
    pub name: String,
    /// How many.
    pub n_dofs: usize,
}

/// A mass that was added.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Loaded {
    /// The selection.
    pub name: String,
    /// How much.
    #[serde(flatten)]
    pub mass: PointMass,
}

/// A rigid mass at a node, its centre at the node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PointMass {
    /// The mass.
    pub mass: f64,
    /// Moments of inertia about x, y, z.
    pub inertia: [f64; 3],
}

impl Assembly {
    /// Components with nothing joined, held or loaded.
    ///
    /// # Errors
    /// [`Error::ComponentTwice`].
    pub fn new(components: Vec<Component>) -> Result<Self> {
        let mut names = BTreeSet::new();
        if let Some(twice) = components.iter().find(|component| !names.insert(component.name.as_str())) {
            return Err(Error::ComponentTwice { name: twice.name.clone() });
        }
        Ok(Self {
            components,
            joints: Vec::new(),
            held: Vec::new(),
            loaded: Vec::new(),
            notes: Vec::new(),
            joined: Vec::new(),
            distance: 0.0,
            held_coordinates: BTreeSet::new(),
            added: Vec::new(),
        })
    }

    /// Joins `a.hub` with `b.pin`: node by node where they are at one place, in all directions that both have.
    ///
    /// # Errors
    /// [`Error::AssemblyName`], [`Error::JoinedTwice`] and those of the comparison of the two: [`Error::JoinUnits`], [`Error::JoinNodes`],
    /// [`Error::JoinPosition`], [`Error::JoinDofs`].
    pub fn join(&mut self, a: &str, b: &str) -> Result<()> {
        let [of_a, of_b] = [self.places("--join", a)?, self.places("--join", b)?];
        let pairs = pairs(&self.components, (&of_a, &of_b), (a, b))?;
        let mut parents = self.parents();
        let dofs: Vec<[usize; 2]> = pairs.iter().flat_map(|pair| pair.dofs.iter().copied()).collect();
        for pair in &dofs {
            let [root_i, root_j] = pair.map(|i| root(&mut parents, i));
            if root_i == root_j {
                return Err(Error::JoinedTwice { a: a.to_owned(), b: b.to_owned() });
            }
            union(&mut parents, *pair);
        }
        self.joined.extend(&dofs);
        self.note_pairs(&pairs);
        pairs.iter().for_each(|pair| self.rest_where_joined(pair));
        let distances = pairs.iter().filter_map(|pair| pair.distance);
        let distance = distances.reduce(f64::max);
        let sizes = [&of_a, &of_b].map(|places| self.components[places[0].component].size());
        let size = sizes.into_iter().filter(|size| *size > 0.0).reduce(f64::min);
        self.distance = self.distance.max(distance.unwrap_or(0.0) / size.unwrap_or(f64::INFINITY));
        let n_dofs = dofs.len();
        let components = [&of_a, &of_b].map(|places| places[0].component);
        let (a, b, n_nodes) = (a.to_owned(), b.to_owned(), pairs.len());
        self.joints.push(Joint { a, b, n_nodes, n_dofs, distance, components });
        Ok(())
    }

    /// Says which directions of joined nodes stay free, which positions nobody knows and which axes differ.
    fn note_pairs(&mut self, pairs: &[Pair]) {
        let Some(Pair { a, b, dofs, at_rest, distance }) = pairs.first() else { return };
        if distance.is_none() {
            self.notes.push(format!("{} and {} have no positions that could be compared", a.name, b.name));
        }
        // Matrices are in the axes of the model, whatever those of a node are.
        if let Some(degrees) = turned(a, b) {
            let (a, b, degrees) = (&a.name, &b.name, quantity(degrees, 4));
            self.notes.push(format!("the axes of {a} and {b} are turned by {degrees} degrees against each other"));
        }
        for (one, other) in [(a, b), (b, a)] {
            let is_tied =
                |at: usize| dofs.iter().flatten().chain(at_rest.iter().flatten().map(|(_, at)| at)).any(|c| *c == at);
            let is_free = |(_, coordinate): &&(Option<Direction>, usize)| !is_tied(*coordinate);
            let free: Vec<String> =
                one.dofs.iter().filter(is_free).filter_map(|(direction, _)| direction.map(|d| d.to_string())).collect();
            if !free.is_empty() {
                let which = free.join(" ");
                self.notes.push(format!("{}: {which} stay free, as {} does not have them", one.name, other.name));
            }
        }
    }

    /// Holds the directions of a node in which the node that it was joined with is at rest: the reduction took that for granted.
    fn rest_where_joined(&mut self, pair: &Pair) {
        let [of_a, of_b] = &pair.at_rest;
        for (held, one, other) in [(of_a, &pair.a, &pair.b), (of_b, &pair.b, &pair.a)] {
            if held.is_empty() {
                continue;
            }
            let which: Vec<String> = held.iter().map(|(direction, _)| direction.to_string()).collect();
            self.notes.push(format!("{}: {} at rest, as those of {} are", one.name, which.join(" "), other.name));
            for (direction, at) in held {
                self.held.push(Held { name: format!("{}.{direction}", one.name), n_dofs: 1 });
                self.held_coordinates.insert(*at);
            }
        }
    }

    /// Holds `b.foot`, or `b.foot.ux` alone.
    ///
    /// # Errors
    /// [`Error::AssemblyName`].
    pub fn fix(&mut self, selection: &str) -> Result<()> {
        let places = self.places("--fix", selection)?;
        let coordinates: Vec<usize> = places.iter().flat_map(|place| &place.dofs).map(|(_, at)| *at).collect();
        self.held.push(Held { name: selection.to_owned(), n_dofs: coordinates.len() });
        self.held_coordinates.extend(coordinates);
        Ok(())
    }

    /// Puts a mass on `a.tip`, in equal parts on its nodes.
    ///
    /// # Errors
    /// [`Error::AssemblyName`]; [`Error::PointMassDofs`] where a node has no dof that carries it, or moves in a direction that its interface was
    /// made without.
    pub fn load(&mut self, selection: &str, mass: PointMass) -> Result<()> {
        let places = self.places("--mass", selection)?;
        let share = 1.0 / places.len() as f64;
        for place in &places {
            let parts = Direction::ALL.map(|direction| {
                let of = if direction.is_rotation() { mass.inertia[direction.axis()] } else { mass.mass };
                (direction, of * share)
            });
            let lacks = |(direction, part): &&(Direction, f64)| *part > 0.0 && self.lacks(place, *direction);
            if let Some((lacking, _)) = parts.iter().find(lacks) {
                let (place, dofs) = (place.name.clone(), place.directions());
                return Err(Error::PointMassDofs { place, lacking: lacking.to_string(), dofs });
            }
            let carried = parts.iter().filter_map(|(d, part)| Some((place.coordinate(Some(*d))?, *part)));
            self.added.extend(carried);
        }
        self.loaded.push(Loaded { name: selection.to_owned(), mass });
        Ok(())
    }

    /// Whether a mass at a place has a direction in which it moves and would not be carried.
    fn lacks(&self, place: &Place, direction: Direction) -> bool {
        let has_translation = place.dofs.iter().any(|(d, _)| d.is_some_and(|d| !d.is_rotation()));
        let superelement = &self.components[place.component].superelement;
        let absence = place.whole.map(|node| absence(superelement, node, direction));
        place.coordinate(Some(direction)).is_none()
            && match absence {
                Some(Absence::AtRest) => false,
                Some(Absence::LeftOut) => true,
                // Where directions are named, these are meant.
                Some(Absence::NotThere) | None => direction.is_rotation() || !has_translation,
            }
    }

    pub(super) fn places(&self, flag: &'static str, text: &str) -> Result<Vec<Place>> {
        Selector { flag, components: &self.components }.places(text)
    }

    /// Coordinates of the components, before anything is joined.
    pub fn n_coordinates(&self) -> usize {
        self.components.iter().map(Component::n_coordinates).sum()
    }

    fn parents(&self) -> Vec<usize> {
        let mut parents: Vec<usize> = (0..self.n_coordinates()).collect();
        self.joined.iter().for_each(|pair| union(&mut parents, *pair));
        parents
    }

    /// The number in the assembly of each coordinate of the components; none where one of `held` is.
    fn numbers(&self, held: &BTreeSet<usize>) -> Vec<Option<usize>> {
        let mut parents = self.parents();
        let roots: Vec<usize> = (0..parents.len()).map(|i| root(&mut parents, i)).collect();
        let held: BTreeSet<usize> = held.iter().map(|at| roots[*at]).collect();
        let mut number_of = vec![None; roots.len()];
        let free = (0..roots.len()).filter(|i| roots[*i] == *i && !held.contains(i));
        free.enumerate().for_each(|(number, at)| number_of[at] = Some(number));
        roots.iter().map(|root| number_of[*root]).collect()
    }

    /// Coordinates of the components that were named to be held.
    pub(super) fn held_coordinates(&self) -> &BTreeSet<usize> {
        &self.held_coordinates
    }

    /// The names of components that are joined to nothing, where there are others.
    pub fn joined_to_nothing(&self) -> impl Iterator<Item = &str> {
        let is_alone = |index: &usize| !self.joints.iter().any(|joint| joint.components.contains(index));
        let all = if self.components.len() > 1 { 0..self.components.len() } else { 0..0 };
        all.filter(move |index| is_alone(index)).map(|index| self.components[index].name.as_str())
    }

    /// The matrices of what moves.
    ///
    /// # Errors
    /// [`Error::AssemblyHeld`] where nothing moves; [`Error::DenseEigen`].
    pub(super) fn assembled(&self) -> Result<Assembled> {
        self.assembled_holding(&self.held_coordinates)
    }

    /// The matrices of the whole with nothing held.
    ///
    /// # Errors
    /// [`Error::DenseEigen`].
    pub(super) fn assembled_free(&self) -> Result<Assembled> {
        self.assembled_holding(&BTreeSet::new())
    }

    fn assembled_holding(&self, held: &BTreeSet<usize>) -> Result<Assembled> {
        let numbers = self.numbers(held);
        let n = numbers.iter().flatten().max().map_or(0, |last| last + 1);
        if n == 0 {
            return Err(Error::AssemblyHeld);
        }
        let [mut stiffness, mut mass, mut rounding, mut doubt] = [0; 4].map(|_| Mat::<f64>::zeros(n, n));
        let mut first = 0;
        let mut blocks = Vec::new();
        for component in &self.components {
            let block = numbers[first..first + component.n_coordinates()].to_vec();
            add(&mut stiffness, &component.stiffness, &block, 1.0);
            add(&mut mass, &component.mass, &block, 1.0);
            let terms = dense::absolute(component.stiffness.as_ref());
            add(&mut rounding, &terms, &block, NOISE_FACTOR * f64::EPSILON);
            add(&mut doubt, &component.doubt, &block, 1.0);
            first += block.len();
            blocks.push(block);
        }
        for (at, part) in self.added.iter().filter_map(|(at, part)| Some((numbers[*at]?, part))) {
            mass[(at, at)] += part;
        }
        let held: Vec<usize> = held.iter().copied().collect();
        let ties = Ties { joined: &self.joined, held: &held, distance: self.distance };
        let motions = rigid_motions(&self.components, &ties)?;
        let mut rigid = Mat::zeros(n, motions.ncols());
        for (row, number) in numbers.iter().enumerate().rev() {
            // The first of joined coordinates has the last word.
            let Some(number) = number else { continue };
            rigid.as_mut().row_mut(*number).copy_from(motions.as_ref().row(row));
        }
        let rigid = dense::orthonormal(rigid.as_ref(), mass.as_ref());
        Ok(Assembled { pencil: Pencil { stiffness, mass, rigid, rounding, doubt }, blocks })
    }

    /// What a coordinate of the assembly is called: the first of those that are joined in it.
    pub(super) fn name_of(&self, number: usize) -> String {
        let at = self.numbers(&self.held_coordinates).iter().position(|own| *own == Some(number)).unwrap_or(0);
        let mut first = 0;
        for component in &self.components {
            if at < first + component.n_coordinates() {
                return component.name_of(at - first);
            }
            first += component.n_coordinates();
        }
        String::new()
    }
}

/// The matrices of what moves, and where the coordinates of each component are in them.
pub(super) struct Assembled {
    pub(super) pencil: Pencil,
    /// For each component the number of each of its coordinates; none where it is held.
    pub(super) blocks: Vec<Vec<Option<usize>>>,
}

/// Adds a multiple of a component's matrix at its places.
fn add(whole: &mut Mat<f64>, part: &Mat<f64>, block: &[Option<usize>], factor: f64) {
    for (j, to_j) in block.iter().enumerate() {
        let Some(to_j) = to_j else { continue };
        for (i, to_i) in block.iter().enumerate() {
            let Some(to_i) = to_i else { continue };
            whole[(*to_i, *to_j)] += factor * part[(i, j)];
        }
    }
}

/// The first coordinate of those that are joined with one.
fn root(parents: &mut [usize], of: usize) -> usize {
    let mut at = of;
    while parents[at] != at {
        parents[at] = parents[parents[at]];
        at = parents[at];
    }
    at
}

fn union(parents: &mut [usize], [i, j]: [usize; 2]) {
    let (i, j) = (root(parents, i), root(parents, j));
    parents[i.max(j)] = i.min(j);
}
