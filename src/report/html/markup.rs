//! Elements of the page. Everything that comes from the user or a file is escaped here, and nowhere else.
//!
//! The page is written so that it is HTML and well-formed XML at once: a test can read it back with a strict parser.

use std::fmt::Write;

use crate::report::page::verdict_word;
use crate::report::printable;
use crate::verification::check::Verdict;

/// Tables of up to so many rows are kept on one printed page.
const ON_ONE_PAGE: usize = 14;

/// Texts of up to so many letters are not broken into lines in a table.
const UNBROKEN: usize = 18;

/// The page so far.
#[derive(Default)]
pub(super) struct Markup(String);

/// One cell of a table.
pub(super) enum Cell {
    /// Names the row.
    Head(String),
    /// Words, aligned left.
    Text(String),
    /// A number, aligned right.
    Number(String),
    /// Sign and word of a verdict.
    Verdict(Verdict),
}

/// A table with its caption.
pub(super) struct Table {
    /// Identifier of the caption.
    pub(super) id: String,
    /// What the rows are, one sentence.
    pub(super) caption: String,
    /// Names of the columns.
    pub(super) heads: Vec<String>,
    /// As many cells as heads in each row.
    pub(super) rows: Vec<Vec<Cell>>,
}

/// A drawing with what is said in its place to those who cannot see it.
pub(super) struct Figure {
    /// Identifier of the figure.
    pub(super) id: &'static str,
    /// The drawing, as a plotting backend writes it.
    pub(super) svg: Option<String>,
    /// What the figure is, in a few words.
    pub(super) title: String,
    /// What can be seen in it, with the numbers that matter.
    pub(super) description: String,
    /// How to read it.
    pub(super) caption: String,
}

impl Markup {
    pub(super) fn into_text(self) -> String {
        self.0
    }

    /// Markup as it stands; only constants and what other functions here have escaped.
    pub(super) fn raw(&mut self, markup: &str) {
        self.0.push_str(markup);
    }

    /// An element that holds nothing but text.
    pub(super) fn element(&mut self, tag: &str, text: &str) {
        let _ = writeln!(self.0, "<{tag}>{}</{tag}>", escaped(text));
    }

    /// An element with a class that holds nothing but text.
    pub(super) fn classed(&mut self, tag: &str, class: &str, text: &str) {
        let _ = writeln!(self.0, "<{tag} class=\"{class}\">{}</{tag}>", escaped(text));
    }

    pub(super) fn paragraph(&mut self, text: &str) {
        self.element("p", text);
    }

    /// Why a part has nothing to show.
    pub(super) fn absent(&mut self, why: &str) {
        self.classed("p", "absent", why);
    }

    /// A part of the page with a heading of the second level.
    pub(super) fn section(&mut self, id: &str, heading: &str, content: impl FnOnce(&mut Self)) {
        let _ = writeln!(self.0, "<section id=\"{id}\" aria-labelledby=\"{id}-heading\">");
        let _ = writeln!(self.0, "<h2 id=\"{id}-heading\">{}</h2>", escaped(heading));
        content(self);
        self.raw("</section>\n");
    }

    /// A heading of the third level.
    pub(super) fn heading(&mut self, text: &str) {
        self.element("h3", text);
    }

    /// Labels with their values, of one line or several.
    pub(super) fn facts(&mut self, facts: &[(&str, Vec<String>)]) {
        self.facts_of("facts", facts);
    }

    /// Digests: long, and to be compared letter by letter.
    pub(super) fn digests(&mut self, digests: &[(&str, Vec<String>)]) {
        self.facts_of("facts digests", digests);
    }

    fn facts_of(&mut self, class: &str, facts: &[(&str, Vec<String>)]) {
        let _ = writeln!(self.0, "<dl class=\"{class}\">");
        for (label, lines) in facts.iter().filter(|(_, lines)| !lines.is_empty()) {
            let _ = writeln!(self.0, "<dt>{}</dt>", escaped(label));
            for line in lines {
                let _ = writeln!(self.0, "<dd>{}</dd>", escaped(line));
            }
        }
        self.raw("</dl>\n");
    }

