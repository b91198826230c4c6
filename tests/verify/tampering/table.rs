//! The table of fields, changes and what becomes of them, made and compared with the one in the documents.
//!
//! Every run makes each change in one of the subjects that have the field, another for each change, and holds what comes of it to the
//! page: nothing may be seen less. With `SUPEL_WHOLE=1` each is made in all of them, and the page has to be the same to the letter;
//! `SUPEL_UPDATE_DOCS=1 cargo test --test verify the_table` makes all of it and writes it there.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;
use supel::audit::{self, Audit, Reference};
use supel::input;
use supel::input::{Allowance, InputFacts};
use supel::job::Job;
use supel::model::Model;
use supel::partition::{
    CarriedMatrix, Expansion, Loads, Partition, Quantities, expansion_modes, further_matrices, loads, patches,
    quantities, recovered_rows,
};
use supel::plan::Plan;
use supel::verification::check::Verdict;
use supel_models::fnv1a;
use supel_runtime::Superelement;

use super::alterations::{ALTERATIONS, Alteration, altered};
use super::fields::{Change, changes, fields_of};
use super::subjects::{Subject, root, subjects};

/// What verification says of a change, from the clearest answer to none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Seen {
    Refused,
    Fails,
    Warns,
    No,
}

impl Seen {
    fn of(audit: &Audit) -> Self {
        match audit.verdict() {
            Verdict::Fail => Self::Fails,
            Verdict::Warn => Self::Warns,
            Verdict::Pass | Verdict::Info => Self::No,
        }
    }

    fn of_word(word: &str) -> Option<Self> {
        [Self::Refused, Self::Fails, Self::Warns, Self::No].into_iter().find(|seen| seen.word() == word)
    }

    fn word(self) -> &'static str {
        match self {
            Self::Refused => "refused",
            Self::Fails => "fails",
            Self::Warns => "warns",
            Self::No => "–",
        }
    }
}

/// Whether every change is made in every subject.
fn is_whole() -> bool {
    ["SUPEL_WHOLE", "SUPEL_UPDATE_DOCS"].into_iter().any(|name| std::env::var_os(name).is_some())
}

/// What is done to a subject.
struct Tampering {
    alterations: Vec<&'static Alteration>,
    changes: Vec<Change>,
}

impl Tampering {
    /// All that can be done to each subject.
    fn of_all(subjects: &[Subject]) -> Vec<Self> {
        let of = |subject: &Subject| {
            let original = &subject.superelement;
            let document = serde_json::to_value(original.metadata()).expect("JSON");
            let applies = |alteration: &&Alteration| altered(original, alteration).is_some();
            Self { alterations: ALTERATIONS.iter().filter(applies).collect(), changes: changes(&document) }
        };
        subjects.iter().map(of).collect()
    }

    fn places(&self) -> BTreeSet<(String, &'static str)> {
        let of_alterations = self.alterations.iter().map(|alteration| (alteration.field.to_owned(), alteration.what));
        of_alterations.chain(self.changes.iter().map(|change| (change.field.clone(), change.what))).collect()
    }

    /// Each place in one subject of those that have it, chosen by its name.
    fn in_turn(all: &mut [Self]) {
        let mut having: BTreeMap<(String, &'static str), Vec<usize>> = BTreeMap::new();
        for (subject, tampering) in all.iter().enumerate() {
            tampering.places().into_iter().for_each(|place| having.entry(place).or_default().push(subject));
        }
        for (subject, tampering) in all.iter_mut().enumerate() {
            let is_its_turn = |field: &str, what: &'static str| {
                let subjects = &having[&(field.to_owned(), what)];
                subjects[(fnv1a(&format!("{field} {what}")) % subjects.len() as u64) as usize] == subject
            };
            tampering.alterations.retain(|alteration| is_its_turn(alteration.field, alteration.what));
            tampering.changes.retain(|change| is_its_turn(&change.field, change.what));
        }
    }
}

/// The model of a subject, read once.
struct Known {
    job: Job,
    facts: InputFacts,
    partition: Partition,
}

