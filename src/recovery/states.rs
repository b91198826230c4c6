//! States from up to three tables: displacements, velocities and accelerations, read row by row in step.

use std::path::{Path, PathBuf};

use super::state::{Order, State};
use crate::error::{Error, Result};
use crate::input::StateTable;

/// The tables of the states of one simulation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateFiles {
    /// The coordinates.
    pub displacement: PathBuf,
    /// Their velocities, where these are wanted.
    pub velocity: Option<PathBuf>,
    /// Their accelerations, where these are wanted.
    pub acceleration: Option<PathBuf>,
}

/// States being read.
pub struct States {
    displacement: StateTable,
    /// The tables of velocities and accelerations that are there.
    derivatives: Vec<(Order, StateTable)>,
    state: State,
    has_times: bool,
}

impl StateFiles {
    /// The table of each order.
    pub fn path(&self, order: Order) -> Option<&Path> {
        match order {
            Order::Displacement => Some(&self.displacement),
            Order::Velocity => self.velocity.as_deref(),
            Order::Acceleration => self.acceleration.as_deref(),
        }
    }
}

impl States {
    /// Opens the tables, for coordinates of these names.
    ///
    /// # Errors
    /// The errors of [`StateTable::open`] for each table.
    pub fn open(files: &StateFiles, names: &[String]) -> Result<Self> {
        let displacement = StateTable::open(&files.displacement, names)?;
        let mut state = State::default();
        state.coordinates[0] = Some(vec![0.0; names.len()]);
        let mut derivatives = Vec::new();
        for order in [Order::Velocity, Order::Acceleration] {
            let Some(path) = files.path(order) else { continue };
            derivatives.push((order, StateTable::open(path, names)?));
            state.coordinates[order as usize] = Some(vec![0.0; names.len()]);
        }
        let has_times = displacement.has_times();
        Ok(Self { displacement, derivatives, state, has_times })
    }

    /// Whether the states have times.
    pub fn has_times(&self) -> bool {
        self.has_times
    }

    /// Which derivatives are known, the coordinates themselves first.
    pub fn orders(&self) -> Vec<Order> {
        Order::ALL.into_iter().filter(|order| self.state.of(*order).is_some()).collect()
    }

    /// The table of the coordinates.
    pub fn path(&self) -> &Path {
        self.displacement.path()
    }

    /// The next state; none at the end of all tables.
    ///
    /// # Errors
    /// Rows that cannot be read; [`Error::StateRows`] where the tables have not the same states; [`Error::NoData`] where there is none.
    pub fn advance(&mut self) -> Result<Option<&State>> {
        let [q, derivatives @ ..] = &mut self.state.coordinates;
        let row = self.displacement.advance(q.as_deref_mut().unwrap_or_default())?;
        for (order, table) in &mut self.derivatives {
            let values = derivatives[*order as usize - 1].as_deref_mut().unwrap_or_default();
            let found = match (row, table.advance(values)?) {
                (None, None) => continue,
                (Some(_), None) => format!("{} states", self.state.number),
                (None, Some(row)) => format!("one state more at line {}", row.line),
                (Some(row), Some(other)) => match (row.time, other.time) {
                    (Some(time), Some(found)) if time != found => {
                        format!("time {found} in place of {time} at line {}", other.line)
                    }
                    _ => continue,
                },
            };
            let (path, of) = (table.path().to_owned(), self.displacement.path().to_owned());
            return Err(Error::StateRows { path, found, of });
        }
        let Some(row) = row else {
            let path = || self.displacement.path().to_owned();
            let is_empty = self.state.number == 0;
            return if is_empty {
                Err(Error::NoData { path: path(), expected: "a row for each state" })
            } else {
                Ok(None)
            };
        };
        self.state.number += 1;
        self.state.time = row.time;
        Ok(Some(&self.state))
    }
}
