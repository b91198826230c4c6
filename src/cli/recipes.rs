//! What to write into the decks of programs, one file each.

/// A recipe.
#[derive(Debug)]
pub(super) struct Recipe {
    /// The program as it is typed.
    pub(super) program: &'static str,
    pub(super) text: &'static str,
}

/// All recipes, one file each. What a recipe says of how it was tried stands in its second line.
pub(super) const RECIPES: [Recipe; 8] = [
    Recipe { program: "abaqus", text: include_str!("recipes/abaqus.txt") },
    Recipe { program: "ansys", text: include_str!("recipes/ansys.txt") },
    Recipe { program: "nastran", text: include_str!("recipes/nastran.txt") },
    Recipe { program: "calculix", text: include_str!("recipes/calculix.txt") },
    Recipe { program: "code_aster", text: include_str!("recipes/code_aster.txt") },
    Recipe { program: "gmsh", text: include_str!("recipes/gmsh.txt") },
    Recipe { program: "scipy", text: include_str!("recipes/scipy.txt") },
    Recipe { program: "matlab", text: include_str!("recipes/matlab.txt") },
];
