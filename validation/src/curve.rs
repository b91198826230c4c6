//! Sampled curves: read, written, compared.

use std::path::Path;

use crate::Result;

/// Quantities over time (or load), one row for each sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// Name of each column, the first of which is the time.
    pub names: Vec<String>,
    /// Time of each sample.
    pub times: Vec<f64>,
    /// Values of each sample, one for each further column.
    pub values: Vec<Vec<f64>>,
}

/// How far a curve is from a reference, as shares of the largest value of the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misfit {
    /// Largest difference.
    pub max: f64,
    /// Root of the mean square difference.
    pub rms: f64,
}

impl Curves {
    /// Curves without samples.
    pub fn new(names: &[&str]) -> Self {
        Self { names: names.iter().map(|name| (*name).to_owned()).collect(), ..Self::default() }
    }

    /// Adds a sample.
    ///
    /// # Panics
    /// If there is not one value for each column.
    pub fn push(&mut self, time: f64, values: Vec<f64>) {
        assert_eq!(values.len() + 1, self.names.len(), "one value a column");
        self.times.push(time);
        self.values.push(values);
    }

    /// What a column holds, from 0 after the time, and its unit: of `root_omega_z_rad_s`, "root omega z" and "rad/s".
    pub fn quantity(&self, column: usize) -> (String, &'static str) {
        let name = &self.names[column + 1];
        let units = [("_rad_s", "rad/s"), ("_m", "m")];
        let found = units.iter().find_map(|(end, unit)| Some((name.strip_suffix(end)?, *unit)));
        let (what, unit) = found.unwrap_or((name, ""));
        (what.replace('_', " "), unit)
    }

    /// Values of a column, from 0 after the time.
    pub fn column(&self, column: usize) -> Vec<f64> {
        self.values.iter().map(|row| row[column]).collect()
    }

    /// The values at a time, within a millionth of a second.
    pub fn at(&self, time: f64) -> Option<&[f64]> {
        let near = self.times.partition_point(|t| *t < time - 1e-6);
        self.times.get(near).filter(|t| (*t - time).abs() < 1e-6).and_then(|_| self.values.get(near)).map(Vec::as_slice)
    }

    /// Reads a CSV file with one line of names.
    ///
    /// # Errors
    /// The file cannot be read or holds something else than numbers.
    pub fn read(path: &Path) -> Result<Self> {
        let mut reader = csv::Reader::from_path(path)?;
        let mut curves = Self { names: reader.headers()?.iter().map(str::to_owned).collect(), ..Self::default() };
        for record in reader.records() {
            let numbers = record?.iter().map(str::parse).collect::<std::result::Result<Vec<f64>, _>>()?;
            let [time, values @ ..] = numbers.as_slice() else { return Err("an empty line".into()) };
            curves.push(*time, values.to_vec());
        }
        Ok(curves)
    }

    /// The text of a CSV file, in the shortest decimals that read back as the same bits.
    pub fn to_csv(&self) -> String {
        let mut text = self.names.join(",") + "\n";
        for (time, row) in self.times.iter().zip(&self.values) {
            text += &row.iter().fold(format!("{time:?}"), |line, value| format!("{line},{value:?}"));
            text.push('\n');
        }
        text
    }

    /// The misfit of a column of these curves against a column of a reference, at the reference's samples from one time
    /// to another; a share of the largest value of the reference over its whole record.
    ///
    /// # Panics
    /// If these curves lack a sample of the reference.
    pub fn misfit(&self, column: usize, reference: (&Self, usize), [from, to]: [f64; 2]) -> Misfit {
        let (curves, other) = reference;
        let amplitude = curves.values.iter().fold(0.0_f64, |largest, row| largest.max(row[other].abs()));
        let (mut max, mut square, mut samples) = (0.0_f64, 0.0, 0_u32);
        for (time, row) in curves.times.iter().zip(&curves.values).filter(|(time, _)| (from..=to).contains(*time)) {
            let own = self.at(*time).unwrap_or_else(|| panic!("no sample at {time}"));
            let difference = (own[column] - row[other]).abs() / amplitude;
            // A value that is not a number is the worst misfit there is.
            max = if difference.is_nan() { f64::INFINITY } else { max.max(difference) };
            square += difference * difference;
            samples += 1;
        }
        Misfit { max, rms: (square / f64::from(samples)).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misfit_is_a_share_of_the_largest_value_of_the_reference() {
        let mut reference = Curves::new(&["t", "a"]);
        let mut found = Curves::new(&["t", "b", "c"]);
        for step in 0..5 {
            reference.push(f64::from(step), vec![f64::from(step) - 4.0]);
            found.push(f64::from(step), vec![0.0, f64::from(step) - 3.0]);
        }
        let misfit = found.misfit(1, (&reference, 0), [0.0, 4.0]);
        assert_eq!((misfit.max, misfit.rms), (0.25, 0.25));
        // In the window the difference is 1 at one sample of two, and the amplitude is still that of the whole record.
        found.values[4][1] = 0.0;
        let misfit = found.misfit(1, (&reference, 0), [3.0, 4.0]);
        assert_eq!((misfit.max, misfit.rms), (0.25, (0.0625_f64 / 2.0).sqrt()));
    }

    #[test]
    fn written_curves_read_back_as_the_same_bits() {
        let mut curves = Curves::new(&["t", "a"]);
        curves.push(0.1 + 0.2, vec![1e-300 / 3.0]);
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("curves.csv");
        std::fs::write(&path, curves.to_csv()).expect("written");
        assert_eq!(Curves::read(&path).expect("read"), curves);
    }
}
