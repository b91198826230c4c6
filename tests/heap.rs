//! Memory that the program frees is its own when it asks again. Without the harness of tests, which would run this in a thread
//! other than the first, where the allocator may keep a heap of its own.

use supel::heap;

#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn main() {
    const BYTES: usize = 256 << 20;
    heap::keep_large_blocks();
    let [first, second] = [(); 2].map(|()| {
        let before = minor_faults();
        std::hint::black_box(vec![1u8; BYTES]);
        minor_faults() - before
    });
    // The pages of the block are the kernel's work the first time, of whatever size it makes them. The second time they are there;
    // a tenth is for what else the process needs, where pages are large and few. An allocator that gives the block back
    // makes the two equal.
    assert!(first > 0, "the kernel counts no page");
    assert!(second * 10 <= first, "{second} pages asked for again, of {first}");
    println!("kept: {first} pages the first time, {second} the second");
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn main() {
    heap::keep_large_blocks();
    println!("skipped: the allocator of this system is left alone");
}

/// Pages that the kernel has given to this process without reading a disk.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn minor_faults() -> u64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("the kernel tells");
    // The name of the program, in brackets, may hold spaces; seven fields after it the count stands.
    let after = stat.rsplit_once(')').expect("a name in brackets").1;
    after.split_whitespace().nth(7).and_then(|count| count.parse().ok()).expect("a number")
}
