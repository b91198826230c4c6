//! Joints in space against closed forms, with rigid bodies: superelements of one node without modes.

use std::f64::consts::FRAC_PI_2;
use std::sync::OnceLock;

use supel_runtime::Superelement;
use supel_runtime::component::{FloatingFrame, Measures, ModalComponent};
use supel_runtime::motion::{IDENTITY_3, Matrix3, Motion, Vector3, cross, dot, join, times_3};
use validation::beam::{Section, polyline};
use validation::examples::{elbow, reduced_parts};
use validation::integrator::{Instant, IterationMatrix, Scheme, simulate};
use validation::joint::{CLAMPED, FREE, Joint, Kind, PLANAR, SPHERICAL, Side, Support, Supports, driven_pin};
use validation::part::{Part, reduced};
use validation::selection::{Modes, selected};
use validation::statics::{Tangent, equilibria};
use validation::system::{Formulation, Load, System};

const FORMULATION: Formulation = Formulation { frame: FloatingFrame::MassWeighted, measures: Measures::MotionBased };
/// Without numerical damping.
const SCHEME: Scheme = Scheme {
    step: 2e-3,
    n_steps: 0,
    spectral_radius: 1.0,
    tolerance: 1e-10,
    floor: 0.0,
    matrix: IterationMatrix::Constant,
};
/// With some damping, without which the multipliers of a position constraint alternate and grow from rounding.
const DAMPED: Scheme = Scheme { spectral_radius: 0.8, ..SCHEME };
/// Tilted against all coordinate axes.
const AXIS: Vector3 = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];
/// Away from the body, so that the joint has a lever.
const POINT: Vector3 = [0.2, -0.3, 0.4];
const G: f64 = 9.81;

/// Beams through points as one rigid body that is held by one of them.
fn rigid(points: &[Vector3], held: usize) -> Superelement {
    let section = Section {
        axial: 1e6,
        shear: [4e5; 2],
        torsion: 1e3,
        bending: [1e3; 2],
        mass: 5.0,
        inertia: [2e-3, 1e-3, 1e-3],
    };
    let part = Part {
        name: "rigid".into(),
        model: polyline(points, 2, &section),
        interface: vec![vec![2 * held as i64 + 1]],
        recovered: Vec::new(),
        units: "m-kg-s",
        n_modes: 0,
    };
    let folder = tempfile::tempdir().expect("folder");
    let job = part.write(folder.path()).expect("written");
    let text = std::fs::read_to_string(&job).expect("job").replace("herting", "craig-bampton");
    std::fs::write(&job, text).expect("written");
    let rigid = reduced(&job).expect("verified");
    assert!(rigid.tensors().stiffness.as_slice().iter().all(|k| *k == 0.0), "one node resists nothing");
    rigid
}

/// A bent bar that no plane through the axis leaves as it is, held in its bend.
fn bent() -> &'static Superelement {
    static BENT: OnceLock<Superelement> = OnceLock::new();
    BENT.get_or_init(|| rigid(&[[0.1, 0.0, 0.0], [0.9, 0.2, 0.0], [0.8, 0.8, 0.0]], 1))
}

/// Bodies of one node each.
fn system(bodies: &[&Superelement], supports: &[Supports], joints: Vec<Joint>, gravity: Vector3) -> System {
    let positions: Vec<Vector3> = bodies.iter().map(|body| body.tensors().interface_positions[0]).collect();
    let nodes: Vec<[usize; 1]> = (0..bodies.len()).map(|node| [node]).collect();
    let parts: Vec<_> = bodies.iter().zip(&nodes).map(|(body, nodes)| (*body, nodes.as_slice())).collect();
    let mut system = System::new(positions, supports, &parts, FORMULATION).expect("accepted");
    (system.joints, system.gravity) = (joints, gravity);
    system
}

