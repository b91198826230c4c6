//! The bundled bracket: sound as a model, and committed as the generator makes it.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use supel_models::model::{dot, multiply};
use supel_models::*;

fn bundled(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bracket").join(name)
}

#[test]
fn committed_matrices_are_what_the_generator_makes() {
    let model = bracket();
    for (name, entries) in [("stiffness.mtx.gz", &model.stiffness), ("mass.mtx.gz", &model.mass)] {
        let mut committed = String::new();
        let file = File::open(bundled(name)).expect("bundled file");
        flate2::read::GzDecoder::new(file).read_to_string(&mut committed).expect("gzipped text");
        let comment = committed.lines().nth(1).expect("a comment line").trim_start_matches("% ").to_owned();
        let mut made = Vec::new();
        write::matrix_market(&mut made, model.n, entries, &comment).expect("memory takes everything");
        assert!(committed.into_bytes() == made, "{name} differs from the generator: run make-bracket");
    }
}

#[test]
fn bracket_is_one_free_body_of_its_mass() {
    let (model, mesh) = (bracket(), bracket_mesh());
    assert_eq!((model.n, model.nodes.len(), mesh.elements.len()), (4938, 1646, 856));
    assert_eq!((model.groups["BASE"].len(), model.groups["EYE"].len()), (4 * 16 * 3, 32 * 5));
    let largest = model.stiffness.iter().fold(0.0, |largest, entry| entry.2.abs().max(largest));
    for mode in model.rigid_body_modes() {
        let force = multiply(&model.stiffness, &mode);
        let amplitude = mode.iter().fold(0.0, |worst: f64, x| x.abs().max(worst));
        // Rows hold at most 81 entries, and blocks of several elements round each.
        assert!(force.iter().all(|f| f.abs() <= 1e3 * f64::EPSILON * largest * amplitude));
    }
    let [tx, ty, tz, ..] = model.rigid_body_modes();
    let mass = model.total_mass(0);
    // job.toml states these; the bracket is symmetric about x = 0 and y = 0.
    assert!((mass / 2.7252196e-3 - 1.0).abs() < 1e-7, "{mass:e}");
    let moment = |d: usize| -> f64 {
        let positions: Vec<f64> = model.nodes.iter().flat_map(|x| [x[d], 0.0, 0.0]).collect();
        dot(&positions, &multiply(&model.mass, &tx)) / mass
    };
    assert!(moment(0).abs() < 1e-12 && moment(1).abs() < 1e-12 && (moment(2) - 34.1205).abs() < 1e-4, "{}", moment(2));
    assert!((dot(&ty, &multiply(&model.mass, &tz))).abs() < 1e-18);
}

#[cfg(feature = "med")]
#[test]
fn committed_mesh_is_what_the_generator_makes() {
    use hdf5_metno::File;

    let made = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bracket.med");
    med::write(&made, &bracket_mesh(), "lug bracket, millimetres").expect("temporary file");
    let open = |path: &Path| File::open(path).expect("HDF5 file");
    let (committed, made) = (open(&bundled("bracket.med")), open(&made));
    let step = "ENS_MAA/mesh/-0000000000000000001-0000000000000000001";
    let read = |file: &File, name: &str| {
        let dataset = file.dataset(&format!("{step}/{name}")).expect(name);
        dataset.read_raw::<f64>().expect(name)
    };
    for name in ["NOE/COO", "NOE/FAM", "MAI/HE8/NOD"] {
        assert_eq!(read(&committed, name), read(&made, name), "{name} differs from the generator: run make-bracket");
    }
    let coordinates = read(&made, "NOE/COO");
    assert_eq!(coordinates.len(), 3 * 1646);
    for (family, group) in [("FAM_1_BASE", "BASE"), ("FAM_2_EYE", "EYE")] {
        let names = committed.dataset(&format!("FAS/mesh/NOEUD/{family}/GRO/NOM")).expect(family);
        let bytes = names.read_raw::<[i8; 80]>().expect("80 bytes a name");
        let text: String = bytes[0].iter().take_while(|&&byte| byte != 0).map(|&byte| byte as u8 as char).collect();
        assert_eq!(text, group);
    }
}
