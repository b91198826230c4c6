//! A job that is proposed of a pair, with comments that say what it rests on.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use toml::Value;

use super::ends::EndFace;
use super::examined::Examined;
use super::finding::Severity;
use super::interfaces::Candidate;
use super::patches::SurfacePatch;
use super::text::{on_surface, units as in_words};
use crate::job::{ConstraintsToGround, NodeSelection, Origin};
use crate::number::{counted, quantity};
use crate::report::printable;

/// Interfaces that a job is proposed with; further groups are named.
const MOST_INTERFACES: usize = 6;
/// Column of remarks beside keys.
const BESIDE: usize = 34;

/// The job, TOML with comments; its paths are relative to `folder` where they lie in it.
pub fn proposal(examined: &Examined, folder: &Path, superelement: &str) -> String {
    let proposal = Proposal { examined, folder };
    let mut text = proposal.head();
    text += &proposal.model();
    let n_interfaces = proposal.interfaces(&mut text);
    proposal.held(&mut text);
    text += &proposal.reduction(n_interfaces);
    if let Some(memory_gib) = examined.job.run.memory_gib {
        text += &format!("\n[run]\n{}", line("memory_gib", memory_gib, ""));
    }
    let _ = write!(text, "\n[write]\nsuperelement = {}\n", Value::from(superelement));
    text
}

struct Proposal<'a> {
    examined: &'a Examined,
    folder: &'a Path,
}

/// A key with its value, and a remark beside it.
fn line(key: &str, value: impl Into<Value>, remark: &str) -> String {
    let line = format!("{key} = {}", value.into());
    match remark {
        "" => format!("{line}\n"),
        _ => format!("{line:<BESIDE$} # {}\n", printable(remark)),
    }
}

fn comment(text: &str) -> String {
    crate::report::table::wrap(&printable(text), 110).iter().map(|line| format!("# {line}\n")).collect()
}

