//! Compiles the one function that only C can define: a logger that takes any number of arguments. Without a C compiler the crate
//! is built all the same, and messages of FMUs show their conversions unformatted.

#![allow(clippy::print_stdout, reason = "the way to talk to cargo")]

fn main() {
    println!("cargo:rerun-if-changed=src/logger/format.c");
    println!("cargo:rustc-check-cfg=cfg(formatted_log)");
    let built = cc::Build::new()
        .file("src/logger/format.c")
        .cargo_warnings(false)
        .try_compile("fmi2_import_format");
    match built {
        Ok(()) => println!("cargo:rustc-cfg=formatted_log"),
        Err(error) => {
            let reason = error.to_string().replace('\n', " ");
            println!("cargo:warning=no C compiler ({reason}): arguments in the messages of FMUs will not be formatted");
        }
    }
}
