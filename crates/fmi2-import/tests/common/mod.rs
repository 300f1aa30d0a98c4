//! Builds small `.fmu` files: zips with a description and, where a C compiler is present, a library.

#![allow(dead_code, reason = "each test file uses a part")]

use std::fs::File;
use std::io::Write;
use std::path::PathBuf;
use std::process::Command;

use fmi2_import::{LIBRARY_SUFFIX, PLATFORM};
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// A folder for one test, and the FMUs in it.
pub struct Workshop {
    folder: TempDir,
}

impl Workshop {
    pub fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Zips the entries to `<name>`.
    pub fn zip(&self, name: &str, entries: &[(&str, &[u8])]) -> PathBuf {
        let path = self.path(name);
        let mut zip = ZipWriter::new(File::create(&path).unwrap());
        for (entry, content) in entries {
            zip.start_file(*entry, SimpleFileOptions::default()).unwrap();
            zip.write_all(content).unwrap();
        }
        zip.finish().unwrap();
        path
    }

    /// Zips a description with a library for this platform.
    pub fn fmu(&self, name: &str, description: &str, library: &[u8]) -> PathBuf {
        let entry = format!("binaries/{PLATFORM}/tank.{LIBRARY_SUFFIX}");
        self.zip(
            name,
            &[
                ("modelDescription.xml", description.as_bytes()),
                (&entry, library),
                ("resources/level.txt", b"0.5"),
                ("sources/tank.c", b"never unpacked"),
            ],
        )
    }

    /// Compiles `tests/common/tank.c` with the given macros; `None` without a C compiler.
    pub fn compile(&self, defines: &[&str]) -> Option<Vec<u8>> {
        self.compile_source("tank.c", defines)
    }

    /// The same for another source beside it, which may include it.
    pub fn compile_source(&self, name: &str, defines: &[&str]) -> Option<Vec<u8>> {
        let output = self.path("tank.module");
        for (name, text) in [
            ("tank.c", include_str!("tank.c")),
            ("talker.c", include_str!("talker.c")),
            ("meddler.c", include_str!("meddler.c")),
        ] {
            std::fs::write(self.path(name), text).unwrap();
        }
        let source = self.path(name);
        let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
        let ran = Command::new(&compiler)
            .args(["-shared", "-fPIC", "-Wall", "-Werror", "-o"])
            .arg(&output)
            .args(defines.iter().map(|d| format!("-D{d}")))
            .arg(source)
            .output();
        match ran {
            Ok(done) => {
                assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
                Some(std::fs::read(output).unwrap())
            }
            Err(_) => {
                eprintln!("SKIPPED: no C compiler `{compiler}` (package gcc)");
                None
            }
        }
    }
}

/// Description of `tank.c`, with more attributes for the CoSimulation element.
pub fn tank_description(attributes: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="tank" guid="{{tank-1}}">
  <CoSimulation modelIdentifier="tank" {attributes}/>
  <ModelVariables>
    <ScalarVariable name="inflow" valueReference="0" causality="input"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="level" valueReference="1" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="answer" valueReference="0" causality="parameter" variability="fixed"><Integer start="0"/></ScalarVariable>
    <ScalarVariable name="steps" valueReference="1" causality="output" variability="discrete"><Integer/></ScalarVariable>
    <ScalarVariable name="open" valueReference="0" causality="input" variability="discrete"><Boolean start="true"/></ScalarVariable>
    <ScalarVariable name="trace" valueReference="0" causality="parameter" variability="fixed"><String start=""/></ScalarVariable>
    <ScalarVariable name="resources" valueReference="1" causality="output" variability="discrete"><String/></ScalarVariable>
  </ModelVariables>
  <ModelStructure/>
</fmiModelDescription>"#
    )
}