/// Mass, centre of mass, and inertia about the origin.
fn rigid_body(superelement: &Superelement) -> (f64, Vector3, Matrix3) {
    let component =
        ModalComponent::with_measures(superelement, FORMULATION.frame, FORMULATION.measures).expect("accepted");
    let rigid = component.rigid_mass();
    let m = rigid[0][0];
    // The block of translations and rotations about the origin is −m x̃_c.
    let centre = [rigid[1][5], rigid[2][3], rigid[0][4]].map(|moment| moment / m);
    (m, centre, std::array::from_fn(|i| std::array::from_fn(|j| rigid[3 + i][3 + j])))
}

fn scaled(v: &Vector3, factor: f64) -> Vector3 {
    v.map(|x| factor * x)
}

fn plus(a: &Vector3, b: &Vector3) -> Vector3 {
    std::array::from_fn(|d| a[d] + b[d])
}

fn minus(a: &Vector3, b: &Vector3) -> Vector3 {
    std::array::from_fn(|d| a[d] - b[d])
}

fn length(v: &Vector3) -> f64 {
    dot(v, v).sqrt()
}

/// What the joints do to a node: force, and moment about a place, in inertial axes.
fn reaction(system: &System, now: &Instant, node: usize, about: &Vector3) -> [Vector3; 2] {
    let mut sum = [0.0; 6];
    for (row, factor) in system.constraints(now.time, &now.at).iter().zip(&now.multipliers) {
        for (_, gradient) in row.gradient.iter().filter(|entry| entry.0 == node) {
            (0..6).for_each(|i| sum[i] -= factor * gradient[i]);
        }
    }
    let turned = |first: usize| times_3(&now.at.motions[node].rotation, &std::array::from_fn(|d| sum[first + d]));
    let (force, lever) = (turned(0), minus(&system.position(&now.at, node), about));
    [force, plus(&turned(3), &cross(&lever, &force))]
}

fn violation(system: &System, now: &Instant) -> f64 {
    system.constraints(now.time, &now.at).iter().fold(0.0, |most: f64, row| most.max(row.violation.abs()))
}

/// The parts of a vector along and across the axis.
fn split(v: &Vector3) -> [Vector3; 2] {
    let along = scaled(&AXIS, dot(&AXIS, v));
    [along, minus(v, &along)]
}

/// A body on a revolute joint, let go at an angle from its lowest place.
struct Compound {
    mass: f64,
    /// From the joint's point to the centre of mass.
    arm: Vector3,
    /// Inertia about the joint's point.
    inertia: Matrix3,
    start: f64,
    gravity: Vector3,
    /// w² of small swings.
    w2: f64,
}

impl Compound {
    fn new(start: f64) -> Self {
        let (mass, centre, about_origin) = rigid_body(bent());
        let arm = minus(&centre, &POINT);
        let steiner = |d: &Vector3, i: usize, j: usize| dot(d, d) * IDENTITY_3[i][j] - d[i] * d[j];
        let shifted = |i: usize, j: usize| about_origin[i][j] + mass * (steiner(&arm, i, j) - steiner(&centre, i, j));
        let inertia = std::array::from_fn(|i| std::array::from_fn(|j| shifted(i, j)));
        let [_, across] = split(&arm);
        // The lowest place is that of the arm turned back by the angle; half of the weight is along the axis.
        let lowest = times_3(&Motion::exp(&join(&[0.0; 3], &scaled(&AXIS, -start))).rotation, &across);
        let share = 0.75_f64.sqrt();
        let down = plus(&scaled(&lowest, share / length(&lowest)), &scaled(&AXIS, 0.5));
        let w2 = mass * length(&across) * share * G / dot(&AXIS, &times_3(&inertia, &AXIS));
        Self { mass, arm, inertia, start, gravity: scaled(&down, G), w2 }
    }

