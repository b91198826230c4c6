//! A soft part behind a stiff one: its forces are nothing among those of the stiff part, and its coordinates count all the same.

use supel::error::Error;
use supel::model::{CoordinateFit, Model as Checked};
use supel_models::transform::{join, supported, translated};
use supel_models::{Ends, Material, Model, brick};

use crate::frames::with_digits;
use crate::{Ties, compared};

const SIZE: [f64; 3] = [0.14, 0.06, 0.05];
const CELLS: [usize; 3] = [4, 2, 2];
/// Nodes of each block.
const N_NODES: i64 = 45;

/// A steel bar that goes on in one whose Young's modulus is so many times that of steel, held at the steel end or free.
fn bar(share: f64, steel_end: Ends) -> Model {
    let soft = Material { young: share * Material::STEEL_SI.young, density: 1100.0, ..Material::STEEL_SI };
    let [steel, soft] = [Material::STEEL_SI, soft].map(|material| brick(CELLS, SIZE, &material));
    let pairs: Vec<(i64, i64)> = steel.groups["XMAX"].iter().zip(&soft.groups["XMIN"]).map(|(a, b)| (*a, *b)).collect();
    let whole = join(&steel, &translated(&soft, [SIZE[0], 0.0, 0.0]), &pairs);
    let wall = steel.groups["XMIN"].clone();
    match steel_end {
        Ends::Fixed => supported(&whole, |(label, _)| wall.contains(&label)),
        Ends::Free => whole,
    }
}

fn fit(model: &Model, digits: u32) -> Result<CoordinateFit, Error> {
    Ok(compared(Checked::new(with_digits(model, digits))?, Ties::All)?.fit)
}

/// Places of some nodes changed; they count from 0.
type Fault = (&'static str, fn(&mut [[f64; 3]]));

/// Of the end of the soft part.
const FAULTS: [Fault; 3] = [
    ("two nodes exchanged", |nodes| {
        let last = nodes.len() - 1;
        nodes.swap(last, last - 9);
    }),
    ("one node out of place", |nodes| {
        let last = nodes.len() - 1;
        nodes[last][1] += 0.05 * SIZE[0];
    }),
    ("mirrored", |nodes| nodes[N_NODES as usize..].iter_mut().for_each(|x| x[1] = SIZE[1] - x[1])),
];

#[test]
fn wrong_places_in_a_soft_part_are_found() {
    for (share, digits) in [(1e-2, 6), (1e-4, 8), (1e-4, 7), (1e-4, 6), (1e-5, 9), (1e-5, 6), (1e-8, 17)] {
        for (steel_end, name) in [(Ends::Fixed, "held"), (Ends::Free, "free")] {
            let sound = bar(share, steel_end);
            let name = format!("{share:e} of steel, {digits} digits, {name}");
            let of_sound = fit(&sound, digits);
            assert!(matches!(of_sound, Ok(CoordinateFit::Exact | CoordinateFit::Rounded(_))), "{name}: {of_sound:?}");
            for (what, fault) in FAULTS {
                let mut model = sound.clone();
                fault(&mut model.nodes);
                let found = fit(&model, digits);
                // Of a node that costs little K alone does not tell whether its place or a spring holds the rotation, and few digits may not
                // tell how many motions are free.
                let is_refused = matches!(
                    found,
                    Err(Error::CoordinatesDoNotFit { .. } | Error::RotationsHeld { .. } | Error::DigitsTooFew { .. })
                );
                assert!(is_refused, "{name}, {what}: {found:?}");
            }
        }
    }
}
