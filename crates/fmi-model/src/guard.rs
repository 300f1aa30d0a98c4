//! The one guard between a model and a caller that knows no panics.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `body`; a panic becomes its message.
///
/// Whatever `body` was changing when it panicked must not be used again: callers put the instance into the fatal phase or drop
/// it.
///
/// # Errors
/// The message of the panic.
pub fn guarded<T>(body: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(body)).map_err(panic_message)
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
}
