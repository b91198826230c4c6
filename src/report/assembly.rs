//! What `supel modes` says, as text and as the JSON document that `schemas/modes.schema.json` describes.

use serde::Serialize;

use super::page::{Page, Paint, Tone, WIDTH};
use super::table::{self, Align};
use super::{Generator, json_text};
use crate::assembly::{Assembly, AssemblyMode, AssemblyModes, Component, Held, Joint, Kind, Loaded, Omitted};
use crate::error::Result;
use crate::number::{self, counted};
use crate::verification::check::Verdict;

/// Version of the document's layout.
const FORMAT_VERSION: u32 = 1;

/// Significant digits of a frequency.
const DIGITS: i32 = 8;

/// The modes of an assembly and what it is made of.
#[derive(Clone, Copy, Debug)]
pub struct ModesReport<'a> {
    /// Components, joints, supports and loads.
    pub assembly: &'a Assembly,
    /// BLAKE3 digests of the files, one for each component.
    pub digests: &'a [String],
    /// What was found.
    pub modes: &'a AssemblyModes,
}

#[derive(Serialize)]
struct Document<'a> {
    format_version: u32,
    generator: Generator,
    components: Vec<ComponentLine<'a>>,
    joints: &'a [Joint],
    held: &'a [Held],
    masses: &'a [Loaded],
    #[serde(flatten)]
    modes: &'a AssemblyModes,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct ComponentLine<'a> {
    name: &'a str,
    digest: &'a str,
    method: supel_runtime::Method,
    units: Option<&'a str>,
    n_coordinates: usize,
    n_rigid: usize,
    omits_above_hz: Option<f64>,
    omits_unknown: Option<&'a str>,
}

