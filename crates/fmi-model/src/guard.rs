//! The one guard between a model and a caller that knows no panics.

use std::any::Any;
use std::cell::Cell;
use std::io::{Write, stderr};
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;
use std::thread::panicking;

/// Runs `body`; a panic becomes its message, and nothing is printed.
///
/// Whatever `body` was changing when it panicked must not be used again: callers put the instance into the fatal phase or drop
/// it. Panics of other threads, those that `body` starts among them, go to the panic hook as ever; a program that sets a hook of its
/// own after the first call hears of those in `body`, too.
///
/// # Errors
/// The message of the panic.
pub fn guarded<T>(body: impl FnOnce() -> T) -> Result<T, String> {
    be_silent_when_guarded();
    let outer = WATCH.get();
    WATCH.set(Watch {
        guards: outer.guards + 1,
        ..outer
    });
    let done = catch_unwind(AssertUnwindSafe(body));
    if WATCH.get().withheld && !outer.withheld {
        let _ = WITHHELD.try_with(Cell::take);
    }
    WATCH.set(outer);
    done.map_err(panic_message)
}

/// How a thread stands to its guards.
#[derive(Clone, Copy)]
struct Watch {
    /// How many it is inside of.
    guards: u32,
    /// A panic was not printed, and none of them has caught it yet.
    withheld: bool,
}

thread_local! {
    static WATCH: Cell<Watch> = const { Cell::new(Watch { guards: 0, withheld: false }) };
    /// The panic that was not printed. Touched by panics only: every call reads [`WATCH`], which needs no destructor.
    static WITHHELD: Cell<Option<String>> = const { Cell::new(None) };
}

/// Puts a panic hook before the present one, once: it withholds a panic that a guard will catch. A second one before that has happened
/// mostly ends the process (a panic in a `drop`, or in a callback with a C interface), so both are printed then. A library with a C
/// interface has a standard library, and a hook, of its own: that of the host is never touched.
fn be_silent_when_guarded() {
    static ONCE: Once = Once::new();
    // Hooks cannot be set while the thread is unwinding.
    if ONCE.is_completed() || panicking() {
        return;
    }
    ONCE.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            let watch = WATCH.get();
            if watch.guards > 0 && !watch.withheld {
                // A thread that is about to end has no place for it any more, and the guard has the message anyway.
                let _ = WITHHELD.try_with(|withheld| withheld.set(Some(panic.to_string())));
                WATCH.set(Watch {
                    withheld: true,
                    ..watch
                });
                return;
            }
            if let Ok(Some(first)) = WITHHELD.try_with(Cell::take) {
                // Where stderr is closed there is nobody to tell.
                let _ = writeln!(stderr(), "{first}");
            }
            before(panic);
        }));
    });
}

fn panic_message(payload: Box<dyn Any + Send>) -> String {
    let text = match payload.downcast::<String>() {
        Ok(text) => *text,
        Err(payload) => match payload.downcast::<&'static str>() {
            Ok(text) => (*text).to_owned(),
            Err(payload) => {
                // dropping a payload of unknown type could panic in turn
                std::mem::forget(payload);
                "no message".to_owned()
            }
        },
    };
    format!("panic inside the model: {text}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_its_message() {
        assert_eq!(guarded(|| 7), Ok(7));
        let texts = [
            guarded(|| panic!("plain")),
            guarded(|| panic!("at {} s", 3)),
            guarded(|| std::panic::panic_any(5_u8)),
        ];
        let texts: Vec<String> = texts.map(Result::<(), _>::unwrap_err).into();
        assert_eq!(
            texts,
            [
                "panic inside the model: plain",
                "panic inside the model: at 3 s",
                "panic inside the model: no message"
            ]
        );
    }

    #[test]
    fn a_payload_that_panics_when_dropped_stays_inside() {
        struct Spiteful;
        impl Drop for Spiteful {
            fn drop(&mut self) {
                panic!("dropped");
            }
        }
        assert!(guarded(|| std::panic::panic_any(Spiteful)).is_err());
    }

    /// A panic inside the guard of another, and one that the body catches itself.
    #[test]
    fn guards_stand_inside_each_other() {
        let inner = guarded(|| {
            let inner = guarded(|| panic!("inner"));
            assert_eq!(WATCH.get().guards, 1);
            inner
        });
        assert_eq!(inner, Ok(Err::<(), _>("panic inside the model: inner".to_owned())));
        assert!(guarded(|| catch_unwind(|| panic!("caught")).is_err()).unwrap());
        let watch = WATCH.get();
        assert!(watch.guards == 0 && !watch.withheld && WITHHELD.take().is_none());
    }
}
