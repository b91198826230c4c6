//! Reads a mesh of Gmsh, section by section.

use std::collections::BTreeMap;
use std::path::Path;

use super::element_kind::ElementKind;
use super::entities::{Physical, count, kind_of};
use crate::dofs::Nodes;
use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;
use crate::input::cell_kind::Kind;
use crate::input::file_start::FileStart;
use crate::input::format::Sureness;
use crate::input::mesh::cell_mesh::{CellMesh, named_apart};
use crate::input::mesh::groups::Sets;
use crate::input::mesh::labels::{LABEL, Labels};
use crate::input::mesh::stream::{Form, Stream};

/// Bytes that a node takes.
const NODE: u64 = 32 + LABEL;
/// Bytes that a node of an element takes.
const CORNER: u64 = 8;
/// Items after which their memory is claimed.
const ITEMS_PER_CLAIM: usize = 1 << 10;

/// Whether a file is a mesh of Gmsh.
pub(in crate::input::mesh) fn sureness(start: &FileStart<'_>) -> Sureness {
    if begins(start) { Sureness::Certain } else { Sureness::Unlikely }
}

/// Whether a file begins with the format of a mesh, or with comments, which may stand before it.
pub(in crate::input) fn begins(start: &FileStart<'_>) -> bool {
    start.lines().next().is_some_and(|line| line.starts_with(b"$MeshFormat") || line.starts_with(b"$Comments"))
}

/// A version that is read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    Two,
    Four,
}

/// `$MeshFormat`: version, form and size of numbers.
fn mesh_format(stream: &mut Stream) -> Result<Version> {
    const EXPECTED: &str = "the version, 0 or 1 for text or binary, and the size of a number";
    while stream.next_line("$MeshFormat")? == b"$Comments" {
        stream.skip_past(b"$EndComments")?;
        stream.rest_of_line()?;
    }
    let line = stream.next_line(EXPECTED)?;
    let text = String::from_utf8_lossy(&line);
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let [version, form, size] = words[..] else {
        return Err(stream.error(format!("`{}`", excerpt(&line)), EXPECTED));
    };
    let version = match version {
        "2.2" | "2.1" | "2" => Version::Two,
        "4.1" => Version::Four,
        other => {
            let found = format!("version {} of the format", excerpt(other.as_bytes()));
            return Err(unsupported(stream, &found, "save the mesh as version 4.1 or 2.2 (gmsh -format msh41)"));
        }
    };
    match (form, size) {
        ("0", _) => {}
        ("1", "8") => {
            // The number one tells the order of bytes.
            stream.form = Form::LittleEndian;
            match stream.bytes::<4>("the number one, in four bytes")? {
                [1, 0, 0, 0] => {}
                [0, 0, 0, 1] => stream.form = Form::BigEndian,
                other => return Err(stream.error(format!("{other:?}"), "the number one, in four bytes")),
            }
        }
        _ => return Err(stream.error(format!("`{}`", excerpt(&line)), EXPECTED)),
    }
    stream.skip_past(b"$EndMeshFormat")?;
    stream.rest_of_line()?;
    Ok(version)
}

fn unsupported(stream: &Stream, found: &str, advice: &'static str) -> Error {
    let (path, line) = (stream.path().to_owned(), stream.line());
    Error::DeckUnsupported { path, line, found: found.to_owned(), advice }
}

/// What was read so far.
struct Reader<'a> {
    stream: Stream,
    version: Version,
    claim: Claim<'a>,
    physical: Physical,
    nodes: Nodes,
    /// Found once the nodes are known.
    labels: Option<Labels>,
    mesh: CellMesh,
    /// Sets of nodes, called by the dimension and the number of their group.
    sets: Sets,
    /// The set of each group.
    set_of: BTreeMap<(u8, i64), usize>,
    n_corners: usize,
}

/// Reads a mesh of Gmsh.
pub(in crate::input::mesh) fn read(path: &Path, allowance: &Allowance) -> Result<CellMesh> {
    let mut stream = Stream::open(path)?;
    let version = mesh_format(&mut stream)?;
    let mut reader = Reader {
        stream,
        version,
        claim: allowance.claim(path),
        physical: Physical::default(),
        nodes: Nodes::default(),
        labels: None,
        mesh: CellMesh::default(),
        sets: Sets::default(),
        set_of: BTreeMap::new(),
        n_corners: 0,
    };
    loop {
        let form = std::mem::replace(&mut reader.stream.form, Form::Text);
        let Some(line) = reader.stream.rest_of_line()? else { break };
        let Some(name) = line.strip_prefix(b"$") else { continue };
        reader.stream.form = form;
        let end = [b"$End", name].concat();
        match (name, version) {
            (b"PhysicalNames", _) => reader.physical.read_names(&mut reader.stream, &reader.claim)?,
            (b"Entities", Version::Four) => reader.physical.read_entities(&mut reader.stream, &reader.claim)?,
            (b"PartitionedEntities", _) => {
                return Err(unsupported(&reader.stream, "a partitioned mesh", "save it in one piece"));
            }
            (b"Nodes", Version::Two) => reader.nodes_two()?,
            (b"Nodes", Version::Four) => reader.nodes_four()?,
            (b"Elements", Version::Two) => reader.elements_two()?,
            (b"Elements", Version::Four) => reader.elements_four()?,
            _ => {}
        }
        reader.stream.skip_past(&end)?;
        reader.stream.rest_of_line()?;
    }
    reader.finish()
}

