//! A look at an XML document before it is parsed: a parser compares every attribute of an element with every other, and hands namespaces
//! down to every element below, so that a hundred kilobytes of them take minutes.

use std::path::Path;

use crate::error::{Error, Result};

/// More attributes than an element of any mesh has.
const MAX_ATTRIBUTES: usize = 64;
/// More namespaces than any mesh declares.
const MAX_NAMESPACES: usize = 64;

/// Refuses a document with elements of very many attributes, or with very many namespaces.
pub(super) fn refuse_many_names(text: &str, path: &Path) -> Result<()> {
    let refuse = |at: usize, limit, counted| {
        let line = text[..at].bytes().filter(|byte| *byte == b'\n').count() + 1;
        Err(Error::XdmfSize { path: path.to_owned(), line, limit, counted })
    };
    let (mut at, mut n_namespaces) = (0, 0);
    while let Some(open) = text[at..].find('<').map(|found| at + found) {
        let rest = &text[open..];
        if let Some(length) = length_of_no_element(rest) {
            at = open + length;
            continue;
        }
        let Tag { length, n_attributes } = tag(rest);
        n_namespaces += rest[..length].matches("xmlns").count();
        if n_attributes > MAX_ATTRIBUTES {
            return refuse(open, MAX_ATTRIBUTES, "attributes in one element");
        }
        if n_namespaces > MAX_NAMESPACES {
            return refuse(open, MAX_NAMESPACES, "namespaces");
        }
        at = open + length;
    }
    Ok(())
}

/// The length of a comment, a data section or an instruction that begins here; none where something else does.
fn length_of_no_element(rest: &str) -> Option<usize> {
    const KINDS: [(&str, &str); 3] = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
    let (open, close) = KINDS.into_iter().find(|(open, _)| rest.starts_with(open))?;
    Some(rest[open.len()..].find(close).map_or(rest.len(), |found| open.len() + found + close.len()))
}

/// The tag that begins here.
struct Tag {
    length: usize,
    n_attributes: usize,
}

fn tag(rest: &str) -> Tag {
    let (mut quote, mut n_attributes) = (None, 0);
    for (at, byte) in rest.bytes().enumerate() {
        match (quote, byte) {
            (Some(opened), _) if opened == byte => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'=') => n_attributes += 1,
            (None, b'>') => return Tag { length: at + 1, n_attributes },
            (None, _) => {}
        }
    }
    Tag { length: rest.len(), n_attributes }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_counted_wherever_they_hide() {
        let code = |text: &str| refuse_many_names(text, Path::new("a.xdmf")).err().map(|error| error.code());
        let attributes: String = (0..65).map(|n| format!(" a{n}=\">\"")).collect();
        let namespaces: String = (0..65).map(|n| format!("<g xmlns:a{n}='u'>")).collect();
        assert_eq!(code(&format!("<Xdmf{attributes}/>")), Some("E-XDMF-SIZE"));
        assert_eq!(code(&format!("<!-- isn't --><Xdmf{attributes}/>")), Some("E-XDMF-SIZE"), "behind an apostrophe");
        assert_eq!(code(&format!("<![CDATA[\"]]><Xdmf{attributes}/>")), Some("E-XDMF-SIZE"), "behind a quote");
        assert_eq!(code(&namespaces), Some("E-XDMF-SIZE"));
        assert_eq!(code(&format!("<Xdmf><!--{attributes}{namespaces}--></Xdmf>")), None, "nothing of it is parsed");
        assert_eq!(code("<Xdmf xmlns:xi=\"x\" Version=\"3.0\"><Grid Name='a=b=c'/></Xdmf> <"), None);
    }
}
