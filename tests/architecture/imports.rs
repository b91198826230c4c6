//! Which file imports which: paths are read from the tokens of each file and followed to the file that defines the name.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The sources of one crate by the path of each module: `["factor", "cholesky"]`, the crate's root is empty.
pub(crate) struct Sources {
    modules: BTreeMap<Vec<String>, Module>,
}

/// What is read of one file.
struct Module {
    /// Path of the file below the folder of the sources.
    file: String,
    /// Paths that its code outside tests names, as written.
    named: Vec<Vec<String>>,
    /// Names that it hands on: `pub use a::b::Name` as `Name` → the path.
    handed_on: BTreeMap<String, Vec<String>>,
}

/// Who sees what a `use` names.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Seen {
    Here,
    ByOthers,
}

/// One file naming something that another one defines.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Import {
    pub(crate) from: String,
    pub(crate) to: String,
    /// The first name that ties them.
    pub(crate) name: String,
}

/// The texts of all files `*.rs` of a folder by their paths.
pub(crate) fn texts_of_folder(root: &Path) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    collect(root, root, &mut files);
    files
}

impl Sources {
    /// Reads all files `*.rs` of a folder.
    pub(crate) fn of_folder(root: &Path) -> Self {
        Self::of_files(&texts_of_folder(root))
    }

    /// Reads files given by their path and text.
    pub(crate) fn of_files(files: &BTreeMap<String, String>) -> Self {
        let modules = files.iter().map(|(file, text)| {
            let tokens: TokenStream = text.parse().unwrap_or_else(|error| panic!("{file}: {error}"));
            let mut module = Module { file: file.clone(), named: Vec::new(), handed_on: BTreeMap::new() };
            module.read(&tokens.into_iter().collect::<Vec<_>>());
            (module_path(file), module)
        });
        Self { modules: modules.collect() }
    }

    /// Number of files.
    pub(crate) fn count(&self) -> usize {
        self.modules.len()
    }

    /// Every import of one file from another, sorted, each pair once.
    pub(crate) fn imports(&self) -> Vec<Import> {
        let mut found: BTreeMap<(String, String), String> = BTreeMap::new();
        for (path, module) in &self.modules {
            for named in &module.named {
                let Some(to) = self.defined_in(path, named, 0) else { continue };
                if to != module.file {
                    found.entry((module.file.clone(), to)).or_insert_with(|| named.join("::"));
                }
            }
        }
        found.into_iter().map(|((from, to), name)| Import { from, to, name }).collect()
    }

    /// The file that defines what a path names as seen from a module; `None` for what other crates define.
    fn defined_in(&self, from: &[String], named: &[String], depth: usize) -> Option<String> {
        let (mut at, mut rest) = self.start_of(from, named)?;
        while let Some((first, tail)) = rest.split_first() {
            let child: Vec<String> = at.iter().cloned().chain([first.clone()]).collect();
            if self.modules.contains_key(&child) {
                (at, rest) = (child, tail);
                continue;
            }
            // A name may be handed on through several modules, never for ever.
            let handed_on = self.modules[&at].handed_on.get(first).filter(|_| depth < 8);
            return match handed_on {
                Some(path) => self.defined_in(&at, path, depth + 1).or_else(|| Some(self.modules[&at].file.clone())),
                None => Some(self.modules[&at].file.clone()),
            };
        }
        Some(self.modules[&at].file.clone())
    }

    /// The module at which a path begins and what is left of it.
    fn start_of<'a>(&self, from: &[String], named: &'a [String]) -> Option<(Vec<String>, &'a [String])> {
        let (first, rest) = named.split_first()?;
        match first.as_str() {
            "crate" => Some((Vec::new(), rest)),
            "self" => Some((from.to_vec(), rest)),
            "super" => {
                let (mut at, mut rest) = (from[..from.len().checked_sub(1)?].to_vec(), rest);
                while rest.first().is_some_and(|segment| segment == "super") {
                    at.pop()?;
                    rest = &rest[1..];
                }
                Some((at, rest))
            }
            _ => {
                let child: Vec<String> = from.iter().cloned().chain([first.clone()]).collect();
                self.modules.contains_key(&child).then(|| (from.to_vec(), named))
            }
        }
    }
}

impl Module {
    /// Walks over the tokens of one level; what stands under `#[cfg(test)]` is left out.
    fn read(&mut self, tokens: &[TokenTree]) {
        let mut i = 0;
        let mut seen = Seen::Here;
        while i < tokens.len() {
            match &tokens[i] {
                TokenTree::Punct(hash) if hash.as_char() == '#' && is_for_tests(tokens.get(i + 1)) => {
                    i = end_of_item(tokens, i + 2);
                    continue;
                }
                TokenTree::Group(group) => self.read(&group.stream().into_iter().collect::<Vec<_>>()),
                TokenTree::Ident(word) if *word == "pub" => {
                    seen = Seen::ByOthers;
                    // The group of `pub(crate)` says nothing more.
                    i += 1 + usize::from(is_group(tokens.get(i + 1), Delimiter::Parenthesis));
                    continue;
                }
                TokenTree::Ident(word) if *word == "use" => {
                    let end = end_of_item(tokens, i);
                    self.read_use(&tokens[i + 1..end.saturating_sub(1)], &[], seen);
                    i = end;
                    seen = Seen::Here;
                    continue;
                }
                TokenTree::Ident(_) if !is_after_separator(tokens, i) => {
                    let (path, next) = path_at(tokens, i);
                    if path.len() > 1 {
                        self.named.push(path);
                    }
                    i = next;
                    seen = Seen::Here;
                    continue;
                }
                _ => {}
            }
            i += 1;
        }
    }

