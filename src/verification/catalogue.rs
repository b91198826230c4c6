//! The catalogue of checks: identifier, proof, meaning and remedy of each, and when a reduction records it. The page, the
//! documentation and the rules for the record in a file are made from it.

use super::preservation::AccuracyMeasure;

/// How firm the answer of a check is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proof {
    /// A count, an enclosure or a comparison of bits that leaves room for rounding only; with full certification that
    /// room is bounded as well.
    Certified,
    /// Computed directly from the full and the reduced matrices.
    Measured,
    /// A first-order bound, or a sample that stands for the whole.
    Estimated,
    /// Shown for judgement.
    Shown,
}

impl Proof {
    /// The word for people.
    pub fn word(self) -> &'static str {
        match self {
            Self::Certified => "certified",
            Self::Measured => "measured",
            Self::Estimated => "estimated",
            Self::Shown => "shown",
        }
    }

    /// What the word means.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Certified => {
                "a count, an enclosure or a comparison of bits that leaves room for rounding only; with --certify full \
                 that room is bounded as well"
            }
            Self::Measured => "computed directly from the full and the reduced matrices",
            Self::Estimated => "a first-order bound, or a sample that stands for the whole",
            Self::Shown => "a number for your judgement, because no limit can be right for every use",
        }
    }
}

/// When a reduction records a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recorded {
    /// By every reduction, this many times at least.
    Always(usize),
    /// By every reduction, this many times at least where it has a mass and where it does without one.
    WithMass([usize; 2]),
    /// Where the interface at rest holds the component, as it does unless the method is Rubin's.
    WithConstraintModes,
    /// Where such an interface is there.
    WithCarryingInterface,
    /// Where Rubin's static modes stand in the place of constraint modes, this many times.
    WithAttachmentModes(usize),
    /// Where the job asks for the count of modes or for their enclosure.
    WithCount,
    /// Where a load has a residual vector, kept or left out.
    WithResidualVector,
    /// Where modes are left out because nothing starts or sees them.
    WithUnseenModes,
    /// Where the job asks for damping.
    WithDamping,
    /// Where the scene accepts an error of this kind.
    WithAccepted(AccuracyMeasure),
    /// Where there is something to measure it on.
    Sometimes,
}

/// One check of the catalogue, in words of a structural engineer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Identifier of the check, `M-05`.
    pub id: &'static str,
    /// How firm its answer is.
    pub proof: Proof,
    /// When a reduction records it.
    pub recorded: Recorded,
    /// What is measured and why it matters.
    pub meaning: &'static str,
    /// What to look at where it is past its limit.
    pub remedy: &'static str,
}

/// The entry of the check `id`; none where no check has this identifier.
pub fn entry(id: &str) -> Option<&'static Entry> {
    CATALOGUE.iter().chain(OF_RESULTS).find(|entry| entry.id == id)
}

const fn line(
    id: &'static str,
    proof: Proof,
    recorded: Recorded,
    meaning: &'static str,
    remedy: &'static str,
) -> Entry {
    Entry { id, proof, recorded, meaning, remedy }
}