impl Known {
    fn of(subject: &Subject) -> Self {
        let job = subject.job();
        let read = input::read(&job.model).expect("files");
        let columns = input::load_columns(&job.loads, &read, &Allowance::of(None)).expect("files");
        let modes = input::expansion_columns(&job.reduction, &read, &Allowance::of(None)).expect("files");
        let rows = input::job_quantities(job.write.quantities.as_ref(), &read, &Allowance::of(None)).expect("files");
        let facts = InputFacts::of(&read).with_loads(&job.loads, &columns).with_modes(modes.as_ref());
        let matrices = input::further_matrices(&job, &read, &Allowance::of(None)).expect("files");
        let facts = facts.with_quantities(rows.as_ref()).with_matrices(&matrices);
        let model = Model::new(read).expect("a model");
        let recovered = recovered_rows(&model, job.write.recovery.as_ref()).expect("nodes");
        let faces = input::patch_faces(&job.model, &patches(&model, &job), &Allowance::of(None)).expect("cells");
        let (recovered, _) = recovered.with_faces(&faces);
        let of_job = quantities(&model, rows).expect("rows");
        let matrices = further_matrices(&model, matrices).expect("rows");
        let row_loads = loads(&model, (&job.loads, &job.added_masses), &columns, &faces).expect("nodes");
        let modes = modes.map(|modes| expansion_modes(&model, &modes).expect("modes"));
        let mut partition = Partition::new(model, &job.interfaces).expect("interfaces");
        if let Some(modes) = modes {
            partition.expansion =
                Expansion::carried(&modes, (&partition.transformation, &partition.mass)).expect("modes that move");
        }
        job.reduction.held.iter().for_each(|held| partition.hold_for_modes(held).expect("interfaces"));
        partition.loads = Loads::carried(row_loads, &partition.transformation).expect("dofs that move");
        partition.matrices = CarriedMatrix::carried(matrices, &partition.transformation).expect("dofs that move");
        partition.recovered = recovered;
        partition.quantities = Quantities::carried(of_job, &partition.transformation);
        Self { job, facts, partition }
    }
}

/// The three ways to look.
const WAYS: [&str; 3] = ["alone", "with job", "made again"];

/// A line of the table: how a change was seen in each way, at worst, and why it was not.
#[derive(Debug)]
struct Line {
    seen: [Seen; 3],
    reasons: [Option<&'static str>; 3],
}

/// The reason an audit gives for not vouching for a field: that of the longest name the field begins with.
fn reason(audit: &Audit, field: &str) -> Option<&'static str> {
    let is_part =
        |name: &str| field.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']));
    let matching = audit.unvouched.iter().filter(|unvouched| is_part(unvouched.field));
    matching.max_by_key(|unvouched| unvouched.field.len()).map(|unvouched| unvouched.reason)
}

/// The lines made so far.
#[derive(Default)]
struct Table {
    lines: BTreeMap<(String, &'static str), Line>,
    /// What was not seen although nothing says that it is not vouched for.
    unexplained: BTreeSet<String>,
}

/// Verifies an altered superelement in all ways, and takes the outcome into the table.
fn take(table: &mut Table, place: (&str, &'static str), altered: Option<&Superelement>, sound: &Sound<'_>) {
    let (field, what) = place;
    let ways = altered.map(|superelement| {
        let alone = audit::of_file(superelement).expect("an audit");
        let against = audit::against(superelement, &sound.reference).expect("an audit");
        let again = sound.again(superelement, &against);
        [(Seen::of(&alone), alone), (Seen::of(&against), against.clone()), (again, against)]
    });
    let nothing = || Line { seen: [Seen::Refused; 3], reasons: [None; 3] };
    let line = table.lines.entry((field.to_owned(), what)).or_insert_with(nothing);
    for (at, (seen, audit)) in ways.iter().flatten().enumerate() {
        line.seen[at] = line.seen[at].max(*seen);
        if *seen == Seen::No {
            let reason = reason(audit, field);
            if reason.is_none() {
                table.unexplained.insert(format!("{field}, {what}, {}", WAYS[at]));
            }
            line.reasons[at] = reason;
        }
    }
}

/// A superelement as its job makes it, and what it has to be.
struct Sound<'a> {
    superelement: &'a Superelement,
    job: &'a Job,
    reference: Reference<'a>,
}

impl Sound<'_> {
    /// What `--job JOB --reproduce` makes of an altered superelement that a comparison with the job has judged already.
    fn again(&self, altered: &Superelement, against: &Audit) -> Seen {
        if !audit::is_of_this_version(altered) {
            return Seen::Refused;
        }
        match audit::reproduced(altered, self.superelement, self.job).expect("names in UTF-8").verdict() {
            Verdict::Fail => Seen::Fails,
            _ => Seen::of(against),
        }
    }
}

