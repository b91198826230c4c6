//! One of the examples: what the paper says of it and leaves open, and how it is run.

use std::path::Path;

use supel_runtime::Superelement;

use super::run::Run;
use super::variant::Variant;
use super::{bend, crank, elbow, rotating, spherical};
use crate::Result;
use crate::curve::Curves;
use crate::integrator::Scheme;
use crate::part::Part;
use crate::statics::Tangent;

/// One of the examples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Example {
    /// 5.1, static.
    Bend,
    /// 5.2.
    Rotating,
    /// 5.3.
    Spherical,
    /// 5.4.
    Crank,
    /// 5.5.
    Elbow,
}

impl Example {
    /// All of them, in the order of the paper.
    pub const ALL: [Self; 5] = [Self::Bend, Self::Rotating, Self::Spherical, Self::Crank, Self::Elbow];

    /// Name on the command line and of the folder.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bend => "bend",
            Self::Rotating => "rotating",
            Self::Spherical => "spherical",
            Self::Crank => "crank",
            Self::Elbow => "elbow",
        }
    }

    /// Heading of the paper.
    pub fn title(self) -> &'static str {
        match self {
            Self::Bend => "5.1 Static problem: 45 degree bend beam",
            Self::Rotating => "5.2 Rotating beam",
            Self::Spherical => "5.3 Beam on a spherical joint",
            Self::Crank => "5.4 Flexible slider–crank mechanism",
            Self::Elbow => "5.5 Out-of-plane loading of a right angle beam",
        }
    }

    /// What the paper leaves open and is chosen here, and what the curves depend on.
    pub fn note(self) -> &'static str {
        match self {
            Self::Bend => {
                "The floating frame is defined by Y = U of the reduced model, the mid-frame of the two nodes; with the rows \
                 of the finite element mesh the figures differ, and both converge."
            }
            Self::Rotating => {
                "Modes are bending modes clamped at the root, made mode-accelerated columns X_I − Ψ_S X_B, without \
                 inertia-relief modes. The residual vibration after 15 s has 1.6 % of the largest deflection."
            }
            Self::Spherical => {
                "The time step of the paper is not converged: the reference has the same step and scheme. Its angular velocity \
                 is uncertain by 2 % (maximum); the place of the tip, which the paper does not show, is the robust measure. Modes \
                 are clamped at the root."
            }
            Self::Crank => {
                "The paper gives no shear stiffness: GA = 5/6 EA/2.6. The drive is prescribed at position level, so that its \
                 sudden lock at 5 s is an impulse. After the lock errors are drift of the phase: 5 s to 7 s is judged. Modes are \
                 free ones."
            }
            Self::Elbow => {
                "The paper gives no polar inertia: 20 kg m, the sum of the other two. Modes are free ones. With them strategy 1 \
                 becomes worse, which the paper does not say of it alone."
            }
        }
    }

    /// What the paper says of the iterations per step; none for the static example.
    pub fn iterations(self) -> Option<&'static str> {
        match self {
            Self::Bend => None,
            Self::Rotating => Some("about 2"),
            Self::Spherical => Some("about 3"),
            Self::Crank => Some("less than about 4"),
            Self::Elbow => Some("about 2"),
        }
    }

    /// Layouts and numbers of modes of the paper.
    pub fn models(self) -> &'static [(usize, usize)] {
        match self {
            Self::Bend => &[(1, 0), (2, 0), (4, 0)],
            Self::Rotating => &[(1, 0), (1, 3)],
            Self::Spherical => &[(1, 0), (1, 6), (1, 12)],
            Self::Crank => &[(2, 0), (2, 3)],
            Self::Elbow => &[(1, 0), (2, 0), (3, 0), (1, 6), (2, 6), (3, 6)],
        }
    }

    /// What a layout and its modes are, in words.
    pub fn label(self, (layout, n_modes): (usize, usize)) -> String {
        let elements = match (self, layout) {
            (Self::Bend | Self::Rotating | Self::Spherical, 1) => "one element".to_owned(),
            (Self::Bend | Self::Rotating | Self::Spherical, n) => format!("{n} elements"),
            (Self::Crank, _) => "two elements".to_owned(),
            (Self::Elbow, strategy) => format!("strategy {strategy}"),
        };
        if n_modes == 0 { elements } else { format!("{elements} + {n_modes} modes") }
    }

    /// The parts of a layout.
    pub fn parts(self, layout: usize) -> Vec<Part> {
        match self {
            Self::Bend => bend::parts(layout),
            Self::Rotating => rotating::parts(layout),
            Self::Spherical => spherical::parts(),
            Self::Crank => crank::parts(),
            Self::Elbow => elbow::parts(layout),
        }
    }

    /// The time integration of the paper; none for the static example.
    pub fn scheme(self) -> Option<Scheme> {
        match self {
            Self::Bend => None,
            Self::Rotating => Some(rotating::SCHEME),
            Self::Spherical => Some(spherical::SCHEME),
            Self::Crank => Some(crank::SCHEME),
            Self::Elbow => Some(elbow::SCHEME),
        }
    }

    /// Runs a variant with the superelements of its parts, with another time integration than the example's own where one
    /// is given.
    ///
    /// # Errors
    /// A superelement that the component refuses. A run that stops is not an error.
    pub fn run(self, parts: &[Superelement], variant: &Variant, scheme: Option<Scheme>) -> Result<Run> {
        let or = |own: Scheme| scheme.unwrap_or(own);
        match self {
            Self::Bend => bend::run(parts, variant, Tangent::Papers),
            Self::Rotating => rotating::run(parts, variant, &or(rotating::SCHEME)),
            Self::Spherical => spherical::run(parts, variant, &or(spherical::SCHEME)),
            Self::Crank => crank::run(parts, variant, &or(crank::SCHEME)),
            Self::Elbow => elbow::run(parts, variant, &or(elbow::SCHEME)),
        }
    }

    /// Tolerances at which iterations are counted. In 5.2 the floor is above the forces of bending, which are lost above
    /// 1e-6.
    pub fn tolerances(self) -> &'static [f64] {
        match self {
            Self::Bend => &[],
            Self::Rotating => &[1e-6, 1e-7, 1e-8],
            Self::Spherical | Self::Crank | Self::Elbow => &[1e-3, 1e-4, 1e-5, 1e-6],
        }
    }

    /// The one of these at which the paper's words on iterations are judged; the paper names none.
    ///
    /// # Panics
    /// If the example is static.
    pub fn counted_at(self) -> f64 {
        match self {
            Self::Bend => panic!("a static example has no time steps"),
            Self::Rotating | Self::Spherical => 1e-6,
            Self::Crank => 1e-5,
            Self::Elbow => 1e-3,
        }
    }

    /// How far the two codes of the reference agree, see `fixtures/paper`.
    pub fn uncertainty(self) -> &'static str {
        match self {
            Self::Bend => "codes agree within 1e-7",
            Self::Rotating => "codes agree within 0.007 % (RMS)",
            Self::Spherical => "codes agree within 0.5 % (RMS) of the angular velocity and 5 mm of the tip",
            Self::Crank => "codes agree within 0.0014 % before the lock, after it 0.19 % of M and 0.47 % of N (RMS)",
            Self::Elbow => "codes agree within 0.005 % (RMS)",
        }
    }

    /// The reference curves in `fixtures/paper`.
    ///
    /// # Errors
    /// The file is missing or damaged.
    pub fn reference(self) -> Result<Curves> {
        let file = match self {
            Self::Bend => "ex51_ref.csv",
            Self::Rotating => "ex52_ref.csv",
            Self::Spherical => "ex53_ref_h20ms.csv",
            Self::Crank => "ex54_ref.csv",
            Self::Elbow => "ex55_ref.csv",
        };
        Curves::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/paper").join(file))
    }
}
