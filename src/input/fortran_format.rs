//! Formats of Fortran that put numbers of one kind into a line, at equal distances.
//!
//! ```text
//! (4E20.12)            four numbers of twenty characters
//! (1P,3(2X,E24.16))    a scale, and three times two blanks and a number of 24 characters
//! ```
//! Where numbers are left, a format begins again with its last group in brackets: one that has more before it makes lines of two kinds, and
//! is none of these.

/// The most items of a line.
const MOST_ITEMS: usize = 4096;
/// The most columns of a number, and of blanks between two.
const MOST_COLUMNS: usize = 64;
/// Brackets within each other.
const DEEPEST: usize = 8;
/// The largest power of ten that a format scales by: a double has no more.
const MOST_SCALE: i32 = 308;

/// Where the numbers of a line are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct NumberLine {
    pub(super) per_line: usize,
    /// Column of the first number, from zero.
    pub(super) first: usize,
    /// Columns from the start of one to that of the next.
    pub(super) pitch: usize,
    pub(super) edit: Edit,
    /// Power of ten by which a number without an exponent is written too large.
    pub(super) scale: i32,
}

/// How a number stands in its columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Edit {
    pub(super) width: usize,
    /// Digits behind the point of a number that is written without one; none in a format of whole numbers.
    pub(super) decimals: usize,
}

impl NumberLine {
    /// Of a format, with brackets around it or without.
    pub(super) fn of(format: &str) -> Option<Self> {
        let items = Parser::new(format).items()?;
        let (mut column, mut starts, mut found) = (0, Vec::new(), None);
        for item in items {
            match item {
                Item::Blank => column += 1,
                Item::Number(edit, scale) => {
                    if found.is_some_and(|known| known != (edit, scale)) {
                        return None;
                    }
                    found = Some((edit, scale));
                    starts.push(column);
                    column += edit.width;
                }
            }
        }
        let ((edit, scale), first) = (found?, *starts.first()?);
        let pitch = starts.get(1).map_or(edit.width, |second| second - first);
        let are_even = starts.iter().enumerate().all(|(at, start)| *start == first + at * pitch);
        are_even.then_some(Self { per_line: starts.len(), first, pitch, edit, scale })
    }
}

#[derive(Clone, Copy)]
enum Item {
    Blank,
    Number(Edit, i32),
}

/// A group in brackets that is open.
struct Group {
    times: usize,
    /// The first of its items.
    from: usize,
}

struct Parser<'a> {
    /// What is left, in whatever case; blanks in a format mean nothing.
    rest: &'a [u8],
    items: Vec<Item>,
    scale: i32,
    open: Vec<Group>,
    is_bracketed: bool,
}

impl<'a> Parser<'a> {
    fn new(format: &'a str) -> Self {
        let rest = format.trim_ascii().as_bytes();
        let (rest, is_bracketed) = rest.strip_prefix(b"(").map_or((rest, false), |rest| (rest, true));
        Self { rest, items: Vec::new(), scale: 0, open: Vec::new(), is_bracketed }
    }

    /// All items of a line; none where the format has others, or lines of two kinds.
    fn items(mut self) -> Option<Vec<Item>> {
        while let Some(byte) = self.next() {
            match byte.to_ascii_uppercase() {
                b',' => {}
                b')' if self.open.is_empty() => {
                    let is_end = self.is_bracketed && self.rest.trim_ascii().is_empty();
                    return is_end.then_some(self.items);
                }
                b')' => self.close()?,
                b'-' | b'+' | b'0'..=b'9' => {
                    if self.counted(byte).is_none() {
                        return self.is_told().then_some(self.items);
                    }
                }
                _ if self.item(byte, 1).is_some() => {}
                // What follows a format without brackets is no part of it.
                _ => return self.is_told().then_some(self.items),
            }
            if self.items.len() > MOST_ITEMS {
                return None;
            }
        }
        (!self.is_bracketed && self.open.is_empty()).then_some(self.items)
    }

    /// Whether a format without brackets has said all that there is to be known.
    fn is_told(&self) -> bool {
        !self.is_bracketed && self.open.is_empty() && !self.items.is_empty()
    }

