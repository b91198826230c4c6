//! A film strip: a solid at several instants, seen along the y axis, coloured by its deformation.

use std::collections::BTreeMap;
use std::fmt::Write;

use supel_models::HexMesh;

/// Faces of a hexahedron, corners counted from outside.
const FACES: [[usize; 4]; 6] = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// Places of all nodes at one instant, and how far each has gone from where the floating frame alone would have it.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Time, s.
    pub time: f64,
    /// Place of each node.
    pub places: Vec<[f64; 3]>,
    /// Length of the deformation at each node.
    pub deformations: Vec<f64>,
}

/// Side of a picture, px.
const SIDE: f64 = 300.0;
const CAPTION: f64 = 34.0;

/// The frames side by side as SVG: z to the right, x downwards, within a square of the model about a middle.
pub fn strip(mesh: &HexMesh, frames: &[Frame], middle: [f64; 2], half_width: f64) -> String {
    let faces = outer_faces(mesh);
    let largest = frames.iter().flat_map(|frame| &frame.deformations).fold(0.0_f64, |largest, d| largest.max(*d));
    let (width, height) = (SIDE * frames.len() as f64, SIDE + CAPTION);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"22\">\n"
    );
    for (number, frame) in frames.iter().enumerate() {
        let left = SIDE * number as f64;
        let scale = SIDE / (2.0 * half_width);
        let place = |node: u32| {
            let [x, _, z] = frame.places[node as usize];
            (left + scale * (z - middle[1] + half_width), scale * (x - middle[0] + half_width))
        };
        // Writing to a text cannot fail. From far to near, so that near faces cover far ones.
        for face in seen(frame, &faces) {
            let deformation = face.iter().map(|node| frame.deformations[*node as usize]).sum::<f64>() / 4.0;
            let corners: Vec<String> = face.map(place).iter().map(|(a, b)| format!("{a:.1},{b:.1}")).collect();
            let colour = shade(deformation / largest);
            let _ = writeln!(
                svg,
                "<polygon points=\"{}\" fill=\"{colour}\" stroke=\"#333\" stroke-width=\".3\"/>",
                corners.join(" ")
            );
        }
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{}\">{:.2} s</text>", left + 8.0, height - 8.0, frame.time);
    }
    let _ = writeln!(svg, "<text x=\"8\" y=\"24\">deformation: grey none, orange {largest:.2} mm</text>");
    svg + "</svg>\n"
}

/// Faces that belong to one element.
fn outer_faces(mesh: &HexMesh) -> Vec<[u32; 4]> {
    let mut faces: BTreeMap<[u32; 4], Vec<[u32; 4]>> = BTreeMap::new();
    for face in mesh.elements.iter().flat_map(|corners| FACES.map(|face| face.map(|corner| corners[corner]))) {
        let mut key = face;
        key.sort_unstable();
        faces.entry(key).or_default().push(face);
    }
    faces.into_values().filter(|shared| shared.len() == 1).flatten().collect()
}

/// The faces from the farthest to the nearest for an observer at y = −∞.
fn seen(frame: &Frame, faces: &[[u32; 4]]) -> Vec<[u32; 4]> {
    let depth = |face: &[u32; 4]| face.iter().map(|node| frame.places[*node as usize][1]).sum::<f64>();
    let mut faces = faces.to_vec();
    faces.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
    faces
}

/// From light grey to dark orange.
fn shade(share: f64) -> String {
    let mix = |low: f64, high: f64| (low + (high - low) * share.clamp(0.0, 1.0)).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mix(232.0, 190.0), mix(236.0, 70.0), mix(240.0, 10.0))
}
