//! The program `supel`.

mod heap;

fn main() -> std::process::ExitCode {
    // An allocator that refuses is slower, no less right.
    heap::keep_large_blocks();
    supel::cli::main(supel::reduce)
}
