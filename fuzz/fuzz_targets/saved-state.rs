#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| (hostile_files::kind("saved-state").feed)(bytes));
