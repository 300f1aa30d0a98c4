//! A shared library by its headers, without loading it: format, machine, exported names.

use std::collections::BTreeSet;

use object::read::macho::{FatArch, MachOFatFile32, MachOFatFile64};
use object::{Architecture, BinaryFormat, File, FileKind, Object};

use crate::finding::Findings;
use crate::functions::{CO_SIMULATION, MODEL_EXCHANGE};
use crate::rules::archive as rules;
use crate::xml::lexical::{boolean, unsigned};
use crate::xml::tree::Node;

/// What a folder under `binaries/` is for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Machine {
    format: BinaryFormat,
    machines: &'static [Architecture],
    suffixes: &'static [&'static str],
}

impl Machine {
    /// What the standard means by the name of a platform.
    pub(super) fn of_platform(name: &str) -> Option<Self> {
        use Architecture::{Aarch64, I386, X86_64};
        let (format, suffixes): (_, &[&str]) = match name.trim_end_matches(char::is_numeric) {
            "win" => (BinaryFormat::Pe, &["dll"]),
            "linux" => (BinaryFormat::Elf, &["so"]),
            "darwin" => (BinaryFormat::MachO, &["dylib"]),
            _ => return None,
        };
        let machines: &[Architecture] = match name.trim_start_matches(char::is_alphabetic) {
            "32" => &[I386],
            // Both kinds of Apple's machines, since the standard has one name for them.
            "64" if format == BinaryFormat::MachO => &[X86_64, Aarch64],
            "64" => &[X86_64],
            _ => return None,
        };
        Some(Self {
            format,
            machines,
            suffixes,
        })
    }

    pub(super) fn suffixes(self) -> &'static [&'static str] {
        self.suffixes
    }
}

/// Checks one library.
///
/// * `first`: it is looked at for the first time, so that its headers are told of once.
pub(super) fn check(
    bytes: &[u8],
    name: &str,
    machine: Option<Machine>,
    interface: &Node,
    first: bool,
    findings: &mut Findings,
) {
    let parts = match parts(bytes) {
        Ok(parts) => parts,
        Err(error) => {
            if first {
                findings.add(&rules::MACHINE, name, format!("it is no library: {error}"));
            }
            return;
        }
    };
    if let Some(machine) = machine.filter(|_| first) {
        for part in &parts {
            if part.format() != machine.format || !machine.machines.contains(&part.architecture()) {
                let what = format!("it is {:?} for {:?}", part.format(), part.architecture());
                findings.add(&rules::MACHINE, name, what);
            }
        }
    }
    for part in &parts {
        exports(part, name, interface, findings);
    }
}

/// Most libraries in a universal one: there are fewer machines.
const PARTS: usize = 16;

/// The library, or each of those that a universal one holds.
fn parts(bytes: &[u8]) -> object::Result<Vec<File<'_>>> {
    match FileKind::parse(bytes)? {
        FileKind::MachOFat32 => MachOFatFile32::parse(bytes)?
            .arches()
            .iter()
            .take(PARTS)
            .map(|arch| File::parse(arch.data(bytes)?))
            .collect(),
        FileKind::MachOFat64 => MachOFatFile64::parse(bytes)?
            .arches()
            .iter()
            .take(PARTS)
            .map(|arch| File::parse(arch.data(bytes)?))
            .collect(),
        _ => Ok(vec![File::parse(bytes)?]),
    }
}

fn exports(part: &File<'_>, name: &str, interface: &Node, findings: &mut Findings) {
    let Ok(exports) = part.exports() else {
        findings.add(&rules::MACHINE, name, "the list of its functions cannot be read");
        return;
    };
    // Apple's linker puts an underscore before every name of C.
    let apple = part.format() == BinaryFormat::MachO;
    let names: BTreeSet<Vec<u8>> = exports
        .filter_map(Result::ok)
        .filter_map(|export| {
            let name = export.name().name()?.to_vec();
            Some(
                name.strip_prefix(b"_")
                    .filter(|_| apple)
                    .map_or(name.clone(), <[u8]>::to_vec),
            )
        })
        .collect();
    let groups = if interface.name == "CoSimulation" {
        CO_SIMULATION
    } else {
        MODEL_EXCHANGE
    };
    for group in groups {
        let offered = group.flag.is_none_or(|flag| {
            let said = interface.get(flag).unwrap_or_default();
            boolean(said) == Some(true) || unsigned(said).is_some_and(|order| order > 0)
        });
        let rule = if offered {
            &rules::EXPORT
        } else {
            &rules::EXPORT_OPTIONAL
        };
        for function in group.names.iter().filter(|f| !names.contains(f.as_bytes())) {
            let what = match group.flag {
                Some(flag) if offered => format!("{name} does not export it, and {flag} offers it"),
                _ => format!("{name} does not export it"),
            };
            findings.add(rule, *function, what);
        }
    }
}
