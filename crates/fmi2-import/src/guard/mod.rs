//! What a foreign library may change for everybody in its thread or process, put back after each call into it.
//!
//! | what | of | after |
//! |---|---|---|
//! | rounding, treatment of denormal numbers, exception masks and flags | thread | every call |
//! | locale | thread and process | every call |
//! | working directory, handlers of the signals that stop or crash a program | process | every call but later gets and sets, and later steps of a library that imports nothing by which they, or the locale, are changed |
//! | handlers of all signals, signal mask | process, thread | every call but later gets, sets, steps and saved states |
//!
//! Arithmetic and locale cost some nanoseconds. A working directory is a system call of 0.4 us and a handler one of 0.2 us, each
//! before and after the call; so what is called all the time is watched whole for the first [`WHOLE`] calls of each function in
//! an instance's life, when libraries set themselves up, and less closely after that.
//!
//! When a library is unloaded, no signal is left to a handler that went with it.
//!
//! What belongs to the process is noted while no call into any library is under way, and what a call in one thread has changed
//! is put back at the end of any. A host that changes such things itself does so between its calls.
//!
//! A change of the process's locale shows by the place of its name, which the C library of GNU keeps for each; others have one
//! place for all, and there it is not noticed in time.
//!
//! On other systems than Unix only arithmetic and the working directory are put back, on other processors than x86-64 and AArch64
//! no arithmetic.
#![allow(
    unsafe_code,
    reason = "registers, signals, locale and folder of the process are read and put back by C functions"
)]

mod arithmetic;
mod directory;
#[cfg(unix)]
mod locale;
mod reach;
#[cfg(unix)]
mod signals;

use std::sync::{Arc, Mutex, PoisonError};

use arithmetic::Arithmetic;
use directory::Directory;
#[cfg(unix)]
use locale::{Locale, Place, ThreadLocale};
pub(crate) use reach::is_wide;
#[cfg(unix)]
use signals::{Mask, Signals};

/// How closely a call is watched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Watch {
    /// Arithmetic and locale.
    Values,
    /// Also the working directory and the signals that stop or crash a program.
    Steps,
    /// Also the other signals.
    Whole,
}

/// The first calls of a function that are watched whole.
const WHOLE: u8 = 3;

/// The first calls of each function that is called all the time, counted.
#[derive(Debug)]
pub(crate) struct FirstCalls {
    counts: Vec<(&'static str, u8)>,
    /// How closely later steps are watched.
    steps: Watch,
}

impl FirstCalls {
    /// * `wide`: whether the library can change folder and handlers, as [`is_wide`] says.
    pub(crate) fn new(wide: bool) -> Self {
        Self {
            counts: Vec::new(),
            steps: if wide { Watch::Steps } else { Watch::Values },
        }
    }

    /// How closely to watch the next call of `function`.
    pub(crate) fn watch(&mut self, function: &'static str) -> Watch {
        let later = match function {
            "fmi2DoStep" | "fmi2GetFMUstate" | "fmi2SetFMUstate" | "fmi2FreeFMUstate" => self.steps,
            _ if function.starts_with("fmi2Get") || function.starts_with("fmi2Set") => Watch::Values,
            _ => return Watch::Whole,
        };
        // Literals of one function share their address; if not, it is watched whole a few times more.
        let counted = |(name, _): &&mut (&'static str, u8)| std::ptr::eq(*name, function);
        match self.counts.iter_mut().find(counted) {
            Some((_, calls)) if *calls == WHOLE => return later,
            Some((_, calls)) => *calls += 1,
            None => self.counts.push((function, 1)),
        }
        Watch::Whole
    }
}

/// Runs `call`, which calls into a foreign library, and puts back what it changed.
pub(crate) fn around<T>(watch: Watch, call: impl FnOnce() -> T) -> T {
    let process = Shared::enter(watch);
    #[cfg(unix)]
    let mask = (watch == Watch::Whole).then(Mask::now);
    #[cfg(unix)]
    let (place, thread_locale) = (Place::now(), ThreadLocale::now());
    let arithmetic = Arithmetic::now();
    let answer = call();
    arithmetic.put_back();
    #[cfg(unix)]
    {
        thread_locale.put_back();
        if Place::now() != place {
            match &process {
                Some(process) => Shared::put_noted_locale_back(process),
                None => Shared::put_locale_back(place),
            }
        }
        mask.inspect(Mask::put_back);
    }
    if let Some(process) = process {
        process.put_back(watch);
        Shared::leave();
    }
    answer
}

/// The process before a library was loaded.
#[derive(Debug)]
pub(crate) struct BeforeLoading {
    #[cfg(unix)]
    signals: Signals,
}

impl BeforeLoading {
    pub(crate) fn now() -> Self {
        Self {
            #[cfg(unix)]
            signals: Signals::now(true),
        }
    }

