//! Which units a model may be in, by its density and by the speed of sound.
//!
//! ```text
//! ρ ≈ m / (volume of the box around it)          a part fills some of its box: a lower bound of its density
//! c ≈ h √(K_ii / M_ii) / √3                       h the distance of neighbours: for a bar of linear elements 3c²/h²
//! ```
//! Materials of structures lie within a factor of ten of steel in both. Systems of units that are in use lie a factor of thirty and more
//! apart in one of the two.

use serde::Serialize;

/// Density of steel in kg/m³.
const DENSITY: f64 = 7850.0;
/// Speed of sound along a bar of it in m/s.
const SPEED: f64 = 5000.0;
/// A part of wood or foam in a box that it hardly fills has a density this share of that of steel, as the box tells.
const LEAST_FILLED: f64 = 1e-4;
/// Tungsten in a box that it fills, and what the estimate is off by.
const MOST_FILLED: f64 = 4.0;
/// How far the speed may be off, either way: other materials, and elements of other shapes.
const SPEED_OFF: f64 = 8.0;

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
        guess: UnitGuess { system, label: Some(label), stiffness, frequencies, is_mixed: false },
        length,
        mass,
        time,
    }
}

const fn mixed(
    [system, stiffness]: [&'static str; 2],
    frequencies: &'static str,
    [length, mass, time]: [f64; 3],
) -> System {
    System { guess: UnitGuess { system, label: None, stiffness, frequencies, is_mixed: true }, length, mass, time }
}

const HERTZ: &str = "in Hz";

/// Systems in use, and mixtures that are made by mistake. A pound of mass next to a pound of force makes time run √386 too slow, a
/// kilogram next to N/mm √1000.
const SYSTEMS: [System; 9] = [
    sound(["m, kg, s (N/m, Pa)", "N/m"], "m-kg-s", HERTZ, [1.0, 1.0, 1.0]),
    sound(["mm, t, s (N/mm, MPa)", "N/mm"], "mm-t-s", HERTZ, [1e-3, 1e3, 1.0]),
    sound(["mm, kg, ms (kN/mm, GPa)", "kN/mm"], "mm-kg-ms", "in kHz: 1 of --up-to-hz is 1000 Hz", [1e-3, 1.0, 1e-3]),
    sound(["mm, g, ms (N/mm, MPa)", "N/mm"], "mm-g-ms", "in kHz: 1 of --up-to-hz is 1000 Hz", [1e-3, 1e-3, 1e-3]),
    sound(["cm, g, s (dyn/cm)", "dyn/cm"], "cm-g-s", HERTZ, [1e-2, 1e-3, 1.0]),
    sound(["in, lbf s²/in, s (lbf/in, psi)", "lbf/in"], "in-slinch-s", HERTZ, [0.0254, 175.126_8, 1.0]),
    sound(["ft, slug, s (lbf/ft)", "lbf/ft"], "ft-slug-s", HERTZ, [0.3048, 14.593_9, 1.0]),
    mixed(
        ["stiffness in N/mm, mass in kg, lengths in mm", "N/mm"],
        "√1000 = 31.6 times too low: divide the mass by 1000, so that it is in t",
        [1e-3, 1.0, 1.0 / 31.622_776_6],
    ),
    mixed(
        ["stiffness in lbf/in, mass in lb, lengths in inches", "lbf/in"],
        "√386 = 19.6 times too low: divide the mass by 386.09",
        [0.0254, 0.453_592_37, 1.0 / 19.649],
    ),
];

/// What is measured of a model, in its own units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub(super) mass: f64,
    pub(super) extents: [f64; 3],
    pub(super) spacing: f64,
    /// The median of K_ii / M_ii.
    pub(super) ratio: f64,
}

/// The systems that a model may be in, the likeliest first.
pub(super) fn guesses(sizes: Sizes) -> Vec<UnitGuess> {
    // A flat part has no extent along one axis; its elements have some thickness.
    let longest = sizes.extents.iter().fold(0.0f64, |max, extent| max.max(*extent));
    let volume: f64 = sizes.extents.iter().map(|extent| extent.max(1e-2 * longest)).product();
    let (density, speed) = (sizes.mass / volume, sizes.spacing * (sizes.ratio / 3.0).sqrt());
    let distance = |system: &System| {
        let of_density = density / (DENSITY * system.length.powi(3) / system.mass);
        let of_speed = speed / (SPEED * system.time / system.length);
        let fits =
            (LEAST_FILLED..=MOST_FILLED).contains(&of_density) && (SPEED_OFF.recip()..=SPEED_OFF).contains(&of_speed);
        // A third of its box is what most parts fill.
        fits.then(|| (3.0 * of_density).ln().abs() + of_speed.ln().abs())
    };
    let mut found: Vec<(f64, &UnitGuess)> =
        SYSTEMS.iter().filter_map(|system| Some((distance(system)?, &system.guess))).collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, guess)| guess.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A steel block of 100 × 40 × 30 mm that fills half of its box, in elements of 5 mm.
    fn block(system: &System) -> Sizes {
        let (length, mass, time) = (system.length, system.mass, system.time);
        Sizes {
            mass: 0.5 * DENSITY * 0.1 * 0.04 * 0.03 / mass,
            extents: [0.1, 0.04, 0.03].map(|extent| extent / length),
            spacing: 0.005 / length,
            ratio: 3.0 * (SPEED / 0.005 * time).powi(2),
        }
    }

    #[test]
    fn every_system_is_recognised_by_a_steel_part() {
        for system in &SYSTEMS {
            let found = guesses(block(system));
            assert_eq!(found.first(), Some(&system.guess), "{found:?}");
        }
    }

    #[test]
    fn nothing_is_guessed_of_what_is_in_no_system() {
        let steel = block(&SYSTEMS[0]);
        assert!(guesses(Sizes { mass: 1e9 * steel.mass, ..steel }).is_empty());
        assert!(guesses(Sizes { ratio: 1e9 * steel.ratio, ..steel }).is_empty());
    }
}
