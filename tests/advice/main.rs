//! The commands that look at a model without reducing it, and those that tell what to do: `supel doctor`, `init`, `certify`,
//! `explain` and `recipe`.

mod certify;
mod doctor;
mod explain;
mod init;
mod recipe;
