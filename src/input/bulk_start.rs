//! How a deck or a punch file of Nastran is recognised.

use super::file_start::FileStart;

/// Entries that a number follows, from which others tell a deck.
const NUMBERED: &[&str] = &[
    "GRID", "SPOINT", "EPOINT", "SEQGP", "CORD1R", "CORD1C", "CORD1S", "CORD2R", "CORD2C", "CORD2S", "EXTRN", "ASET",
    "ASET1", "BSET", "BSET1", "CSET", "CSET1", "QSET", "QSET1", "OMIT", "OMIT1", "SUPORT", "SPC", "SPC1", "SPCADD",
    "MPC", "MPCADD", "RBAR", "RBE1", "RBE2", "RBE3", "RROD", "CBAR", "CBEAM", "CBUSH", "CBUSH1D", "CELAS1", "CELAS2",
    "CELAS3", "CELAS4", "CDAMP1", "CDAMP2", "CGAP", "CHEXA", "CONM1", "CONM2", "CONROD", "CPENTA", "CPYRAM", "CQUAD4",
    "CQUAD8", "CQUADR", "CROD", "CSHEAR", "CTETRA", "CTRIA3", "CTRIA6", "CTRIAR", "CTUBE", "CWELD", "PBAR", "PBARL",
    "PBEAM", "PBEAML", "PBUSH", "PCOMP", "PELAS", "PGAP", "PLOTEL", "PROD", "PSHEAR", "PSHELL", "PSOLID", "PTUBE",
    "MAT1", "MAT2", "MAT8", "MAT9", "EIGR", "EIGRL", "FORCE", "FREQ", "FREQ1", "LOAD", "MOMENT", "PLOAD", "PLOAD2",
    "PLOAD4", "SET1", "TABDMP1", "TABLED1", "TEMP", "TEMPD", "TSTEP",
];
/// Entries that a name follows.
const NAMED: &[&str] = &["DMI", "PARAM", "USET", "USET1"];
/// Statements in front of the bulk data, each with a character that is in it.
const STATEMENTS: &[(&str, u8)] =
    &[("ASSIGN", b'='), ("NASTRAN", b'='), ("INIT", b'('), ("INCLUDE", b'\''), ("INCLUDE", b'"'), ("RESTART", b'=')];

/// Whether a file is a deck of Nastran, or a part of one: a line that divides its sections, a statement or an entry as the first line below
/// comments of a dollar, or nothing but such comments as far as one can see.
pub(super) fn is_bulk(start: &FileStart<'_>) -> bool {
    let Some(line) = start.lines().find(|line| !line.starts_with(b"$")) else { return is_commented(start) };
    let is_divided = start.lines().any(|line| divides(&line.to_ascii_uppercase()));
    is_divided || begins(&line.to_ascii_uppercase())
}

/// A line of a deck without the comment behind its fields.
pub(super) fn without_comment(line: &[u8]) -> &[u8] {
    line.split(|byte| *byte == b'$').next().unwrap_or(line)
}

/// Whether a line stands between sections of a deck.
fn divides(line: &[u8]) -> bool {
    const BEGIN: [&[u8]; 3] = [b"BEGIN BULK", b"BEGIN SUPER", b"EXTRN"];
    let line = without_comment(line).trim_ascii_end();
    line == b"CEND" || BEGIN.iter().any(|word| line.starts_with(word))
}

/// Whether a line can be the first one of a deck.
fn begins(line: &[u8]) -> bool {
    let length = line.iter().take_while(|byte| byte.is_ascii_alphanumeric()).count();
    let (word, rest) = line.split_at(length);
    let is_one_of = |words: &[&str]| words.iter().any(|known| known.as_bytes() == word);
    let is_statement = || STATEMENTS.iter().any(|(known, mark)| known.as_bytes() == word && rest.contains(mark));
    match word {
        b"SOL" => rest.first().is_some_and(|byte| matches!(byte, b' ' | b'\t' | b',')),
        b"GRDSET" | b"DMIG" => rest.first().is_some_and(|byte| matches!(byte, b' ' | b'\t' | b',' | b'*')),
        b"CEND" | b"SEBULK" | b"SECONCT" => true,
        _ if is_one_of(NUMBERED) => is_followed_by(rest, u8::is_ascii_digit),
        _ if is_one_of(NAMED) => is_followed_by(rest, u8::is_ascii_alphabetic) && has_value(rest),
        _ => is_statement(),
    }
}

/// Whether the first field behind the name of an entry begins so; a column of a table may have the name of an entry.
fn is_followed_by(rest: &[u8], begins: fn(&u8) -> bool) -> bool {
    let field = rest.strip_prefix(b"*").unwrap_or(rest);
    let field = field.strip_prefix(b",").unwrap_or(field).trim_ascii_start();
    field.len() < rest.len() && field.first().is_some_and(begins)
}

/// Whether the second field behind the name of an entry is a value.
fn has_value(rest: &[u8]) -> bool {
    let mut fields = rest.split(|byte| matches!(byte, b',' | b'*' | b' ' | b'\t')).filter(|field| !field.is_empty());
    let value = fields.nth(1).unwrap_or_default();
    matches!(value, b"YES" | b"NO" | [b'0'..=b'9' | b'-' | b'+' | b'.', ..])
}

/// Whether a file begins with comments of a dollar, and nothing else for as long as formats are recognised by. Sections of Gmsh have a name
/// behind the dollar.
fn is_commented(start: &FileStart<'_>) -> bool {
    let first = start.lines().next().and_then(|line| line.strip_prefix(b"$"));
    first.is_some_and(|rest| !rest.first().is_some_and(u8::is_ascii_alphabetic))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn is_of_nastran(text: &str) -> bool {
        is_bulk(&FileStart { path: Path::new("a"), head: text.as_bytes().to_vec(), packing: None })
    }

    #[test]
    fn decks_and_what_is_none() {
        for text in [
            "ASSIGN OUTPUT4='part.op4', UNIT=51\n",
            "NASTRAN SYSTEM(1)=2\n",
            "INIT MASTER(S)\n",
            "include 'a.bdf'\n",
            "ID A,B\nTIME 600\nCEND\n",
            "ID A,B\nTIME 600\nCEND $ a comment\n",
            "TITLE = A\nBEGIN BULK\n",
            "$ a comment\n\nSOL 103\n",
            "SOL,101\n",
            "PARAM,POST,-1\n",
            "PARAM   POST    -1\n",
            "DMIG    KAAX           0       6       2       0\n",
            "dmig*   k                              0               6\n",
            "SPOINT,10,11\n",
            "GRID*                  1\n",
            "CORD2R  1\n",
            "GRDSET,,,,,,,456\n",
            "DMIG\tKAAX\t0\t6\t2\n",
            "SOL\t103\n",
            "GRDSET\t\t\t\t\t\t456\n",
            "USET\tU1\t1\t123\n",
            "$ only\n$ comments\n",
        ] {
            assert!(is_of_nastran(text), "{text}");
        }
        for text in [
            "",
            "id x y z\n1 0 0 0\n",
            "grid,x,y,z\n1,0,0,0\n",
            "force,moment\n1,2\n",
            "param,value\n1,2\n",
            "param,x1,x2\n1,2,3\n",
            "node,dof\n1,1\n",
            "$MeshFormat\n2.2 0 8\n",
            "$Comments\n",
            "1 1 2.5\n",
            "init,x\n",
        ] {
            assert!(!is_of_nastran(text), "{text}");
        }
    }
}
