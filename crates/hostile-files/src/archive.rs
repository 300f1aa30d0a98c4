//! FMUs as archives: opened, checked, unpacked. Nothing is loaded.

use crate::cage::cage;
use crate::zips::DESCRIPTION;
use crate::{Kind, told, zips};

pub(crate) const KIND: Kind = Kind {
    name: "archive",
    feed,
    seeds,
};

fn feed(bytes: &[u8]) {
    let cage = cage();
    let path = cage.put("given.fmu", bytes);
    match fmi2_import::Fmu::open(&path) {
        Ok(fmu) => match fmu.unpack() {
            Ok(folder) => cage.holds(folder.path()),
            Err(error) => told(&error, "given.fmu"),
        },
        Err(error) => told(&error, "given.fmu"),
    }
    if let Err(error) = fmi2_check::check(&path, None) {
        told(&error, "given.fmu");
    }
    cage.check(&[&path]);
}

fn seeds() -> Vec<(String, Vec<u8>)> {
    let description = ("modelDescription.xml", DESCRIPTION.as_bytes());
    let more: [(&str, &[u8]); 4] = [
        ("binaries/linux64/tank.so", b"\x7fELF\x02\x01\x01"),
        ("resources/level.txt", b"0.5 0.5 0.5 0.5 0.5 0.5 0.5"),
        ("documentation/index.html", b"<html></html>"),
        (
            "terminalsAndIcons/terminalsAndIcons.xml",
            b"<fmiTerminalsAndIcons fmiVersion=\"2.0\"/>",
        ),
    ];
    let whole = [&[description], &more[..]].concat();
    let mut seeds = vec![
        ("alone".to_owned(), zips::stored(&[description])),
        ("whole".to_owned(), zips::deflated(&whole)),
        ("stored".to_owned(), zips::stored(&whole)),
    ];
    seeds.extend(
        zips::hostile()
            .into_iter()
            .map(|(name, bytes)| (name.to_owned(), bytes)),
    );
    seeds
}
