//! What is written is what the programs that own the formats read. Skipped, with a message, where Python has no SciPy.

use std::process::Command;

use super::converted::{supel, text, unsymmetric};
use super::fixture;

#[test]
fn other_programs_read_the_same_bits() {
    let interpreter = std::env::var_os("SUPEL_PYTHON").unwrap_or_else(|| "python3".into());
    let probe = Command::new(&interpreter).args(["-c", "import numpy, scipy"]).output();
    if !probe.is_ok_and(|probe| probe.status.success()) {
        println!("skipped: {} has no numpy and scipy; set SUPEL_PYTHON", interpreter.display());
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for source in [fixture("k.mtx"), unsymmetric(folder.path())] {
        for (name, to) in [
            ("converted.mtx", "matrix-market"),
            ("converted.npz", "npz"),
            ("converted.op4", "op4"),
            ("binary.op4", "op4-binary"),
            ("converted.mat", "matlab"),
        ] {
            let output = folder.path().join(name);
            let ended = supel(&["convert", text(&source), text(&output), "--to", to]);
            assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
        }
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/matrices/oracle.py");
        let ended =
            Command::new(&interpreter).arg(script).args([folder.path(), &source]).env("PYTHONUTF8", "1").output();
        let ended = ended.expect("it ran");
        let said = String::from_utf8_lossy(&ended.stdout);
        assert!(ended.status.success(), "{said}{}", String::from_utf8_lossy(&ended.stderr));
        println!("{said}");
    }
}
