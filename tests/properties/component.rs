//! Random components: a family, its size, an interface, a method and a number of modes.

use proptest::prelude::*;
use supel::job::InterfaceJob;
use supel_models::{Ends, Inertia, Material, Model, Section, brick, frame, membrane, spring};

use crate::chain::{Chain, Method, direct, reduce, rigid_group, rows};

/// What the component is made of. Lengths are multiples of a sixteenth: they shrink to round numbers.
#[derive(Clone, Debug)]
pub(crate) enum Family {
    /// Free hexahedra, on rigid patches.
    Patches { cells: [usize; 3], sixteenths: [u8; 3] },
    /// Free hexahedra, on three corners.
    Corners { cells: [usize; 3], sixteenths: [u8; 3] },
    /// A free sheet on two corners: three rigid-body modes.
    Sheet { cells: [usize; 2], sixteenths: [u8; 2] },
    /// A free chain of beams with bends, on both ends.
    Beams { sixteenths: Vec<[u8; 3]> },
    /// A free chain of springs, on both ends: one rigid-body mode.
    Springs { n: usize },
}

/// A component with what is asked of it.
#[derive(Clone, Debug)]
pub(crate) struct Component {
    pub(crate) family: Family,
    pub(crate) method: Method,
    pub(crate) count: usize,
}

impl Component {
    pub(crate) fn model(&self) -> Model {
        let length = |sixteenths: u8| f64::from(sixteenths) / 16.0;
        match &self.family {
            Family::Patches { cells, sixteenths } | Family::Corners { cells, sixteenths } => {
                brick(*cells, sixteenths.map(length), &Material::UNIT)
            }
            Family::Sheet { cells, sixteenths } => membrane(*cells, sixteenths.map(length), &Material::UNIT),
            Family::Beams { sixteenths } => {
                let mut nodes = vec![[0.0; 3]];
                for step in sixteenths {
                    let last = nodes[nodes.len() - 1];
                    nodes.push(std::array::from_fn(|axis| last[axis] + length(step[axis])));
                }
                let edges: Vec<[usize; 2]> = (0..sixteenths.len()).map(|i| [i, i + 1]).collect();
                frame(&nodes, &edges, &Section::round(0.2), &Material::UNIT, Inertia::Consistent)
            }
            Family::Springs { n } => spring(*n, Ends::Free),
        }
    }

    pub(crate) fn interfaces(&self) -> Vec<InterfaceJob> {
        match &self.family {
            Family::Patches { .. } => vec![rigid_group("XMIN"), rigid_group("XMAX")],
            Family::Corners { cells: [nx, ny, nz], .. } => {
                let label = |i: usize, j: usize, k: usize| (1 + i + (nx + 1) * (j + (ny + 1) * k)) as i64;
                vec![direct("corners", &[label(0, 0, 0), label(*nx, 0, 0), label(0, *ny, *nz)])]
            }
            Family::Sheet { cells: [nx, ny], .. } => {
                vec![direct("corners", &[1, ((nx + 1) * (ny + 1)) as i64])]
            }
            Family::Beams { sixteenths } => vec![direct("ends", &[1, sixteenths.len() as i64 + 1])],
            Family::Springs { n } => vec![rows("ends", &[0, n - 1])],
        }
    }

    pub(crate) fn n_rigid(&self) -> usize {
        match self.family {
            Family::Sheet { .. } => 3,
            Family::Springs { .. } => 1,
            _ => 6,
        }
    }

    pub(crate) fn reduce(&self) -> Chain {
        self.reduced_from(&self.model())
    }

    /// This job for another model of the same nodes.
    pub(crate) fn reduced_from(&self, model: &Model) -> Chain {
        reduce(model, &self.interfaces(), self.method, self.count).unwrap_or_else(|error| panic!("{self:?}: {error}"))
    }

    /// Eigenvalues of the free reduced model in the user's units, ascending.
    pub(crate) fn eigenvalues(chain: &Chain) -> Vec<f64> {
        let unit = chain.partition.scaling.eigenvalue_unit();
        let found = crate::chain::spectrum(chain.reduction.stiffness.as_ref(), chain.reduction.mass.as_ref());
        found.iter().map(|lambda| lambda * unit).collect()
    }
}

/// The smallest of each family that has internal dofs and no cell thinner than a tenth of its length.
fn family() -> impl Strategy<Value = Family> {
    let cells = || [2..=4usize, 1..=2, 1..=2];
    let solid = || [24..=48u8, 10..=24, 8..=20];
    prop_oneof![
        (cells(), solid()).prop_map(|(cells, sixteenths)| Family::Patches { cells, sixteenths }),
        (cells(), solid()).prop_map(|(cells, sixteenths)| Family::Corners { cells, sixteenths }),
        ([2..=5usize, 1..=3], [16..=48u8, 8..=24]).prop_map(|(cells, sixteenths)| Family::Sheet { cells, sixteenths }),
        prop::collection::vec([8..=32u8, 0..=24, 0..=16], 3..=7).prop_map(|sixteenths| Family::Beams { sixteenths }),
        (4..=40usize).prop_map(|n| Family::Springs { n }),
    ]
}

/// The methods that need nothing but a number of modes.
pub(crate) fn method() -> impl Strategy<Value = Method> {
    prop_oneof![
        Just(Method::CraigBampton),
        Just(Method::Herting),
        Just(Method::Rubin),
        Just(Method::Macneal),
        Just(Method::Guyan)
    ]
}

pub(crate) fn component() -> impl Strategy<Value = Component> {
    (family(), method(), 1..=6usize).prop_map(|(family, method, count)| Component { family, method, count })
}