impl ModesReport<'_> {
    /// The JSON document.
    ///
    /// # Errors
    /// [`crate::error::Error::NotJson`]; nothing in it can have it.
    pub fn to_json(&self) -> Result<String> {
        let Self { assembly, modes, .. } = *self;
        let document = Document {
            format_version: FORMAT_VERSION,
            generator: Generator::default(),
            components: self.components().map(|(component, digest)| ComponentLine::of(component, digest)).collect(),
            joints: &assembly.joints,
            held: &assembly.held,
            masses: &assembly.loaded,
            modes,
            notes: self.notes(),
        };
        json_text("the answer", &document)
    }

    /// The text for people.
    pub fn to_text(&self, paint: Paint) -> String {
        let mut page = Page::new(paint);
        let Self { assembly, modes, .. } = *self;
        let n = counted(assembly.components.len(), "superelement", "superelements");
        page.line(Page::toned(&format!("modes of {n} · {} free coordinates", modes.n_free), Tone::Heading));
        for (component, digest) in self.components() {
            let method = component.superelement.metadata().method.name();
            let short: String = digest.chars().take(12).collect();
            let size = component.n_coordinates();
            page.entry("component", &format!("{} · {method} · {size} coordinates · blake3 {short}…", component.name));
            page.entry("", &omits(&component.omitted));
        }
        for Joint { a, b, n_nodes, n_dofs, .. } in &assembly.joints {
            let pairs = counted(*n_nodes, "pair of nodes", "pairs of nodes");
            page.entry("joined", &format!("{a} = {b} · {pairs} · {}", counted(*n_dofs, "dof", "dofs")));
        }
        for Held { name, n_dofs } in &assembly.held {
            page.entry("held", &format!("{name} · {}", counted(*n_dofs, "dof", "dofs")));
        }
        for Loaded { name, mass } in &assembly.loaded {
            let has_inertia = mass.inertia.iter().any(|inertia| *inertia > 0.0);
            let inertia = mass.inertia.map(number::typed).join(", ");
            let inertia = if has_inertia { format!(" · moments of inertia {inertia}") } else { String::new() };
            page.entry("mass", &format!("{name} · {}{inertia}", number::typed(mass.mass)));
        }
        self.notes().iter().for_each(|note| page.entry("note", note));
        page.heading("Modes");
        self.table(&mut page);
        page.line("");
        for line in table::wrap(&self.conclusion(), WIDTH - 2) {
            page.line(&format!("  {line}"));
        }
        page.into_text()
    }

    fn components(&self) -> impl Iterator<Item = (&Component, &str)> {
        self.assembly.components.iter().zip(self.digests.iter().map(String::as_str))
    }

    /// What the assembly says of itself, and what follows from its modes.
    fn notes(&self) -> Vec<String> {
        let Self { assembly, modes, .. } = *self;
        let mut notes = assembly.notes.clone();
        notes.extend(assembly.components.iter().filter_map(unseen));
        notes.extend(assembly.joined_to_nothing().map(|name| format!("{name} is joined to nothing")));
        if modes.n_massless > 0 {
            let motions = counted(modes.n_massless, "motion has", "motions have");
            notes.push(format!(
                "{motions} no mass, or too little of it next to the others: as many eigenvalues are infinite as far as \
                 rounding tells, and left out"
            ));
        }
        if modes.modes.iter().any(|mode| mode.kind == Kind::Elastic && mode.at_least_hz == Some(0.0)) {
            notes.push(
                "rounding of the reduced masses leaves no bound from below but 0 of some modes: rigid interfaces next to each \
                 other and small masses on large ones cause that"
                    .to_owned(),
            );
        }
        let without_energy = modes.modes.iter().filter(|mode| mode.kind == Kind::WithoutEnergy);
        let unknown_to = without_energy.map(|mode| mode.rounding_hz).reduce(f64::max);
        notes.extend(unknown_to.map(|hertz| {
            format!(
                "a motion that strains a component has no energy beyond rounding, which leaves {} Hz open: its frequency is given \
                 as 0",
                number::quantity(hertz, 2)
            )
        }));
        notes
    }

    fn table(&self, page: &mut Page) {
        let Self { assembly, modes, .. } = *self;
        let highest = modes.modes.iter().map(|mode| mode.frequency_hz).fold(0.0, f64::max);
        let decimals = usize::try_from(DIGITS - 1 - number::decade(highest)).unwrap_or(0).min(9);
        let several = assembly.components.len() > 1;
        let energy = if several { "strain energy" } else { "" };
        let mut rows = vec![["mode", "Hz", "not below Hz", "", energy, ""].map(str::to_owned)];
        for mode in &modes.modes {
            let frequency = format!("{:.decimals$}", mode.frequency_hz);
            // A bound from below is rounded down.
            let unit = 10.0f64.powi(decimals as i32);
            let at_least = mode.at_least_hz.map(|hz| format!("{:.decimals$}", (hz * unit).floor() / unit));
            let at_least = at_least.unwrap_or_else(|| "–".to_owned());
            let shares = mode.energy_shares.iter().flatten().zip(&assembly.components).filter(|_| several);
            let shares = shares.map(|(share, component)| format!("{} {:.1} %", component.name, 100.0 * share));
            let shares = match mode.kind {
                Kind::RigidBody => "rigid-body motion".to_owned(),
                Kind::WithoutEnergy => "no energy".to_owned(),
                Kind::Elastic => shares.collect::<Vec<_>>().join(" · "),
            };
            rows.push([mode.number.to_string(), frequency, at_least, spread(mode), shares, self.mark(mode)]);
        }
        let align = [Align::Right, Align::Right, Align::Right, Align::Right, Align::Left, Align::Left];
        let mut lines = table::columns(&rows, align).into_iter();
        if let Some(heads) = lines.next() {
            page.spans(&["  ".into(), Page::toned(&heads.join("  "), Tone::Faint)]);
        }
        for ([number, frequency, at_least, spread, shares, mark], mode) in lines.zip(&modes.modes) {
            let row = format!("  {number}  {frequency}  {at_least}  {spread}  {shares}  ");
            let tone = if mode.is_beyond_band { Tone::Of(Verdict::Warn) } else { Tone::Faint };
            page.spans(&[(&row).into(), Page::toned(mark.trim_end(), tone)]);
        }
        if modes.modes.len() < modes.n_modes {
            let hint = format!("{} of {} modes; --count or --up-to-hz shows more", modes.modes.len(), modes.n_modes);
            page.spans(&["  ".into(), Page::toned(&hint, Tone::Faint)]);
        }
    }

    /// What is to be seen of a mode at once.
    fn mark(&self, mode: &AssemblyMode) -> String {
        if mode.is_beyond_band { "! beyond the band".to_owned() } else { String::new() }
    }

    /// What the figures mean.
    fn conclusion(&self) -> String {
        let names_of = |is_meant: fn(&Omitted) -> bool| -> Vec<&str> {
            let components = self.assembly.components.iter().filter(|component| is_meant(&component.omitted));
            components.map(|component| component.name.as_str()).collect()
        };
        let in_doubt = names_of(|omitted| matches!(omitted, Omitted::InDoubt { .. }));
        if !in_doubt.is_empty() {
            return format!("Nothing bounds these frequencies: the matrices of {} are in doubt.", in_doubt.join(", "));
        }
        let above = "Each frequency is an upper bound: no frequency of the full assembly is above the one of its number here, but for \
            rounding.";
        let names = names_of(|omitted| matches!(omitted, Omitted::Unknown { .. }));
        if !names.is_empty() {
            let says = if names.len() == 1 { "does not say what it leaves" } else { "do not say what they leave" };
            return format!("{above} There are no lower bounds, as {} {says} out.", names.join(", "));
        }
        let but_unseen = " of its number, numbered without modes that nothing starts or sees";
        match self.modes.band_hz {
            None => format!("{above} No component leaves anything out, so that each is exact as well."),
            Some(band) => format!(
                "{above} None is below the lower bound{}, by the modes that the components leave out; these begin at {} Hz, and \
                frequencies above that are marked.{}",
                if self.assembly.components.iter().any(|component| unseen(component).is_some()) {
                    but_unseen
                } else {
                    ""
                },
                number::quantity(band, 7),
                self.least_certain()
            ),
        }
    }

    /// The mode inside the band whose bounds are farthest apart, and the component that could change that.
    fn least_certain(&self) -> String {
        let width = |mode: &AssemblyMode| mode.at_least_hz.map_or(0.0, |hz| 1.0 - hz / mode.frequency_hz);
        let inside = self.modes.modes.iter().filter(|mode| mode.kind == Kind::Elastic && !mode.is_beyond_band);
        let widest = inside.max_by(|a, b| width(a).total_cmp(&width(b)));
        let Some((mode, component)) = widest.and_then(|mode| Some((mode, mode.limited_by?))) else {
            return String::new();
        };
        let name = &self.assembly.components[component].name;
        format!(" Inside the band mode {} is the least certain, by what {name} leaves out.", mode.number)
    }
}

