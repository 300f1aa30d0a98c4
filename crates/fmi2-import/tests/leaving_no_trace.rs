//! An FMU that changes whatever a library can change for its process: after each call all of it is as before, and the numbers of
//! others are the same bits.

#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail by panic, too")]
#![allow(unsafe_code, reason = "asks the C library how things stand")]

mod common;

use std::ffi::{CStr, c_int};
use std::mem::MaybeUninit;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use common::{Workshop, tank_description};
use fmi2_import::{Fmu, Instance};

/// What the FMUs change belongs to the process: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How things stand.
#[derive(Debug, PartialEq)]
struct World {
    arithmetic: Vec<u64>,
    directory: PathBuf,
    locale: String,
    thread_locale: usize,
    handlers: Vec<usize>,
    blocked: bool,
}

/// Those that are watched in every step, and all that the FMU changes.
const FIRST: [c_int; 4] = [libc::SIGINT, libc::SIGTERM, libc::SIGSEGV, libc::SIGFPE];
const ALL: [c_int; 6] = [
    libc::SIGINT,
    libc::SIGTERM,
    libc::SIGSEGV,
    libc::SIGFPE,
    libc::SIGUSR2,
    libc::SIGCHLD,
];

#[cfg(target_arch = "x86_64")]
fn arithmetic() -> Vec<u64> {
    let (mut sse, mut x87) = (0_u32, 0_u16);
    // SAFETY: both write to the place given.
    unsafe {
        std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut sse);
        std::arch::asm!("fnstcw [{}]", in(reg) &raw mut x87);
    }
    // The flags that arithmetic of the test itself raises are not compared.
    vec![u64::from(sse & !0x3f), x87.into()]
}

#[cfg(not(target_arch = "x86_64"))]
fn arithmetic() -> Vec<u64> {
    Vec::new()
}

impl World {
    fn now(signals: &[c_int]) -> Self {
        let handler = |signal: &c_int| {
            let mut action = MaybeUninit::<libc::sigaction>::zeroed();
            // SAFETY: null changes nothing, and the answer has room.
            unsafe {
                assert_eq!(libc::sigaction(*signal, std::ptr::null(), action.as_mut_ptr()), 0);
                action.assume_init().sa_sigaction
            }
        };
        let mut mask = MaybeUninit::<libc::sigset_t>::zeroed();
        // SAFETY: null asks and changes nothing; the answers have room.
        let (locale, thread_locale, blocked) = unsafe {
            libc::pthread_sigmask(libc::SIG_BLOCK, std::ptr::null(), mask.as_mut_ptr());
            (
                CStr::from_ptr(libc::setlocale(libc::LC_ALL, std::ptr::null())),
                libc::uselocale(std::ptr::null_mut()) as usize,
                libc::sigismember(mask.as_ptr(), libc::SIGUSR1) == 1,
            )
        };
        Self {
            arithmetic: arithmetic(),
            directory: std::env::current_dir().unwrap(),
            locale: locale.to_str().unwrap().to_owned(),
            thread_locale,
            handlers: signals.iter().map(handler).collect(),
            blocked,
        }
    }
}

/// A meddler that does it at this place; `None` without a C compiler.
fn meddler(shop: &Workshop, place: &str) -> Option<Fmu> {
    let library = shop.compile_source("meddler.c", &[place])?;
    Some(Fmu::open(shop.fmu(&format!("{place}.fmu"), &tank_description(""), &library)).unwrap())
}

fn level(instance: &mut Instance) -> u64 {
    let mut level = [0.0];
    instance.get_real(&[1], &mut level).unwrap();
    level[0].to_bits()
}

#[test]
fn after_each_call_all_is_as_before() {
    let _alone = alone();
    let before = World::now(&ALL);
    for place in ["AT_LOAD", "AT_LIFE", "AT_STEP=0", "AT_GET"] {
        let shop = Workshop::new();
        let Some(fmu) = meddler(&shop, place) else { return };
        fmu.load().unwrap();
        assert_eq!(World::now(&ALL), before, "{place}: load");
        let mut instance = fmu.instantiate("m1", false).unwrap();
        assert_eq!(World::now(&ALL), before, "{place}: instantiate");
        instance.exit_initialization().unwrap();
        assert_eq!(World::now(&ALL), before, "{place}: exit initialization");
        let _ = instance.do_step(0.0, 1.0).unwrap();
        assert_eq!(World::now(&ALL), before, "{place}: step");
        level(&mut instance);
        assert_eq!(World::now(&ALL), before, "{place}: get");
        instance.terminate().unwrap();
        drop(instance);
        assert_eq!(World::now(&ALL), before, "{place}: free");
        drop(fmu);
        assert_eq!(World::now(&ALL), before, "{place}: unload");
    }
}