    /// When it is lowest, T/4 = π / (2 w AGM(1, cos φ₀/2)).
    fn quarter_period(&self) -> f64 {
        let (mut a, mut b) = (1.0, (0.5 * self.start).cos());
        while a - b > 1e-15 {
            (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
        }
        FRAC_PI_2 / (self.w2.sqrt() * a)
    }

    /// The angle from the lowest place, of the body's motion.
    fn angle(&self, motion: &Motion) -> f64 {
        let ([_, down], arm) = (split(&self.gravity), times_3(&motion.rotation, &split(&self.arm)[1]));
        dot(&AXIS, &cross(&down, &arm)).atan2(dot(&down, &arm))
    }

    /// What the joint does to the body at a motion: force, and moment about the joint's point. From φ̇² = 2 w² (cos φ − cos φ₀),
    /// φ̈ = −w² sin φ.
    fn reaction(&self, motion: &Motion) -> [Vector3; 2] {
        let angle = self.angle(motion);
        let (squared, faster) = (2.0 * self.w2 * (angle.cos() - self.start.cos()), -self.w2 * angle.sin());
        let turned = |v: &Vector3| times_3(&motion.rotation, v);
        let arm = turned(&self.arm);
        let acceleration = plus(&scaled(&cross(&AXIS, &arm), faster), &scaled(&split(&arm)[1], -squared));
        let weight = scaled(&self.gravity, self.mass);
        // The axis stays where it is in the body, too.
        let momentum = times_3(&self.inertia, &AXIS);
        let rate = turned(&plus(&scaled(&momentum, faster), &scaled(&cross(&AXIS, &momentum), squared)));
        [minus(&scaled(&acceleration, self.mass), &weight), minus(&rate, &cross(&arm, &weight))]
    }

    /// Lets it swing beyond its lowest place: when it was there, and the largest distance of the reaction from the closed form,
    /// force and moment over weight and its lever.
    fn swing(&self, step: f64) -> [f64; 2] {
        let joint = Joint { kind: Kind::Revolute { axis: AXIS }, sides: [Side::Node(0), Side::Ground], point: POINT };
        let mut system = system(&[bent()], &[FREE], vec![joint], self.gravity);
        let (mut angles, mut away) = (Vec::new(), 0.0_f64);
        let n_steps = (1.2 * self.quarter_period() / step) as usize;
        let scheme = Scheme { step, n_steps, ..DAMPED };
        let weight = self.mass * G;
        let effort = simulate(&mut system, &scheme, |system, now| {
            let motion = &now.at.motions[0];
            angles.push(self.angle(motion));
            // The iteration leaves 1e-10 of forces below 20 weights; of the violation it leaves that over β' > 1/h² times a mean
            // inertia above 1.
            let left = SCHEME.tolerance * 20.0 * weight;
            assert!(violation(system, now) < left * step * step, "{:e} at {} s", violation(system, now), now.time);
            let ([force, moment], [as_force, as_moment]) = (reaction(system, now, 0, &POINT), self.reaction(motion));
            // The body does not move along the axis: there the joint carries the weight and nothing else.
            let out_of_plane = dot(&AXIS, &minus(&force, &as_force));
            assert!(out_of_plane.abs() < left, "{out_of_plane:e} N along the axis at {} s", now.time);
            away = away.max(length(&minus(&force, &as_force)) / weight);
            away = away.max(length(&minus(&moment, &as_moment)) / (weight * length(&self.arm)));
        });
        // The acceleration changes by up to 2 w h = 0.05 of itself in a step. An iteration leaves what its matrix lacks, the
        // stiffness w² J of the pendulum over β' J = 3.9 J / h², 1.6e-4 of that: 1e-9 after two, 2e-13 after three.
        assert!(effort.expect("swings").most <= 3);
        let lowest = angles.windows(2).position(|pair| pair[0] > 0.0 && pair[1] <= 0.0).expect("it comes down");
        [step * (lowest as f64 + angles[lowest] / (angles[lowest] - angles[lowest + 1])), away]
    }
}

/// That the README says so, of figures just computed.
fn assert_stated(words: &str) {
    let readme = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).expect("README");
    let in_a_line = readme.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(in_a_line.contains(words), "README.md lacks: {words}");
}

