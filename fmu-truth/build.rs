//! Gives the library its GUID, as `FMU_GUID`, before it is linked; `trade-harness pack` reads it from cargo's messages.

fn main() -> std::io::Result<()> {
    build_identity::tell_cargo(env!("CARGO_MANIFEST_DIR").as_ref(), env!("CARGO_PKG_NAME"))
}
