//! How the component is supported or loaded by its neighbours while its frequencies are compared.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The words of [`Support`]; mass and stiffness are decimal numbers above zero.
const PATTERN: &str = r"^(free|fix:.+|mass:[^=]+|(mass|spring):.+=\+?([0-9]*[1-9][0-9]*\.?[0-9]*|[0-9]*\.[0-9]*[1-9][0-9]*)([eE][-+]?[0-9]+)?)$";

/// How the component is supported while its frequencies are compared: `free`, `fix:NAME`, `mass:NAME`, `mass:NAME=2.5` or
/// `spring:NAME=1e5`, NAME being an interface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(extend("pattern" = PATTERN, "examples" = ["fix:hub"]))]
pub enum Support {
    /// `free`: no interface held or loaded.
    Free,
    /// `fix:hub`: this interface held, the others free.
    Fixed {
        /// Name of the interface.
        interface: String,
    },
    /// `mass:hub` or `mass:hub=2.5`: a rigid mass on this interface, the others free.
    Loaded {
        /// Name of the interface.
        interface: String,
        /// The mass; that of the component where absent.
        mass: Option<f64>,
    },
    /// `spring:hub=1e5`: each translation of this interface on a spring to the ground, the others free.
    Sprung {
        /// Name of the interface.
        interface: String,
        /// The stiffness in each direction, all nodes of the interface together.
        stiffness: f64,
    },
}

impl Support {
    /// The interface it is about.
    pub fn interface(&self) -> Option<&str> {
        match self {
            Self::Free => None,
            Self::Fixed { interface } | Self::Loaded { interface, .. } | Self::Sprung { interface, .. } => {
                Some(interface)
            }
        }
    }

    /// The number that it states.
    pub(super) fn size(&self) -> Option<f64> {
        match self {
            Self::Free | Self::Fixed { .. } => None,
            Self::Loaded { mass, .. } => *mass,
            Self::Sprung { stiffness, .. } => Some(*stiffness),
        }
    }
}

impl std::fmt::Display for Support {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Free => f.write_str("free"),
            Self::Fixed { interface } => write!(f, "fix:{interface}"),
            Self::Loaded { interface, mass: None } => write!(f, "mass:{interface}"),
            Self::Loaded { interface, mass: Some(mass) } => write!(f, "mass:{interface}={mass}"),
            Self::Sprung { interface, stiffness } => write!(f, "spring:{interface}={stiffness}"),
        }
    }
}

impl From<Support> for String {
    fn from(support: Support) -> Self {
        support.to_string()
    }
}

impl TryFrom<String> for Support {
    type Error = String;

    fn try_from(text: String) -> std::result::Result<Self, String> {
        let expected = || {
            format!("boundary `{text}`: expected `free`, `fix:NAME`, `mass:NAME`, `mass:NAME=2.5` or `spring:NAME=1e5`")
        };
        match text.split_once(':') {
            None if text == "free" => Ok(Self::Free),
            Some(("fix", name)) if !name.is_empty() => Ok(Self::Fixed { interface: name.to_owned() }),
            Some(("mass", rest)) if !rest.is_empty() => {
                let (name, mass) = rest.rsplit_once('=').map_or((rest, None), |(name, mass)| (name, Some(mass)));
                if name.is_empty() {
                    return Err(expected());
                }
                let mass = mass.map(str::parse).transpose().map_err(|_| expected())?;
                Ok(Self::Loaded { interface: name.to_owned(), mass })
            }
            Some(("spring", rest)) => {
                let (name, stiffness) =
                    rest.rsplit_once('=').filter(|(name, _)| !name.is_empty()).ok_or_else(expected)?;
                let stiffness = stiffness.parse().map_err(|_| expected())?;
                Ok(Self::Sprung { interface: name.to_owned(), stiffness })
            }
            _ => Err(expected()),
        }
    }
}

/// A boundary in words: `base held` for `fix:base`, `base loaded` for `mass:base`, `base loaded by 2.5` for `mass:base=2.5`, `base on
/// springs of 1e5` for `spring:base=1e5`; names of others as they stand.
pub fn boundary_in_words(code: &str) -> String {
    if let Some(interface) = code.strip_prefix("fix:") {
        return format!("{interface} held");
    }
    let number = |text: &str| text.parse::<f64>().is_ok();
    if let Some((interface, stiffness)) =
        code.strip_prefix("spring:").and_then(|sprung| sprung.rsplit_once('=')).filter(|(_, k)| number(k))
    {
        return format!("{interface} on springs of {stiffness}");
    }
    let Some(loaded) = code.strip_prefix("mass:") else { return code.to_owned() };
    match loaded.rsplit_once('=').filter(|(_, mass)| number(mass)) {
        Some((interface, mass)) => format!("{interface} loaded by {mass}"),
        None => format!("{loaded} loaded"),
    }
}
