//! Models that a library other than the probe's might hold, through the functions that the export macro forwards to.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ffi::{CString, c_void};
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

fn instantiate<M: Exported<Fmi2>>(guid: &str, journal: &Journal) -> (*mut c_void, Vec<Message>) {
    let functions = callbacks(journal);
    let guid = CString::new(guid).unwrap();
    let (name, guid) = (c"other".as_ptr(), guid.as_ptr());
    // SAFETY: all pointers are to live Rust values.
    let component = unsafe { boundary::instantiate::<M>(name, 1, guid, ptr::null(), &functions, 0, 1) };
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