fn examine(table: &mut Table, subject: &Subject, tampering: Tampering) {
    let known = Known::of(subject);
    let plan = Plan::of(&known.job);
    let reference = Reference::new(&plan, &known.facts, &known.partition).expect("a reference");
    let original = &subject.superelement;
    for audit in [audit::of_file(original), audit::against(original, &reference)] {
        let audit = audit.expect("an audit");
        let loud: Vec<_> = audit.checks.iter().filter(|check| check.verdict() > Verdict::Pass).collect();
        assert!(loud.is_empty(), "{} is sound: {loud:#?}", subject.name);
    }
    let sound = Sound { superelement: original, job: &known.job, reference };
    for alteration in tampering.alterations {
        if let Some(altered) = altered(original, alteration) {
            take(table, (alteration.field, alteration.what), altered.as_ref().ok(), &sound);
        }
    }
    for change in tampering.changes {
        let metadata = serde_json::from_value(change.document).ok();
        let altered = metadata.and_then(|metadata| Superelement::new(original.tensors().clone(), metadata).ok());
        take(table, (&change.field, change.what), altered.as_ref(), &sound);
    }
}

/// The format's own two fields cannot be changed and sealed again: another version is another format, and the digest is the seal.
fn add_seal(table: &mut Table, superelement: &Superelement) {
    let sealed = superelement.to_bytes().expect("bytes");
    let replaced = |old: &str, new: &str| {
        let at = sealed.bytes.windows(old.len()).position(|window| window == old.as_bytes()).expect("in the header");
        let mut bytes = sealed.bytes.clone();
        bytes[at..at + old.len()].copy_from_slice(new.as_bytes());
        Superelement::from_bytes(&bytes)
    };
    let version = |number: u32| format!("\\\"format_version\\\":\\\"{number}\\\"");
    let other = if sealed.digest.starts_with('0') { "1" } else { "0" };
    let digest = format!("{other}{}", &sealed.digest[1..]);
    for (field, altered) in
        [("format_version", replaced(&version(1), &version(2))), ("blake3", replaced(&sealed.digest, &digest))]
    {
        assert!(altered.is_err(), "{field} is not looked at");
        table.lines.insert((field.to_owned(), "another word"), Line { seen: [Seen::Refused; 3], reasons: [None; 3] });
    }
}

fn markdown(table: &Table) -> String {
    let mut text =
        "| field | change | alone | with job | made again | why not seen |\n|---|---|---|---|---|---|\n".to_owned();
    for ((field, what), Line { seen, reasons }) in &table.lines {
        // Made again a change is not seen for the reason that it is not seen with the job.
        let [alone, with_job, _] = reasons;
        let reason = match (alone, with_job) {
            (None, None) => String::new(),
            (Some(alone), None) => format!("alone: {alone}"),
            (None, Some(with_job)) => format!("with the job: {with_job}"),
            (Some(alone), Some(with_job)) if alone == with_job => (*alone).to_owned(),
            (Some(alone), Some(with_job)) => format!("alone: {alone}; with the job: {with_job}"),
        };
        let words = seen.map(Seen::word).join(" | ");
        text += &format!("| `{field}` | {what} | {words} | {reason} |\n");
    }
    text
}

/// Every tensor; destructured, so that a new one cannot be forgotten.
fn tensor_names(superelement: &Superelement) -> BTreeSet<String> {
    let supel_runtime::Tensors {
        stiffness: _,
        mass: _,
        rigid_body_modes: _,
        rigid_body_mass: _,
        interface_positions: _,
        interface_frames: _,
        frequencies: _,
        damping: _,
        mixing: _,
        gravity: _,
        load_vectors: _,
        recovery: _,
        quantities: _,
        matrices: _,
    } = superelement.tensors();
    let names = "stiffness mass rigid_body_modes rigid_body_mass interface_positions interface_frames frequencies damping mixing \
                 gravity load_vectors matrices quantities recovery recovery_dofs recovery_faces recovery_face_offsets \
                 recovery_positions";
    names.split_whitespace().map(str::to_owned).collect()
}

