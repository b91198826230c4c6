//! The message of a command that ends in an error: one line on stderr, and with `--json` a document on stdout.

use std::error::Error as _;

use serde_json::json;

use super::answer::Terminal;
use super::exit_code::ExitCode;
use crate::error::{Error, INTERNAL_CODE, USAGE_CODE};
use crate::report::value_text;

/// A command that ended without its answer.
pub(super) struct Refusal {
    code: &'static str,
    exit: ExitCode,
    message: String,
    /// Messages below the first that it has not quoted.
    causes: Vec<String>,
}

/// In which form the answer was asked for, and so the error that takes its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Text,
    Json,
}

impl Refusal {
    /// A command line that cannot be read.
    pub(super) fn usage(error: &clap::Error) -> Self {
        let text = error.render().to_string();
        let message = text.strip_prefix("error: ").unwrap_or(&text).trim_end().to_owned();
        Self { code: USAGE_CODE, exit: ExitCode::Usage, message, causes: Vec::new() }
    }

    /// An error of a stage, with its causes unless the line before has quoted them.
    pub(super) fn of(error: &Error) -> Self {
        let mut causes: Vec<String> = Vec::new();
        let mut deeper = error.source();
        while let Some(cause) = deeper {
            let text = cause.to_string();
            if !causes.last().unwrap_or(&error.to_string()).contains(&text) {
                causes.push(text);
            }
            deeper = cause.source();
        }
        Self { code: error.code(), exit: ExitCode::from(error.class()), message: error.to_string(), causes }
    }

    /// A panic.
    pub(super) fn defect() -> Self {
        let message = "this is a defect of supel, please report it with the lines above".to_owned();
        Self { code: INTERNAL_CODE, exit: ExitCode::InternalError, message, causes: Vec::new() }
    }

    /// Says it; the exit code is for the process.
    pub(super) fn tell(&self, form: Form, terminal: &mut Terminal<'_>) -> ExitCode {
        let line = format!("supel: error[{}]: {}", self.code, self.message);
        // Of clap's messages the lines are wanted.
        if self.code == USAGE_CODE {
            terminal.complain_at_length(&line)
        } else {
            terminal.complain(&line)
        }
        for cause in &self.causes {
            terminal.complain(&format!("  caused by: {cause}"));
        }
        if form == Form::Json {
            terminal.answer(&value_text(&self.document()));
        }
        self.exit
    }

    /// `schemas/error.schema.json` describes it.
    fn document(&self) -> serde_json::Value {
        let Self { code, exit, message, causes } = self;
        json!({ "error": { "code": code, "exit_code": *exit as u8, "message": message, "causes": causes } })
    }
}
