#![doc = include_str!("../README.md")]
//!
//! # Where to start
//!
//! With [`types`]; [`functions`] holds one pointer type for each function of the standard, [`symbols`] the names to look them up by,
//! [`callbacks`] what a host in Rust hands over. An integer that comes from
//! the other side of the boundary is never trusted to be an enum: it arrives as a [`RawStatus`] or [`c_int`](std::ffi::c_int)
//! and is read by `from_raw`.

pub mod callbacks;
pub mod functions;
pub mod symbols;
pub mod types;

pub use types::*;

/// What `fmi2GetVersion` answers.
pub const FMI_VERSION: &std::ffi::CStr = c"2.0";

/// What `fmi2GetTypesPlatform` answers for the types of this crate.
pub const TYPES_PLATFORM: &std::ffi::CStr = c"default";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_raw_values_of_the_c_headers() {
        for (raw, status) in [
            (0, Fmi2Status::Ok),
            (1, Fmi2Status::Warning),
            (2, Fmi2Status::Discard),
            (3, Fmi2Status::Error),
            (4, Fmi2Status::Fatal),
            (5, Fmi2Status::Pending),
        ] {
            assert_eq!(Fmi2Status::from_raw(raw), Some(status));
            assert_eq!(status.raw(), raw);
        }
        for (raw, kind) in [
            (0, Fmi2StatusKind::DoStepStatus),
            (1, Fmi2StatusKind::PendingStatus),
            (2, Fmi2StatusKind::LastSuccessfulTime),
            (3, Fmi2StatusKind::Terminated),
        ] {
            assert_eq!(Fmi2StatusKind::from_raw(raw), Some(kind));
            assert_eq!(kind.raw(), raw);
        }
        assert_eq!(Fmi2Type::from_raw(0), Some(Fmi2Type::ModelExchange));
        assert_eq!(Fmi2Type::from_raw(1), Some(Fmi2Type::CoSimulation));
    }

    #[test]
    fn truth_values_cross_as_in_c() {
        assert_eq!((boolean(false), boolean(true)), (FMI2_FALSE, FMI2_TRUE));
        assert_eq!([0, 1, 2, -1].map(truth), [false, true, true, true]);
    }

    #[test]
    fn any_other_raw_value_is_none() {
        for raw in [-1, 6, 7, i32::MIN, i32::MAX] {
            assert_eq!(Fmi2Status::from_raw(raw), None);
            assert_eq!(Fmi2StatusKind::from_raw(raw), None);
            assert_eq!(Fmi2Type::from_raw(raw), None);
        }
    }

    /// The C struct is five pointers in a row; a host of any language relies on that.
    #[test]
    fn val_callback_functions_have_the_c_layout() {
        let word = size_of::<usize>();
        assert_eq!(size_of::<Fmi2CallbackFunctions>(), 5 * word);
        assert_eq!(std::mem::offset_of!(Fmi2CallbackFunctions, logger), 0);
        assert_eq!(
            std::mem::offset_of!(Fmi2CallbackFunctions, component_environment),
            4 * word
        );
        assert_eq!(std::mem::offset_of!(Fmi2EventInfo, next_event_time), 24);
        assert_eq!(size_of::<Fmi2EventInfo>(), 32);
    }
}
