//! Each tensor altered by a part in a thousand or less and the file sealed again: its digest is right, its content not.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::transform::rounded;
use supel_models::{HexMesh, Material, SplitMix64};
use supel_runtime::{Matrix, Metadata, Superelement, Tensors};

use crate::healthy::hinged_blocks;
use crate::place::{Place, supel};

type Alteration<'a> = &'a dyn Fn(&mut Tensors, &mut Metadata);

/// The failed checks of an altered file, as `id name`.
#[track_caller]
fn failures(place: &Place, alter: Alteration<'_>) -> Vec<String> {
    let original = place.superelement("x.supel");
    let (mut tensors, mut metadata) = (original.tensors().clone(), original.metadata().clone());
    alter(&mut tensors, &mut metadata);
    let altered = Superelement::new(tensors, metadata).expect("a superelement still");
    assert!(altered != original, "nothing was altered");
    altered.write(&place.path("altered.supel")).expect("written");
    let ended = supel(&["verify", &place.text("altered.supel"), "--json"]);
    assert_eq!(ended.code, ExitCode::CheckFailed, "{}{}", ended.out, ended.err);
    let document: Value = serde_json::from_str(&ended.out).expect("JSON");
    let checks = document["checks"].as_array().expect("checks");
    let failed = checks.iter().filter(|check| check["verdict"] == "fail");
    let text = |value: &Value| value.as_str().expect("text").to_owned();
    failed.map(|check| format!("{} {}", text(&check["id"]), text(&check["name"]))).collect()
}

/// Asserts that an alteration fails the check that is there for it.
#[track_caller]
fn fails(place: &Place, expected: &str, alter: Alteration<'_>) {
    let failures = failures(place, alter);
    assert!(failures.iter().any(|failure| failure == expected), "expected {expected}, failed {failures:#?}");
}

/// The matrix with entries (i, j) and (j, i) multiplied by a factor, or set to a share of the diagonal where they are zero.
fn changed(matrix: &Matrix, (i, j): (usize, usize), factor: f64) -> Matrix {
    Matrix::from_fn(matrix.rows(), matrix.cols(), |row, col| {
        let value = matrix[(row, col)];
        if (row, col) != (i, j) && (row, col) != (j, i) {
            value
        } else if value == 0.0 {
            (factor - 1.0) * (matrix[(i, i)] * matrix[(j, j)]).sqrt()
        } else {
            value * factor
        }
    })
}

/// Adds to one entry of a matrix that is not symmetric.
fn changed_at(matrix: &Matrix, (i, j): (usize, usize), by: f64) -> Matrix {
    Matrix::from_fn(matrix.rows(), matrix.cols(), |row, col| {
        matrix[(row, col)] + if (row, col) == (i, j) { by } else { 0.0 }
    })
}

const PER_MILLE: f64 = 1.001;

/// Two interface nodes of six dofs; 12 interface coordinates, modal ones behind them.
fn reduced(method: &str) -> Place {
    let place = Place::with_brick();
    let interfaces = "--rigid-interface foot=1,11,31 --rigid-interface head=5,15,35";
    place.reduce(&place.model_flags(), &format!("{interfaces} --method {method} --modes 5")).expect(ExitCode::Done);
    place
}

#[test]
fn stiffness() {
    for method in ["herting", "craig-bampton"] {
        let place = reduced(method);
        for at in [(0, 0), (2, 9), (4, 4), (7, 10)] {
            fails(&place, "M-12 rigid-body motion makes no force", &|tensors, _| {
                tensors.stiffness = changed(&tensors.stiffness, at, PER_MILLE);
            });
        }
        fails(&place, "M-13 interface and modes uncoupled in stiffness", &|tensors, _| {
            tensors.stiffness = changed(&tensors.stiffness, (3, 12), PER_MILLE);
        });
        // The first modal coordinate of Herting's is an inertia-relief mode, which no low frequency feels.
        let first = match method {
            "herting" => "M-18 inertia relief answers unit accelerations",
            _ => "M-14 reduced matrices have the stated frequencies",
        };
        fails(&place, first, &|tensors, _| {
            tensors.stiffness = changed(&tensors.stiffness, (12, 12), PER_MILLE);
        });
        let last = place.superelement("x.supel").n_coordinates() - 1;
        fails(&place, "M-14 reduced matrices have the stated frequencies", &|tensors, _| {
            tensors.stiffness = changed(&tensors.stiffness, (last, last), PER_MILLE);
        });
        fails(&place, "M-25 reduced mass and stiffness are not negative", &|tensors, _| {
            let negative = |i, j| if i == j { -tensors.stiffness[(i, j)] } else { tensors.stiffness[(i, j)] };
            tensors.stiffness = Matrix::from_fn(tensors.stiffness.rows(), tensors.stiffness.cols(), negative);
        });
    }
}

