//! Files that are no FMU, or none for us: each is refused with an error that says what is wrong and where.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "helpers of tests fail by panic, too"
)]

mod common;

use common::{Workshop, tank_description};
use fmi2_import::{Fmu, ImportError, LIBRARY_SUFFIX, PLATFORM};

fn refusal(path: impl AsRef<std::path::Path>) -> ImportError {
    Fmu::open(path).expect_err("this file is no usable FMU")
}

/// Opens an FMU that consists of this description alone.
fn open_description(xml: &str) -> Result<Fmu, ImportError> {
    let shop = Workshop::new();
    Fmu::open(shop.zip("only.fmu", &[("modelDescription.xml", xml.as_bytes())]))
}

#[test]
fn a_missing_file_is_named() {
    let path = Workshop::new().path("nowhere.fmu");
    let error = refusal(&path);
    assert!(matches!(&error, ImportError::NotFound { path: p } if *p == path));
    assert!(error.to_string().contains("nowhere.fmu"), "{error}");
}

#[test]
fn a_folder_cannot_be_read() {
    let shop = Workshop::new();
    assert!(matches!(refusal(shop.path("")), ImportError::Read { .. }));
}

#[test]
fn a_corrupt_archive_is_refused() {
    let shop = Workshop::new();
    let path = shop.fmu("cut.fmu", &tank_description(""), b"library");
    let bytes = std::fs::read(&path).unwrap();

    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    assert!(
        matches!(refusal(&path), ImportError::NotAnArchive { .. }),
        "cut in half"
    );

    std::fs::write(&path, b"not a zip at all").unwrap();
    assert!(matches!(refusal(&path), ImportError::NotAnArchive { .. }), "plain text");

    // A byte inside the compressed description: the checksum tells.
    let mut flipped = bytes.clone();
    flipped[200] ^= 0x55;
    std::fs::write(&path, flipped).unwrap();
    assert!(
        matches!(refusal(&path), ImportError::NotAnArchive { .. }),
        "flipped byte"
    );
}

#[test]
fn an_entry_outside_the_archive_is_refused() {
    let shop = Workshop::new();
    let description = tank_description("");
    let good = ("modelDescription.xml", description.as_bytes());
    for name in ["../evil.txt", "resources/../../evil.txt"] {
        let error = refusal(shop.zip("slip.fmu", &[good, (name, b"x")]));
        assert!(
            matches!(&error, ImportError::UnsafeEntry { entry, .. } if entry == name),
            "{error}"
        );
    }
}

#[test]
fn a_symbolic_link_is_refused() {
    let shop = Workshop::new();
    let path = shop.path("link.fmu");
    let mut zip = zip::ZipWriter::new(std::fs::File::create(&path).unwrap());
    let options = zip::write::SimpleFileOptions::default();
    zip.add_symlink("resources/passwords", "/etc/passwd", options).unwrap();
    zip.finish().unwrap();
    assert!(matches!(
        refusal(path),
        ImportError::UnsafeEntry {
            reason: "is a symbolic link",
            ..
        }
    ));
}

#[test]
fn a_zip_without_description_is_no_fmu() {
    let shop = Workshop::new();
    // In a subfolder it does not count.
    let path = shop.zip("empty.fmu", &[("fmu/modelDescription.xml", b"<x/>")]);
    assert!(matches!(refusal(path), ImportError::NoModelDescription { .. }));
}

