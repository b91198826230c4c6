//! Damping of components in mechanisms that move, against closed forms.

use supel_runtime::component::{FloatingFrame, Measures};
use supel_runtime::motion::{Vector3, cross, dot};
use supel_runtime::{Matrix, Superelement, Tensors};
use validation::beam::{Section, polyline};
use validation::integrator::{IterationMatrix, Scheme, simulate};
use validation::joint::{CLAMPED, FREE, Joint, Kind, SPHERICAL, Side, Support};
use validation::part::{Part, reduced};
use validation::selection::{Modes, selected};
use validation::system::{Formulation, System};

const FORMULATION: Formulation = Formulation { frame: FloatingFrame::MassWeighted, measures: Measures::MotionBased };
/// Without numerical damping, which would hide what is tested.
const SCHEME: Scheme = Scheme {
    step: 1e-3,
    n_steps: 1000,
    spectral_radius: 1.0,
    tolerance: 1e-10,
    floor: 0.0,
    matrix: IterationMatrix::Constant,
};
const SECTION: Section =
    Section { axial: 1e6, shear: [4e5; 2], torsion: 1e3, bending: [1e3, 2e3], mass: 5.0, inertia: [2e-3, 1e-3, 1e-3] };

fn beam(points: &[Vector3], interface: Vec<Vec<i64>>, n_modes: usize) -> Superelement {
    let part = Part {
        name: "beam".into(),
        model: polyline(points, 8, &SECTION),
        interface,
        recovered: Vec::new(),
        units: "m-kg-s",
        n_modes,
    };
    let folder = tempfile::tempdir().expect("folder");
    reduced(&part.write(folder.path()).expect("written")).expect("verified")
}

fn with(superelement: &Superelement, change: impl Fn(&mut Tensors)) -> Superelement {
    let mut tensors = superelement.tensors().clone();
    change(&mut tensors);
    Superelement::new(tensors, superelement.metadata().clone()).expect("the parts fit")
}

fn sum(a: f64, x: &Matrix, b: f64, y: &Matrix) -> Matrix {
    Matrix::from_fn(x.rows(), x.cols(), |i, j| a * x[(i, j)] + b * y[(i, j)])
}

/// The free body of one node with the inertia of a sphere about it, which [`beam`] gives the form.
fn sphere(mass: f64, inertia: f64, damping: impl Fn(usize, usize) -> f64) -> Superelement {
    let form = beam(&[[0.4, 0.1, 0.0], [1.0, 0.1, 0.0]], vec![vec![1]], 0);
    let form = selected(&form, Modes::Free(0)).expect("no modes");
    with(&form, |tensors| {
        let diagonal = |i: usize, j: usize| match (i == j, i < 3) {
            (true, true) => mass,
            (true, false) => inertia,
            _ => 0.0,
        };
        tensors.stiffness = Matrix::from_fn(6, 6, |_, _| 0.0);
        tensors.mass = Matrix::from_fn(6, 6, diagonal);
        let u = tensors.rigid_body_modes.clone();
        let entry = |a: usize, b: usize| (0..6).map(|i| u[(i, a)] * diagonal(i, i) * u[(i, b)]).sum();
        tensors.rigid_body_mass = Matrix::from_fn(6, 6, entry);
        tensors.gravity = None;
        tensors.damping = Some(Matrix::from_fn(6, 6, &damping));
    })
}

/// A beam that vibrates in its first mode with Rayleigh's damping α M + β K decays at (α + β ω²)/2.
#[test]
fn clamped_beam_decays_at_the_rate_of_its_mode() {
    let (of_mass, of_stiffness) = (0.8, 2e-3);
    let free =
        selected(&beam(&[[0.0; 3], [2.0, 0.0, 0.0]], vec![vec![1], vec![9]], 20), Modes::Free(3)).expect("modes");
    let damped = with(&free, |tensors| {
        tensors.damping = Some(sum(of_mass, &tensors.mass, of_stiffness, &tensors.stiffness));
    });
    let (omega, shape) = first_mode(&free);
    let rate = 0.5 * (of_mass + of_stiffness * omega * omega);
    let turns = (omega * omega - rate * rate).sqrt();
    let largest_error = |step: f64| {
        let positions = free.tensors().interface_positions.clone();
        let mut system =
            System::new(positions, &[CLAMPED, FREE], &[(&damped, &[0, 1])], FORMULATION).expect("accepted");
        // So small that the motion is linear: the deflection is 1e-6 of the length.
        system.initial_velocity = shape.iter().map(|x| 1e-6 * x).collect();
        let mut worst = 0.0_f64;
        let n_steps = (1.0 / step).round() as usize;
        simulate(&mut system, &Scheme { step, n_steps, floor: 1e-12, ..SCHEME }, |system, now| {
            let found = system.position(&now.at, 1)[1] / (1e-6 * shape[7]);
            let expected = (-rate * now.time).exp() * (turns * now.time).sin() / turns;
            worst = worst.max((found - expected).abs() * turns);
        })
        .expect("it vibrates");
        worst
    };
    let [coarse, fine] = [2e-3, 1e-3].map(largest_error);
    println!("ω {omega}, rate {rate}: {coarse:e} {fine:e}");
    // The trapezoidal rule has the frequency wrong by (ω h)²/12 of it: after so many radians that is the phase, and the amplitude
    // has fallen. Without the damping the curve would be off by one.
    let phase = (omega * 1e-3).powi(2) / 12.0 * omega * (1.0 / rate).min(1.0);
    assert!(rate > 0.7 && fine < phase, "{fine:e} for {phase:e}");
    assert!((coarse / fine / 4.0 - 1.0).abs() < 0.05, "{coarse:e} {fine:e}");
}

