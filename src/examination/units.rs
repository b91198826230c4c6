//! Which units a model may be in, by its density and by the speed of sound.
//!
//! ```text
//! ρ ≥ m / (volume of the box around it)          a part fills some of its box, a frame one part in 10⁵
//! c ≈ h √(K_ii / M_ii) / √3                       h the distance of neighbours: for a bar of linear elements 3c²/h²
//! ```
//! Structures are of materials in which sound travels at 1 to 13 km/s. Rubber and foam are slower, and listed after them. Two
//! numbers tell systems of units apart and not mixtures of them from a sound system: a block of steel with stiffness in N/mm and mass in
//! kilograms is a thin wooden frame in inches. So what fits is listed, and no mass is called wrong.

use serde::Serialize;

use super::sizes::{NodeKind, Sizes};

/// Density of steel in kg/m³.
const DENSITY: f64 = 7850.0;
/// Speed of sound along a bar of it in m/s.
const SPEED: f64 = 5000.0;
/// Mass in the box over that of steel that fills it: a shell of solid elements, of a light metal.
const LEAST_OF_SOLIDS: f64 = 2e-3;
/// That of a frame of beams with a slenderness of a few hundred.
const LEAST_OF_FRAMES: f64 = 5e-6;
/// Tungsten in a box that it fills, and what the estimate is off by.
const MOST_FILLED: f64 = 4.0;
/// The most of rubber and foam.
const MOST_OF_SOFT: f64 = 0.3;
/// How far the speed may be off that of steel, either way: other materials, and elements of other shapes.
const SPEED_OFF: f64 = 8.0;
/// How much slower it is in soft rubber, estimated as badly.
const SOFT_OFF: f64 = 500.0;
/// Smallest extent over the largest below which nodes of beams and shells lie in a plane, and the box has no volume that means anything.
const FLAT: f64 = 1e-2;

/// A system of units that a model may be in.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnitGuess {
    /// Length, mass and time, or what is mixed.
    pub system: &'static str,
    /// The label for `model.units`; none of a system that does not fit together.
    pub label: Option<&'static str>,
    /// Its unit of stiffness.
    pub stiffness: &'static str,
    /// What follows for frequencies.
    pub frequencies: &'static str,
    /// Whether K and M are not in one system of units.
    pub is_mixed: bool,
    /// What to do where the component weighs what the unit of a mixture says.
    #[serde(skip)]
    pub mend: &'static str,
}

/// What is known of the units of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Units {
    /// Nothing: there are no coordinates.
    #[default]
    Untold,
    /// Nothing: the nodes that were given were left out.
    LeftOut,
    /// Nothing: the component has no mass, or no two nodes that are joined.
    NoSpeed,
    /// The nodes lie in a plane or on a line, so that nothing is known of the density.
    NoVolume,
    /// Rows without a place have part of the mass, as amplitudes of a superelement do, and no system fits what the others have.
    NoPlace,
    /// Density and speed of sound are those of these systems, the likeliest first and mixtures last.
    Guessed(Vec<UnitGuess>),
}

impl Units {
    /// The systems that fit.
    pub fn guesses(&self) -> &[UnitGuess] {
        match self {
            Self::Guessed(guesses) => guesses,
            Self::Untold | Self::LeftOut | Self::NoSpeed | Self::NoVolume | Self::NoPlace => &[],
        }
    }

    /// The system, where only one fits and that is none of the mixtures.
    pub fn only(&self) -> Option<&UnitGuess> {
        match self.guesses() {
            [only] if !only.is_mixed => Some(only),
            _ => None,
        }
    }
}

/// A system: metres in its unit of length, kilograms in that of mass as M has it, seconds in the time that frequencies come out in.
struct System {
    guess: UnitGuess,
    length: f64,
    mass: f64,
    time: f64,
}

