//! Creation: what is asked for, and what cannot be had.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ffi::{CStr, CString};
use std::ptr;

use fmi3_export::abi::{Fmi3Instance, Fmi3Status};

use crate::host::{Journal, journal, own_token};
use crate::probe::fmi3;

use Fmi3Status::Error;

/// What a host may ask of the three functions that make an instance.
#[derive(Clone, Copy)]
struct Wish<'a> {
    name: Option<&'a CStr>,
    token: Option<&'a CStr>,
    event_mode: u8,
    required: &'a [u32],
}

impl Wish<'_> {
    fn co_simulation(self, journal_of_host: &Journal) -> Fmi3Instance {
        let pointer = |text: Option<&CStr>| text.map_or(ptr::null(), CStr::as_ptr);
        let environment = ptr::from_ref(journal_of_host).cast_mut().cast();
        let (required, count) = (self.required.as_ptr(), self.required.len());
        // SAFETY: pointers are null or to live values.
        unsafe {
            fmi3::fmi3InstantiateCoSimulation(
                pointer(self.name),
                pointer(self.token),
                c"/no/such/folder/".as_ptr(),
                0,
                1,
                self.event_mode,
                1,
                required,
                count,
                environment,
                Some(journal),
                None,
            )
        }
    }

    /// What is logged when the answer must be null.
    #[track_caller]
    fn refusal(self) -> String {
        let journal = Journal::default();
        assert!(self.co_simulation(&journal).is_null());
        let messages = journal.messages.into_inner().unwrap();
        assert_eq!(messages.len(), 1);
        assert_eq!(messages[0].category, "logStatusError");
        messages[0].text.clone()
    }
}

#[test]
fn instantiate_says_why_not() {
    let own = CString::new(own_token()).unwrap();
    let good = Wish {
        name: Some(c"x"),
        token: Some(&own),
        event_mode: 0,
        required: &[],
    };
    let token = Some(c"{abc}");
    let wrong = Wish { token, ..good }.refusal();
    assert!(
        wrong.contains("instantiation token given is '{abc}'") && wrong.contains(&own_token()),
        "{wrong}"
    );
    let needs = "resourcePath '/no/such/folder/' is no folder here; an FMU packed with a mission needs it";
    assert!(wrong.contains(needs), "{wrong}");
    for (wish, part) in [
        (
            Wish {
                name: Some(c""),
                ..good
            },
            "name is empty",
        ),
        (Wish { name: None, ..good }, "instanceName is a null"),
        (Wish { token: None, ..good }, "instantiationToken is a null"),
        (
            Wish {
                name: Some(c"\xff"),
                ..good
            },
            "instanceName is not UTF-8",
        ),
        (Wish { event_mode: 1, ..good }, "hasEventMode = false"),
        (
            Wish {
                required: &[6, 7],
                ..good
            },
            "2 intermediate variables are required",
        ),
    ] {
        let reason = wish.refusal();
        assert!(reason.contains(part), "{reason}");
        assert!(reason.starts_with("fmi3InstantiateCoSimulation: "), "{reason}");
    }
    let instance = good.co_simulation(&Journal::default());
    assert!(!instance.is_null());
    // SAFETY: alive, and not used again.
    unsafe { fmi3::fmi3FreeInstance(instance) };
}

#[test]
fn the_other_interfaces_are_refused_with_the_reason() {
    let own = CString::new(own_token()).unwrap();
    let (name, token, none) = (c"x".as_ptr(), own.as_ptr(), ptr::null());
    let said = Journal::default();
    let environment = ptr::from_ref(&said).cast_mut().cast();
    // SAFETY: pointers are null or to live values.
    let instances = unsafe {
        [
            fmi3::fmi3InstantiateModelExchange(name, token, none, 0, 1, environment, Some(journal)),
            fmi3::fmi3InstantiateScheduledExecution(
                name,
                token,
                none,
                0,
                1,
                environment,
                Some(journal),
                None,
                None,
                None,
            ),
        ]
    };
    assert!(instances.iter().all(|instance| instance.is_null()));
    let messages = said.messages.into_inner().unwrap();
    let texts: Vec<_> = messages.iter().map(|message| message.text.as_str()).collect();
    assert_eq!(
        texts,
        [
            "fmi3InstantiateModelExchange: this FMU is co-simulation only",
            "fmi3InstantiateScheduledExecution: this FMU is co-simulation only",
        ]
    );
}

#[test]
fn without_a_logger_there_is_silence() {
    let own = CString::new(own_token()).unwrap();
    let (name, token, none) = (c"x".as_ptr(), own.as_ptr(), ptr::null());
    let nobody = ptr::null_mut();
    // SAFETY: pointers are null or to live values; the refused call has no one to tell.
    unsafe {
        let instance =
            fmi3::fmi3InstantiateCoSimulation(name, token, none, 0, 1, 0, 0, ptr::null(), 0, nobody, None, None);
        assert!(!instance.is_null());
        assert_eq!(fmi3::fmi3Terminate(instance), Error.raw());
        fmi3::fmi3FreeInstance(instance);
    }
}

#[test]
fn the_version_is_that_of_the_standard() {
    // SAFETY: a static string.
    assert_eq!(unsafe { CStr::from_ptr(fmi3::fmi3GetVersion()) }, c"3.0");
}
