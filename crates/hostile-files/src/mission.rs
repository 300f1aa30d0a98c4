//! Mission files.

use interface::Mission;
use interface::mission::{Document, EMBEDDED};

use crate::cage::cage;
use crate::{Kind, told};

pub(crate) const KIND: Kind = Kind {
    name: "mission",
    feed,
    seeds,
};

fn feed(bytes: &[u8]) {
    let cage = cage();
    let path = cage.put("given.toml", bytes);
    match Mission::read(&path) {
        Ok(mission) => {
            let _ = (mission.navigation(), mission.notes(), mission.files());
            let text = mission.to_toml().expect("a mission that was read can be written");
            let again = Mission::parse("again", &text).expect("what is written can be read");
            assert_eq!(again.name, mission.name);
        }
        Err(error) => told(&error, "given.toml"),
    }
    if let Ok(text) = std::str::from_utf8(bytes)
        && let Ok(mut document) = Document::parse("given.toml", text)
    {
        let _ = document.set("time.duration_s", "100");
        let _ = document.files();
    }
    cage.check(&[&path]);
}

fn seeds() -> Vec<(String, Vec<u8>)> {
    let seed = |entry: &interface::mission::Embedded| (entry.name.to_owned(), entry.text.as_bytes().to_vec());
    EMBEDDED.iter().map(seed).collect()
}
