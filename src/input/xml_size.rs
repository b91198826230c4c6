//! A look at an XML document before it is parsed: a parser compares every attribute of an element with every other, and hands namespaces
//! down to every element below, so that a hundred kilobytes of them take minutes. Entities would make gigabytes of a few lines.

use std::path::Path;

use crate::error::{Error, Result};

/// More attributes than an element of any mesh has.
const MAX_ATTRIBUTES: usize = 64;
/// More namespaces than any mesh declares.
const MAX_NAMESPACES: usize = 64;

/// Refuses a document with elements of very many attributes, with very many namespaces, or with declarations in its document type.
pub(super) fn refuse_many_names(text: &str, path: &Path) -> Result<()> {
    let refuse = |at: usize, limit, counted| {
        let line = text[..at].bytes().filter(|byte| *byte == b'\n').count() + 1;
        Err(Error::XdmfSize { path: path.to_owned(), line, limit, counted })
    };
    let (mut at, mut n_namespaces) = (0, 0);
    while let Some(open) = text[at..].find('<').map(|found| at + found) {
        let rest = &text[open..];
        if rest.starts_with(DOCUMENT_TYPE) {
            let declares = || Error::MeshUnsupported {
                path: path.to_owned(),
                object: "DOCTYPE".to_owned(),
                found: "declarations".to_owned(),
                expected: "none between its brackets, as no mesh needs entities or elements of its own",
            };
            at = open + length_of_document_type(rest).ok_or_else(declares)?;
            continue;
        }
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

/// How a document type begins: `<!DOCTYPE Xdmf SYSTEM "Xdmf.dtd" []>` is what FEniCS and XDMF 2 write.
const DOCUMENT_TYPE: &str = "<!DOCTYPE";

/// The length of a document type that declares nothing.
fn length_of_document_type(rest: &str) -> Option<usize> {
    let mut quote = None;
    let head = rest.bytes().skip(DOCUMENT_TYPE.len()).position(|byte| match quote {
        Some(opened) => {
            quote = quote.filter(|_| opened != byte);
            false
        }
        None if matches!(byte, b'"' | b'\'') => {
            quote = Some(byte);
            false
        }
        None => matches!(byte, b'>' | b'[' | b'<'),
    })?;
    let tail = &rest[DOCUMENT_TYPE.len() + head..];
    let tail = match tail.strip_prefix('[') {
        Some(declarations) => declarations.trim_ascii_start().strip_prefix(']')?.trim_ascii_start(),
        None => tail,
    };
    let after = tail.strip_prefix('>')?;
    Some(rest.len() - after.len())
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

    /// What a document type could hide, entities first, is refused before a parser sees it.
    #[test]
    fn document_types_declare_nothing() {
        let code = |text: &str| refuse_many_names(text, Path::new("a.xdmf")).err().map(|error| error.code());
        for sound in ["", " []", " [ \n ] ", " SYSTEM \"Xdmf.dtd\" []", " PUBLIC '-//X>' \"a[<\"", " SYSTEM 'a' [\t]"] {
            assert_eq!(code(&format!("<?xml version='1.0'?><!DOCTYPE Xdmf{sound}><Xdmf/>")), None, "{sound}");
        }
        let attributes: String = (0..65).map(|n| format!(" a{n}=\"\"")).collect();
        let behind = format!("<!DOCTYPE Xdmf SYSTEM \"it's\" []><Xdmf{attributes}/>");
        assert_eq!(code(&behind), Some("E-XDMF-SIZE"), "the quote of a name ends with it");
        let hidden = format!("<!DOCTYPE Xdmf [<!-- ' -->]><Xdmf{attributes}/>");
        for declared in [
            "<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>",
            "<!DOCTYPE a [%b;]><a/>",
            "<!DOCTYPE a [",
            "<!DOCTYPE a",
            &hidden,
        ] {
            assert_eq!(code(declared), Some("E-MESH-UNSUPPORTED"), "{declared}");
        }
    }

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