#[test]
fn mass() {
    for method in ["herting", "craig-bampton"] {
        let place = reduced(method);
        let r = place.superelement("x.supel").n_coordinates();
        for at in [(0, 0), (4, 4), (2, 9), (5, 11)] {
            fails(&place, "M-16 mass, centre and inertia are preserved", &|tensors, _| {
                tensors.mass = changed(&tensors.mass, at, PER_MILLE);
            });
        }
        // A translation of the interface and a mode: only gravity sees both. Largest entry of that column.
        let mass = place.superelement("x.supel").tensors().mass.clone();
        let row = (0..3).max_by(|a, b| mass[(*a, 12)].abs().total_cmp(&mass[(*b, 12)].abs())).expect("a row");
        fails(&place, "M-18 loads of gravity are those of M̂", &|tensors, _| {
            tensors.mass = changed(&tensors.mass, (row, 12), PER_MILLE);
        });
        fails(&place, "M-03 modal masses are one", &|tensors, _| {
            tensors.mass = changed(&tensors.mass, (r - 1, r - 1), PER_MILLE);
        });
        fails(&place, "M-25 reduced mass and stiffness are not negative", &|tensors, _| {
            tensors.mass = changed(&tensors.mass, (0, 0), -1.0);
        });
    }
}

#[test]
fn rigid_body_modes() {
    let place = reduced("herting");
    for at in [(0, 0), (3, 3), (8, 4)] {
        fails(&place, "M-05 rigid-body modes fit the interface nodes", &|tensors, _| {
            tensors.rigid_body_modes = changed_at(&tensors.rigid_body_modes, at, 1e-6);
        });
    }
    fails(&place, "M-12 rigid-body motion makes no force", &|tensors, _| {
        tensors.rigid_body_modes = changed_at(&tensors.rigid_body_modes, (0, 0), 1e-3);
    });
}

/// Without a rigid-body mode the file claims a motion to be elastic that costs no energy.
#[test]
fn a_rigid_body_mode_left_out() {
    let place = reduced("herting");
    fails(&place, "M-12 no other motion is free", &|tensors, metadata| {
        let fewer = |matrix: &Matrix, rows, cols| Matrix::from_fn(rows, cols, |i, j| matrix[(i, j)]);
        let r = tensors.rigid_body_modes.rows();
        tensors.rigid_body_modes = fewer(&tensors.rigid_body_modes, r, 5);
        tensors.rigid_body_mass = fewer(&tensors.rigid_body_mass, 5, 5);
        metadata.model.rigid_body_modes = supel_runtime::RigidBodyModes::Algebraic;
        metadata.model.mass_properties = None;
    });
}

#[test]
fn rigid_body_mass() {
    let place = reduced("craig-bampton");
    for at in [(0, 0), (5, 5), (1, 5)] {
        fails(&place, "M-16 mass, centre and inertia are preserved", &|tensors, _| {
            tensors.rigid_body_mass = changed(&tensors.rigid_body_mass, at, 1.0001);
        });
    }
}

/// A file has all entries of a symmetric matrix, and a reader may take them from either triangle.
#[test]
fn either_triangle_of_the_rigid_body_mass() {
    let place = reduced("craig-bampton");
    for at in [(1, 5), (5, 1), (0, 2), (4, 3)] {
        fails(&place, "M-16 mass, centre and inertia are preserved", &|tensors, _| {
            let size = (tensors.rigid_body_mass[(at.0, at.0)] * tensors.rigid_body_mass[(at.1, at.1)]).sqrt();
            tensors.rigid_body_mass = changed_at(&tensors.rigid_body_mass, at, 1e-3 * size);
        });
    }
}