    /// No signal is handled by code that went with the library: later steps may have installed what nobody has seen.
    pub(crate) fn after_unloading(&self) {
        #[cfg(unix)]
        self.signals.replace_unloaded();
    }
}

/// What belongs to the process.
#[derive(Debug, Clone)]
struct Process {
    watch: Watch,
    directory: Directory,
    #[cfg(unix)]
    locale: Locale,
    #[cfg(unix)]
    signals: Signals,
}

impl Process {
    fn now(watch: Watch) -> Self {
        Self {
            watch,
            directory: Directory::now(),
            #[cfg(unix)]
            locale: Locale::now(),
            #[cfg(unix)]
            signals: Signals::now(watch == Watch::Whole),
        }
    }

    /// The same, and what is missing for a closer watch as it is now.
    fn extended(&self, watch: Watch) -> Self {
        Self {
            watch,
            #[cfg(unix)]
            signals: self.signals.extended(watch == Watch::Whole),
            ..self.clone()
        }
    }

    fn is_still(&self, watch: Watch) -> bool {
        let still = self.watch == watch && self.directory.is_still();
        #[cfg(unix)]
        let still = still && self.locale.place() == Place::now() && self.signals.are_still();
        still
    }

    fn put_back(&self, watch: Watch) {
        self.directory.put_back();
        #[cfg(unix)]
        self.signals.put_back(watch == Watch::Whole);
        let _ = watch;
    }
}

/// Closely watched calls that are under way in all threads, and how the process was before the first of them.
#[derive(Debug)]
struct Shared {
    calls: usize,
    before: Option<Arc<Process>>,
}

static SHARED: Mutex<Shared> = Mutex::new(Shared { calls: 0, before: None });

impl Shared {
    /// Notes a call, and how the process was before it; nothing for a call that is not watched so closely.
    fn enter(watch: Watch) -> Option<Arc<Process>> {
        if watch == Watch::Values {
            return None;
        }
        // The lock is held for a moment, but by the first of several calls, which looks at the process.
        let mut shared = Self::lock();
        let before = match shared.before.take() {
            // Whatever differs now was changed by a call that is not over yet.
            Some(before) if shared.calls > 0 && before.watch >= watch => before,
            Some(before) if shared.calls > 0 => Arc::new(before.extended(watch)),
            Some(before) if before.is_still(watch) => before,
            _ => Arc::new(Process::now(watch)),
        };
        shared.calls += 1;
        shared.before = Some(Arc::clone(&before));
        Some(before)
    }

    fn leave() {
        Self::lock().calls -= 1;
    }

    /// After a call that is not watched closely and has changed the locale from the one at `place`: while others are under way it
    /// may be their change, and theirs to put back.
    #[cfg(unix)]
    fn put_locale_back(place: Place) {
        let mut shared = Self::lock();
        let known = shared.before.as_ref().filter(|before| before.locale.place() == place);
        if shared.calls == 0
            && let Some(before) = known
        {
            before.locale.put_back();
            shared.look_for_locale_again();
        }
    }

    /// After a call that is watched closely: puts back the locale as it was before.
    #[cfg(unix)]
    fn put_noted_locale_back(noted: &Process) {
        noted.locale.put_back();
        Self::lock().look_for_locale_again();
    }

    /// The locale was put back, and its name has another place: later changes of it are told by that.
    #[cfg(unix)]
    fn look_for_locale_again(&mut self) {
        if let Some(before) = &mut self.before {
            let locale = before.locale.put_back_at();
            *before = Arc::new(Process {
                locale,
                ..Process::clone(before)
            });
        }
    }

    fn lock() -> std::sync::MutexGuard<'static, Self> {
        // Each change is complete in itself, so a poisoned lock holds a usable value.
        SHARED.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
