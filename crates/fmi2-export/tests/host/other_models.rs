//! Models that a library other than the probe's might hold, through the functions that the export macro forwards to.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ffi::{CString, c_void};
use std::path::Path;
use std::ptr;
use std::sync::OnceLock;

use fmi2_export::abi::Fmi2Status;
use fmi2_export::{
    DefinitionError, Experiment, Exported, Fmi2, GoldenError, GuidCell, Log, Model, ModelError, ModelInfo, Table,
    TableBuilder, boundary, golden_check, guid, render,
};
use serde::{Deserialize, Serialize};
use uuid::Uuid;

use crate::host::{Host, Journal, Message, callbacks};

/// A model of which `KIND` says what is wrong with it.
#[derive(Clone, Serialize, Deserialize)]
struct Other<const KIND: u8>(f64);

const SOUND: u8 = 0;
const WITHOUT_START: u8 = 1;
const PANICS_WHEN_MADE: u8 = 2;
const FORGETFUL: u8 = 3;
const BUILT: u8 = 4;
/// What it is packed with makes it another FMU: the text of `pack` in its resources.
const PACKED: u8 = 5;

/// What a build script gave the library of `BUILT`.
const BUILD: Uuid = Uuid::from_u128(0x7f1f_3d1c_0d7e_5f6a_9b1e_1c2d_3e4f_5a6b);

impl<const KIND: u8> Other<KIND> {
    fn new_table() -> Table<Self> {
        let mut t = TableBuilder::<Self>::new();
        match KIND {
            WITHOUT_START => t.real("x").parameter().rw(|m| m.0, |m, v| m.0 = v),
            FORGETFUL => t.real("x").input().start(1.0).rw(|m| m.0, |_, _| {}),
            _ => t.real("x").output().get(|m| m.0),
        }
        t.build()
    }
}

macro_rules! model {
    ($kind:ident) => {
        impl Exported<Fmi2> for Other<$kind> {
            fn guid_cell() -> &'static GuidCell {
                static CELL: GuidCell = GuidCell::new();
                &CELL
            }
        }

        impl Model for Other<$kind> {
            fn info() -> &'static ModelInfo {
                static INFO: OnceLock<ModelInfo> = OnceLock::new();
                INFO.get_or_init(|| ModelInfo {
                    model_name: stringify!($kind),
                    model_identifier: "other",
                    default_stop: 1.0,
                    default_step: 1.0,
                    guid: ($kind == BUILT).then_some(BUILD),
                    ..ModelInfo::default()
                })
            }

            fn table() -> &'static Table<Self> {
                static TABLE: OnceLock<Table<Other<$kind>>> = OnceLock::new();
                TABLE.get_or_init(Self::new_table)
            }

            fn blank() -> Self {
                assert!($kind != PANICS_WHEN_MADE, "out of clay");
                Self(0.0)
            }

            fn identifier_with(own: &str, resources: &Path) -> Option<String> {
                let pack = std::fs::read(resources.join("pack"))
                    .ok()
                    .filter(|_| $kind == PACKED)?;
                let own = Uuid::parse_str(own).unwrap();
                Some(format!("{{{}}}", Uuid::new_v5(&own, &pack)))
            }

            fn initialise(&mut self, _: &Experiment, _: &mut Log<'_>) -> Result<(), ModelError> {
                Ok(())
            }

            fn do_step(&mut self, _: f64, _: f64, _: &mut Log<'_>) -> Result<(), ModelError> {
                Ok(())
            }
        }
    };
}
model!(SOUND);
model!(WITHOUT_START);
model!(PANICS_WHEN_MADE);
model!(FORGETFUL);
model!(BUILT);
model!(PACKED);

fn instantiate<M: Exported<Fmi2>>(guid: &str, journal: &Journal) -> (*mut c_void, Vec<Message>) {
    instantiate_at::<M>(guid, None, journal)
}

fn instantiate_at<M: Exported<Fmi2>>(
    guid: &str,
    location: Option<&str>,
    journal: &Journal,
) -> (*mut c_void, Vec<Message>) {
    let location = location.map(|text| CString::new(text).unwrap());
    let location = location.as_ref().map_or(ptr::null(), |text| text.as_ptr());
    let functions = callbacks(journal);
    let guid = CString::new(guid).unwrap();
    let (name, guid) = (c"other".as_ptr(), guid.as_ptr());
    // SAFETY: all pointers are to live Rust values.
    let component = unsafe { boundary::instantiate::<M>(name, 1, guid, location, &functions, 0, 1) };
    let messages = journal.messages.lock().unwrap().clone();
    (component, messages)
}

