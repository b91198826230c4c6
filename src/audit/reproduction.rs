//! A superelement against the one that its job makes now: M-26.
//!
//! In one version of the program a job on unchanged files always gives the same bytes. Paths of the job kept in the file
//! depend on where the file was written, and are taken from it.

use serde_json::Value;
use supel_runtime::{Matrix, Superelement, Tensors};

use super::flaw::flaw;
use super::jobs::differences;
use super::version::kept_job;
use crate::error::{Result, json_value};
use crate::job::Job;
use crate::verification::check::Check;

/// M-26: the file has the bytes of a superelement made again by `job`.
///
/// # Errors
/// [`crate::error::Error::NotJson`] where the job names a file that is not UTF-8.
pub fn reproduced(superelement: &Superelement, again: &Superelement, job: &Job) -> Result<Check> {
    let equation = "number of tensors and fields that differ from those of the same job run again";
    Ok(flaw("the same job makes it again", equation, &different_parts(superelement, again, job)?))
}

/// The names of the parts that differ; none where the bytes are the same.
fn different_parts(superelement: &Superelement, again: &Superelement, job: &Job) -> Result<Vec<String>> {
    let mut metadata = again.metadata().clone();
    let is_its_job = match kept_job(superelement) {
        Some(kept) => differences(&kept, job)? == Default::default(),
        None => false,
    };
    if is_its_job {
        metadata.job = superelement.metadata().job.clone();
    }
    let Ok(again) = Superelement::new(again.tensors().clone(), metadata) else {
        return Ok(vec!["its job".to_owned()]);
    };
    let mut parts = Vec::new();
    tensors(superelement.tensors(), again.tensors(), &mut parts);
    let document = |superelement: &Superelement| json_value("the metadata of a superelement", superelement.metadata());
    fields(&document(superelement)?, &document(&again)?, "", &mut parts);
    if parts.is_empty() {
        match (superelement.to_bytes(), again.to_bytes()) {
            (Ok(one), Ok(other)) if one.bytes == other.bytes => {}
            // Numbers that are equal and have other bits, as zero has.
            (Ok(_), Ok(_)) => parts.push("signs of zeros".to_owned()),
            _ => parts.push("bytes that cannot be written".to_owned()),
        }
    }
    Ok(parts)
}

fn tensors(one: &Tensors, other: &Tensors, parts: &mut Vec<String>) {
    let Tensors {
        stiffness,
        mass,
        rigid_body_modes,
        rigid_body_mass,
        interface_positions,
        interface_frames,
        frequencies,
        damping,
        mixing,
        gravity,
        load_vectors,
        recovery,
        quantities,
        matrices: further,
    } = one;
    let mut note = |name: &str, differs: bool, size: Option<f64>| {
        if differs {
            parts.push(size.map_or_else(|| name.to_owned(), |size| format!("{name} (by {size:.1e})")));
        }
    };
    let matrices = [
        ("stiffness", Some(stiffness), Some(&other.stiffness)),
        ("mass", Some(mass), Some(&other.mass)),
        ("rigid_body_modes", Some(rigid_body_modes), Some(&other.rigid_body_modes)),
        ("rigid_body_mass", Some(rigid_body_mass), Some(&other.rigid_body_mass)),
        ("damping", damping.as_ref(), other.damping.as_ref()),
        ("mixing", mixing.as_ref(), other.mixing.as_ref()),
        ("gravity", gravity.as_ref(), other.gravity.as_ref()),
        ("load_vectors", load_vectors.as_ref(), other.load_vectors.as_ref()),
        ("quantities", quantities.as_ref(), other.quantities.as_ref()),
    ];
    for (name, one, other) in matrices {
        note(name, one != other, one.zip(other).and_then(|(one, other)| distance(one, other)));
    }
    note("matrices", *further != other.matrices, None);
    note("interface_positions", *interface_positions != other.interface_positions, None);
    note("interface_frames", *interface_frames != other.interface_frames, None);
    note("frequencies", *frequencies != other.frequencies, None);
    note("recovery", *recovery != other.recovery, None);
}

/// The largest difference relative to the largest entry, of matrices of one shape.
fn distance(one: &Matrix, other: &Matrix) -> Option<f64> {
    if (one.rows(), one.cols()) != (other.rows(), other.cols()) {
        return None;
    }
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0f64, |max, value| max.max(value.abs()));
    let pairs = one.as_slice().iter().zip(other.as_slice());
    let size = largest(&mut other.as_slice().iter().copied());
    Some(largest(&mut pairs.map(|(one, other)| one - other)) / if size > 0.0 { size } else { 1.0 })
}

/// Names of the fields with other values; lists and objects are named as far as both have them.
fn fields(one: &Value, other: &Value, name: &str, parts: &mut Vec<String>) {
    match (one, other) {
        (Value::Object(one), Value::Object(other)) if one.len() == other.len() => {
            for (key, value) in one {
                let below = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                fields(value, other.get(key).unwrap_or(&Value::Null), &below, parts);
            }
        }
        (Value::Array(one), Value::Array(other)) if one.len() == other.len() => {
            one.iter().zip(other).enumerate().for_each(|(at, (one, other))| {
                fields(one, other, &format!("{name}[{at}]"), parts);
            });
        }
        _ if one != other => parts.push(name.to_owned()),
        _ => {}
    }
}
