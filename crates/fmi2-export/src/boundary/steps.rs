//! Steps, status queries, and derivatives, which this FMU does not have.

use std::ffi::c_int;

use fmi2_abi::{
    Fmi2Boolean, Fmi2Component, Fmi2Integer, Fmi2Real, Fmi2Status, Fmi2StatusKind, Fmi2String, Fmi2ValueReference,
    RawStatus, boolean,
};

use super::call::call;
use super::memory;
use crate::error::CallError;
use crate::identity::Exported;
use crate::instance::{Instance, not_available};
use crate::order::{self, Function};

pub unsafe fn do_step<M: Exported>(
    component: Fmi2Component,
    t: Fmi2Real,
    h: Fmi2Real,
    _no_state_set_before_t: Fmi2Boolean,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<M>(component, &order::DO_STEP, |instance| instance.do_step(t, h)) }
}

pub unsafe fn cancel_step<M: Exported>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe { not_supported::<M>(component, &order::CANCEL_STEP, "no step is ever pending") }
}

/// Answers a status query from `value`.
unsafe fn status<M: Exported, C>(
    component: Fmi2Component,
    function: &Function,
    kind: c_int,
    answer: *mut C,
    value: impl FnOnce(&Instance<M>, Fmi2StatusKind) -> Result<C, CallError>,
) -> RawStatus {
    // SAFETY: `answer` points to room for one value; see the module.
    unsafe {
        call::<M>(component, function, |instance| {
            let answer = memory::place("value", answer)?;
            let kind = Fmi2StatusKind::from_raw(kind).ok_or(CallError::UnknownStatusKind { raw: kind })?;
            answer.write(value(instance, kind)?);
            Ok(Fmi2Status::Ok)
        })
    }
}

pub unsafe fn get_status<M: Exported>(component: Fmi2Component, kind: c_int, value: *mut RawStatus) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        status::<M, _>(component, &order::GET_STATUS, kind, value, |_, kind| {
            Err(not_available(kind))
        })
    }
}

pub unsafe fn get_real_status<M: Exported>(component: Fmi2Component, kind: c_int, value: *mut Fmi2Real) -> RawStatus {
    // SAFETY: see the module.
    unsafe { status::<M, _>(component, &order::GET_REAL_STATUS, kind, value, Instance::real_status) }
}

pub unsafe fn get_integer_status<M: Exported>(
    component: Fmi2Component,
    kind: c_int,
    value: *mut Fmi2Integer,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        status::<M, _>(component, &order::GET_INTEGER_STATUS, kind, value, |_, kind| {
            Err(not_available(kind))
        })
    }
}

pub unsafe fn get_boolean_status<M: Exported>(
    component: Fmi2Component,
    kind: c_int,
    value: *mut Fmi2Boolean,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        status::<M, _>(component, &order::GET_BOOLEAN_STATUS, kind, value, |instance, kind| {
            instance.boolean_status(kind).map(boolean)
        })
    }
}

pub unsafe fn get_string_status<M: Exported>(
    component: Fmi2Component,
    kind: c_int,
    value: *mut Fmi2String,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        status::<M, _>(component, &order::GET_STRING_STATUS, kind, value, |_, kind| {
            Err(not_available(kind))
        })
    }
}

unsafe fn not_supported<M: Exported>(component: Fmi2Component, function: &Function, why: &'static str) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<M>(component, function, |_| Err(CallError::NotSupported { why })) }
}

pub unsafe fn set_real_input_derivatives<M: Exported>(
    component: Fmi2Component,
    _references: *const Fmi2ValueReference,
    _count: usize,
    _orders: *const Fmi2Integer,
    _values: *const Fmi2Real,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        not_supported::<M>(
            component,
            &order::SET_REAL_INPUT_DERIVATIVES,
            "inputs are not interpolated (canInterpolateInputs = false)",
        )
    }
}

pub unsafe fn get_real_output_derivatives<M: Exported>(
    component: Fmi2Component,
    _references: *const Fmi2ValueReference,
    _count: usize,
    _orders: *const Fmi2Integer,
    _values: *mut Fmi2Real,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        not_supported::<M>(
            component,
            &order::GET_REAL_OUTPUT_DERIVATIVES,
            "outputs have no derivatives (maxOutputDerivativeOrder = 0)",
        )
    }
}

#[allow(clippy::too_many_arguments, reason = "the standard's seven and the instance")]
pub unsafe fn get_directional_derivative<M: Exported>(
    component: Fmi2Component,
    _unknowns: *const Fmi2ValueReference,
    _unknown_count: usize,
    _knowns: *const Fmi2ValueReference,
    _known_count: usize,
    _seed: *const Fmi2Real,
    _result: *mut Fmi2Real,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        not_supported::<M>(
            component,
            &order::GET_DIRECTIONAL_DERIVATIVE,
            "there are no partial derivatives (providesDirectionalDerivative = false)",
        )
    }
}