    pub(super) fn table(&mut self, table: &Table) {
        let Table { id, caption, heads, rows } = table;
        let length = if rows.len() <= ON_ONE_PAGE { "wide whole" } else { "wide" };
        let _ = writeln!(self.0, "<div class=\"{length}\" role=\"region\" tabindex=\"0\" aria-labelledby=\"{id}\">");
        let _ = writeln!(self.0, "<table>\n<caption id=\"{id}\">{}</caption>\n<thead>\n<tr>", escaped(caption));
        for (column, head) in heads.iter().enumerate() {
            let is_number = rows.first().is_some_and(|row| matches!(row.get(column), Some(Cell::Number(_))));
            let class = if is_number { " class=\"number\"" } else { "" };
            let _ = writeln!(self.0, "<th scope=\"col\"{class}>{}</th>", escaped(head));
        }
        self.raw("</tr>\n</thead>\n<tbody>\n");
        for row in rows {
            self.raw("<tr>");
            row.iter().for_each(|cell| self.cell(cell));
            self.raw("</tr>\n");
        }
        self.raw("</tbody>\n</table>\n</div>\n");
    }

    fn cell(&mut self, cell: &Cell) {
        let _ = match cell {
            Cell::Head(text) if text.chars().count() <= UNBROKEN => {
                write!(self.0, "<th scope=\"row\" class=\"unbroken\">{}</th>", escaped(text))
            }
            Cell::Head(text) => write!(self.0, "<th scope=\"row\">{}</th>", escaped(text)),
            Cell::Text(text) if text.chars().count() <= UNBROKEN => {
                write!(self.0, "<td class=\"unbroken\">{}</td>", escaped(text))
            }
            Cell::Text(text) => write!(self.0, "<td>{}</td>", escaped(text)),
            Cell::Number(text) => write!(self.0, "<td class=\"number\">{}</td>", escaped(text)),
            Cell::Verdict(verdict) => write!(
                self.0,
                "<td><span class=\"verdict {}\">{}</span></td>",
                class_of(*verdict),
                verdict_word(*verdict)
            ),
        };
    }

    pub(super) fn figure(&mut self, figure: &Figure) {
        let Figure { id, svg, title, description, caption } = figure;
        let _ = writeln!(
            self.0,
            "<figure id=\"{id}\">\n<div class=\"plot\" role=\"region\" tabindex=\"0\" aria-labelledby=\"{id}-caption\">"
        );
        match svg.as_deref().and_then(|svg| svg.strip_prefix("<svg ")) {
            Some(svg) => {
                let (attributes, drawing) = svg.split_once('>').unwrap_or((svg, ""));
                let _ = write!(self.0, "<svg role=\"img\" aria-labelledby=\"{id}-title {id}-text\" {attributes}>");
                let _ = writeln!(self.0, "<title id=\"{id}-title\">{}</title>", escaped(title));
                let _ = write!(self.0, "<desc id=\"{id}-text\">{}</desc>", escaped(description));
                self.raw(drawing);
            }
            None => self.absent("This figure could not be drawn; the numbers are in the JSON report."),
        }
        let _ = writeln!(
            self.0,
            "</div>\n<figcaption id=\"{id}-caption\"><strong>{}.</strong> {}</figcaption>\n</figure>",
            escaped(title),
            escaped(caption)
        );
    }
}

/// The class that colours a verdict; the word next to it says the verdict too.
pub(super) fn class_of(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Info => "info",
        Verdict::Pass => "pass",
        Verdict::Warn => "warn",
        Verdict::Fail => "fail",
    }
}

/// Text that is safe in content and in attributes of HTML and XML.
pub fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in printable(text).chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            _ => safe.push(character),
        }
    }
    safe
}
