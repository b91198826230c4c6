//! Text in columns.

/// How a column is aligned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Right,
}

/// Width of `text` in columns of the terminal; every character used here is one column wide. A table of widths would serve names in
/// wide scripts alone, and no crate that we have brings one.
pub(crate) fn width(text: &str) -> usize {
    text.chars().count()
}

/// `text` padded to `columns`.
pub(crate) fn pad(text: &str, columns: usize, align: Align) -> String {
    let gap = " ".repeat(columns.saturating_sub(width(text)));
    match align {
        Align::Left => format!("{text}{gap}"),
        Align::Right => format!("{gap}{text}"),
    }
}

/// `text` cut to `columns`, with an ellipsis where something was cut.
pub(crate) fn shorten(text: &str, columns: usize) -> String {
    if width(text) <= columns {
        return text.to_owned();
    }
    let kept: String = text.chars().take(columns.saturating_sub(1)).collect();
    format!("{}…", kept.trim_end())
}

/// `text` broken at blanks into lines of at most `columns`; a longer word stays whole, and so do several blanks and any other white
/// space, which may be part of a name.
pub(crate) fn wrap(text: &str, columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if width(line) + 1 + width(word) <= columns => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Rows with each column as wide as its widest cell, two blanks between columns.
pub(crate) fn columns<const N: usize>(rows: &[[String; N]], align: [Align; N]) -> Vec<[String; N]> {
    let widths: [usize; N] =
        std::array::from_fn(|column| rows.iter().map(|row| width(&row[column])).max().unwrap_or(0));
    rows.iter().map(|row| std::array::from_fn(|column| pad(&row[column], widths[column], align[column]))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_space_of_names_stays() {
        assert_eq!(wrap("two  blanks\nand \u{2028}", 80), ["two  blanks\nand \u{2028}"]);
        assert_eq!(wrap("one two", 4), ["one", "two"]);
    }

    #[test]
    fn long_text_is_cut_or_broken_at_the_width() {
        assert_eq!(shorten("eigenpair backward error", 10), "eigenpair…");
        assert_eq!(wrap("one two three", 8), ["one two", "three"]);
    }
}
