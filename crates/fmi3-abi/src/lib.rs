#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! With [`types`]; [`functions`] holds one pointer type for each function of the standard. An integer that comes from
//! the other side of the boundary is never trusted to be an enum: it arrives as a [`RawStatus`] and is read by `from_raw`. A
//! truth value arrives as a byte and is read by [`truth`].

pub mod functions;
pub mod types;

pub use types::*;

/// What `fmi3GetVersion` answers.
pub const FMI_VERSION: &std::ffi::CStr = c"3.0";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_raw_values_of_the_c_headers() {
        for (raw, status) in [
            (0, Fmi3Status::Ok),
            (1, Fmi3Status::Warning),
            (2, Fmi3Status::Discard),
            (3, Fmi3Status::Error),
            (4, Fmi3Status::Fatal),
        ] {
            assert_eq!(Fmi3Status::from_raw(raw), Some(status));
            assert_eq!(status.raw(), raw);
        }
        for raw in [-1, 5, i32::MIN, i32::MAX] {
            assert_eq!(Fmi3Status::from_raw(raw), None);
        }
    }

    #[test]
    fn truth_values_cross_as_in_c() {
        assert_eq!((boolean(false), boolean(true)), (FMI3_FALSE, FMI3_TRUE));
        assert_eq!([0, 1, 2, 255].map(truth), [false, true, true, true]);
        // C's bool has one byte on every platform that FMUs are made for.
        assert_eq!(size_of::<Fmi3Boolean>(), size_of::<bool>());
    }
}