#[test]
fn body_on_a_tilted_hinge_swings_as_a_compound_pendulum() {
    let off = [0.05, 2.5].map(|start| {
        let compound = Compound::new(start);
        let step = 8e-3;
        let [[coarse, far], [fine, near]] = [step, 0.5 * step].map(|step| compound.swing(step));
        let (expected, small) = (compound.quarter_period(), compound.w2.sqrt() * step);
        println!("{start}: {coarse} {fine} for {expected}; reactions {far:e} {near:e}; w h {small}");
        // Second order, with terms of the third that are smaller by w h.
        let ratio = (coarse - expected) / (fine - expected);
        assert!((ratio / 4.0 - 1.0).abs() < small, "{ratio}");
        let limit = (4.0 * fine - coarse) / 3.0;
        assert!((limit - expected).abs() < small * (fine - expected).abs(), "{limit} for {expected}");
        assert!((coarse / expected - 1.0).abs() < small * small / 6.0, "twice the trapezoidal rule's (w h)²/12");
        // Angular velocities of up to 2 w enter squared, those and their errors.
        assert!(far < 4.0 * small * small && near < small * small, "{far:e} {near:e}");
        coarse / expected - 1.0
    });
    assert_stated(&format!("quarter periods are {:.1e} and {:.1e} off at 8 ms", off[0], off[1]));
}

#[test]
fn body_on_a_tilted_rail_falls_uniformly() {
    let gravity = [3.0, -2.0, -9.0];
    let joint = Joint {
        kind: Kind::Prismatic { axis: scaled(&AXIS, 5.0) },
        sides: [Side::Node(0), Side::Ground],
        point: POINT,
    };
    let mut system = system(&[bent()], &[FREE], vec![joint], gravity);
    let (mass, centre, _) = rigid_body(bent());
    let [along, across] = split(&gravity);
    let start = system.positions[0];
    simulate(&mut system, &Scheme { n_steps: 500, ..DAMPED }, |system, now| {
        let expected = scaled(&along, 0.5 * now.time * now.time);
        let moved = minus(&system.position(&now.at, 0), &start);
        // The scheme is exact for a constant acceleration: roundings of positions of some metres in 500 steps.
        assert!(length(&minus(&moved, &expected)) < 1e-12, "{moved:?} for {expected:?} at {}", now.time);
        let rows = now.at.motions[0].rotation.iter().zip(&IDENTITY_3);
        let turned = rows.fold(0.0, |most: f64, (row, unit)| most.max(length(&minus(row, unit))));
        assert!(turned < 1e-13, "it turns: {turned:e}");
        // The rail carries the weight across it, in the centre of mass.
        let [force, moment] = reaction(system, now, 0, &POINT);
        let expected = scaled(&across, -mass);
        let lever = minus(&plus(&centre, &moved), &POINT);
        // Roundings of the position add up to the violation that the tolerance leaves, forces below 200 N over β' times the mean
        // inertia, above 1 kg; putting it right takes β' m times as much, a fifth of which is forgotten in each step.
        let left = DAMPED.tolerance * 200.0 * mass / (1.0 - DAMPED.spectral_radius);
        assert!(length(&minus(&force, &expected)) < left, "{force:?} for {expected:?}");
        assert!(length(&minus(&moment, &cross(&lever, &expected))) < left * length(&lever), "{moment:?}");
    })
    .expect("it slides");
}