/// Checks of eigenpairs of another program, in addition to those of the catalogue that say the same of both.
pub const OF_RESULTS: &[Entry] = &[
    line(
        "C-01",
        Proof::Measured,
        Recorded::Sometimes,
        "The frequency of each pair is compared with the one that belongs to its shape, or where the shape is a poor one with the mode \
         that it mostly is. How far that itself may be from a frequency of K and M, by the force that is left over, is added.",
        "Look at the pair named: frequencies in the order of the shapes, enough iterations, enough digits written.",
    ),
    line(
        "C-02",
        Proof::Measured,
        Recorded::Sometimes,
        "A pair is invented where its shape leaves a large force over and no mode of the band has half of it: K and M have nothing like it \
         there.",
        "The other program did not converge, or factored a singular matrix: a free component needs a shift below zero.",
    ),
    line(
        "C-03",
        Proof::Measured,
        Recorded::Sometimes,
        "No shape is made up of the others: what is left of it beside them is a mode of its own, too. Otherwise one vibration is \
         counted twice.",
        "Ask for another start vector or a stricter tolerance; a repeated frequency needs a block method or full orthogonalisation.",
    ),
    line(
        "C-04",
        Proof::Measured,
        Recorded::Sometimes,
        "A free component moves as a rigid body at frequency zero, in as many ways as K lets pass. A result that has some of these motions \
         needs all of them; one that has none may have left them out on purpose.",
        "Ask for as many modes more, or give a --band that begins above zero.",
    ),
    line(
        "C-05",
        Proof::Measured,
        Recorded::Sometimes,
        "Rigid-body motion has no frequency. What a result states of it is rounding, relative to the first elastic mode.",
        "A shift at zero factors a singular matrix; otherwise a weak spring holds the component, see M-05.",
    ),
    line(
        "C-06",
        Proof::Shown,
        Recorded::Sometimes,
        "Modal masses of the shapes as they are written. Nothing here depends on them; a program that takes the shapes for mass-normalised \
         does.",
        "Divide each shape by the root of its modal mass where they are to be one.",
    ),
    line(
        "C-07",
        Proof::Measured,
        Recorded::Sometimes,
        "The reduced matrices of a superelement are those of K and M on its basis, entry by entry. The factor says how an entry differs: one \
         that is the same everywhere is a unit.",
        "Basis and matrices are not of one run, or the columns are in another order; look at the coordinate named.",
    ),
    line(
        "C-08",
        Proof::Measured,
        Recorded::Sometimes,
        "Frequencies of the superelement with its interface free against those of the component, within the band, of modes whose shapes are \
         the same. Above it they may differ. Where one of K̂ and M̂ alone is not that of the basis (C-07), it is named.",
        "Keep more modes, or ask for a --band that ends lower.",
    ),
    line(
        "C-09",
        Proof::Measured,
        Recorded::Sometimes,
        "Each mode of the free component in the band is made up of the columns of the basis as well as they can. What is left over is a \
         motion that the superelement does not know; most of a mode left over is a mode that it has not.",
        "A mode was lost on the way, or too few were kept.",
    ),
    line(
        "C-10",
        Proof::Measured,
        Recorded::Sometimes,
        "Rows that --fix holds stay at rest, and rows that --constraints makes dependent follow the others, in every shape and in every \
         column of a basis as the file has it. Nothing else looks at these rows: they are no dofs of K and M as they are compared with.",
        "The result is that of other supports or constraints: give those that it was computed with.",
    ),
    line(
        "C-11",
        Proof::Measured,
        Recorded::Sometimes,
        "No column of a basis is made up of the others, and no motion is without stiffness and mass at once in the reduced matrices: \
         otherwise they are singular together, and no simulation can solve with them. A condition loses as many digits as it has: six are \
         left at the limit, three where the check fails.",
        "Leave out the column named, or orthogonalise the columns before the projection.",
    ),
    line(
        "C-12",
        Proof::Measured,
        Recorded::Sometimes,
        "A superelement of modes has some modes of its component exactly, with its interface held or free: at least half of its amplitudes \
         are such. Up to the highest of them a count finds which are left out. It fails where frequencies in the band are off by more than \
         a tenth, and warns where nothing shows that they are needed.",
        "The mode named was lost on the way: compute the modes again, with a count of them.",
    ),
    line(
        "C-13",
        Proof::Measured,
        Recorded::Sometimes,
        "Where K̂ and M̂ name their rows, each column that moves a node and direction of the model has a row of that name. A row with the name \
         of another node joins that one to whatever is connected by names, and fails; a name that the model has not is a warning.",
        "Write the rows of K̂ and M̂ by the nodes that the columns of the basis move, or give the basis that belongs to them.",
    ),
];