impl<'a> ComponentLine<'a> {
    fn of(component: &'a Component, digest: &'a str) -> Self {
        let metadata = component.superelement.metadata();
        Self {
            name: &component.name,
            digest,
            method: metadata.method,
            units: metadata.units.as_deref(),
            n_coordinates: component.n_coordinates(),
            n_rigid: component.superelement.n_rigid(),
            omits_above_hz: match component.omitted {
                Omitted::Above { hz, .. } => Some(hz),
                Omitted::Nothing | Omitted::Unknown { .. } | Omitted::InDoubt { .. } => None,
            },
            omits_unknown: match &component.omitted {
                Omitted::Unknown { why } | Omitted::InDoubt { why } => Some(why),
                Omitted::Nothing | Omitted::Above { .. } => None,
            },
        }
    }
}

/// What a component leaves out, in words.
fn omits(omitted: &Omitted) -> String {
    match omitted {
        Omitted::Nothing => "leaves nothing out".to_owned(),
        Omitted::Above { hz, .. } => format!("leaves out motions above {} Hz", number::quantity(*hz, 7)),
        Omitted::Unknown { why } => format!("leaves out motions, and where they begin is unknown: {why}"),
        Omitted::InDoubt { why } => format!("in doubt: {why}"),
    }
}

/// The modes that a component leaves out because nothing starts or sees them; none where it leaves out none.
fn unseen(component: &Component) -> Option<String> {
    let left_out = component.unseen_modes()?;
    Some(format!("{left_out}: the full assembly has them in addition to those listed here"))
}

/// How far the lower bound is below the frequency, in per cent of it.
fn spread(mode: &AssemblyMode) -> String {
    match mode.at_least_hz {
        Some(at_least) if mode.kind == Kind::Elastic => {
            format!("−{} %", number::quantity(100.0 * (1.0 - at_least / mode.frequency_hz), 2))
        }
        _ => String::new(),
    }
}
