//! What was typed after commands that print what supel knows, as clap reads it.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use super::recipes::{RECIPES, Recipe};

#[derive(Debug, Args)]
pub(super) struct ExplainFlags {
    /// Code of an error, a warning or a check, as in E-SWAPPED, W-GROUNDED or M-06; all of them without one
    pub(super) code: Option<String>,
    /// Print as JSON
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Args)]
pub(super) struct RecipeFlags {
    /// The program that has the model
    #[arg(value_name = "PROGRAM", value_parser = recipes())]
    pub(super) recipe: &'static Recipe,
}

/// The recipes by the names of their programs.
fn recipes() -> impl TypedValueParser<Value = &'static Recipe> {
    let named = |name: String| RECIPES.iter().find(|recipe| recipe.program == name).ok_or("not a program");
    PossibleValuesParser::new(RECIPES.iter().map(|recipe| recipe.program)).try_map(named)
}