/// Every check of a reduction, in the order of the identifiers.
pub const CATALOGUE: &[Entry] = &[
    line(
        "M-01",
        Proof::Measured,
        Recorded::WithMass([1, 0]),
        "Each mode and its frequency are put back into the full equation K x = λ M x; the value is the force that is left \
         over, relative to the matrices. It says how far the mode is from being an exact mode of the supplied matrices.",
        "The iteration has not converged on this mode: compare with --eigensolver arpack and look at the mode named.",
    ),
    line(
        "M-02",
        Proof::Measured,
        Recorded::WithMass([1, 0]),
        "The same left-over force, taken at every degree of freedom by itself and relative to the forces that cancel there: \
         no soft corner of the model hides behind a stiff one.",
        "Look at the degree of freedom named: it is often held by very soft or very stiff elements.",
    ),
    line(
        "M-03",
        Proof::Measured,
        Recorded::WithMass([1, 0]),
        "Modal masses are one and modes do not couple through the mass. If they did, one vibration would be counted twice. In a file of \
         MacNeal's method the mass is that of the modes and of rigid-body motion, and nothing else has any.",
        "Two modes named together describe the same motion: ask for a few modes more, so that their group is whole.",
    ),
    line(
        "M-04",
        Proof::Measured,
        Recorded::WithMass([1, 0]),
        "Modes do not couple through the stiffness, so that modal stiffness is the square of the frequency and nothing else.",
        "As for M-03.",
    ),
    line(
        "M-05",
        Proof::Measured,
        Recorded::Always(1),
        "The component is moved and turned as a rigid body. It must store no energy and show no force: otherwise something \
         ties it to the ground, or the coordinates do not belong to the stiffness.",
        "Look at the node named: a spring to ground, a support left in, a multi-point constraint that does not let \
         rotations pass, or coordinates of another mesh. Too few digits in a text file look the same.",
    ),
    line(
        "M-06",
        Proof::Certified,
        Recorded::WithCount,
        "How many frequencies lie in the interval is counted from the signs of a factorisation, without computing a single \
         mode, and compared with the modes found. Equal counts prove that none was missed. One more factorisation counts the \
         modes under every other boundary that is compared.",
        "A mode was missed and the run is not to be used. Please report it; another --eigensolver may help.",
    ),
    line(
        "M-07",
        Proof::Certified,
        Recorded::Sometimes,
        "Each frequency is enclosed between two bounds, relative to its size; an exact frequency of the full matrices lies \
         between them.",
        "The model asks more than double precision gives, which is usual for very thin or slender parts; see M-23.",
    ),
    line(
        "M-08",
        Proof::Estimated,
        Recorded::Sometimes,
        "Angle between each computed shape and the exact one, in the energy of K − σM, from the left-over force and the distance to the next \
         frequency. Near neighbours make shapes uncertain although their frequencies are not. For a shape x of another program, with \
         r = Kx − ρMx, it is δ/γ: δ² = rᵀ(K − σM)⁻¹r / ((ρ − σ) xᵀMx), and γ the relative distance of ρ − σ to that of the nearest other \
         mode; or, where that is smaller and all modes below some frequency are known, √(Σ a_k² (λ_k − σ)/(ρ − σ)) + δ_⊥/γ_⊥ √(1 + (δ/γ)²): \
         a_k = ŷ_kᵀMx is what the shape has of each other known mode, δ_⊥ what is left of δ outside of all of them, and γ_⊥ the relative \
         distance to the modes above them. Of a shape of few digits √(Σ a_k²), which their rounding changes less, is judged by itself, too.",
        "Judge the group of neighbouring modes together: the plane they span is certain, the shapes in it are not.",
    ),
    line(
        "M-09",
        Proof::Estimated,
        Recorded::WithMass([1, 0]),
        "How far the digits of the input file let each frequency move. Thin and slender parts cancel large element \
         stiffnesses, so that a text file of few digits changes their frequencies although nothing in it looks wrong.",
        "Export the matrices with more digits, or in a binary format.",
    ),
    line(
        "M-10",
        Proof::Estimated,
        Recorded::WithConstraintModes,
        "The static solutions under unit displacements of the interface are put back into the full stiffness, on all of \
         them or on random combinations of them.",
        "The stiffness of the interior is nearly singular: look for a mechanism or for a huge ratio of stiffnesses.",
    ),
    line(
        "M-11",
        Proof::Measured,
        Recorded::WithCarryingInterface,
        "Moving the interface as a rigid body carries the whole component along as a rigid body: the constraint modes add \
         up to rigid-body motion (24).",
        "The interface hardly holds the component against one rigid-body motion: add an interface node away from it.",
    ),
    line(
        "M-12",
        Proof::Measured,
        Recorded::WithMass([3, 2]),
        "The reduced stiffness gives no force under rigid-body motion and has no other motion without force: in the \
         simulation the component neither sticks to the ground nor falls apart.",
        "Too many zero modes mean a mechanism in the model, too few mean grounding; see M-05.",
    ),
    line(
        "M-13",
        Proof::Measured,
        Recorded::WithConstraintModes,
        "Interface coordinates and modal amplitudes do not couple in the reduced stiffness, as (29) demands; what is left of \
         that coupling is rounding.",
        "The static solutions are poor; see M-10.",
    ),
    line(
        "M-14",
        Proof::Measured,
        Recorded::WithMass([2, 0]),
        "Each retained mode is put into the reduced equation, with the boundary it was computed for: the reduced model has \
         the same frequency and the same shape (34), (35).",
        "The superelement does not reproduce its own modes and is not to be used; see M-11 and M-13 for the cause.",
    ),
    line(
        "M-15",
        Proof::Measured,
        Recorded::Sometimes,
        "Shapes of the full and of the reduced model are compared by the modal assurance criterion with the mass as weight: \
         1 is the same shape. Repeated frequencies are compared as a group.",
        "Shapes mix where modes are missing: keep more modes.",
    ),
    line(
        "M-16",
        Proof::Measured,
        Recorded::WithMass([1, 0]),
        "Mass, centre of mass and inertia of the reduced model are those of the full one, and those of a body: the same mass \
         in every direction, and an inertia that M has the digits for. Where the job names the expected ones, they are compared as well.",
        "Reduced against full: see M-11. Against the job: units, a missing part, density, or coordinates in other units. An inertia that is not \
         known: write M with all digits, or the part near the origin of its coordinates.",
    ),
    line(
        "M-17",
        Proof::Measured,
        Recorded::Sometimes,
        "Each interface is displaced while the others are held, in the full and in the reduced model. The reduced static \
         stiffness must be that of the full model, whatever the number of modes. Where the component is free to move while they \
         are held, the flexibility of the interface is compared in its place.",
        "The static solutions are poor; see M-10.",
    ),
    line(
        "M-18",
        Proof::Measured,
        Recorded::Sometimes,
        "Deflection under unit accelerations, in both models. Inertia-relief modes make it exact; without them it depends on \
         how many modes are kept.",
        "Use --method herting, or keep more modes.",
    ),
    line(
        "M-19",
        Proof::Shown,
        Recorded::Sometimes,
        "Share of the mass that the retained modes set in motion along each rigid-body direction. What is missing is moved \
         by modes above the cut-off.",
        "Keep modes to a higher frequency where the component is shaken in that direction.",
    ),
    line(
        "M-20",
        Proof::Measured,
        Recorded::Sometimes,
        "Frequency response between interface degrees of freedom, and of the outputs that the scene names under a force on \
         each of them, the full model solved anew at each sample and compared with the reduced one: what the simulation \
         will feel and see, at worst.",
        "Keep more modes; the size–error curve says how many would give which error.",
    ),
    line(
        "M-21",
        Proof::Estimated,
        Recorded::Sometimes,
        "How well the full model's response itself is known at each sample: a bound from what the iteration left over, \
         relative to the response; of outputs for the one that errs most. A small value says that the difference of M-20 is \
         that of the reduction and not of the solution it is compared with.",
        "The comparison at the frequency named says little: give more damping in [scene], or a band that ends below it.",
    ),
    line(
        "M-22",
        Proof::Measured,
        Recorded::WithAttachmentModes(2),
        "Rubin's residual attachment modes are put into the full matrices: nothing of them is rigid-body motion, and the forces that \
         keep them act on the interface alone, but for the inertia of the free body.",
        "Unit accelerations hardly deform the interior, or not each in a way of its own: use --method herting, which has its inertia-relief \
         modes as coordinates.",
    ),
    line(
        "M-23",
        Proof::Estimated,
        Recorded::WithMass([2, 1]),
        "How much the arithmetic amplifies rounding: by the interface that holds the rigid-body motions, by the stiffness of \
         the interior, by the reduced matrices.",
        "Spread the interface nodes, and avoid stiffness ratios that no real part has.",
    ),
    line(
        "M-24",
        Proof::Measured,
        Recorded::Sometimes,
        "A reduced model is the full one with constraints added, so that no reduced frequency can lie below the full one of \
         the same number.",
        "This cannot happen but by a defect or by a missed mode. Do not use the result; please report it.",
    ),
    line(
        "M-25",
        Proof::Certified,
        Recorded::Always(2),
        "The projections are symmetric up to rounding, which is then removed; every motion has positive mass and no \
         negative stiffness.",
        "A column depends on the others, or the full matrices are not definite; see the notes of the model.",
    ),
    line(
        "M-26",
        Proof::Certified,
        Recorded::Sometimes,
        "The written file was read back: its digest is right and it holds what was computed, to the last bit.",
        "The disk or the file system changed the file: write it elsewhere.",
    ),
    line(
        "M-27",
        Proof::Measured,
        Recorded::WithResidualVector,
        "Static answer to each load that the job names, its interface held, in both models. A residual vector makes it exact; without \
         one it depends on how many modes are kept.",
        "Leave `residual = true` of the load, or keep more modes. Against the job: the load of another model, or in other units.",
    ),
    line(
        "M-28",
        Proof::Measured,
        Recorded::WithDamping,
        "Damping does nothing to the component as a whole, and takes energy from every other motion. Against the job: damping and further \
         matrices are those of the full model, skew parts included.",
        "Look at the motion named: a damper to the ground, or damping in proportion to the mass. A fluid may drive a motion; nothing else does.",
    ),
    line(
        "M-29",
        Proof::Measured,
        Recorded::WithAccepted(AccuracyMeasure::Frequency),
        "The largest relative difference of a frequency in the band, reduced against full model, under each boundary of the scene, \
         against what the scene accepts. There is no margin: past the limit the check fails, and so it does where a boundary could not \
         be compared.",
        "Keep more modes, or take another method; what is named next to the worst frequency says which would do. Or accept more.",
    ),
    line(
        "M-30",
        Proof::Measured,
        Recorded::WithAccepted(AccuracyMeasure::Response),
        "The largest difference of the frequency response of M-20, against what the scene accepts. There is no margin.",
        "As for M-29.",
    ),
    line(
        "M-31",
        Proof::Measured,
        Recorded::WithAccepted(AccuracyMeasure::Static),
        "Static stiffness of each interface (M-17) and the static answer to each load that the job names (M-27), whichever is worse, \
         against what the scene accepts. There is no margin.",
        "Of a load: leave its `residual = true`. Of an interface: the static solutions are poor, see M-10.",
    ),
    line(
        "M-32",
        Proof::Estimated,
        Recorded::Sometimes,
        "What guards work that was left out. Where the constraint modes are not stored: random motions of the reduced model have the \
         forces and the inertia that the full model has in them. Where the interface separates parts that were factored apart: no entry \
         of K or M couples them.",
        "The interior is too badly conditioned for its condensation: `run.constraint_modes = \"stored\"` keeps every column, `--no-skip` \
         leaves nothing out.",
    ),
    line(
        "M-33",
        Proof::Measured,
        Recorded::Sometimes,
        "Comparisons that were to be made and that have no answer: where the reduced matrices are singular together, or negative, no \
         frequency and no response of theirs exists. A comparison that was left out because of what it costs is not counted.",
        "Look at what is named, and at M-23 and M-25: a column of the basis may depend on the others. Where its own matrices are what has no \
         answer, a simulation has none either.",
    ),
    line(
        "M-34",
        Proof::Measured,
        Recorded::WithAccepted(AccuracyMeasure::InternalLoad),
        "The largest error of the internal loads under a harmonic force on an interface dof, over the band, in the norm of the strain \
         energy, against what the scene accepts. There is no margin.",
        "As for M-29.",
    ),
    line(
        "M-35",
        Proof::Measured,
        Recorded::WithUnseenModes,
        "Modes that the superelement leaves out stay at rest: what each does at the interface, at outputs and under loads and gravity, over \
         the largest of a mode, and what mass, damping and further matrices tie it to. Against the job: both by modes found again.",
        "`--no-skip` keeps them. In a file: a mode was taken out that something starts or sees.",
    ),
];
