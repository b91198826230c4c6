//! The crate without the standard library, for a processor without an operating system where the toolchain has that target.
//!
//! The other tests run without it by `cargo test -p supel-runtime --no-default-features --tests`.

use std::path::Path;
use std::process::Command;

/// Its `std` does not exist: a dependency that takes it cannot be compiled.
const BARE: &str = "x86_64-unknown-none";

#[test]
fn library_builds_without_std() {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let printed = Command::new(rustc).args(["--print", "sysroot"]).output().expect("rustc runs");
    let sysroot = String::from_utf8(printed.stdout).expect("a path");
    let bare = Path::new(sysroot.trim()).join("lib/rustlib").join(BARE).is_dir();
    let mut build = Command::new(env!("CARGO"));
    build.args(["build", "--offline", "--lib", "--no-default-features", "--manifest-path"]);
    build.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml"));
    if bare {
        build.args(["--target", BARE]);
    } else {
        println!("no target {BARE} in the toolchain: built for this system");
    }
    let built = build.output().expect("cargo runs");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
}