impl Proposal<'_> {
    /// What the pair is and what was found of it.
    fn head(&self) -> String {
        let Examined { findings, body, .. } = self.examined;
        let mut text =
            comment("A job for `supel reduce`, proposed from the files it names. Read the lines marked `check`.");
        if let Some(body) = body {
            let mut parts = vec![counted(body.model.n_dofs, "row", "rows")];
            parts.extend(body.model.n_nodes.map(|n_nodes| counted(n_nodes, "node", "nodes")));
            parts.push(counted(body.model.n_bodies, "body", "bodies"));
            parts.push(counted(body.model.rigid_body_modes.count, "free motion", "free motions"));
            parts.extend(body.model.mass_properties.mass.map(|mass| format!("total mass {}", quantity(mass, 5))));
            text += &comment(&parts.join(", "));
        }
        for finding in findings.iter().filter(|finding| finding.severity > Severity::Remark) {
            let went_on = finding.went_on.as_ref().map_or_else(String::new, |how| format!("; this job goes on {how}"));
            text += "#\n";
            text += &comment(&format!("check: {}{went_on}", finding.what));
            if !finding.remedy.is_empty() {
                text += &comment(&format!("  {}", finding.remedy));
            }
        }
        text
    }

    fn model(&self) -> String {
        let model = &self.examined.job.model;
        let path = |path: &Path| Value::from(self.relative(path));
        let mut text = "\n[model]\n".to_owned();
        text += &line("stiffness", path(&model.stiffness), "");
        let files = [
            ("mass", &model.mass),
            ("dofs", &model.dofs),
            ("nodes", &model.nodes),
            ("frames", &model.frames),
            ("constraints", &model.constraints),
        ];
        for (key, file) in files {
            file.iter().for_each(|file| text += &line(key, path(file), ""));
        }
        if model.constraints_to_ground != ConstraintsToGround::default() {
            text += &line("constraints_to_ground", "accept", "constraints hold the component");
        }
        if let Some(layout) = model.layout.and_then(|layout| Value::try_from(layout).ok()) {
            text += &line("layout", layout, "the content leaves several formats");
        }
        if let Some(triangle) = model.symmetric.and_then(|triangle| Value::try_from(triangle).ok()) {
            text += &line("symmetric", triangle, "the other triangle is incomplete");
        }
        if model.drop_empty {
            text += &line("drop_empty", true, "rows without stiffness and mass");
        }
        let units = &self.examined.units;
        match units.only().and_then(|guess| Some((guess, guess.label?))) {
            Some((guess, label)) => {
                let remark = format!(
                    "check: {}, frequencies {}, by density and speed of sound",
                    guess.system, guess.frequencies
                );
                text += &line("units", label, &remark);
            }
            None if units.guesses().is_empty() => {}
            None => {
                let labels: Vec<String> = units
                    .guesses()
                    .iter()
                    .filter_map(|guess| guess.label)
                    .map(|label| format!("\"{label}\""))
                    .collect();
                let known =
                    if labels.is_empty() { String::new() } else { format!(", such as {}", labels.join(" or ")) };
                text += &comment(&format!("units = the label of your system{known}. Units: {}.", in_words(units)));
            }
        }
        text
    }

    /// Interfaces from the groups, or from the surface and the ends of the component; how many.
    fn interfaces(&self, text: &mut String) -> usize {
        let Examined { interfaces, ends, patches, .. } = self.examined;
        let mut n_proposed = 0;
        for (candidate, why_not) in interfaces.iter().zip(choices(interfaces)) {
            let what =
                [counted(candidate.n_nodes, "node", "nodes"), counted(candidate.n_dofs, "dof", "dofs")].join(", ");
            match why_not {
                Some(why) => *text += &format!("\n{}", comment(&format!("group {}: {what}; {why}", candidate.group))),
                None => {
                    n_proposed += 1;
                    *text += &of_group(candidate, &what);
                }
            }
        }
        patches.iter().for_each(|patch| *text += &of_patch(patch));
        ends.iter().for_each(|end| *text += &of_end(end));
        let n_proposed = n_proposed + patches.len() + ends.len();
        if n_proposed == 0 {
            *text += "\n# No interface: the superelement has modal amplitudes alone, and nothing can be joined to it. With a mesh that has\n\
                      # groups, `supel init K M --nodes MESH` proposes some; otherwise name nodes or rows:\n\
                      # [[interface]]\n# name = \"hub\"\n# nodes = [12, 17, 19]             # or { rows = [0, 1, 2] }\n";
        }
        n_proposed
    }

    fn held(&self, text: &mut String) {
        for fixed in &self.examined.job.fixed {
            *text += "\n[[fixed]]\n";
            fixed.name.iter().for_each(|name| *text += &line("name", name.as_str(), ""));
            *text += &selection(&fixed.nodes);
            if let Some(dofs) = fixed.dofs.as_ref().and_then(|dofs| Value::try_from(dofs).ok()) {
                *text += &line("dofs", dofs, "");
            }
        }
    }

    fn reduction(&self, n_interfaces: usize) -> String {
        let Examined { body, job, .. } = self.examined;
        let mut text = "\n[reduction]\n".to_owned();
        text += &match n_interfaces {
            0 => line("method", "craig-bampton", ""),
            _ => line("method", "herting", "or \"craig-bampton\", where something stiff holds the interfaces"),
        };
        let modes = body.as_ref().map_or(&[][..], |body| &body.reduction.modes[..]);
        let Some(highest) = modes.last().map(|mode| mode.frequency_hz) else {
            text += &line("modes", count(20), "check");
            return text;
        };
        let listed: Vec<String> = modes.iter().map(|mode| quantity(mode.frequency_hz, 4)).collect();
        let is_held = !job.fixed.is_empty() || job.model.constraints_to_ground != ConstraintsToGround::default();
        let component = if is_held { "held" } else { "free" };
        let listed = listed.join(", ");
        text += &comment(&format!("The lowest elastic frequencies of the {component} component are {listed} Hz."));
        let up_to = rounded_up(2.0 * highest);
        let table = Value::Table([("up_to_hz".to_owned(), up_to.into())].into_iter().collect());
        text += &line("modes", table, "check: twice the highest frequency that the simulation excites");
        if job.scene.is_none() && n_interfaces > 0 {
            let band = quantity(rounded_up(highest), 6).replace(',', "");
            text += &format!(
                "\n# What the simulation will ask; the report then says how far the superelement is off.\n# [scene]\n# band_hz = [0, {band}]\n"
            );
            text += "# accept = { frequency = 1e-2, response_db = 1.0 }\n";
        }
        text
    }

    fn relative(&self, path: &Path) -> String {
        let relative = path.strip_prefix(self.folder).unwrap_or(path);
        relative.display().to_string()
    }
}

/// Why each group is no interface of the job; nothing of those that are.
fn choices(candidates: &[Candidate]) -> Vec<Option<String>> {
    let mut taken: BTreeSet<i64> = BTreeSet::new();
    let mut n_proposed = 0;
    let is_held = candidates.iter().any(Candidate::holds_all);
    let choice = |candidate: &Candidate| {
        let why_not = match candidate.couplings.first() {
            None => Some(candidate.remark.clone().unwrap_or_else(|| "too many dofs".to_owned())),
            Some(_) if !is_held => candidate.remark.clone(),
            Some(_) if candidate.labels.iter().any(|label| taken.contains(label)) => {
                Some("it shares nodes with an interface above".to_owned())
            }
            Some(_) if n_proposed == MOST_INTERFACES => Some("it may be added like those above".to_owned()),
            Some(_) => None,
        };
        if why_not.is_none() {
            taken.extend(&candidate.labels);
            n_proposed += 1;
        }
        why_not
    };
    candidates.iter().map(choice).collect()
}

fn count(count: i64) -> Value {
    Value::Table([("count".to_owned(), count.into())].into_iter().collect())
}

fn selection(nodes: &NodeSelection) -> String {
    Value::try_from(nodes).map_or_else(|_| String::new(), |nodes| line("nodes", nodes, ""))
}

