//! Handlers of signals, and which of them the thread blocks.

use std::ffi::c_int;
use std::mem::MaybeUninit;

/// Those that a user stops a program with, and those of a program that is about to crash.
const FIRST: [c_int; 4] = [libc::SIGINT, libc::SIGTERM, libc::SIGSEGV, libc::SIGFPE];

/// The last signal with a meaning; those of real time have none.
const LAST: c_int = 31;

/// Handlers by signal.
#[derive(Clone)]
pub(super) struct Signals {
    handlers: Vec<(c_int, libc::sigaction)>,
}

impl std::fmt::Debug for Signals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let handlers = self
            .handlers
            .iter()
            .map(|(signal, action)| (signal, action.sa_sigaction));
        f.debug_map().entries(handlers).finish()
    }
}

impl Signals {
    /// The first four, or all of them.
    pub(super) fn now(all: bool) -> Self {
        let noted = |signal| handler(signal).map(|action| (signal, action));
        Self {
            handlers: watched(all).filter_map(noted).collect(),
        }
    }

    /// These, and those that are missing as they are now.
    pub(super) fn extended(&self, all: bool) -> Self {
        let known = |signal| self.handlers.iter().find(|(known, _)| *known == signal).copied();
        let noted = |signal| known(signal).or_else(|| handler(signal).map(|action| (signal, action)));
        Self {
            handlers: watched(all).filter_map(noted).collect(),
        }
    }

    pub(super) fn are_still(&self) -> bool {
        let mut handlers = self.handlers.iter();
        handlers.all(|(signal, before)| handler(*signal).is_some_and(|now| same(before, &now)))
    }

    pub(super) fn put_back(&self, all: bool) {
        let count = if all { self.handlers.len() } else { FIRST.len() };
        for (signal, before) in self.handlers.iter().take(count) {
            if handler(*signal).is_some_and(|now| !same(before, &now)) {
                // SAFETY: the action is what was in place for the signal before.
                unsafe { libc::sigaction(*signal, before, std::ptr::null_mut()) };
            }
        }
    }
}

impl Signals {
    /// After a library was unloaded: where a handler is code that is gone, back to the one of these.
    pub(super) fn replace_unloaded(&self) {
        for (signal, before) in &self.handlers {
            let gone = |action: &libc::sigaction| {
                !matches!(action.sa_sigaction, libc::SIG_DFL | libc::SIG_IGN)
                    && !same(before, action)
                    && !is_loaded(action.sa_sigaction)
            };
            if handler(*signal).is_some_and(|now| gone(&now)) {
                // SAFETY: the action was in place for the signal before the library was loaded.
                unsafe { libc::sigaction(*signal, before, std::ptr::null_mut()) };
            }
        }
    }
}

/// Whether an address belongs to the program or a library.
fn is_loaded(address: usize) -> bool {
    let mut about = MaybeUninit::<libc::Dl_info>::zeroed();
    // SAFETY: the address is looked up, not used, and the answer has room.
    unsafe { libc::dladdr(std::ptr::without_provenance(address), about.as_mut_ptr()) != 0 }
}

/// The signals to look at, the first four first.
fn watched(all: bool) -> impl Iterator<Item = c_int> {
    let others = (1..=LAST).filter(move |signal| all && !FIRST.contains(signal));
    FIRST.into_iter().chain(others)
}

/// How a signal is handled; nothing for one that cannot be asked for.
fn handler(signal: c_int) -> Option<libc::sigaction> {
    let mut action = MaybeUninit::<libc::sigaction>::zeroed();
    // SAFETY: null changes nothing, and the answer has room; it is whole if the function says so.
    unsafe { (libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) == 0).then(|| action.assume_init()) }
}

fn same(a: &libc::sigaction, b: &libc::sigaction) -> bool {
    (a.sa_sigaction, a.sa_flags) == (b.sa_sigaction, b.sa_flags)
}

/// The signals that the thread blocks.
#[derive(Clone, Copy)]
pub(super) struct Mask(libc::sigset_t);

impl Mask {
    pub(super) fn now() -> Self {
        let mut mask = MaybeUninit::<libc::sigset_t>::zeroed();
        // SAFETY: null changes nothing, and the answer has room; all zeros, which a failure would leave, is a mask, too.
        Self(unsafe {
            libc::pthread_sigmask(libc::SIG_SETMASK, std::ptr::null(), mask.as_mut_ptr());
            mask.assume_init()
        })
    }

    pub(super) fn put_back(&self) {
        // SAFETY: the mask was that of the thread before.
        unsafe { libc::pthread_sigmask(libc::SIG_SETMASK, &raw const self.0, std::ptr::null_mut()) };
    }
}
