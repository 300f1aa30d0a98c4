//! Gives the library its GUID, as `FMU_GUID`, before it is linked; `trade-harness pack` reads it from cargo's messages. The library gets our
//! elementary functions in place of the C library's.

fn main() -> std::io::Result<()> {
    elementary::linking::tell_cargo();
    build_identity::tell_cargo(env!("CARGO_MANIFEST_DIR").as_ref(), env!("CARGO_PKG_NAME"))
}
