//! Centre and radius of gyration of a mass that its motions tell, M_F = [m I, −m c̃; m c̃, J] in the six unit motions about a point.
//!
//! A model in a plane has translations along two axes or one, and the entries of the others are zero:
//!
//! ```text
//! m c_x = M_F(y, rz) = −M_F(z, ry)      m c_y = M_F(z, rx) = −M_F(x, rz)      m c_z = M_F(x, ry) = −M_F(y, rx)
//! J_aa  = Σ_{d ≠ a} m_d (lever of a on d)²    of the translations d that there are, and what rotates by itself
//! m c_x = e_xᵀM(x e_x)    from the coordinates of the rows along x alone, where no other direction tells
//! ```

use faer::MatRef;

use crate::model::Weight;

/// The axes of a model in space.
pub(crate) const ALL_AXES: [usize; 3] = [0, 1, 2];

/// For each coordinate of the centre the two entries of M_F that tell it: translation, rotation and sign.
const FIRST_MOMENTS: [[(usize, usize, f64); 2]; 3] =
    [[(1, 5, 1.0), (2, 4, -1.0)], [(2, 3, 1.0), (0, 5, -1.0)], [(0, 4, 1.0), (1, 3, -1.0)]];

/// Share of the mass by which one direction has to have more than another to be believed instead.
const MORE: f64 = 1e-9;

#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) centre: [f64; 3],
    /// The radius of gyration, the length that a shift of the centre is compared with.
    pub(super) gyration: f64,
}

impl Place {
    /// Of a body that moves along all axes.
    pub(super) fn of(m_f: MatRef<'_, f64>, mass: f64) -> Self {
        let centre = centre(m_f, None);
        Self { centre, gyration: gyration((m_f, mass), &ALL_AXES, centre).unwrap_or(0.0) }
    }

    /// Of a whole model; nothing without coordinates.
    pub(super) fn of_weight(weight: &Weight, mass: f64) -> Option<Self> {
        let m_f = weight.motions.as_ref()?.as_ref();
        let centre = centre(m_f, Some(weight.along_themselves));
        // A straight line of masses that move along it alone has no moment of inertia, but a length.
        Some(Self { centre, gyration: gyration((m_f, mass), &weight.axes, centre).unwrap_or(weight.extent) })
    }

    /// How far the centre is from a point, relative to the radius of gyration.
    pub(super) fn shift_from(self, point: [f64; 3]) -> f64 {
        let distance = ALL_AXES.iter().map(|&k| (self.centre[k] - point[k]).powi(2)).sum::<f64>().sqrt();
        if distance == 0.0 { 0.0 } else { distance / self.gyration }
    }
}

/// The centre: each coordinate by a direction of which no other has more mass, for supports and parts in a plane take mass out of some. With
/// `along`, m_d times the coordinate along each direction d itself, that one tells as well; a coordinate that none tells is zero.
pub(super) fn centre(m_f: MatRef<'_, f64>, along: Option<[f64; 3]>) -> [f64; 3] {
    ALL_AXES.map(|k| {
        let across = FIRST_MOMENTS[k].map(|(d, rotation, sign)| (m_f[(d, d)], sign * m_f[(d, rotation)]));
        let itself = along.map(|along| (m_f[(k, k)], along[k]));
        let most = |best: (f64, f64), next: (f64, f64)| if next.0 > (1.0 + MORE) * best.0 { next } else { best };
        let (mass, moment) = across.into_iter().chain(itself).fold((0.0, 0.0), most);
        if mass > 0.0 { moment / mass } else { 0.0 }
    })
}

/// Σ c_e² over the levers e that the rotation about an axis has on the translations there are.
pub(super) fn square_levers(axes: &[usize], centre: [f64; 3], about: usize) -> f64 {
    axes.iter().filter(|&&d| d != about).map(|d| centre[3 - about - d].powi(2)).sum()
}

/// √(tr J / (g m)) about the centre, g = 2 of a model in space and 1 of one in a plane, where two of the levers of a mass are its distances
/// in the plane; nothing of a point about the origin.
fn gyration((m_f, mass): (MatRef<'_, f64>, f64), axes: &[usize], centre: [f64; 3]) -> Option<f64> {
    let in_planes = if axes.len() == 3 { 2.0 } else { 1.0 };
    let about_origin = (m_f[(3, 3)] + m_f[(4, 4)] + m_f[(5, 5)]) / (in_planes * mass);
    let of_centre: f64 = ALL_AXES.iter().map(|&a| square_levers(axes, centre, a)).sum();
    let square = about_origin - of_centre / in_planes;
    // A point has none; what rounding leaves of one is not a length to compare with.
    let length = if square > f64::EPSILON * about_origin { square.sqrt() } else { about_origin.sqrt() };
    (length > 0.0).then_some(length)
}