/// r̈ = φ̇² r with φ = ½ α t²: r = r₀ Σ c_k, c_k = c_{k−1} α² t⁴ / (4k (4k − 1)).
#[test]
fn bead_on_a_spun_rod_flies_outwards() {
    const FASTER: f64 = 1.5;
    const END: f64 = 2.0;
    let rod = rigid(&[[0.0; 3], [0.4, 0.0, 0.0]], 0);
    let bead = rigid(&[[0.5, 0.0, 0.0], [0.9, 0.0, 0.0]], 1);
    let centre = rigid_body(&bead).1[0];
    let at_end = |step: f64| {
        let kind = Kind::Prismatic { axis: [1.0, 0.0, 0.0] };
        let joint = Joint { kind, sides: [Side::Node(1), Side::Node(0)], point: [0.9, 0.0, 0.0] };
        let supports = [driven_pin(|time| 0.5 * FASTER * time * time, FASTER), FREE];
        let mut system = system(&[&rod, &bead], &supports, vec![joint], [0.0; 3]);
        let mut place = [0.0; 3];
        let n_steps = (END / step).round() as usize;
        simulate(&mut system, &Scheme { step, n_steps, ..SCHEME }, |_, now| {
            place = now.at.motions[1].apply(&[centre, 0.0, 0.0]);
        })
        .expect("it slides");
        let phi = 0.5 * FASTER * END * END;
        // The tolerance leaves its share of the Coriolis force, below 200 N, over β' = 4/h² times a mean inertia above 1; each
        // step rounds.
        let left = SCHEME.tolerance * 200.0 * 0.25 * step * step + n_steps as f64 * f64::EPSILON * length(&place);
        let distance = phi.cos() * place[1] - phi.sin() * place[0];
        assert!(distance.abs() < left, "it leaves the rod by {distance:e} m, {left:e} allowed");
        length(&place)
    };
    let (mut expected, mut term) = (centre, centre);
    for k in (4..).step_by(4).take(40) {
        term *= (FASTER * END * END).powi(2) / f64::from(k * (k - 1));
        expected += term;
    }
    let [coarse, fine] = [8e-3, 4e-3].map(at_end);
    println!("{coarse} {fine} for {expected}");
    let (ratio, limit) = ((coarse - expected) / (fine - expected), (4.0 * fine - coarse) / 3.0);
    // Second order; the next terms are smaller by φ̇ h = 0.024 and its square.
    assert!((ratio / 4.0 - 1.0).abs() < 0.024, "{ratio}");
    assert!((limit - expected).abs() < 0.024 * (fine - expected).abs(), "{limit} for {expected}");
}