#[test]
fn a_late_step_is_watched_for_what_stops_a_program() {
    let _alone = alone();
    let shop = Workshop::new();
    let Some(fmu) = meddler(&shop, "AT_STEP=100") else {
        return;
    };
    let whole = World::now(&ALL);
    let mut instance = fmu.instantiate("m1", false).unwrap();
    instance.exit_initialization().unwrap();
    let before = World::now(&FIRST);
    for k in 0..110 {
        let _ = instance.do_step(f64::from(k), 1.0).unwrap();
        let now = World {
            // Not watched in later steps.
            blocked: before.blocked,
            ..World::now(&FIRST)
        };
        assert_eq!(now, before, "step {k}");
    }
    // The other handlers go with the library, the mask is this test's to put back.
    drop(instance);
    drop(fmu);
    // SAFETY: a mask of one signal, which nothing here sends.
    unsafe {
        let mut set = MaybeUninit::<libc::sigset_t>::zeroed();
        libc::sigemptyset(set.as_mut_ptr());
        libc::sigaddset(set.as_mut_ptr(), libc::SIGUSR1);
        libc::pthread_sigmask(libc::SIG_UNBLOCK, set.as_ptr(), std::ptr::null_mut());
    }
    assert_eq!(World::now(&ALL), whole);
}

#[test]
fn the_numbers_of_others_are_the_same_bits() {
    let _alone = alone();
    let shop = Workshop::new();
    let (Some(library), Some(meddler)) = (shop.compile(&[]), meddler(&shop, "AT_STEP=0")) else {
        return;
    };
    let fmu = Fmu::open(shop.fmu("tank.fmu", &tank_description(""), &library)).unwrap();
    let levels = |mut beside: Option<Instance>| -> Vec<u64> {
        let mut tank = fmu.instantiate("t1", false).unwrap();
        // Sums that are rounded in every step, and end among the denormal numbers.
        let mut inflow = 0.1;
        (0..2000)
            .map(|k| {
                tank.set_real(&[0], &[inflow]).unwrap();
                inflow *= 0.7 + f64::EPSILON;
                if let Some(beside) = &mut beside {
                    let _ = beside.do_step(f64::from(k), 1.0).unwrap();
                }
                let _ = tank.do_step(f64::from(k), 0.3).unwrap();
                level(&mut tank) ^ inflow.to_bits()
            })
            .collect()
    };
    let alone = levels(None);
    assert!(levels(Some(meddler.instantiate("m1", false).unwrap())) == alone);
}

#[test]
fn what_the_host_changes_between_calls_stays() {
    let _alone = alone();
    let shop = Workshop::new();
    let Some(fmu) = meddler(&shop, "AT_STEP=0") else { return };
    let mut instance = fmu.instantiate("m1", false).unwrap();
    let home = std::env::current_dir().unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let elsewhere = elsewhere.path().canonicalize().unwrap();
    for k in 0..8 {
        let here = if k % 2 == 0 { &elsewhere } else { &home };
        std::env::set_current_dir(here).unwrap();
        let handler = if k % 2 == 0 { libc::SIG_IGN } else { libc::SIG_DFL };
        // SAFETY: no code runs on the signal.
        unsafe { libc::signal(libc::SIGTERM, handler) };
        let _ = instance.do_step(f64::from(k), 1.0).unwrap();
        level(&mut instance);
        assert_eq!(std::env::current_dir().unwrap(), *here, "step {k}");
        assert_eq!(World::now(&[libc::SIGTERM]).handlers, [handler], "step {k}");
    }
}

/// A locale that is set anew has its name at another place each time, but for "C": each change of it is seen, and put back.
#[test]
fn a_named_locale_of_the_host_stays() {
    let _alone = alone();
    let set = |name: &CStr| {
        // SAFETY: a NUL-terminated name.
        let set = unsafe { libc::setlocale(libc::LC_ALL, name.as_ptr()) };
        assert!(!set.is_null(), "{name:?}");
        World::now(&[]).locale
    };
    for place in ["AT_GET", "AT_STEP=0"] {
        let shop = Workshop::new();
        let Some(library) = shop.compile_source("meddler.c", &[place, "LOCALE=\"C\""]) else {
            return;
        };
        let fmu = Fmu::open(shop.fmu("m.fmu", &tank_description(""), &library)).unwrap();
        let mut instance = fmu.instantiate("m1", false).unwrap();
        instance.exit_initialization().unwrap();
        let named = set(c"C.UTF-8");
        for k in 0..8 {
            let _ = instance.do_step(f64::from(k), 1.0).unwrap();
            assert_eq!(World::now(&[]).locale, named, "{place}: step {k}");
            level(&mut instance);
            assert_eq!(World::now(&[]).locale, named, "{place}: get {k}");
        }
        set(c"C");
    }
}

#[test]
fn threads_do_not_hand_on_what_an_fmu_changes() {
    let _alone = alone();
    let shop = Workshop::new();
    let Some(fmu) = meddler(&shop, "AT_STEP=0") else { return };
    let before = World::now(&ALL);
    std::thread::scope(|scope| {
        for name in ["m1", "m2", "m3", "m4"] {
            let fmu = &fmu;
            scope.spawn(move || {
                let mut instance = fmu.instantiate(name, false).unwrap();
                for k in 0..200 {
                    let _ = instance.do_step(f64::from(k), 1.0).unwrap();
                }
            });
        }
    });
    drop(fmu);
    assert_eq!(World::now(&ALL), before);
}