/// Frequency and shape of the lowest vibration with node 0 held, by inverse iteration on the reduced matrices.
fn first_mode(superelement: &Superelement) -> (f64, Vec<f64>) {
    let (k, m) = (&superelement.tensors().stiffness, &superelement.tensors().mass);
    let r = k.rows();
    // Bending about z alone, in which the beam is twice as stiff as about y.
    let of_plane = |i: usize| i >= 12 || [7, 11].contains(&i);
    let kept: Vec<usize> = (6..r).filter(|i| of_plane(*i)).collect();
    let mut x: Vec<f64> = kept.iter().map(|i| if *i == 7 { 1.0 } else { 0.0 }).collect();
    let mut lambda = 0.0;
    for _ in 0..200 {
        let load: Vec<f64> = kept.iter().map(|i| kept.iter().zip(&x).map(|(j, x)| m[(*i, *j)] * x).sum()).collect();
        let next = solved(&kept, k, &load);
        lambda = x.iter().zip(&load).map(|(x, f)| x * f).sum::<f64>()
            / next.iter().zip(&load).map(|(x, f)| x * f).sum::<f64>();
        let size = next.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        x = next.iter().map(|x| x / size).collect();
    }
    let mut shape = vec![0.0; r];
    kept.iter().zip(x).for_each(|(i, x)| shape[*i] = x);
    (lambda.sqrt(), shape)
}

/// K x = f on the rows kept, by conjugate gradients carried to rounding.
fn solved(kept: &[usize], k: &Matrix, load: &[f64]) -> Vec<f64> {
    let n = kept.len();
    let mut a: Vec<Vec<f64>> = kept.iter().map(|i| kept.iter().map(|j| k[(*i, *j)]).collect()).collect();
    let mut b = load.to_vec();
    for c in 0..n {
        let pivot = (c..n).max_by(|i, j| a[*i][c].abs().total_cmp(&a[*j][c].abs())).expect("a row");
        a.swap(c, pivot);
        b.swap(c, pivot);
        for i in c + 1..n {
            let factor = a[i][c] / a[c][c];
            let above = a[c].clone();
            a[i].iter_mut().zip(&above).for_each(|(x, y)| *x -= factor * y);
            b[i] -= factor * b[c];
        }
    }
    for c in (0..n).rev() {
        let rest: f64 = (c + 1..n).map(|j| a[c][j] * b[j]).sum();
        b[c] = (b[c] - rest) / a[c][c];
    }
    b
}

/// A body on a rail that is braked in proportion to its mass: v = v₀ e^(−αt), x = v₀ (1 − e^(−αt))/α.
#[test]
fn braked_body_on_a_rail_comes_to_rest_exponentially() {
    let (mass, alpha) = (3.0, 1.7);
    let body = sphere(mass, 0.5, |i, j| if i == j && i < 3 { alpha * mass } else { 0.0 });
    let along = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];
    let largest_error = |step: f64| {
        let positions = body.tensors().interface_positions.clone();
        let mut system = System::new(positions, &[FREE], &[(&body, &[0])], FORMULATION).expect("accepted");
        let start = system.positions[0];
        system.joints = vec![Joint {
            kind: Kind::Prismatic { axis: along },
            sides: [Side::Node(0), Side::Ground],
            point: [0.2, 0.0, 0.0],
        }];
        system.initial_velocity[..3].copy_from_slice(&along);
        let mut worst = 0.0_f64;
        simulate(
            &mut system,
            &Scheme { step, n_steps: (2.0 / step) as usize, floor: 1e-6, ..SCHEME },
            |system, now| {
                let moved: Vector3 = std::array::from_fn(|d| system.position(&now.at, 0)[d] - start[d]);
                let expected = (1.0 - (-alpha * now.time).exp()) / alpha;
                worst = worst.max((dot(&along, &moved) - expected).abs());
            },
        )
        .expect("it slides");
        worst
    };
    let [coarse, fine] = [2e-2, 1e-2].map(largest_error);
    println!("{coarse:e} {fine:e}");
    // (α h)²/12 of the way, with terms of the fourth order.
    assert!(fine < (alpha * 1e-2_f64).powi(2) / 12.0 / alpha, "{fine:e}");
    assert!((coarse / fine / 4.0 - 1.0).abs() < 0.01, "{coarse:e} {fine:e}");
}