impl Reader<'_> {
    fn nodes_two(&mut self) -> Result<()> {
        const EXPECTED: &str = "a node: number and three coordinates";
        let n = count(&mut self.stream, "the number of nodes")?;
        self.after_count()?;
        for _ in 0..n {
            let label = self.stream.int(EXPECTED)?;
            self.node(label, EXPECTED)?;
        }
        Ok(())
    }

    fn nodes_four(&mut self) -> Result<()> {
        const EXPECTED: &str = "a block of nodes: their numbers, then their coordinates";
        let n_blocks = self.blocks(EXPECTED)?;
        for _ in 0..n_blocks {
            let dimension = self.stream.int(EXPECTED)?;
            let _entity = self.stream.int(EXPECTED)?;
            let is_parametric = self.stream.int(EXPECTED)? != 0;
            let number = self.stream.long(EXPECTED)?;
            let n = self.stream.count(number, EXPECTED)?;
            let first = self.nodes.labels.len();
            for _ in 0..n {
                let label = self.stream.long(EXPECTED)?;
                if self.nodes.labels.len().is_multiple_of(ITEMS_PER_CLAIM) {
                    self.claim.add(NODE * ITEMS_PER_CLAIM as u64)?;
                }
                self.nodes.labels.push(label);
            }
            let n_parameters = if is_parametric { dimension.clamp(0, 3) } else { 0 };
            for _ in first..self.nodes.labels.len() {
                let point = self.point(EXPECTED)?;
                self.nodes.coordinates.push(point);
                for _ in 0..n_parameters {
                    self.stream.any_real(EXPECTED)?;
                }
            }
        }
        Ok(())
    }

    fn elements_two(&mut self) -> Result<()> {
        const EXPECTED: &str = "an element: number, type, tags and nodes";
        self.find_labels()?;
        let n = count(&mut self.stream, "the number of elements")?;
        self.after_count()?;
        let mut n_left = n;
        while n_left > 0 {
            // Binary files say type and number of tags once for many elements.
            let is_text = self.stream.form == Form::Text;
            let (kind, n_follow) = if is_text {
                self.stream.int(EXPECTED)?;
                (self.element_kind(EXPECTED)?, 1)
            } else {
                let kind = self.element_kind(EXPECTED)?;
                let number = self.stream.int(EXPECTED)?;
                (kind, self.stream.count(number, EXPECTED)?)
            };
            let number = self.stream.int(EXPECTED)?;
            let n_tags = self.stream.count(number, EXPECTED)?;
            if n_follow == 0 || n_follow > n_left {
                return Err(self.stream.error(format!("a block of {n_follow} elements"), EXPECTED));
            }
            for _ in 0..n_follow {
                if !is_text {
                    self.stream.int(EXPECTED)?;
                }
                let mut group = 0;
                for tag in 0..n_tags {
                    let value = self.stream.int(EXPECTED)?;
                    group = if tag == 0 { value } else { group };
                }
                let groups: &[i64] = if group == 0 { &[] } else { &[group.saturating_abs()] };
                self.element(kind, groups, EXPECTED)?;
            }
            n_left -= n_follow;
        }
        Ok(())
    }

    fn elements_four(&mut self) -> Result<()> {
        const EXPECTED: &str = "a block of elements: number and nodes of each";
        self.find_labels()?;
        let n_blocks = self.blocks(EXPECTED)?;
        for _ in 0..n_blocks {
            let dimension = self.stream.int(EXPECTED)?;
            let entity = self.stream.int(EXPECTED)?;
            let kind = self.element_kind(EXPECTED)?;
            let number = self.stream.long(EXPECTED)?;
            let n = self.stream.count(number, EXPECTED)?;
            let dimension = u8::try_from(dimension).unwrap_or(u8::MAX);
            let groups = self.physical.of_entity(dimension, entity).to_vec();
            for _ in 0..n {
                self.stream.long(EXPECTED)?;
                self.element(kind, &groups, EXPECTED)?;
            }
        }
        Ok(())
    }

    /// The number of blocks at the head of a section of version 4, behind which come their sum and the numbers from and to.
    fn blocks(&mut self, expected: &str) -> Result<u64> {
        let number = self.stream.long(expected)?;
        for _ in 0..3 {
            self.stream.long(expected)?;
        }
        self.stream.count(number, expected)
    }

    /// In binary files one line end is between a count in text and the numbers.
    fn after_count(&mut self) -> Result<()> {
        if self.stream.form != Form::Text {
            self.stream.rest_of_line()?;
        }
        Ok(())
    }

    fn element_kind(&mut self, expected: &str) -> Result<ElementKind> {
        let number = self.stream.int(expected)?;
        let kind = ElementKind::of(number);
        kind.ok_or_else(|| {
            self.stream.error(format!("elements of type {number}"), "a type whose number of nodes is known")
        })
    }

    fn node(&mut self, label: i64, expected: &str) -> Result<()> {
        if self.nodes.labels.len().is_multiple_of(ITEMS_PER_CLAIM) {
            self.claim.add(NODE * ITEMS_PER_CLAIM as u64)?;
        }
        let point = self.point(expected)?;
        self.nodes.labels.push(label);
        self.nodes.coordinates.push(point);
        Ok(())
    }

    fn point(&mut self, expected: &str) -> Result<[f64; 3]> {
        let mut point = [0.0; 3];
        for coordinate in &mut point {
            *coordinate = self.stream.real(expected)?;
        }
        Ok(point)
    }

    fn find_labels(&mut self) -> Result<()> {
        let labels = Labels::new(&self.nodes.labels).map_err(|[first, _]| {
            self.stream
                .error(format!("node {} twice in the section before", self.nodes.labels[first]), "one node of a number")
        })?;
        self.labels = Some(labels);
        Ok(())
    }

    /// Nodes of one element, into the groups.
    fn element(&mut self, kind: ElementKind, groups: &[i64], expected: &str) -> Result<()> {
        let mut nodes = Vec::with_capacity(kind.n_nodes);
        let is_long = self.stream.form != Form::Text && self.version == Version::Four;
        for _ in 0..kind.n_nodes {
            let label = if is_long { self.stream.long(expected)? } else { self.stream.int(expected)? };
            let index = self.labels.as_ref().and_then(|labels| labels.find(label));
            nodes
                .push(index.ok_or_else(|| self.stream.error(format!("node {label}"), "a node of the section $Nodes"))?);
        }
        if self.n_corners.is_multiple_of(ITEMS_PER_CLAIM) || kind.n_nodes > ITEMS_PER_CLAIM {
            self.claim.add(CORNER * (ITEMS_PER_CLAIM + kind.n_nodes) as u64)?;
        }
        self.n_corners += kind.n_nodes;
        for group in groups {
            let (sets, key) = (&mut self.sets, (kind.dimension, *group));
            let set = *self.set_of.entry(key).or_insert_with(|| sets.named(&format!("{} {group}", kind.dimension)));
            let n_items = self.nodes.labels.len() + self.n_corners;
            self.sets.extend(set, nodes.iter().copied(), (self.stream.path(), n_items))?;
        }
        match kind.kind {
            Kind::Faced(cell) => self.mesh.add(cell, kind.ordered(&nodes)),
            Kind::Faceless => {}
            Kind::Unknown => {
                let words = || format!("{}s of {} nodes", kind_of(kind.dimension), kind.n_nodes);
                self.mesh.unread.get_or_insert_with(words);
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<CellMesh> {
        if self.nodes.labels.is_empty() {
            let path = self.stream.path().to_owned();
            return Err(Error::NoData { path, expected: "nodes in a section $Nodes" });
        }
        self.find_labels()?;
        // A group of more dimensions has the first right to a name.
        let mut by_dimension: [BTreeMap<String, Vec<usize>>; 4] = Default::default();
        for ((dimension, group), set) in &self.set_of {
            let members = self.sets.members(*set).iter().map(|node| *node as usize).collect();
            let groups = &mut by_dimension[usize::from(*dimension)];
            let group: &mut Vec<usize> = groups.entry(self.physical.name(*dimension, *group)).or_default();
            group.extend::<Vec<usize>>(members);
            group.sort_unstable();
            group.dedup();
        }
        let [points, curves, surfaces, volumes] = by_dimension;
        let others = [(2, surfaces), (1, curves), (0, points)].map(|(dimension, groups)| (kind_of(dimension), groups));
        self.nodes.groups = named_apart(volumes, others);
        self.mesh.nodes = self.nodes;
        Ok(self.mesh)
    }
}