#[test]
fn a_faulty_table_is_told_at_every_door() {
    let defect = DefinitionError::MissingStart { name: "x".to_owned() };
    assert_eq!(render::<Other<WITHOUT_START>>(), Err(defect.clone()));
    let golden = golden_check::<Other<WITHOUT_START>>("unused".as_ref());
    assert!(matches!(golden, Err(GoldenError::Definition(found)) if found == defect));
    let (component, messages) = instantiate::<Other<WITHOUT_START>>("{}", &Journal::default());
    assert!(component.is_null());
    assert_eq!(messages.len(), 1);
    assert!(messages[0].text.ends_with(&defect.to_string()));
}

#[test]
fn a_start_value_that_the_model_does_not_keep_fails_the_golden_check() {
    let golden = golden_check::<Other<FORGETFUL>>("unused".as_ref());
    assert!(matches!(
        golden,
        Err(GoldenError::Definition(DefinitionError::StartNotKept { .. }))
    ));
}

/// Whoever packs an FMU has the text of its description and the GUID of the build; a text of other variables must not start.
#[test]
fn a_library_with_a_guid_of_its_build_refuses_the_description_of_another_table() {
    let text = render::<Other<BUILT>>().unwrap();
    assert!(text.contains("guid=\"{made-by-the-build}\""), "{text}");
    let packed = |text: &str| Uuid::new_v5(&BUILD, text.as_bytes());
    assert_eq!(guid::<Other<BUILT>>().unwrap(), packed(&text));
    let starts = |guid: Uuid| {
        let (component, messages) = instantiate::<Other<BUILT>>(&format!("{{{guid}}}"), &Journal::default());
        if component.is_null() {
            assert!(
                messages[0].text.contains(&packed(&text).to_string()),
                "{}",
                messages[0].text
            );
            return false;
        }
        // SAFETY: the component is alive.
        unsafe { boundary::free_instance::<Other<BUILT>>(component) };
        true
    };
    assert!(starts(packed(&text)));
    assert!(!starts(packed(&text.replace("name=\"x\"", "name=\"y\""))));
    assert!(!starts(BUILD));
}

#[test]
fn a_panic_while_instantiating_is_told_and_stays_inside() {
    let own = format!("{{{}}}", guid::<Other<PANICS_WHEN_MADE>>().unwrap());
    let (component, messages) = instantiate::<Other<PANICS_WHEN_MADE>>(&own, &Journal::default());
    assert!(component.is_null());
    assert_eq!(messages.len(), 1);
    assert_eq!(messages[0].status, Fmi2Status::Fatal);
    assert_eq!(messages[0].text, "fmi2Instantiate: panic inside the model: out of clay");
}

/// Two FMUs in one process: a handle of one is not taken for one of the other.
#[test]
fn handles_of_another_fmu_are_recognised() {
    let error = Fmi2Status::Error.raw();
    let probe = Host::new();
    let mut state = ptr::null_mut();
    assert_eq!(probe.get_fmu_state(&mut state), Fmi2Status::Ok);
    let own = format!("{{{}}}", guid::<Other<SOUND>>().unwrap());
    let journal = Journal::default();
    let (other, messages) = instantiate::<Other<SOUND>>(&own, &journal);
    assert!(!other.is_null());
    assert_eq!(messages, []);
    // SAFETY: both components and the state are alive.
    unsafe {
        assert_eq!(boundary::reset::<Other<SOUND>>(probe.component), error);
        boundary::free_instance::<Other<SOUND>>(probe.component);
        assert_eq!(boundary::reset::<Other<SOUND>>(other), 0);
        assert_eq!(boundary::set_fmu_state::<Other<SOUND>>(other, state), error);
        boundary::free_instance::<Other<SOUND>>(other);
    }
    assert_eq!(probe.reset(), Fmi2Status::Ok);
    assert_eq!(probe.set_fmu_state(state), Fmi2Status::Ok);
    assert_eq!(probe.free_fmu_state(&mut state), Fmi2Status::Ok);
}

/// An FMU of the library of `PACKED` with this in it, and the identifier that its description has.
fn packed(text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("pack"), text).unwrap();
    let with = Uuid::new_v5(&guid::<Other<PACKED>>().unwrap(), text.as_bytes());
    (folder, format!("{{{with}}}"))
}