/// A ball with a rotor inside on a spherical joint: J ω̇ = −S ω with S ω = ω × h. Its angular velocity turns about the rotor's axis at
/// h/J and keeps its length; a symmetrised damping would let it stay where it is.
#[test]
fn rotor_turns_the_angular_velocity_and_takes_no_energy() {
    let (inertia, momentum) = (0.5, [0.0, 0.0, 2.0]);
    // ω × h as a matrix on ω: −h̃.
    let turning = |i: usize, j: usize| {
        let unit: Vector3 = std::array::from_fn(|d| f64::from(u8::from(d + 3 == j)));
        if i < 3 || j < 3 { 0.0 } else { cross(&unit, &momentum)[i - 3] }
    };
    let body = sphere(3.0, inertia, turning);
    let largest_error = |step: f64| {
        let positions = body.tensors().interface_positions.clone();
        let mut system = System::new(positions, &[SPHERICAL], &[(&body, &[0])], FORMULATION).expect("accepted");
        let start = [0.6, 0.0, 0.8];
        system.initial_velocity[3..6].copy_from_slice(&start);
        let (rate, mut worst, mut first) = (momentum[2] / inertia, 0.0_f64, None);
        simulate(&mut system, &Scheme { step, n_steps: (2.0 / step) as usize, ..SCHEME }, |system, now| {
            let (sine, cosine) = (rate * now.time).sin_cos();
            let expected = [start[0] * cosine, start[0] * sine, start[2]];
            worst = (0..3).fold(worst, |worst, d| worst.max((now.velocity[3 + d] - expected[d]).abs()));
            let kinetic = system.energies().expect("a weight")[0];
            // The scheme is the trapezoidal rule, which keeps squares to rounding and to the tolerance.
            assert!((kinetic / *first.get_or_insert(kinetic) - 1.0).abs() < 1e-7, "{kinetic} at {}", now.time);
            assert!(system.dissipated_power().abs() < 1e-14, "{:e}", system.dissipated_power());
        })
        .expect("it turns");
        worst
    };
    let [coarse, fine] = [2e-2, 1e-2].map(largest_error);
    println!("{coarse:e} {fine:e}");
    // The phase of eight radians is (4 h)²/12 of them wrong.
    assert!(fine < 8.0 * 0.6 * (4.0 * 1e-2_f64).powi(2) / 12.0 * 1.05, "{fine:e}");
    assert!((coarse / fine / 4.0 - 1.0).abs() < 0.01, "{coarse:e} {fine:e}");
}

/// The modes of a variant come with the damping of the richer superelement, and so do its loads of gravity.
#[test]
fn selected_modes_keep_damping_and_gravity() {
    let rich = beam(&[[0.0; 3], [2.0, 0.0, 0.0]], vec![vec![1], vec![9]], 20);
    let rich = with(&rich, |tensors| {
        let r = tensors.mass.rows();
        let skew = |i: usize, j: usize| (i as f64 - j as f64) / r as f64;
        tensors.damping = Some(Matrix::from_fn(r, r, |i, j| tensors.mass[(i, j)] + skew(i, j)));
    });
    let few = selected(&rich, Modes::Free(3)).expect("modes");
    let (damping, mass) = (few.tensors().damping.as_ref().expect("a damping"), &few.tensors().mass);
    // The symmetric part is the mass, the skew part is still there.
    let r = mass.rows();
    let largest = (0..r).fold(0.0, |size: f64, i| size.max(mass[(i, i)]));
    for (i, j) in (0..r).flat_map(|i| (0..r).map(move |j| (i, j))) {
        let symmetric = 0.5 * (damping[(i, j)] + damping[(j, i)]);
        assert!((symmetric - mass[(i, j)]).abs() <= 1e-12 * largest, "({i}, {j})");
    }
    assert_eq!(
        damping[(0, 11)] - damping[(11, 0)],
        rich.tensors().damping.as_ref().expect("a damping")[(0, 11)]
            - rich.tensors().damping.as_ref().expect("a damping")[(11, 0)]
    );
    let gravity = few.tensors().gravity.as_ref().expect("loads of gravity");
    for (i, a) in (0..r).flat_map(|i| (0..3).map(move |a| (i, a))) {
        let u = &few.tensors().rigid_body_modes;
        let whole: f64 = (0..r).map(|j| mass[(i, j)] * u[(j, a)]).sum();
        assert!((gravity[(i, a)] - whole).abs() <= 1e-9 * largest, "({i}, {a}): {} for {whole}", gravity[(i, a)]);
    }
}

/// Supports hold a damped body as they hold another: nothing moves, nothing is dissipated.
#[test]
fn held_damped_body_stays() {
    let body = sphere(3.0, 0.5, |i, j| if i == j { 10.0 } else { 0.0 });
    let positions = body.tensors().interface_positions.clone();
    let mut supports = CLAMPED;
    supports[3] = Support::Free;
    let mut system = System::new(positions, &[supports], &[(&body, &[0])], FORMULATION).expect("accepted");
    simulate(&mut system, &Scheme { n_steps: 10, floor: 1.0, ..SCHEME }, |system, now| {
        assert_eq!(system.position(&now.at, 0), system.positions[0]);
        assert_eq!(system.dissipated_power(), 0.0);
    })
    .expect("it stays");
}
