//! What belongs to the whole process, and no FMU may leave changed.

use std::path::PathBuf;

use crate::rule::Rule;
use crate::rules::binary as rules;

/// A look at it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Surroundings {
    folder: Option<PathBuf>,
    locale: String,
    arithmetic: u64,
    signals: Vec<(i32, usize)>,
}

impl Surroundings {
    pub(super) fn now() -> Self {
        Self {
            folder: std::env::current_dir().ok(),
            locale: locale(),
            arithmetic: arithmetic(),
            signals: signals(),
        }
    }

    /// What is another than it was.
    pub(super) fn changes(&self, now: &Self) -> Vec<(&'static Rule, String)> {
        let mut found: Vec<(&'static Rule, String)> = Vec::new();
        if self.folder != now.folder {
            let path = |f: &Option<PathBuf>| f.as_ref().map_or("nowhere".to_owned(), |f| f.display().to_string());
            found.push((
                &rules::FOLDER,
                format!("the working directory is now {}", path(&now.folder)),
            ));
        }
        if self.locale != now.locale {
            found.push((
                &rules::LOCALE,
                format!("the locale is now {}, it was {}", now.locale, self.locale),
            ));
        }
        if self.arithmetic != now.arithmetic {
            let what = format!(
                "the control word is now {:#x}, it was {:#x}",
                now.arithmetic, self.arithmetic
            );
            found.push((&rules::FLOATING_POINT, what));
        }
        for ((number, before), (_, after)) in self.signals.iter().zip(&now.signals) {
            if before != after {
                found.push((&rules::SIGNALS, format!("signal {number} has another handler")));
            }
        }
        found
    }
}

#[cfg(unix)]
fn locale() -> String {
    // SAFETY: asking changes nothing, and the answer is copied before anything else is called.
    unsafe {
        let answer = libc::setlocale(libc::LC_ALL, std::ptr::null());
        if answer.is_null() {
            String::new()
        } else {
            std::ffi::CStr::from_ptr(answer).to_string_lossy().into_owned()
        }
    }
}

#[cfg(not(unix))]
fn locale() -> String {
    String::new()
}

#[cfg(unix)]
fn signals() -> Vec<(i32, usize)> {
    let watched = [
        libc::SIGINT,
        libc::SIGTERM,
        libc::SIGSEGV,
        libc::SIGBUS,
        libc::SIGFPE,
        libc::SIGILL,
        libc::SIGABRT,
        libc::SIGPIPE,
        libc::SIGCHLD,
        libc::SIGALRM,
        libc::SIGHUP,
    ];
    let handler = |number| {
        // SAFETY: asking with a null pointer changes nothing; the struct is plain data that zeros are a value of.
        unsafe {
            let mut now: libc::sigaction = std::mem::zeroed();
            libc::sigaction(number, std::ptr::null(), &raw mut now);
            now.sa_sigaction
        }
    };
    watched.map(|number| (number, handler(number))).to_vec()
}

#[cfg(not(unix))]
fn signals() -> Vec<(i32, usize)> {
    Vec::new()
}

/// Rounding, masks and treatment of subnormal numbers, without the flags that every operation sets.
#[cfg(target_arch = "x86_64")]
fn arithmetic() -> u64 {
    let (mut vector, mut stack): (u32, u16) = (0, 0);
    // SAFETY: both instructions store a control register in the variable that is named, and do nothing else.
    unsafe {
        std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut vector, options(nostack, preserves_flags));
        std::arch::asm!("fnstcw [{}]", in(reg) &raw mut stack, options(nostack, preserves_flags));
    }
    u64::from(stack) << 32 | u64::from(vector & !0x3f)
}

#[cfg(target_arch = "aarch64")]
fn arithmetic() -> u64 {
    let control: u64;
    // SAFETY: reads a control register and does nothing else.
    unsafe { std::arch::asm!("mrs {}, fpcr", out(reg) control, options(nomem, nostack, preserves_flags)) };
    control
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn arithmetic() -> u64 {
    0
}
