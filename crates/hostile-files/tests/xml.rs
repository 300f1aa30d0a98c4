//! XML that grows, nests, lies about its encoding or makes readers search: refused or read, in time and memory by its length.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "what fails in a helper is a failed test"
)]

use std::path::Path;

use fmi2_import::ModelDescription;
use hostile_files::zips::deflated;

const HEAD: &str =
    "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"m\" guid=\"g\"><CoSimulation modelIdentifier=\"m\"/>";
const TAIL: &str = "</fmiModelDescription>";

fn import(bytes: &[u8]) -> Result<ModelDescription, String> {
    ModelDescription::parse(bytes, Path::new("given.fmu")).map_err(|error| error.to_string())
}

/// What the checker finds, as `rule: what`.
fn check(bytes: &[u8]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("given.fmu");
    std::fs::write(&path, deflated(&[("modelDescription.xml", bytes)])).unwrap();
    let found = fmi2_check::check(&path, None).unwrap();
    found.0.iter().map(|f| format!("{}: {}", f.rule.id, f.what)).collect()
}

fn structure(bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("given.ssp");
    std::fs::write(&path, deflated(&[("SystemStructure.ssd", bytes)])).unwrap();
    match ssp::Package::open(&path).and_then(|package| ssp::flatten(package.structure())) {
        Ok(flat) => format!("{} components", flat.components.len()),
        Err(error) => study::chain(&error),
    }
}

/// Whether all three readers refuse a document, each in its own words.
fn refused_by_all(what: &str, document: &[u8], says: [&str; 3]) {
    let imported = import(document).map(|d| d.model_name).unwrap_err();
    assert!(
        imported.starts_with("given.fmu: modelDescription.xml, line") && imported.contains(says[0]),
        "{what}: {imported}"
    );
    let found = check(document);
    assert!(found.iter().any(|f| f.contains(says[1])), "{what}: {found:?}");
    let told = structure(document);
    assert!(
        told.contains("SystemStructure.ssd:") && told.contains(says[2]),
        "{what}: {told}"
    );
}

#[test]
fn entities_are_not_expanded_nor_fetched() {
    let mut laughs = String::from("<?xml version=\"1.0\"?>\n<!DOCTYPE d [\n<!ENTITY l0 \"ha\">\n");
    for n in 1..=9 {
        laughs.push_str(&format!("<!ENTITY l{n} \"{}\">\n", format!("&l{};", n - 1).repeat(10)));
    }
    let laughs = format!("{laughs}]>\n");
    let file = "<?xml version=\"1.0\"?>\n<!DOCTYPE d [<!ENTITY l9 SYSTEM \"file:///etc/passwd\">]>\n";
    for (what, prologue) in [("laughs", laughs.as_str()), ("file", file)] {
        let document = format!("{prologue}<fmiModelDescription fmiVersion=\"2.0\" modelName=\"&l9;\" guid=\"g\"/>");
        refused_by_all(what, document.as_bytes(), ["l9", "l9", "l9"]);
        // Said and not used, or used where text means nothing, it does nothing.
        for text in ["", "&l9;"] {
            let document = format!(
                "{prologue}{HEAD}<ModelVariables/><VendorAnnotations><Tool name=\"t\">{text}</Tool></VendorAnnotations>{TAIL}"
            );
            assert_eq!(import(document.as_bytes()).unwrap().vendor_annotations[0].xml, text);
        }
    }
}

#[test]
fn nesting_has_an_end() {
    for (what, document) in [
        ("open", format!("{HEAD}\n{}", "<a>".repeat(1_000_000))),
        (
            "closed",
            format!("{HEAD}\n{}{}{TAIL}", "<a>".repeat(300), "</a>".repeat(300)),
        ),
        (
            "annotated",
            format!(
                "{HEAD}\n<VendorAnnotations><Tool name=\"t\">{}",
                "<a b=\"c\">".repeat(500_000)
            ),
        ),
    ] {
        refused_by_all(
            what,
            document.as_bytes(),
            ["more than 200 deep", "more than 200 deep", "more than 200"],
        );
    }
}