/// One library packed with two things is two FMUs, which do not take each other's states, neither in memory nor as bytes.
#[test]
fn what_an_fmu_is_packed_with_keeps_its_states_apart() {
    type M = Other<PACKED>;
    let error = Fmi2Status::Error.raw();
    let made = |text: &str| {
        let (folder, guid) = packed(text);
        let journal = Box::<Journal>::default();
        let (component, messages) = instantiate_at::<M>(&guid, folder.path().to_str(), &journal);
        assert!(!component.is_null(), "{messages:?}");
        (component, journal, guid)
    };
    let (a, _journal, guid_a) = made("a");
    let (a_too, _journal_too, _) = made("a");
    let (b, journal, guid_b) = made("b");
    let (mut state, mut read, mut size) = (ptr::null_mut(), ptr::null_mut(), 0);
    // SAFETY: components and states are alive, and the arrays are as long as is said.
    unsafe {
        assert_eq!(boundary::get_fmu_state::<M>(a, &mut state), 0);
        assert_eq!(boundary::serialized_fmu_state_size::<M>(a, state, &mut size), 0);
        let mut bytes = vec![0_u8; size];
        assert_eq!(
            boundary::serialize_fmu_state::<M>(a, state, bytes.as_mut_ptr().cast(), size),
            0
        );
        assert_eq!(boundary::set_fmu_state::<M>(a_too, state), 0);
        assert_eq!(
            boundary::de_serialize_fmu_state::<M>(a_too, bytes.as_ptr().cast(), size, &mut read),
            0
        );
        assert_eq!(boundary::set_fmu_state::<M>(a, read), 0);

        let answers = [
            boundary::set_fmu_state::<M>(b, state),
            boundary::serialized_fmu_state_size::<M>(b, state, &mut size),
            boundary::get_fmu_state::<M>(b, &mut state),
            boundary::free_fmu_state::<M>(b, &mut state),
            boundary::de_serialize_fmu_state::<M>(b, bytes.as_ptr().cast(), size, &mut read),
        ];
        assert_eq!(answers, [error; 5]);
        let messages = std::mem::take(&mut *journal.messages.lock().unwrap());
        for message in &messages[..4] {
            assert!(message.text.ends_with("no state of this FMU"), "{message:?}");
        }
        let of_other = format!("a state of the FMU with GUID '{guid_a}', this one has '{guid_b}'");
        assert!(messages[4].text.ends_with(&of_other), "{:?}", messages[4]);

        assert_eq!(boundary::free_fmu_state::<M>(a, &mut state), 0);
        assert_eq!(boundary::free_fmu_state::<M>(a_too, &mut read), 0);
        for component in [a, a_too, b] {
            boundary::free_instance::<M>(component);
        }
    }
}

/// A host that does not say where the resources are is told so, and not of versions alone.
#[test]
fn a_packed_fmu_whose_resources_are_not_found_says_so() {
    type M = Other<PACKED>;
    let (folder, own) = packed("a");
    let nowhere = folder.path().join("gone");
    let uri = format!("file://{}", nowhere.display());
    let needs = "is no folder here; an FMU packed with a mission needs it";
    for (location, part) in [
        (
            None,
            "fmuResourceLocation is null; an FMU packed with a mission needs it".to_owned(),
        ),
        (
            nowhere.to_str(),
            format!("fmuResourceLocation '{}' {needs}", nowhere.display()),
        ),
        (Some(&uri), format!("fmuResourceLocation '{uri}' {needs}")),
        (
            Some("file://server/share/resources"),
            format!("fmuResourceLocation 'file://server/share/resources' {needs}"),
        ),
    ] {
        let (component, messages) = instantiate_at::<M>(&own, location, &Journal::default());
        assert!(component.is_null());
        assert!(messages[0].text.contains(&part), "{:?}", messages[0]);
    }
    // Where the folder is there it is not to blame.
    let (component, messages) = instantiate_at::<M>("{x}", folder.path().to_str(), &Journal::default());
    assert!(component.is_null());
    let versions = format!("that of this FMU is '{own}': modelDescription.xml and library are of different versions");
    assert!(messages[0].text.ends_with(&versions), "{:?}", messages[0]);
    // Every form of URI that leads there is as good as the next.
    let path = folder.path().display();
    for location in [
        format!("{path}"),
        format!("file:{path}"),
        format!("file://{path}"),
        format!("file://localhost{path}"),
    ] {
        let (component, messages) = instantiate_at::<M>(&own, Some(&location), &Journal::default());
        assert!(!component.is_null(), "{messages:?}");
        // SAFETY: the component is alive, and not used again.
        unsafe { boundary::free_instance::<M>(component) };
    }
}