#[test]
fn the_table_of_what_is_seen_is_that_of_the_documents() {
    let mut table = Table::default();
    let subjects = subjects();
    let mut tampering = Tampering::of_all(&subjects);
    if !is_whole() {
        Tampering::in_turn(&mut tampering);
    }
    subjects.iter().zip(tampering).for_each(|(subject, tampering)| examine(&mut table, subject, tampering));
    add_seal(&mut table, &subjects[0].superelement);
    assert!(
        table.unexplained.is_empty(),
        "not seen, and nothing says that it is not vouched for: {:#?}",
        table.unexplained
    );
    let rows: BTreeSet<String> = table.lines.keys().map(|(field, _)| field.clone()).collect();
    let schema: Value =
        serde_json::from_str(include_str!("../../../schemas/superelement.schema.json")).expect("schema is JSON");
    let known = fields_of(&schema).into_iter().chain(tensor_names(&subjects[0].superelement));
    let has_row = |field: &String| {
        rows.iter()
            .any(|row| row == field || row.starts_with(&format!("{field}.")) || row.starts_with(&format!("{field}[")))
    };
    let missing: Vec<String> = known.filter(|field| !has_row(field)).collect();
    assert!(missing.is_empty(), "fields without a row: {missing:?}");
    // Whatever else is not seen has a reason; these fields alone may have one with the job, and then with the job run again.
    let unseen = |way: usize| -> BTreeSet<(&str, &str)> {
        let lines = table.lines.iter().filter(|(_, line)| line.seen[way] == Seen::No);
        lines.map(|((field, what), _)| (field.as_str(), *what)).collect()
    };
    let begins = |field: &str, names: &[&str]| names.iter().any(|name| field.starts_with(name));
    let (with_job, again) = (unseen(1), unseen(2));
    // Parts of a cache are known to the run alone that took them, and a bar may have a little more by the residual of any eigensolver.
    let known = ["dropped[].reason", "job.", "verification.", "generator.parts_of_earlier_runs"];
    let is_known = |(field, what): &(&str, &str)| {
        begins(field, &known) || (*field, *what) == ("coordinates[].error_bar_hz", "changed by a thousandth")
    };
    assert!(with_job.iter().all(is_known), "{with_job:?}");
    assert!(again.iter().all(|(field, _)| begins(field, &["job."])), "{again:?}");
    // Without the bundled example some fields have no row.
    if cfg!(feature = "hdf5") {
        compare_with_page(&table);
    }
}

fn compare_with_page(table: &Table) {
    let path = root().join("docs/what-verify-sees.md");
    let page = std::fs::read_to_string(&path).expect("the document");
    let (begin, end) = ("<!-- begin table -->\n", "<!-- end table -->");
    let (head, rest) = page.split_once(begin).expect("a place for the table");
    let (found, tail) = rest.split_once(end).expect("the end of the table");
    if !is_whole() {
        return hold_to_page(table, found);
    }
    let made = markdown(table);
    if std::env::var_os("SUPEL_UPDATE_DOCS").is_some() {
        std::fs::write(&path, format!("{head}{begin}{made}{end}{tail}")).expect("written");
        return;
    }
    let lines = |text: &str| -> BTreeSet<String> { text.lines().map(str::to_owned).collect() };
    let (made, found) = (lines(&made), lines(found));
    let (new, old): (Vec<_>, Vec<_>) = (made.difference(&found).collect(), found.difference(&made).collect());
    assert!(new.is_empty() && old.is_empty(), "docs/what-verify-sees.md says\n{old:#?}\nand it is\n{new:#?}");
}

/// Each line of a table made in part is one of the page, which sees no more than it.
fn hold_to_page(table: &Table, page: &str) {
    let mut on_page = BTreeMap::new();
    for line in page.lines().skip(2) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let seen = [3, 4, 5].map(|at| Seen::of_word(cells[at]).expect("a word of the table"));
        on_page.insert((cells[1].trim_matches('`').to_owned(), cells[2]), seen);
    }
    let made: BTreeSet<_> = table.lines.keys().map(|(field, what)| (field.clone(), *what)).collect();
    let known: BTreeSet<_> = on_page.keys().cloned().collect();
    assert_eq!(made, known, "docs/what-verify-sees.md has other lines: SUPEL_UPDATE_DOCS=1 writes them");
    let is_less = |((field, what), line): &(&(String, &'static str), &Line)| {
        line.seen.iter().zip(on_page[&(field.clone(), *what)]).any(|(seen, on_page)| *seen > on_page)
    };
    let less: Vec<_> = table.lines.iter().filter(is_less).collect();
    assert!(less.is_empty(), "seen less than docs/what-verify-sees.md says: {less:#?}");
}