#[test]
fn positions() {
    let place = reduced("herting");
    fails(&place, "M-05 rigid-body modes fit the interface nodes", &|tensors, metadata| {
        tensors.interface_positions[1][2] += 1e-6;
        metadata.interface_nodes[1].position = tensors.interface_positions[1];
    });
}

#[test]
fn names_exchanged_between_interfaces() {
    let place = reduced("herting");
    fails(&place, "M-26 file is what its job asks for", &|_, metadata| {
        let [a, b] = [0, 1].map(|at| metadata.interface_nodes[at].name.clone());
        assert_ne!(a, b);
        (metadata.interface_nodes[0].name, metadata.interface_nodes[1].name) = (b, a);
    });
}

#[test]
fn frames() {
    let place = reduced("herting");
    fails(&place, "M-26 file is what its job asks for", &|tensors, _| {
        tensors.interface_frames[0] = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    });
}

#[test]
fn frequencies() {
    for method in ["herting", "craig-bampton"] {
        let place = reduced(method);
        fails(&place, "M-14 reduced matrices have the stated frequencies", &|tensors, metadata| {
            tensors.frequencies[2] *= 1.00001;
            for coordinate in &mut metadata.coordinates {
                use supel_runtime::Coordinate::{ElasticMode, FixedInterfaceMode};
                if let ElasticMode { mode: 2, frequency_hz, .. } | FixedInterfaceMode { mode: 2, frequency_hz, .. } =
                    coordinate
                {
                    *frequency_hz = tensors.frequencies[2] / std::f64::consts::TAU;
                }
            }
        });
    }
}

#[test]
fn gravity() {
    let place = reduced("herting");
    let r = place.superelement("x.supel").n_coordinates();
    for at in [(0, 0), (7, 1), (r - 1, 2)] {
        let size = place.superelement("x.supel").tensors().gravity.as_ref().expect("gravity")[(2, 2)];
        fails(&place, "M-18 loads of gravity are those of M̂", &|tensors, _| {
            tensors.gravity = tensors.gravity.as_ref().map(|gravity| changed_at(gravity, at, 1e-4 * size));
        });
    }
}

/// What mechanisms add to the zero modes takes nothing from what gravity is.
#[test]
fn gravity_of_a_hinged_part() {
    let place = Place::with(&hinged_blocks());
    for method in ["herting", "craig-bampton"] {
        let rest = format!("--interface here=1,2,4,7 --interface there=15,18,21 --method {method} --modes 4");
        place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
        let made = place.superelement("x.supel");
        let gravity = made.tensors().gravity.as_ref().expect("gravity");
        let modal = (made.n_interface()..made.n_coordinates()).flat_map(|i| (0..3).map(move |j| (i, j)));
        let largest = modal.max_by(|a, b| gravity[*a].abs().total_cmp(&gravity[*b].abs())).expect("modes");
        for by in [0.02, -2.0] {
            fails(&place, "M-18 loads of gravity are those of M̂", &|tensors, _| {
                tensors.gravity = Some(changed_at(gravity, largest, by * gravity[largest]));
            });
        }
    }
}

#[test]
fn mixing() {
    let place = reduced("herting");
    let n = place.superelement("x.supel").n_modal();
    let changed = |at: (usize, usize)| {
        move |tensors: &mut Tensors, _: &mut Metadata| {
            let mixing = tensors.mixing.as_ref().expect("mixing");
            let by = 1e-3 * mixing[(at.1, at.1)];
            tensors.mixing = Some(changed_at(mixing, at, by));
        }
    };
    fails(&place, "M-18 inertia relief answers unit accelerations", &changed((1, 1)));
    fails(&place, "M-14 named modes are eigenpairs of K̂ and M̂", &changed((n - 2, n - 1)));
}