fn of_group(candidate: &Candidate, what: &str) -> String {
    let mut text = format!("\n{}[[interface]]\n", comment(&format!("group {}: {what}", candidate.group)));
    text += &line("name", candidate.group.as_str(), "");
    text += &line("nodes", format!("group:{}", candidate.group), "");
    if candidate.couplings.contains(&"rigid") {
        let direct = if candidate.couplings.contains(&"direct") { ", or \"direct\": its own dofs" } else { "" };
        text += &line(
            "coupling",
            "rigid",
            &format!("check: or \"average\", so that the patch stays free to deform{direct}"),
        );
    } else {
        let remark = candidate.remark.as_deref().unwrap_or_default();
        text += &line("coupling", "direct", remark);
    }
    if let Some(surface) = candidate.surface.as_ref().filter(|_| candidate.couplings.contains(&"rigid")) {
        let at = surface.at.map(|value| quantity(value, 5)).join(", ");
        let remark = format!("its nodes lie {}; the interface node is at ({at})", on_surface(surface));
        text += &line("origin", surface.origin, &remark);
    }
    text
}

fn of_end(end: &EndFace) -> String {
    let what = counted(end.n_nodes, "node", "nodes");
    let mut text = format!("\n{}[[interface]]\n", comment(&format!("check: a flat face at the end, {what}")));
    text += &line("name", end.name.as_str(), "");
    text += &selection(&NodeSelection::Region { within: end.region.clone() });
    text += &line("coupling", "rigid", "or \"average\", so that the patch stays free to deform");
    text
}

fn of_patch(patch: &SurfacePatch) -> String {
    let what = counted(patch.n_nodes, "node", "nodes");
    let mut text = format!("\n{}[[interface]]\n", comment(&format!("check: {}, {what}", patch.what)));
    text += &line("name", patch.name.as_str(), "");
    text += &match &patch.nodes {
        NodeSelection::Labels(labels) => listed(labels),
        nodes => selection(nodes),
    };
    text += &line("coupling", "rigid", "or \"average\", so that the patch stays free to deform");
    if patch.origin != Origin::Centroid
        && let Ok(origin) = Value::try_from(&patch.origin)
    {
        text += &line("origin", origin, "the interface node is on the axis");
    }
    text
}

/// Labels, some in a line.
fn listed(labels: &[i64]) -> String {
    /// Labels in a line.
    const IN_LINE: usize = 12;
    let lines = labels.chunks(IN_LINE).map(|labels| {
        let labels: Vec<String> = labels.iter().map(ToString::to_string).collect();
        format!("    {},\n", labels.join(", "))
    });
    format!("nodes = [\n{}]\n", lines.collect::<String>())
}

/// The next number of two digits.
fn rounded_up(value: f64) -> f64 {
    let unit = 10f64.powi(value.log10().floor() as i32 - 1);
    (value / unit).ceil() * unit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_up_to_two_digits() {
        for (value, expected) in [(1234.5, 1300.0), (99.9, 100.0), (0.0123, 0.013), (2000.0, 2000.0)] {
            assert!((rounded_up(value) / expected - 1.0).abs() < 1e-12, "{value}");
        }
    }

    /// A patch of some nodes that carries all six motions.
    fn patch(group: &str, labels: impl IntoIterator<Item = i64>) -> Candidate {
        let labels: Vec<i64> = labels.into_iter().collect();
        Candidate {
            group: group.to_owned(),
            n_nodes: labels.len(),
            n_dofs: 3 * labels.len(),
            couplings: vec!["direct", "rigid", "average"],
            remark: None,
            surface: None,
            labels,
        }
    }

    #[test]
    fn groups_that_share_nodes_are_proposed_once() {
        let said = choices(&[patch("A", 1..5), patch("B", 4..9), patch("C", 5..9)]);
        assert_eq!(said[1].as_deref(), Some("it shares nodes with an interface above"));
        assert!(said[0].is_none() && said[2].is_none(), "{said:?}");
        // Of many groups the first are taken.
        let many: Vec<Candidate> = (0..9).map(|at| patch("X", 10 * at..10 * at + 4)).collect();
        assert_eq!(choices(&many).iter().filter(|why_not| why_not.is_none()).count(), MOST_INTERFACES);
    }

    #[test]
    fn a_line_of_nodes_is_an_interface_only_beside_one_that_holds() {
        let line = Candidate {
            couplings: vec!["direct"],
            remark: Some("it can react 5 of six rigid-body motions".to_owned()),
            ..patch("LINE", 20..24)
        };
        assert!(choices(std::slice::from_ref(&line))[0].is_some());
        assert!(choices(&[line, patch("A", 1..5)]).iter().all(Option::is_none));
    }

    #[test]
    fn remarks_stand_beside_keys() {
        assert_eq!(line("a", "b", ""), "a = \"b\"\n");
        assert_eq!(line("a", "b", "c"), format!("{:<34} # c\n", "a = \"b\""));
    }
}