    /// One tree of a `use`, below a prefix.
    fn read_use(&mut self, tokens: &[TokenTree], prefix: &[String], seen: Seen) {
        for tree in tokens.split(|token| matches!(token, TokenTree::Punct(punct) if punct.as_char() == ',')) {
            let (path, next) = path_at(tree, 0);
            let whole: Vec<String> = prefix.iter().cloned().chain(path).collect();
            match tree.get(next) {
                Some(TokenTree::Group(group)) => {
                    self.read_use(&group.stream().into_iter().collect::<Vec<_>>(), &whole, seen);
                }
                // `use a::b as c`
                Some(TokenTree::Ident(_)) => self.take_use(&whole, tree.last().map(ToString::to_string), seen),
                _ if whole.is_empty() => {}
                _ => self.take_use(&whole, whole.last().cloned(), seen),
            }
        }
    }

    fn take_use(&mut self, path: &[String], name: Option<String>, seen: Seen) {
        let is_self = path.len() > 1 && path.last().is_some_and(|last| last == "self");
        let path = if is_self { &path[..path.len() - 1] } else { path };
        match name.filter(|_| seen == Seen::ByOthers) {
            // What is handed on is an import of whoever takes it.
            Some(name) => drop(self.handed_on.insert(name, path.to_vec())),
            None => self.named.push(path.to_vec()),
        }
    }
}

/// The path of a module from that of its file.
fn module_path(file: &str) -> Vec<String> {
    let mut path: Vec<String> = file.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if matches!(path.last().map(String::as_str), Some("mod" | "lib")) {
        path.pop();
    }
    path
}

fn collect(root: &Path, folder: &Path, files: &mut BTreeMap<String, String>) {
    for entry in std::fs::read_dir(folder).expect("the sources can be listed") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(root, &path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(root).expect("below the root").to_string_lossy().replace('\\', "/");
            files.insert(name, std::fs::read_to_string(&path).expect("a source can be read"));
        }
    }
}

/// Segments a::b::c from a place on, and the place after them.
fn path_at(tokens: &[TokenTree], mut i: usize) -> (Vec<String>, usize) {
    let mut path = Vec::new();
    while let Some(TokenTree::Ident(segment)) = tokens.get(i) {
        path.push(segment.to_string());
        i += 1;
        if !is_separator(tokens, i) {
            break;
        }
        i += 2;
    }
    (path, i)
}

fn is_separator(tokens: &[TokenTree], i: usize) -> bool {
    let is_colon = |token: Option<&TokenTree>| matches!(token, Some(TokenTree::Punct(p)) if p.as_char() == ':');
    is_colon(tokens.get(i)) && is_colon(tokens.get(i + 1))
}

fn is_after_separator(tokens: &[TokenTree], i: usize) -> bool {
    i >= 2 && is_separator(tokens, i - 2)
}

fn is_group(token: Option<&TokenTree>, delimiter: Delimiter) -> bool {
    matches!(token, Some(TokenTree::Group(group)) if group.delimiter() == delimiter)
}

/// Whether an attribute is `cfg(test)` or a condition that holds in tests only.
fn is_for_tests(attribute: Option<&TokenTree>) -> bool {
    let Some(TokenTree::Group(group)) = attribute else { return false };
    let text = group.stream().to_string().replace(' ', "");
    text.starts_with("cfg(test") || text.starts_with("cfg(all(test")
}

/// The place after an item: behind its `;` or its braces.
fn end_of_item(tokens: &[TokenTree], mut i: usize) -> usize {
    let is_use = tokens[i..].iter().take(4).any(|token| matches!(token, TokenTree::Ident(word) if *word == "use"));
    while i < tokens.len() {
        let is_end = match &tokens[i] {
            TokenTree::Punct(punct) => punct.as_char() == ';',
            TokenTree::Group(group) => group.delimiter() == Delimiter::Brace && !is_use,
            _ => false,
        };
        i += 1;
        if is_end {
            break;
        }
    }
    i
}

/// Files that import each other, directly or by way of others: each set sorted, the sets in order.
pub(crate) fn circles(imports: &[Import]) -> Vec<Vec<String>> {
    let mut next: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for import in imports {
        next.entry(&import.from).or_default().insert(&import.to);
    }
    let reached = |from: &str| {
        let mut seen = BTreeSet::new();
        let mut open = vec![from.to_owned()];
        while let Some(file) = open.pop() {
            for to in next.get(file.as_str()).into_iter().flatten() {
                if seen.insert((*to).to_owned()) {
                    open.push((*to).to_owned());
                }
            }
        }
        seen
    };
    let from: BTreeMap<&str, BTreeSet<String>> = next.keys().map(|file| (*file, reached(file))).collect();
    let mut circles = BTreeSet::new();
    for (file, ends) in &from {
        if ends.contains(*file) {
            let back = ends.iter().filter(|end| from.get(end.as_str()).is_some_and(|ends| ends.contains(*file)));
            circles.insert(back.cloned().collect::<Vec<_>>());
        }
    }
    circles.into_iter().collect()
}