/// r̈ = ω² r: r = r₀ cosh ωt + u/ω sinh ωt, with the force 2 m ω ṙ across the rod.
#[test]
fn bead_thrown_along_a_turning_rod_is_pushed_by_coriolis() {
    const OMEGA: f64 = 1.5;
    const OUTWARDS: f64 = 0.8;
    let along = scaled(&[3.0, 2.0, 0.0], 13.0_f64.sqrt().recip());
    let spin = scaled(&AXIS, OMEGA);
    assert!(dot(&along, &AXIS).abs() < 1e-15, "the rod is across the axis");
    let rod = rigid(&[[0.0; 3], scaled(&along, 0.4)], 0);
    let bead = rigid(&[scaled(&along, 0.5), scaled(&along, 0.9)], 1);
    let (mass, centre, _) = rigid_body(&bead);
    let thrown = |velocity: Vector3, joint: Joint| {
        let kind = Kind::Prismatic { axis: along };
        let slide = Joint { kind, sides: [Side::Node(1), Side::Node(0)], point: scaled(&along, 0.9) };
        let mut system = system(&[&rod, &bead], &[FREE; 2], vec![joint, slide], [0.0; 3]);
        system.initial_velocity[3..6].copy_from_slice(&spin);
        system.initial_velocity[6..9].copy_from_slice(&velocity);
        system.initial_velocity[9..12].copy_from_slice(&spin);
        system
    };
    let kind = Kind::PrescribedRotation { axis: AXIS, angle: |time| OMEGA * time };
    let drive = |kind: Kind| Joint { kind, sides: [Side::Node(0), Side::Ground], point: [0.0; 3] };
    let of_bead = plus(&cross(&spin, &scaled(&along, 0.9)), &scaled(&along, OUTWARDS));
    let errors = [8e-3, 4e-3].map(|step| {
        let (mut away, mut unlike, mut at_start) = (0.0_f64, 0.0_f64, f64::NAN);
        let scheme = Scheme { step, n_steps: (1.0 / step).round() as usize, ..DAMPED };
        simulate(&mut thrown(of_bead, drive(kind)), &scheme, |system, now| {
            let turn = Motion::exp(&join(&[0.0; 3], &scaled(&spin, now.time))).rotation;
            let (start, grown, shrunk) = (length(&centre), (OMEGA * now.time).cosh(), (OMEGA * now.time).sinh());
            let place = start * grown + OUTWARDS / OMEGA * shrunk;
            let rate = start * OMEGA * shrunk + OUTWARDS * grown;
            away = away.max(length(&minus(&now.at.motions[1].apply(&centre), &scaled(&times_3(&turn, &along), place))));
            let across = times_3(&turn, &cross(&AXIS, &along));
            let [force, _] = reaction(system, now, 1, &POINT);
            let share = length(&minus(&force, &scaled(&across, 2.0 * mass * OMEGA * rate))) / length(&force);
            if now.time == 0.0 {
                at_start = share;
            }
            // The scheme's own acceleration lags by a part of a step and starts without that lag; a fifth of it goes in each step.
            if now.time > 0.5 {
                unlike = unlike.max(share);
            }
        })
        .expect("it slides");
        [away, unlike, at_start]
    });
    println!("{errors:?}");
    let [coarse, fine] = errors;
    let small = OMEGA * 8e-3;
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(coarse < small * small, "{coarse:e}");
        // Second order, with terms of the third that are smaller by ω h.
        assert!((coarse / fine / 4.0 - 1.0).abs() < small, "{coarse:e} {fine:e}");
    }
    assert_stated(&format!("place and force are {:.1e} m and {:.1e} off at 8 ms", coarse[0], coarse[1]));
    // On the way with constant velocity the bead is u/ω (1 − cos ωt) away from the rod: the difference over two steps is short by
    // (ω h)²/12 of one half of the force.
    assert!((24.0 * coarse[2] / (small * small) - 1.0).abs() < small * small, "{:e}", coarse[2]);
    let refused = |velocity: Vector3, kind: Kind| {
        let why = simulate(&mut thrown(velocity, drive(kind)), &SCHEME, |_, _| ()).expect_err("it breaks a joint");
        assert!(why.to_string().contains("do not allow the initial velocity"), "{why}");
    };
    // Across the rod; along it, but with a drive that stands still.
    refused(plus(&of_bead, &AXIS), kind);
    refused(of_bead, Kind::Clamp);
}

/// Change of energy as a share of the largest kinetic one, (φ̇ h)², and mean iterations, of two bodies hung one from the other for
/// a second.
fn double_pendulum(elbow: Kind, step: f64) -> [f64; 3] {
    let forearm = rigid(&[[0.8, 0.8, 0.0], [1.5, 0.9, 0.0]], 1);
    let joints = vec![
        Joint { kind: Kind::Spherical, sides: [Side::Ground, Side::Node(0)], point: POINT },
        Joint { kind: elbow, sides: [Side::Node(1), Side::Node(0)], point: [0.8, 0.8, 0.1] },
    ];
    let mut system = system(&[bent(), &forearm], &[FREE; 2], joints, [1.0, 2.0, -9.0]);
    let (mut first, mut most, mut kinetic, mut fastest) = (None, 0.0_f64, 0.0_f64, 0.0_f64);
    let n_steps = (1.0 / step).round() as usize;
    let effort = simulate(&mut system, &Scheme { step, n_steps, ..SCHEME }, |system, now| {
        let energies = system.energies().expect("a weight");
        let sum: f64 = energies.iter().sum();
        most = most.max((sum - *first.get_or_insert(sum)).abs());
        kinetic = kinetic.max(energies[0]);
        let rates = [0, 1].map(|node| length(&std::array::from_fn(|d| now.velocity[6 * node + 3 + d])));
        fastest = fastest.max(rates[0]).max(rates[1]);
    })
    .expect("swings");
    [most / kinetic, (fastest * step).powi(2), effort.mean()]
}

