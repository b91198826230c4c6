//! The program `supel`.

fn main() -> std::process::ExitCode {
    supel::cli::main(supel::reduce)
}
