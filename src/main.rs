//! The program `supel`.

mod stdout;

#[global_allocator]
static HEAP: supel::heap::Heap = supel::heap::Heap;

fn main() -> std::process::ExitCode {
    // An allocator that refuses is slower, no less right.
    supel::heap::keep_large_blocks();
    supel::heap::end_once();
    let _until_the_end = supel::foreign_exit::watch();
    supel::cli::main(supel::PIPELINE, stdout::state())
}