#[test]
fn what_the_file_says_of_itself() {
    let place = reduced("herting");
    fails(&place, "M-16 stated mass properties are those of M_F", &|_, metadata| {
        metadata.model.mass_properties.as_mut().expect("known").mass *= PER_MILLE;
    });
    // A small product of inertia changed by a thousandth is a change of this size.
    fails(&place, "M-16 stated mass properties are those of M_F", &|_, metadata| {
        let properties = metadata.model.mass_properties.as_mut().expect("known");
        properties.inertia[0][1] += 1e-8 * properties.inertia[0][0];
    });
    fails(&place, "M-16 mass and centre are those expected", &|_, metadata| {
        metadata.job["model"]["expect"] = serde_json::json!({ "mass": 1.0 });
    });
    fails(&place, "M-26 no check failed when it was made", &|_, metadata| {
        metadata.verification.verdict = supel_runtime::Verdict::Fail;
    });
    fails(&place, "M-26 file is what its job asks for", &|_, metadata| {
        metadata.method = supel_runtime::Method::CraigBampton;
    });
}

/// What follows from content and method holds whatever version a file names.
#[test]
fn columns_are_those_of_the_method_in_any_version() {
    fails(&reduced("herting"), "M-26 its parts belong together", &|_, metadata| {
        metadata.generator.version = "99.0.0".to_owned();
        metadata.method = supel_runtime::Method::CraigBampton;
    });
}

/// Error bars cannot excuse what is wrong.
#[test]
fn error_bars_without_end_excuse_nothing() {
    let place = reduced("herting");
    fails(&place, "M-12 rigid-body motion makes no force", &|tensors, metadata| {
        tensors.stiffness = changed(&tensors.stiffness, (0, 0), 1.1);
        for coordinate in &mut metadata.coordinates {
            if let supel_runtime::Coordinate::ElasticMode { error_bar_hz, .. } = coordinate {
                *error_bar_hz = Some(1e9);
            }
        }
    });
}

/// Bytes that no reader looks at are refused by the format; a damaged file never gets as far as the checks.
#[test]
fn a_file_not_sealed_again_is_an_input_error() {
    let place = reduced("herting");
    let mut bytes = place.bytes("x.supel");
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    place.write("altered.supel", &bytes);
    supel(&["verify", &place.text("altered.supel")]).expect(ExitCode::InputData);
}

/// K of six digits lets rigid-body motion pass to a thousandth of the first elastic energy. The modes that are found again are those of
/// the file all the same, so that an entry between interface and modes is known to many more digits.
#[test]
fn few_digits_hide_no_changed_entry() {
    // Nodes off their places, so that no two elements round alike.
    let mut random = SplitMix64::new(7);
    let mut mesh = HexMesh::structured([4, 2, 2], |[x, y, z]| [0.3 * x, 0.2 * y, 0.1 * z], |_| true);
    mesh.nodes.iter_mut().flatten().for_each(|x| *x += 0.01 * (random.uniform() - 0.5));
    let place = Place::with(&rounded(&mesh.assemble(&Material::STEEL_SI), 6));
    let job = "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\nnodes = \"nodes.csv\"\ndofs = \"dofs.txt\"\n\
               [[interface]]\nname = \"a\"\nnodes = [1, 6, 16]\ncoupling = \"rigid\"\n\
               [[interface]]\nname = \"b\"\nnodes = [5, 10, 20]\n\
               [reduction]\nmethod = \"herting\"\nmodes = { count = 6 }\n[write]\nsuperelement = \"x.supel\"\n";
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    let verified = |file: &str| supel(&["verify", &place.text(file), "--job", &place.text("job.toml")]);
    verified("x.supel").expect(ExitCode::Done);
    let original = place.superelement("x.supel");
    let (mut tensors, metadata) = (original.tensors().clone(), original.metadata().clone());
    let (last, mass) = (original.n_coordinates() - 1, &original.tensors().mass);
    let size = (mass[(3, 3)] * mass[(last, last)]).sqrt();
    tensors.mass = Matrix::from_fn(mass.rows(), mass.cols(), |i, j| {
        mass[(i, j)] + if (i, j) == (3, last) || (i, j) == (last, 3) { 1e-3 * size } else { 0.0 }
    });
    let altered = Superelement::new(tensors, metadata).expect("a superelement still");
    altered.write(&place.path("altered.supel")).expect("written");
    let ended = verified("altered.supel");
    assert_eq!(ended.code, ExitCode::CheckFailed, "{}{}", ended.out, ended.err);
    assert!(ended.out.contains("mass is that of the full model"), "{}", ended.out);
}