#[test]
fn attributes_may_be_many_and_long() {
    let long = "x".repeat(8 << 20);
    let variable = format!(
        "{HEAD}<ModelVariables><ScalarVariable name=\"{long}\" valueReference=\"1\"><Real/></ScalarVariable></ModelVariables>{TAIL}"
    );
    let description = import(variable.as_bytes()).unwrap();
    // No nearer name is looked for, which would take eight times the product of both lengths.
    let told = description.variable(&"y".repeat(8 << 20)).unwrap_err().to_string();
    assert!(!told.contains("did you mean"));
    let found = check(variable.as_bytes());
    assert!(
        found
            .iter()
            .any(|f| f.contains("name of ScalarVariable is longer than 4096 bytes")),
        "{found:?}"
    );
    let told = structure(format!("<a name=\"{long}\"/>").as_bytes());
    assert!(told.contains("longer than 1000 bytes"), "{told}");
    // Where it may be long it is read.
    let described = variable.replace("name=\"xxx", "name=\"v\" description=\"xxx");
    assert!(!check(described.as_bytes()).iter().any(|f| f.contains("longer")));

    let many: String = (0..500_000).map(|n| format!(" a{n}=\"\"")).collect();
    let document = format!("{HEAD}<ModelVariables/><VendorAnnotations{many}/>{TAIL}");
    assert_eq!(import(document.as_bytes()).unwrap().model_name, "m");
    assert!(check(document.as_bytes()).len() > 400_000);
    let names: String = (0..500_000).map(|n| format!(" xmlns:a{n}=\"b\"")).collect();
    let told = structure(format!("<a{names}/>").as_bytes());
    assert!(told.contains("SystemStructure.ssd:1:"), "{told}");
}

/// Documents that make a reader with a loop in a loop take hours.
#[test]
fn time_grows_with_the_document_and_no_faster() {
    let count = 50_000;
    let list = |each: &dyn Fn(usize) -> String| (0..count).map(each).collect::<String>();
    let unknown = list(&|n| format!("<Unknown index=\"{}\"/>", n + 1));
    let items = list(&|n| format!("<Item name=\"i{n}\" value=\"{n}\"/>"));
    let variables = list(&|n| {
        format!(
            "<ScalarVariable name=\"v{n}\" valueReference=\"7\" variability=\"discrete\"><Enumeration declaredType=\"E\" start=\"-1\"/></ScalarVariable>"
        )
    });
    let document = format!(
        "{HEAD}<TypeDefinitions><SimpleType name=\"E\"><Enumeration>{items}</Enumeration></SimpleType></TypeDefinitions>\
        <ModelVariables>{variables}</ModelVariables><ModelStructure><Outputs>{unknown}</Outputs></ModelStructure>{TAIL}"
    );
    assert_eq!(import(document.as_bytes()).unwrap().variables.len(), count);
    assert!(check(document.as_bytes()).len() > count);
    let states = list(&|n| {
        format!(
            "<ScalarVariable name=\"v{n}\" valueReference=\"{n}\"><Real reinit=\"true\" derivative=\"9\"/></ScalarVariable>"
        )
    });
    let document = format!("{HEAD}<ModelVariables>{states}</ModelVariables>{TAIL}");
    assert!(check(document.as_bytes()).len() > count);
}

const SSD: &str = "<d:SystemStructureDescription xmlns:d=\"http://ssp-standard.org/SSP1/SystemStructureDescription\" version=\"1.0\" name=\"s\">";

#[test]
fn a_system_structure_has_as_many_parts_as_can_be_held_against_each_other() {
    let component = |n: usize| format!("<d:Component name=\"c{n}\" source=\"a.fmu\"/>");
    let of = |count: usize| {
        let all: String = (0..count).map(component).collect();
        format!("{SSD}<d:System name=\"r\"><d:Elements>{all}</d:Elements></d:System></d:SystemStructureDescription>")
    };
    assert_eq!(structure(of(50_000).as_bytes()), "50000 components");
    let told = structure(of(200_000).as_bytes());
    assert!(
        told.contains("SystemStructure.ssd:1: the structure has more than 200000 elements"),
        "{told}"
    );
    // Names of systems go into those of what is inside.
    let name = "n".repeat(900);
    let (open, close): (String, String) = (
        format!("<d:System name=\"{name}\"><d:Elements>").repeat(5),
        "</d:Elements></d:System>".repeat(5),
    );
    let nested = format!(
        "{SSD}<d:System name=\"r\"><d:Elements>{open}{}{close}</d:Elements></d:System></d:SystemStructureDescription>",
        component(1)
    );
    let told = structure(nested.as_bytes());
    assert!(told.contains("longer than 2000 bytes"), "{told}");
}

