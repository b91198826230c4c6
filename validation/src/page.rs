//! The page that compares every claim of the paper with what was found.

use std::fmt::Write;

use supel::report::escaped;
use supel_runtime::component::Measures;

use crate::Result;
use crate::claims::claims;
use crate::examples::Variant;
use crate::figure::{FIGURES, Figure, Line, drawn};
use crate::pendulum::{Figures, Pendulum};
use crate::study::{Study, taken};
use crate::summary::totals;
use crate::verdict::{ABOUT, ACCURATE, Claim, EXCELLENT, NOTICED, OVERALL, SLIGHT, Verdict};

const HEAD: &str = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Validation against the paper</title>\n\
<style>body{font:16px/1.5 sans-serif;color:#1a2129;max-width:1000px;margin:2em auto;padding:0 1em}\n\
table{border-collapse:collapse;width:100%;margin:1em 0}td,th{border-bottom:1px solid #d5dce3;padding:.4em .6em;\
text-align:left;vertical-align:top}img{width:100%}.reached{color:#14653a}.partly{color:#8a5a00}.not{color:#a52014}\n\
.n{text-align:right}td.n{white-space:nowrap}figure{margin:1.5em 0}figcaption{color:#55606b}</style></head><body>\n";

/// The whole page; figures are taken from the folders of the examples.
pub fn page(studies: &[Study], pendulum: Option<&Pendulum>) -> String {
    let mut html = HEAD.to_owned();
    html += "<h1>Validation against the paper</h1>\n";
    // The bracket alone is compared with nothing of the paper.
    if !studies.is_empty() {
        html += &rules(studies);
    }
    html += &iterations(studies);
    for study in studies {
        // Writing to a text cannot fail.
        let _ = section(&mut html, study);
    }
    html += &pendulum.map_or(String::new(), solid);
    // A number and its sign stay on one line.
    html.replace(" %", "\u{a0}%") + "</body></html>\n"
}

/// What is compared with what, and how the paper's words are judged.
fn rules(studies: &[Study]) -> String {
    let examples = "<p>The examples of section 5 of Sonneville, Brüls and Bauchau, \
             <em>Modal Reduction Procedures for Flexible Multibody Dynamics</em>: linear beam models written as matrices, \
             reduced by supel, moved as modal components. References are fully nonlinear beam models of independent codes \
             (<code>fixtures/paper</code>). Misfits are shares of the largest value of the reference over its record, \
             the largest or the root of the mean square.</p>\n";
    format!(
        "{examples}<p>The paper compares by eye; what its words are taken for here was chosen with the first results in view, once for \
         all examples. RMS misfits: <em>overall</em> up to {OVERALL} %, <em>accurate</em> up to {ACCURATE} % (<em>poor</em> above), \
         <em>excellent</em> up to {EXCELLENT} %. Changes of a misfit, as a share of it: none below {SLIGHT}, <em>slight</em> or \
         <em>marginal</em> up to {NOTICED}, from there <em>noticed</em>, <em>considerable</em>, <em>significant</em>; without a \
         degree any change counts, and measures are <em>equally</em> accurate where it is not noticed. <em>About n</em> iterations: \
         at most n + {ABOUT}, with a matrix that never changes; a lower number of iterations is any lower one.</p>\n<p>Claims: {}.</p>\n",
        escaped(&totals(studies))
    )
}

/// The solid in large rotation.
fn solid(pendulum: &Pendulum) -> String {
    let row = |f: Figures| {
        let away = if f.away > 0.0 { format!("{:.1e}", f.away) } else { "–".to_owned() };
        let numbers =
            format!("{:.1e}</td><td class=\"n\">{:.1e}</td><td class=\"n\">{away}", f.of_kinetic, f.of_strain);
        format!(
            "<tr><td>{}</td><td class=\"n\">{numbers}</td><td class=\"n\">{:.2}</td></tr>\n",
            f.n_modes, f.iterations
        )
    };
    format!(
        "<h2>A solid in large rotation</h2>\n<p>Not in the paper: the bundled bracket of 4938 dofs, 10,000 times softer than \
         steel, let go from the horizontal on a hinge through its bore; 2 s, step 1 ms, ϱ∞ = 1, Herting's method.</p>\n\
         <table><tr><th>Elastic modes</th><th class=\"n\">change of energy, share of the largest kinetic</th><th class=\"n\">of the largest strain energy</th>\
         <th class=\"n\">distance of the base from the finest basis</th><th class=\"n\">iterations per step</th></tr>\n{}</table>\n\
         <figure><img src=\"bracket/film.svg\" alt=\"the bracket at five instants\"><figcaption>With 20 modes, every 0.1 s; \
         colour is the length of the deformation.</figcaption></figure>\n",
        pendulum.figures().into_iter().map(row).collect::<String>()
    )
}

/// What the paper says of iterations, compared with what was counted at the coarsest and the finest tolerance.
fn iterations(studies: &[Study]) -> String {
    let mut rows = String::new();
    for study in studies {
        let (Some(paper), [coarse, .., fine]) = (study.example.iterations(), study.example.tolerances()) else {
            continue;
        };
        let found =
            [coarse, fine].map(|tolerance| format!("{} at {tolerance:.0e}", taken(study, *tolerance))).join("; ");
        let [title, paper, found] = [study.example.title(), paper, &found].map(escaped);
        rows += &format!("<tr><td>{title}</td><td>{paper}</td><td>{found}</td></tr>\n");
    }
    let head = "<tr><th>Mean iterations per step</th><th>The paper</th><th>Found here, by variant</th></tr>";
    if rows.is_empty() { rows } else { format!("<table>{head}\n{rows}</table>\n") }
}

/// The curves of an example, as in the figures of the paper: name of the file and drawing.
///
/// # Errors
/// A drawing fails.
pub fn figures(study: &Study) -> Result<Vec<(String, String)>> {
    let mut files = Vec::new();
    for (figure, measures) in of_example(study) {
        let mut lines = vec![Line::of("reference", &study.reference, figure.quantity.0)];
        for model in figure.models {
            let variant = Variant { layout: model.0, n_modes: model.1, measures };
            lines.push(Line::of(&study.example.label(*model), &study.of(variant).curves, figure.quantity.0));
        }
        files.push((file_name(figure, measures), drawn(figure, &lines)?));
    }
    Ok(files)
}

fn of_example(study: &Study) -> impl Iterator<Item = (&'static Figure, Measures)> {
    let own = FIGURES.iter().filter(|figure| figure.example == study.example);
    own.flat_map(|figure| [Measures::MotionBased, Measures::Classical].map(|measures| (figure, measures)))
}

fn file_name(figure: &Figure, measures: Measures) -> String {
    let letter = if measures == Measures::MotionBased { 'a' } else { 'b' };
    format!("figure-{}{letter}.svg", figure.number)
}

fn section(html: &mut String, study: &Study) -> std::fmt::Result {
    writeln!(html, "<h2>{}</h2>", escaped(study.example.title()))?;
    if let Some(same) = study.same_by_command {
        let word = if same { "the same to the last bit" } else { "<strong class=\"not\">different</strong>" };
        writeln!(html, "<p>Superelements from the library and from <code>supel reduce</code>: {word}.</p>")?;
    }
    writeln!(html, "<p>{}</p>", escaped(study.example.note()))?;
    claim_table(html, study)?;
    misfit_table(html, study)?;
    iteration_table(html, study)?;
    for (figure, measures) in of_example(study) {
        let file = file_name(figure, measures);
        let words = if measures == Measures::MotionBased { "motion-based measures" } else { "classical measures" };
        writeln!(
            html,
            "<figure><img src=\"{}/{file}\" alt=\"{}\"><figcaption>As figure {} of the paper, computed here: {words}; \
             below, the differences from the reference.</figcaption></figure>",
            study.example.name(),
            escaped(figure.quantity.1),
            file.trim_start_matches("figure-").trim_end_matches(".svg"),
        )?;
    }
    Ok(())
}

fn claim_table(html: &mut String, study: &Study) -> std::fmt::Result {
    writeln!(html, "<table><tr><th>The paper says</th><th>Found here</th><th>Reference</th><th>Reached</th></tr>")?;
    for claim in claims(study) {
        let (class, word) = match claim.verdict {
            Verdict::Reached => ("reached", "yes"),
            Verdict::Partly => ("partly", "in part"),
            Verdict::NotReached => ("not", "no"),
        };
        let Claim { paper, found, reference, .. } = claim;
        let [paper, found, reference] = [paper, &found, &reference].map(escaped);
        writeln!(
            html,
            "<tr><td>{paper}</td><td>{found}</td><td>{reference}</td><td class=\"{class}\">{word}</td></tr>"
        )?;
    }
    writeln!(html, "</table>")
}

fn misfit_table(html: &mut String, study: &Study) -> std::fmt::Result {
    // A column of the reference that is not drawn is not recorded either.
    let n = study.runs.first().map_or(0, |run| run.1.curves.names.len().min(study.reference.names.len()) - 1);
    write!(html, "<table><tr><th>Misfit, largest / RMS</th>")?;
    (0..n)
        .try_for_each(|column| write!(html, "<th class=\"n\">{}</th>", escaped(&study.reference.quantity(column).0)))?;
    writeln!(html, "</tr>")?;
    for (variant, run) in &study.runs {
        let words = if variant.measures == Measures::MotionBased { "" } else { ", classical" };
        write!(html, "<tr><td>{}{words}</td>", escaped(&study.example.label((variant.layout, variant.n_modes))))?;
        match &run.stopped {
            Some(why) => write!(html, "<td colspan=\"{n}\">stops: {}</td>", escaped(why))?,
            None => (0..n).try_for_each(|column| {
                let misfit = run.curves.misfit(column, (&study.reference, column), [0.0, f64::INFINITY]);
                write!(html, "<td class=\"n\">{:.2} % / {:.2} %</td>", 100.0 * misfit.max, 100.0 * misfit.rms)
            })?,
        }
        writeln!(html, "</tr>")?;
    }
    writeln!(html, "</table>")
}

fn iteration_table(html: &mut String, study: &Study) -> std::fmt::Result {
    if study.efforts.is_empty() {
        return Ok(());
    }
    write!(html, "<table><tr><th>Mean iterations per step (most; matrices beyond the first) at tolerance</th>")?;
    study.example.tolerances().iter().try_for_each(|tolerance| write!(html, "<th class=\"n\">{tolerance:.0e}</th>"))?;
    writeln!(html, "</tr>")?;
    for model in study.example.models() {
        write!(html, "<tr><td>{}</td>", escaped(&study.example.label(*model)))?;
        let own = study.efforts.iter().filter(|entry| (entry.0.layout, entry.0.n_modes) == *model);
        for (_, _, effort) in own {
            match effort {
                Some(e) => write!(html, "<td class=\"n\">{:.2} ({}; {})</td>", e.mean(), e.most, e.renewals)?,
                None => write!(html, "<td class=\"n\">stops</td>")?,
            }
        }
        writeln!(html, "</tr>")?;
    }
    writeln!(html, "</table>")
}
