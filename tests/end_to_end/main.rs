//! The whole way, from files on disk to files on disk, through the command line.

mod alike;
mod axes;
mod axes_of_decks;
mod cache;
mod failures;
mod few_digits;
mod fixed_point;
mod foreign_names;
mod left_by_the_producer;
mod links;
mod macneal;
mod methods;
mod misleading;
mod node_frames;
mod outputs;
mod penalties;
mod recovery;
mod reference_node;
mod results;
mod rounded_levers;
mod rubin_free;
#[cfg(feature = "hdf5")]
mod same_bytes;
mod soft_joint;
mod told;
mod unseen;

use supel_testing::place;