#[test]
fn encodings_are_what_the_bytes_are_or_the_file_is_refused() {
    let declared = |encoding: &str, name: &[u8]| -> Vec<u8> {
        let head = format!(
            "<?xml version=\"1.0\" encoding=\"{encoding}\"?>\n<fmiModelDescription fmiVersion=\"2.0\" guid=\"g\" modelName=\""
        );
        let tail = "\"><CoSimulation modelIdentifier=\"m\"/><ModelVariables/></fmiModelDescription>";
        [head.as_bytes(), name, tail.as_bytes()].concat()
    };
    let utf16 = |text: &[u8]| -> Vec<u8> {
        let text = String::from_utf8(text.to_vec()).unwrap();
        text.encode_utf16().flat_map(u16::to_le_bytes).collect()
    };
    // Right, or as XML says.
    for (document, name) in [
        (declared("UTF-8", "\u{e4}".as_bytes()), "\u{e4}"),
        (declared("ISO-8859-1", b"\xe4"), "\u{e4}"),
        (declared("windows-1252", b"\x80"), "\u{20ac}"),
        (utf16(&declared("UTF-16", "\u{e4}".as_bytes())), "\u{e4}"),
        (declared("UTF-16", b"m"), "m"),
        (
            [b"\xef\xbb\xbf", &declared("ISO-8859-1", "\u{e4}".as_bytes())[..]].concat(),
            "\u{e4}",
        ),
    ] {
        assert_eq!(import(&document).unwrap().model_name, name);
        check(&document);
        structure(&document);
    }
    let surrogate = |document: Vec<u8>| [&document[..], &[0x00, 0xd8]].concat();
    for (what, document, says) in [
        (
            "Latin-1 as UTF-8",
            declared("UTF-8", b"\xe4"),
            "line 2, column 59: not UTF-8",
        ),
        (
            "Latin-1 as nothing",
            declared("UTF-8", b"\xe4")[38..].to_vec(),
            "not UTF-8",
        ),
        ("overlong", declared("UTF-8", b"\xc0\xaf"), "not UTF-8"),
        (
            "no encoding",
            declared("klingon", b"m"),
            "\"klingon\" is not known: save the file as UTF-8",
        ),
        ("UTF-7", declared("UTF-7", b"m"), "\"UTF-7\" is not known"),
        ("EBCDIC", declared("ibm037", b"m"), "\"ibm037\" is not known"),
        (
            "a stateful one",
            declared("iso-2022-kr", b"m"),
            "which the file declares",
        ),
        (
            "a lone surrogate",
            surrogate(utf16(&declared("UTF-16", b"m"))),
            "which the file declares",
        ),
        (
            "half a character",
            [&utf16(&declared("UTF-16", b"m"))[..], b"x"].concat(),
            "which the file declares",
        ),
        (
            "UTF-32",
            declared("UTF-32", b"m").iter().flat_map(|b| [*b, 0, 0, 0]).collect(),
            "UTF-32: save it as UTF-8",
        ),
        (
            "UTF-32 with its mark",
            vec![0xff, 0xfe, 0, 0, b'<', 0, 0, 0],
            "UTF-32: save it as UTF-8",
        ),
        (
            "UTF-32, the other way",
            vec![0, 0, 0xfe, 0xff, 0, 0, 0, b'<'],
            "UTF-32: save it as UTF-8",
        ),
        (
            "Shift_JIS cut off",
            declared("Shift_JIS", b"\x81\""),
            "modelDescription.xml, line",
        ),
    ] {
        let told = import(&document).map(|d| d.model_name).expect_err(what);
        assert!(told.contains("given.fmu") && told.contains(says), "{what}: {told}");
        check(&document);
        structure(&document);
    }
}