#[test]
fn malformed_xml_is_refused_with_its_place() {
    let broken = "<?xml version=\"1.0\"?>\n<fmiModelDescription fmiVersion=\"2.0\">\n  <A></B>\n</fmiModelDescription>";
    match open_description(broken).unwrap_err() {
        ImportError::MalformedXml { line, column, .. } => assert_eq!((line, column), (3, 6)),
        other => panic!("{other}"),
    }

    let cut = tank_description("");
    let cut = &cut[..cut.len() - 10];
    let last_line = cut.lines().count();
    assert!(matches!(open_description(cut).unwrap_err(), ImportError::MalformedXml { line, .. } if line == last_line));

    let latin1 = b"<fmiModelDescription fmiVersion=\"2.0\" modelName=\"\xe9\"/>";
    let shop = Workshop::new();
    let error = refusal(shop.zip("latin1.fmu", &[("modelDescription.xml", latin1)]));
    assert!(
        matches!(
            error,
            ImportError::MalformedXml {
                line: 1,
                column: 50,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn a_missing_attribute_is_named() {
    let error = open_description(&tank_description("").replace("guid=\"{tank-1}\"", "")).unwrap_err();
    assert!(matches!(error, ImportError::MalformedXml { .. }));
    assert!(error.to_string().contains("guid"), "{error}");
}

#[test]
fn other_versions_are_refused() {
    let three = r#"<fmiModelDescription fmiVersion="3.0" modelName="m" instantiationToken="t"><ModelVariables/></fmiModelDescription>"#;
    let error = open_description(three).unwrap_err();
    assert!(matches!(&error, ImportError::FmiVersion { found, .. } if found == "3.0"));
    assert!(error.to_string().contains("2.0"), "{error}");
}

#[test]
fn model_exchange_alone_is_refused() {
    let xml = tank_description("").replace("<CoSimulation", "<ModelExchange");
    assert!(matches!(
        open_description(&xml).unwrap_err(),
        ImportError::NotCoSimulation { .. }
    ));
}

#[test]
fn contradictions_in_a_description_are_named() {
    let tank = tank_description("");
    for (from, to, names) in [
        ("name=\"level\"", "name=\"inflow\"", "inflow"),
        (
            "<Boolean start=\"true\"/>",
            "<Enumeration declaredType=\"Lid\"/>",
            "Lid",
        ),
        ("<Boolean start=\"true\"/>", "", "open"),
        ("causality=\"output\"", "causality=\"outlet\"", "outlet"),
        ("variability=\"fixed\"", "variability=\"rigid\"", "rigid"),
        (
            "causality=\"output\"",
            "causality=\"output\" initial=\"later\"",
            "later",
        ),
        ("modelIdentifier=\"tank\"", "modelIdentifier=\"../tank\"", "../tank"),
    ] {
        let error = open_description(&tank.replace(from, to)).unwrap_err();
        assert!(matches!(error, ImportError::InvalidDescription { .. }), "{error}");
        assert!(error.to_string().contains(names), "{error}");
    }
}

#[test]
fn a_binary_for_another_platform_is_not_enough() {
    let shop = Workshop::new();
    let xml = tank_description("");
    let path = shop.zip(
        "other.fmu",
        &[
            ("modelDescription.xml", xml.as_bytes()),
            ("binaries/amiga68k/tank.module", b"x"),
            ("binaries/os2/tank.dll", b"x"),
        ],
    );
    // It can be inspected all the same.
    let fmu = Fmu::open(path).unwrap();
    assert_eq!(fmu.platforms(), ["amiga68k", "os2"]);
    let error = fmu.load().unwrap_err();
    assert!(matches!(&error, ImportError::NoBinary { present, .. } if present == fmu.platforms()));
    let text = error.to_string();
    assert!(text.contains(PLATFORM) && text.contains("amiga68k, os2"), "{text}");
}

#[test]
fn a_library_that_is_none_is_refused_in_the_loaders_words() {
    let shop = Workshop::new();
    let fmu = Fmu::open(shop.fmu("text.fmu", &tank_description(""), b"no machine code")).unwrap();
    let error = fmu.load().unwrap_err();
    assert!(
        matches!(&error, ImportError::Load { reason, .. } if !reason.is_empty()),
        "{error}"
    );
}

#[test]
fn a_description_that_unpacks_without_end_is_refused() {
    let shop = Workshop::new();
    let spaces = vec![b' '; (64 << 20) + 1];
    let path = shop.zip("bomb.fmu", &[("modelDescription.xml", &spaces)]);
    assert!(std::fs::metadata(&path).unwrap().len() < 1 << 20, "a small file");
    let error = refusal(path);
    assert!(
        matches!(
            error,
            ImportError::TooLarge {
                limit_bytes: 0x400_0000,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn an_archive_that_cannot_be_unpacked_says_where() {
    let shop = Workshop::new();
    let xml = tank_description("");
    let library = format!("binaries/{PLATFORM}/tank.{LIBRARY_SUFFIX}");
    // A file where a folder has to be.
    let entries: [(&str, &[u8]); 3] = [
        ("modelDescription.xml", xml.as_bytes()),
        (&library, b"x"),
        ("resources", b"a file"),
    ];
    let error = Fmu::open(shop.zip("clash.fmu", &entries)).unwrap().load().unwrap_err();
    assert!(
        matches!(&error, ImportError::Unpack { target, .. } if target.ends_with("resources")),
        "{error}"
    );
}

#[test]
fn names_with_colons_are_unpacked_where_the_system_has_such_files() {
    let shop = Workshop::new();
    let Some(library) = shop.compile(&[]) else { return };
    let library_entry = format!("binaries/{PLATFORM}/tank.{LIBRARY_SUFFIX}");
    let description = tank_description("");
    let path = shop.zip(
        "colons.fmu",
        &[
            ("modelDescription.xml", description.as_bytes()),
            (&library_entry, &library),
            ("resources/level.txt", b"0.5"),
            ("resources/2026-01-01T12:30:00.csv", b"1"),
            ("resources\\deep\\what?.txt", b"2"),
        ],
    );
    if cfg!(windows) {
        let error = refusal(path);
        assert!(error.to_string().contains("cannot be written"), "{error}");
        return;
    }
    let mut instance = Fmu::open(path).unwrap().instantiate("t1", false).unwrap();
    let resources = instance.get_string(&[1]).unwrap().remove(0);
    for (name, text) in [("2026-01-01T12:30:00.csv", "1"), ("deep/what?.txt", "2")] {
        let file = std::path::Path::new(&resources).join(name);
        assert_eq!(std::fs::read_to_string(file).unwrap(), text, "{name}");
    }
}

/// Built with a function of libm and without naming libm: found by the loader where this program has the library itself.
#[test]
#[cfg(target_os = "linux")]
fn a_library_that_was_forgotten_is_loaded_and_told() {
    let shop = Workshop::new();
    let linked = std::fs::read_to_string("/proc/self/maps").unwrap().contains("/libm");
    for (symbol, helper) in [("__gfortran_nowhere", None), ("cos", Some("libm.so.6"))] {
        let uses = format!("FORGETS={symbol}");
        let Some(library) = shop.compile(&[&uses]) else { return };
        let fmu = Fmu::open(shop.fmu("forgets.fmu", &tank_description(""), &library)).unwrap();
        match (fmu.instantiate("t1", false), helper) {
            (Err(error), None) => {
                let text = error.to_string();
                assert!(text.contains("cannot load") && text.contains(symbol), "{text}");
            }
            (Ok(instance), Some(helper)) => {
                let messages: Vec<String> = instance.messages().iter().map(ToString::to_string).collect();
                let told = format!(
                    "fmi2Warning [loader] binaries/{PLATFORM}/tank.so uses {symbol} without naming {helper}, which was loaded for it: \
                     link the FMU with that library"
                );
                assert_eq!(messages, if linked { vec![] } else { vec![told] });
            }
            (answer, _) => panic!("{symbol}: {answer:?}"),
        }
    }
}
