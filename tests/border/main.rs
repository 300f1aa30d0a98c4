//! The C functions of both FMUs as no careful host would call them: a million resets, a hundred thousand lives and a million calls
//! in any order with any arguments. Memory stays flat, nothing panics, and an instance beside all that gives the same bits.
//!
//! `BORDER_PERCENT` sets how much of that is done: 2 where it is not set, 100 in `.ci/full`. `BORDER_SEED` chooses the calls.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]
#![allow(unsafe_code, reason = "calls the C functions")]

#[path = "../common/mod.rs"]
mod common;
mod hostile;
mod library;
mod memory;

use std::ffi::CString;
use std::ptr;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use fmi2_abi::{Fmi2Component, Fmi2Status};
use library::Library;
use memory::Memory;

static TRUTH: LazyLock<Library> = LazyLock::new(|| Library::load("fmu-truth"));
static NAV: LazyLock<Library> = LazyLock::new(|| Library::load("fmu-nav"));

/// Memory is counted for the whole process: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A number from the environment.
fn setting(name: &str, otherwise: f64) -> f64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().unwrap())
}

/// The part of `whole` that this run does.
fn share(whole: u64) -> u64 {
    (whole as f64 * setting("BORDER_PERCENT", 2.0) / 100.0) as u64
}

/// Most that memory may grow in all cycles after the first tenth, bytes: of the heap what the test itself may keep meanwhile, of
/// the pages what the allocator may find convenient. A byte in each of a million cycles is more than either.
const HEAP: i64 = 64 << 10;
const RESIDENT: i64 = 1 << 20;

/// Runs a cycle many times; memory does not grow after the first tenth of them.
fn stays_flat(what: &str, cycles: u64, mut cycle: impl FnMut(u64)) {
    let warm = cycles / 10;
    (0..warm).for_each(&mut cycle);
    let before = Memory::now();
    (warm..cycles).for_each(&mut cycle);
    let grown = Memory::now().since(&before);
    eprintln!(
        "{what}: {cycles} cycles, after the first {warm} the heap grew by {} bytes and resident memory by {}",
        grown.heap, grown.resident
    );
    assert!(grown.heap < HEAP && grown.resident < RESIDENT, "{what}: {grown:?}");
}

fn check(status: i32) {
    assert_eq!(Fmi2Status::from_raw(status), Some(Fmi2Status::Ok));
}

impl Library {
    fn instance(&self) -> Fmi2Component {
        let resources = CString::new(self.resources.as_str()).unwrap();
        // SAFETY: all strings are NUL-terminated, and no callbacks are needed.
        let component = unsafe {
            let (guid, resources) = (self.guid.as_ptr(), resources.as_ptr());
            (self.c.instantiate)(c"i1".as_ptr(), 1, guid, resources, ptr::null(), 0, 0)
        };
        assert!(!component.is_null());
        component
    }

    fn initialise(&self, component: Fmi2Component) {
        // SAFETY: the component is alive.
        unsafe {
            check((self.c.setup_experiment)(component, 0, 0.0, 0.0, 0, 0.0));
            check((self.c.enter_initialization_mode)(component));
            check((self.c.exit_initialization_mode)(component));
        }
    }

    /// Takes some steps of 1 s and reads every Real after each.
    fn run(&self, component: Fmi2Component, from: u32, steps: u32) -> Vec<u64> {
        let references = &self.reals;
        let mut values = vec![0.0; references.len()];
        let mut bits = Vec::new();
        for k in from..from + steps {
            // SAFETY: the component is alive, and both arrays have the length that is passed.
            unsafe {
                check((self.c.do_step)(component, f64::from(k), 1.0, 1));
                let (n, room) = (references.len(), values.as_mut_ptr());
                check((self.c.get_real)(component, references.as_ptr(), n, room));
            }
            bits.extend(values.iter().map(|value| value.to_bits()));
        }
        bits
    }

    fn free(&self, component: Fmi2Component) {
        // SAFETY: the component is alive and not used again.
        unsafe { (self.c.free_instance)(component) };
    }
}

#[test]
fn a_million_resets_keep_memory_flat() {
    let _alone = alone();
    for library in [&*TRUTH, &*NAV] {
        let component = library.instance();
        stays_flat(&format!("resets of {}", library.name), share(1_000_000), |k| {
            // Now and then from the middle of a run.
            if k % 100 == 0 {
                library.initialise(component);
                library.run(component, 0, 2);
            }
            // SAFETY: the component is alive.
            check(unsafe { (library.c.reset)(component) });
        });
        library.free(component);
    }
}

#[test]
fn a_hundred_thousand_lives_keep_memory_flat() {
    let _alone = alone();
    for library in [&*TRUTH, &*NAV] {
        stays_flat(&format!("lives of {}", library.name), share(100_000), |k| {
            let component = library.instance();
            // One in ten is lived to the end, the others end where they are: as made, or in initialization.
            if k % 10 == 0 {
                library.initialise(component);
                library.run(component, 0, 1);
                // SAFETY: the component is alive.
                check(unsafe { (library.c.terminate)(component) });
            } else if k % 10 == 1 {
                // SAFETY: the component is alive.
                check(unsafe { (library.c.enter_initialization_mode)(component) });
            }
            library.free(component);
        });
    }
}

#[test]
fn a_million_hostile_calls_do_no_harm() {
    let _alone = alone();
    let calls = share(1_000_000);
    let seed = setting("BORDER_SEED", 1.0) as u64;
    let libraries = [&*TRUTH, &*NAV];
    let witnesses = libraries.map(|library| {
        let component = library.instance();
        library.initialise(component);
        component
    });
    const STEPS: u32 = 50;
    let mut seen = [Vec::new(), Vec::new()];
    let mut attack = hostile::Attack::new(libraries, seed);
    for k in 0..STEPS {
        attack.calls(calls / u64::from(STEPS));
        for ((library, component), seen) in libraries.iter().zip(witnesses).zip(&mut seen) {
            seen.extend(library.run(component, k, 1));
        }
    }
    eprintln!("hostile calls, seed {seed}: {}", attack.summary());
    attack.end();
    for ((library, component), seen) in libraries.iter().zip(witnesses).zip(seen) {
        let undisturbed = library.instance();
        library.initialise(undisturbed);
        assert!(library.run(undisturbed, 0, STEPS) == seen, "{}", library.name);
        library.free(undisturbed);
        library.free(component);
    }
}
