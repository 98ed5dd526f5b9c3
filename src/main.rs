//! The `modl` command.

fn main() -> std::process::ExitCode {
    modl::cli::main()
}
