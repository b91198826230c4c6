//! Rigid-body modes, mechanisms and supports: lines S-01 to S-27.