const fn sound(
    [system, stiffness]: [&'static str; 2],
    label: &'static str,
    frequencies: &'static str,
    [length, mass, time]: [f64; 3],
) -> System {
    System {
        guess: UnitGuess { system, label: Some(label), stiffness, frequencies, is_mixed: false, mend: "" },
        length,
        mass,
        time,
    }
}

const fn mixed(
    [system, stiffness]: [&'static str; 2],
    [frequencies, mend]: [&'static str; 2],
    [length, mass, time]: [f64; 3],
) -> System {
    let guess = UnitGuess { system, label: None, stiffness, frequencies, is_mixed: true, mend };
    System { guess, length, mass, time }
}

const HERTZ: &str = "in Hz";

/// Systems in use, and mixtures that are made by mistake. A pound of mass next to a pound of force makes time run √386 too slow, a
/// kilogram next to N/mm √1000.
static SYSTEMS: [System; 9] = [
    sound(["m, kg, s (N/m, Pa)", "N/m"], "m-kg-s", HERTZ, [1.0, 1.0, 1.0]),
    sound(["mm, t, s (N/mm, MPa)", "N/mm"], "mm-t-s", HERTZ, [1e-3, 1e3, 1.0]),
    sound(["mm, kg, ms (kN/mm, GPa)", "kN/mm"], "mm-kg-ms", "in kHz: 1 of --up-to-hz is 1000 Hz", [1e-3, 1.0, 1e-3]),
    sound(["mm, g, ms (N/mm, MPa)", "N/mm"], "mm-g-ms", "in kHz: 1 of --up-to-hz is 1000 Hz", [1e-3, 1e-3, 1e-3]),
    sound(["cm, g, s (dyn/cm)", "dyn/cm"], "cm-g-s", HERTZ, [1e-2, 1e-3, 1.0]),
    sound(["in, lbf s²/in, s (lbf/in, psi)", "lbf/in"], "in-slinch-s", HERTZ, [0.0254, 175.126_8, 1.0]),
    sound(["ft, slug, s (lbf/ft)", "lbf/ft"], "ft-slug-s", HERTZ, [0.3048, 14.593_9, 1.0]),
    mixed(
        ["stiffness in N/mm, mass in kg, lengths in mm", "N/mm"],
        ["√1000 = 31.6 times too low", "in kg, divide the mass matrix by 1000, so that it is in t"],
        [1e-3, 1.0, 1.0 / 31.622_776_6],
    ),
    mixed(
        ["stiffness in lbf/in, mass in lb, lengths in inches", "lbf/in"],
        ["√386 = 19.6 times too low", "in lb, divide the mass matrix by 386.09, so that it is in lbf s²/in"],
        [0.0254, 0.453_592_37, 1.0 / 19.649],
    ),
];

/// Nodes in another unit of length than the matrices. Where a sound system fits as well, that is the likelier one, and this is not listed.
static NODES_IN_MM: System = mixed(
    ["stiffness in N/m, mass in kg, nodes in mm", "N/m"],
    [
        "right, and inertia and the motion of rigid patches wrong,",
        "in kg, divide the coordinates by 1000, so that they are in m",
    ],
    [1e-3, 1.0, 1.0],
);

/// How a system explains a model.
struct Fit<'a> {
    guess: &'a UnitGuess,
    /// Density of the box over that of steel.
    filled: f64,
    /// Speed of sound over that in steel.
    speed: f64,
}

impl Fit<'_> {
    /// Whether a structure of metal, wood, concrete, plastics or composites explains it.
    fn is_stiff(&self, least: f64) -> bool {
        (least..=MOST_FILLED).contains(&self.filled) && (SPEED_OFF.recip()..=SPEED_OFF).contains(&self.speed)
    }

    /// Whether one of rubber or foam does.
    fn is_soft(&self, least: f64) -> bool {
        (least..=MOST_OF_SOFT).contains(&self.filled) && (SOFT_OFF.recip()..SPEED_OFF.recip()).contains(&self.speed)
    }
}

/// The systems that a model may be in. Where none fits its whole mass, point masses may have most of that, and the rest of it tells.
pub(super) fn of(sizes: Sizes) -> Units {
    let is_empty = |units: &Units| matches!(units, Units::Guessed(guesses) if guesses.is_empty());
    let tried = [(&SYSTEMS[..], sizes.mass), (&SYSTEMS, sizes.light_mass)];
    let mut found = tried.into_iter().map(|(systems, mass)| among(systems, sizes, mass));
    let found = found.find(|units| !is_empty(units));
    found.unwrap_or_else(|| among(std::slice::from_ref(&NODES_IN_MM), sizes, sizes.mass))
}

/// Which of the given systems a model of this mass may be in. The density tells an interval only, so the speed orders the systems.
fn among(systems: &'static [System], sizes: Sizes, mass: f64) -> Units {
    let longest = sizes.extents.iter().fold(0.0f64, |max, extent| max.max(*extent));
    let shortest = sizes.extents.iter().fold(f64::INFINITY, |min, extent| min.min(*extent));
    let (least, flat) = match sizes.nodes {
        NodeKind::Translations => (LEAST_OF_SOLIDS, 0.0),
        NodeKind::Rotations => (LEAST_OF_FRAMES, FLAT),
    };
    if shortest <= flat * longest {
        return Units::NoVolume;
    }
    let volume: f64 = sizes.extents.iter().product();
    let (density, speed) = (mass / volume, sizes.spacing * (sizes.ratio / 3.0).sqrt());
    let fit = |system: &'static System| Fit {
        guess: &system.guess,
        filled: density / (DENSITY * system.length.powi(3) / system.mass),
        speed: speed / (SPEED * system.time / system.length),
    };
    let mut fits: Vec<Fit<'_>> = systems.iter().map(fit).collect();
    fits.sort_by(|a, b| a.speed.ln().abs().total_cmp(&b.speed.ln().abs()));
    let sound = || fits.iter().filter(|fit| !fit.guess.is_mixed);
    let mut found: Vec<&UnitGuess> = sound().filter(|fit| fit.is_stiff(least)).map(|fit| fit.guess).collect();
    found.extend(sound().filter(|fit| fit.is_soft(least)).map(|fit| fit.guess));
    found.extend(fits.iter().filter(|fit| fit.guess.is_mixed && fit.is_stiff(least)).map(|fit| fit.guess));
    Units::Guessed(found.into_iter().cloned().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Young's modulus in Pa and density in kg/m³ of what components are made of.
    const MATERIALS: [(&str, f64, f64); 8] = [
        ("steel", 2.1e11, 7850.0),
        ("aluminium", 7.0e10, 2700.0),
        ("lead", 1.6e10, 11340.0),
        ("tungsten", 4.1e11, 19300.0),
        ("wood", 1.1e10, 500.0),
        ("polyamide", 2.5e9, 1140.0),
        ("rubber", 1.0e7, 1100.0),
        ("carbon fibre", 1.4e11, 1600.0),
    ];

    /// A component in a box of 1 × 0.4 × 0.3 m that it fills to a share, its nodes 0.05 m apart.
    fn component((young, density): (f64, f64), filled: f64, nodes: NodeKind, system: &System) -> Sizes {
        let (length, mass, time) = (system.length, system.mass, system.time);
        Sizes {
            mass: filled * density * 0.12 / mass,
            light_mass: 0.7 * filled * density * 0.12 / mass,
            extents: [1.0, 0.4, 0.3].map(|extent| extent / length),
            spacing: 0.05 / length,
            ratio: 3.0 * young / density * (time / 0.05).powi(2),
            nodes,
        }
    }

    #[test]
    fn every_system_is_among_those_of_a_sound_component() {
        for system in SYSTEMS.iter().filter(|system| !system.guess.is_mixed) {
            for (name, young, density) in MATERIALS {
                for (filled, nodes) in [(1.0, NodeKind::Translations), (0.2, NodeKind::Translations)]
                    .into_iter()
                    .chain([0.3, 1e-2, 1e-4].map(|filled| (filled, NodeKind::Rotations)))
                {
                    let found = of(component((young, density), filled, nodes, system));
                    let place = found.guesses().iter().position(|guess| guess == &system.guess);
                    assert!(place.is_some(), "{name} {filled} {nodes:?} {}: {found:?}", system.guess.system);
                    let is_mixed = found.guesses().iter().map(|guess| guess.is_mixed);
                    assert!(is_mixed.is_sorted(), "{name} {filled} {nodes:?} {}: {found:?}", system.guess.system);
                }
            }
        }
    }

    #[test]
    fn a_solid_of_steel_is_of_its_system_first() {
        for system in &SYSTEMS {
            let found = of(component((2.1e11, 7850.0), 0.5, NodeKind::Translations, system));
            let first = found.guesses().iter().find(|guess| guess.is_mixed == system.guess.is_mixed);
            assert_eq!(first, Some(&system.guess), "{found:?}");
        }
    }

    #[test]
    fn nothing_is_guessed_of_what_is_in_no_system() {
        let steel = component((2.1e11, 7850.0), 0.5, NodeKind::Translations, &SYSTEMS[0]);
        assert_eq!(
            of(Sizes { mass: 1e9 * steel.mass, light_mass: 1e9 * steel.mass, ..steel }),
            Units::Guessed(Vec::new())
        );
        assert_eq!(of(Sizes { ratio: 1e9 * steel.ratio, ..steel }), Units::Guessed(Vec::new()));
    }

    #[test]
    fn nodes_in_another_unit_are_named_where_nothing_else_fits() {
        let found = of(component((2.1e11, 7850.0), 0.5, NodeKind::Translations, &NODES_IN_MM));
        assert_eq!(found, Units::Guessed(vec![NODES_IN_MM.guess.clone()]));
    }

    /// A point mass a thousand times as heavy as the rest says nothing of the density.
    #[test]
    fn point_masses_are_no_density() {
        let steel = component((2.1e11, 7850.0), 0.5, NodeKind::Translations, &SYSTEMS[1]);
        assert_eq!(of(Sizes { mass: 1e3 * steel.mass, ..steel }), of(steel));
    }

    #[test]
    fn a_line_or_a_plane_has_no_density() {
        let frame = component((2.1e11, 7850.0), 1e-2, NodeKind::Rotations, &SYSTEMS[0]);
        for extents in [[1.0, 0.0, 0.0], [1.0, 0.4, 0.0], [1.0, 0.4, 1e-3]] {
            assert_eq!(of(Sizes { extents, ..frame }), Units::NoVolume);
        }
        let sheet = Sizes { extents: [1.0, 0.4, 1e-3], nodes: NodeKind::Translations, ..frame };
        assert!(matches!(of(sheet), Units::Guessed(_)), "the nodes of solids are those of its surface");
    }
}
