//! `supel recipe`: what to write into the deck of a program so that it exports K, M and what their rows are, and where that goes wrong.

use super::answer::Terminal;
use super::exit_code::ExitCode;
use super::text_flags::RecipeFlags;
use crate::error::Result;

pub(super) fn run(flags: &RecipeFlags, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    terminal.answer(flags.recipe.text);
    Ok(ExitCode::Done)
}
