//! Wall time of each stage.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::chart::{Drawn, FAINT, INK, LETTER, PALE_BLUE, WIDTH, draw, text};
use crate::number;
use crate::report::StageTime;

/// Height of a row.
const ROW: u32 = 40;

/// Where the bars begin, and what stays free at their right for the times.
const LEFT: i32 = 300;
const RIGHT: i32 = 190;

/// A bar for each stage with its name and its time.
pub(in crate::report::html) fn stage_times(stages: &[StageTime]) -> Option<String> {
    let longest = stages.iter().map(|stage| stage.seconds).fold(0.0, f64::max);
    if longest <= 0.0 {
        return None;
    }
    draw(ROW * stages.len() as u32 + 8, |area| -> Drawn {
        for (row, stage) in stages.iter().enumerate() {
            let middle = (ROW as usize * row) as i32 + ROW as i32 / 2 + 4;
            let length = (stage.seconds / longest * f64::from(WIDTH as i32 - LEFT - RIGHT)).round() as i32;
            area.draw(&Text::new(stage.name, (LEFT - 16, middle), text(LETTER, INK, HPos::Right, VPos::Center)))?;
            let bar = [(LEFT, middle - 12), (LEFT + length.max(2), middle + 12)];
            area.draw(&Rectangle::new(bar, PALE_BLUE.filled()))?;
            let time = number::duration(stage.seconds);
            let style = text(LETTER, FAINT, HPos::Left, VPos::Center);
            area.draw(&Text::new(time, (LEFT + length.max(2) + 12, middle), style))?;
        }
        Ok(())
    })
}