#[test]
fn double_pendulum_keeps_its_energy_to_the_second_order() {
    for elbow in [Kind::Spherical, Kind::Prismatic { axis: [0.5, -0.2, 0.3] }, Kind::PointOnPlane { normal: AXIS }] {
        let [[coarse, next, many], [fine, _, fewer]] = [8e-3, 4e-3].map(|step| double_pendulum(elbow, step));
        println!("{elbow:?}: {coarse:e} {fine:e}; terms of the fourth order {next:e}");
        // Energy is wrong by a twelfth of (φ̇ h)² and the like, and half the step leaves a quarter to the next order.
        assert!(coarse < next, "{coarse:e}");
        assert!((coarse / fine / 4.0 - 1.0).abs() < next, "{coarse:e} {fine:e}");
        if let Kind::Spherical = elbow {
            assert_stated(&format!("its energy changes by {coarse:.0e} of the kinetic energy at 8 ms"));
            assert_stated(&format!("{many:.1} and {fewer:.1} iterations a step to 1e-10"));
        }
    }
}

#[test]
fn joints_to_the_ground_move_as_supports_do() {
    let mut hinge = CLAMPED;
    hinge[5] = Support::Free;
    let mut rail = CLAMPED;
    rail[0] = Support::Free;
    let cases = [
        (Kind::Spherical, SPHERICAL),
        (Kind::Revolute { axis: [0.0, 0.0, -2.0] }, hinge),
        (Kind::Prismatic { axis: [1.0, 0.0, 0.0] }, rail),
        (
            Kind::PrescribedRotation { axis: [0.0, 0.0, 3.0], angle: |time| 0.7 * time * time },
            driven_pin(|time| 0.7 * time * time, 1.4),
        ),
    ];
    for (kind, support) in cases {
        let point = bent().tensors().interface_positions[0];
        let joint = Joint { kind, sides: [Side::Node(0), Side::Ground], point };
        let [by_joint, by_support] = [(FREE, vec![joint]), (support, Vec::new())].map(|(supports, joints)| {
            let mut system = system(&[bent()], &[supports], joints, [3.0, -2.0, -9.0]);
            let mut end = Motion::IDENTITY;
            simulate(&mut system, &Scheme { n_steps: 500, ..SCHEME }, |_, now| end = now.at.motions[0]).expect("moves");
            end
        });
        let turned = (0..3).map(|i| length(&minus(&by_joint.rotation[i], &by_support.rotation[i]))).fold(0.0, f64::max);
        let away = length(&minus(&by_joint.translation, &by_support.translation)).max(turned);
        println!("{kind:?}: {away:e}");
        assert!(length(&minus(&by_support.translation, &Motion::IDENTITY.translation)) > 0.5, "it hardly moves");
        // An iteration leaves accelerations of 1e-10 · 1000 N / 1 kg: half of that in a second.
        assert!(away < 5e-8, "{kind:?}: {by_joint:?} for {by_support:?}");
    }
}