    fn next(&mut self) -> Option<u8> {
        self.rest = self.rest.trim_ascii_start();
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*first)
    }

    /// A number that has begun with a byte.
    fn number(&mut self, first: Option<u8>) -> Option<i32> {
        let mut text: String = first.map(char::from).into_iter().collect();
        while let Some(digit) = self.rest.trim_ascii_start().first().filter(|byte| byte.is_ascii_digit()) {
            text.push(char::from(*digit));
            self.next();
        }
        text.parse().ok()
    }

    /// What stands behind a number that begins with a byte.
    fn counted(&mut self, first: u8) -> Option<()> {
        let number = self.number(Some(first))?;
        let item = self.next()?;
        if item.eq_ignore_ascii_case(&b'P') {
            self.scale = Some(number).filter(|scale| (-MOST_SCALE..=MOST_SCALE).contains(scale))?;
            return Some(());
        }
        let times = usize::try_from(number).ok().filter(|times| (1..=MOST_ITEMS).contains(times))?;
        self.item(item, times)
    }

    /// Blanks, numbers or a group, so many times.
    fn item(&mut self, letter: u8, times: usize) -> Option<()> {
        match letter.to_ascii_uppercase() {
            b'(' if self.open.len() < DEEPEST => {
                // The line after the first one would begin here.
                let begins_here = !self.open.is_empty() || self.items.is_empty();
                self.open.push(Group { times, from: self.items.len() });
                begins_here.then_some(())
            }
            b'X' if times <= MOST_COLUMNS => {
                self.items.extend(std::iter::repeat_n(Item::Blank, times));
                Some(())
            }
            letter @ (b'I' | b'E' | b'D' | b'F' | b'G') => {
                let edit = self.edit(letter)?;
                self.items.extend(std::iter::repeat_n(Item::Number(edit, self.scale), times));
                Some(())
            }
            _ => None,
        }
    }

    /// Width and decimals behind a letter.
    fn edit(&mut self, letter: u8) -> Option<Edit> {
        // `ES` and `EN` are exponents of other looks.
        if letter == b'E' && self.rest.trim_ascii_start().first().is_some_and(|byte| b"SNsn".contains(byte)) {
            self.next();
        }
        let bounded = |parser: &mut Self, least: usize| {
            let number = usize::try_from(parser.number(None)?).ok();
            number.filter(|number| (least..MOST_COLUMNS).contains(number))
        };
        let width = bounded(self, 1)?;
        let mut decimals = 0;
        if self.rest.trim_ascii_start().first() == Some(&b'.') {
            self.next();
            decimals = bounded(self, 0)?;
        }
        // Digits of the exponent.
        if letter != b'I' && self.rest.first().is_some_and(|byte| byte.eq_ignore_ascii_case(&b'E')) {
            let digits = self.rest.get(1).is_some_and(u8::is_ascii_digit);
            if digits {
                self.next();
                self.number(None)?;
            }
        }
        Some(Edit { width, decimals: if letter == b'I' { 0 } else { decimals } })
    }

    fn close(&mut self) -> Option<()> {
        let Group { times, from } = self.open.pop()?;
        let group = self.items[from..].to_vec();
        if group.is_empty() || from + times * group.len() > MOST_ITEMS {
            return None;
        }
        (1..times).for_each(|_| self.items.extend_from_slice(&group));
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_and_blanks_are_where_fortran_puts_them() {
        for (text, per_line, first, pitch, width, decimals, scale) in [
            ("(3(1X,E24.16))", 3, 1, 25, 24, 16, 0),
            ("(1P,3(2X,E24.16))", 3, 2, 26, 24, 16, 1),
            ("(1p3(2x,e24.16e3))", 3, 2, 26, 24, 16, 1),
            ("( 4 ( 1X , I7 ) )", 4, 1, 8, 7, 0, 0),
            ("(2(2(1X,D12.4)),1X)", 4, 1, 13, 12, 4, 0),
            ("(3(E24.16,1X))", 3, 0, 25, 24, 16, 0),
            ("(2X,4F10.3)", 4, 2, 10, 10, 3, 0),
            ("(1X,E10.3,2(1X,E10.3))", 0, 0, 0, 0, 0, 0),
            ("(((4E20.12)))", 4, 0, 20, 20, 12, 0),
            ("(3(1P,1X,E24.16))", 3, 1, 25, 24, 16, 1),
        ] {
            let expected = NumberLine { per_line, first, pitch, edit: Edit { width, decimals }, scale };
            assert_eq!(NumberLine::of(text), (per_line > 0).then_some(expected), "{text}");
        }
    }

    /// Distances, kinds, lines that differ, and what is too much.
    #[test]
    fn formats_that_are_none_of_these() {
        for text in [
            "(2(1X,2E12.4))",
            "(1X,3(E24.16))",
            "(E24.16,3(1X,E24.16))",
            "(E24.16,I5)",
            "(E24.16,1P,E24.16)",
            "(3(1X,E24.16)",
            "(3(1X,E24.16)))",
            "(3(1X))",
            "(3())",
            "(0(E24.16))",
            "(4000(4000E2.1))",
            "(99999999999X,E24.16)",
            "(((((((((((E24.16)))))))))))",
            "(A8,3E24.16)",
            "(3E24.16) x",
            "(3E24.16/)",
        ] {
            assert_eq!(NumberLine::of(text), None, "{text}");
        }
    }
}
