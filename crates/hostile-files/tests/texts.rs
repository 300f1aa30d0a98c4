//! Missions, studies and files of names that nest, repeat or never end.

#![allow(clippy::unwrap_used, reason = "what fails in a helper is a failed test")]

use interface::Mission;
use interface::mission::embedded;
use study::{Plan, read_mappings};

/// What each reader says of a file; empty where it takes it.
fn told(bytes: &[u8]) -> [String; 3] {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("given.toml");
    std::fs::write(&path, bytes).unwrap();
    let text = |error: &dyn std::error::Error| study::chain(error);
    [
        Mission::read(&path).err().map(|e| text(&e)),
        Plan::read(&path).err().map(|e| text(&e)),
        read_mappings(&path).err().map(|e| text(&e)),
    ]
    .map(Option::unwrap_or_default)
}

#[test]
fn what_nests_without_end_or_is_no_text_is_refused_with_its_place() {
    let times = 100_000;
    for (what, bytes, says) in [
        (
            "arrays",
            ["a = ", &"[".repeat(times)].concat().into_bytes(),
            "given.toml:1:",
        ),
        (
            "inline tables",
            ["a = ", &"{a=".repeat(times)].concat().into_bytes(),
            "given.toml:1:",
        ),
        (
            "dotted keys",
            ["a", &".a".repeat(times), " = 1"].concat().into_bytes(),
            "given.toml:1:",
        ),
        (
            "headers",
            ["[a", &".a".repeat(times), "]"].concat().into_bytes(),
            "given.toml:1:",
        ),
        ("dates", "a = 99999-99-99".as_bytes().to_vec(), "given.toml:1:"),
        ("one key twice", "a = 1\na = 2\n".as_bytes().to_vec(), "given.toml:2:"),
        (
            "no end of a text",
            ["a = \"", &"x".repeat(times)].concat().into_bytes(),
            "given.toml:1:",
        ),
        ("Latin-1", b"# a\na = \"\xe4\"\n".to_vec(), "line 2 is not UTF-8"),
        ("UTF-16", b"\xff\xfea\0 \0=\0".to_vec(), "save it as UTF-8"),
        ("a NUL", b"a = \"\0\"".to_vec(), "given.toml:1:"),
        ("five million bytes", vec![b'\n'; 5_000_000], "more than 4194304 bytes"),
    ] {
        for text in told(&bytes) {
            assert!(
                text.contains("given.toml") && text.contains(says),
                "{what}: {}",
                &text[..text.len().min(300)]
            );
            assert!(text.len() < 2000, "{what}: a message of {} bytes", text.len());
        }
    }
}

/// Files of as many bytes as are read, made to be searched through again and again.
#[test]
fn long_files_take_no_longer_than_their_length_asks_for() {
    let mission = embedded("leo_venting").unwrap().text;
    let burn = |n: usize| {
        format!(
            "[[burn]]\nname = \"b{n}\"\nstart_s = 1.0\nduration_s = 1.0\nacceleration_m_s2 = 1.0\ndirection = [0, 0, 0]\n"
        )
    };
    let burns: String = (0..30_000).map(burn).collect();
    let [said, ..] = told(format!("{mission}\n{burns}").as_bytes());
    assert!(
        said.contains("given.toml:") && said.len() < 100_000,
        "{} bytes",
        said.len()
    );
    let vent = |n: usize| format!("[[vent]]\nname = \"v{n}\"\nafter = \"v{}\"\n", n + 1);
    let vents: String = (0..50_000).map(vent).collect();
    assert!(!told(format!("{mission}\n{vents}").as_bytes())[0].is_empty());

    // A name that nobody has mistyped.
    let key = "k".repeat(4_000_000);
    let [mission, study, _] = told(format!("{key} = 1\n").as_bytes());
    for text in [mission, study] {
        assert!(
            text.contains("unknown key `kkk") && text.len() < 3000,
            "{}",
            &text[..300]
        );
    }
    let lines: String = (0..150_000).map(|n| format!("\"x{n}\" = \"est.r_tc_n\"\n")).collect();
    assert_eq!(told(format!("[a]\n{lines}").as_bytes())[2], "");
    let values: Vec<String> = (0..400_000).map(|n| n.to_string()).collect();
    let grid = format!("[[grid]]\nset = {{ \"m.a\" = [{}] }}\n", values.join(","));
    let plan = Plan::parse("given.toml", &grid).unwrap();
    let refused = plan.check().unwrap_err().to_string();
    assert!(refused.contains("400000 cases"), "{refused}");
}