#[test]
fn clamp_joins_as_a_shared_node_does() {
    let folder = tempfile::tempdir().expect("folder");
    let legs = reduced_parts(&elbow::parts(2), folder.path()).expect("verified");
    let legs: Vec<Superelement> = legs.iter().map(|leg| selected(leg, Modes::Free(2)).expect("modes")).collect();
    let ([root, tip], bend) = ([[0.0; 3], [10.0, 10.0, 0.0]], [10.0, 0.0, 0.0]);
    let run = |positions: Vec<Vector3>, joints: Vec<Joint>, tolerance: f64| {
        let last = positions.len() - 1;
        let mut supports = vec![FREE; positions.len()];
        supports[0] = CLAMPED;
        let parts = [(&legs[0], [0, 1].as_slice()), (&legs[1], &[last - 1, last])];
        let mut system = System::new(positions, &supports, &parts, FORMULATION).expect("accepted");
        system.joints = joints;
        system.loads = vec![Load::force(1, [0.0, 0.0, 1.0], |time| 500.0 * time)];
        let mut places = Vec::new();
        let scheme = Scheme { n_steps: 100, tolerance, ..elbow::SCHEME };
        simulate(&mut system, &scheme, |system, now| places.push(system.position(&now.at, last))).expect("moves");
        places
    };
    let apart = |one: &[Vector3], other: &[Vector3]| {
        one.iter().zip(other).map(|(a, b)| length(&minus(a, b))).fold(0.0, f64::max)
    };
    let clamp = Joint { kind: Kind::Clamp, sides: [Side::Node(1), Side::Node(2)], point: bend };
    let [looser, shared] = [1e-7, 1e-8].map(|tolerance| run(vec![root, bend, tip], Vec::new(), tolerance));
    let clamped = run(vec![root, bend, bend, tip], vec![clamp], 1e-8);
    let (rise, open) = (shared.last().expect("places")[2], apart(&looser, &shared));
    println!("{:e}, {open:e} by the tolerance, of {rise} m", apart(&shared, &clamped));
    assert!(rise > 0.5 && open < 1e-6, "{rise} m, known to {open:e}");
    // The same equations, solved to the same tolerance: no farther than another tolerance is.
    assert!(apart(&shared, &clamped) < open, "{:?} for {:?}", clamped.last(), shared.last());
}

#[test]
fn joints_that_hold_a_direction_twice_are_refused() {
    let refused = |supports: &[Supports], joints: Vec<Joint>, bodies: &[&Superelement]| {
        let mut system = system(bodies, supports, joints, [0.0; 3]);
        let why = simulate(&mut system, &SCHEME, |_, _| ()).expect_err("they depend on each other").to_string();
        assert!(why.contains("the joints depend on each other"), "{why}");
    };
    let hinge = |axis: Vector3, sides, point| Joint { kind: Kind::Revolute { axis }, sides, point };
    let ground = [Side::Node(0), Side::Ground];
    // Two hinges of one rigid body on one axis; a tilted pin between bodies that are held in a plane.
    refused(&[FREE], vec![hinge(AXIS, ground, POINT), hinge(AXIS, ground, plus(&POINT, &AXIS))], &[bent()]);
    let pin = |axis: Vector3| vec![hinge(axis, [Side::Node(0), Side::Node(1)], [0.9, 0.2, 0.0])];
    refused(&[PLANAR; 2], pin(AXIS), &[bent(), bent()]);
    // The pin across the plane has three rows that the supports keep.
    let mut planar = system(&[bent(), bent()], &[PLANAR; 2], pin([0.0, 0.0, 1.0]), [0.0; 3]);
    simulate(&mut planar, &Scheme { n_steps: 1, floor: 1.0, ..SCHEME }, |_, _| ()).expect("it moves");
}

#[test]
fn statics_refuse_joints() {
    let joint = Joint { kind: Kind::Clamp, sides: [Side::Node(0), Side::Ground], point: POINT };
    let mut system = system(&[bent()], &[FREE], vec![joint], [0.0; 3]);
    let why =
        equilibria(&mut system, 1, Tangent::Papers, |_, _, _| ()).expect_err("joints are not part of it").to_string();
    assert!(why.contains("with joints"), "{why}");
}
