//! Mass matrices: lines MS-01 to MS-08.
