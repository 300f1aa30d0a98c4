//! Steps, status queries, and derivatives, which this FMU does not have.

use std::ffi::c_int;

use fmi_export::{CallError, Exported, Function, Instance, Status, call, memory};
use fmi2_abi::{
    Fmi2Boolean, Fmi2Component, Fmi2Integer, Fmi2Real, Fmi2StatusKind, Fmi2String, Fmi2ValueReference, RawStatus,
    boolean,
};

use crate::error::Fmi2Error;
use crate::order;
use crate::version::Fmi2;

pub unsafe fn do_step<M: Exported<Fmi2>>(
    component: Fmi2Component,
    t: Fmi2Real,
    h: Fmi2Real,
    _no_state_set_before_t: Fmi2Boolean,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<Fmi2, M>(component, &order::DO_STEP, |instance| instance.do_step(t, h)) }
}

pub unsafe fn cancel_step<M: Exported<Fmi2>>(component: Fmi2Component) -> RawStatus {
    // SAFETY: see the module.
    unsafe { not_supported::<M>(component, &order::CANCEL_STEP, "no step is ever pending") }
}

/// Answers a status query from `value`.
unsafe fn status<M: Exported<Fmi2>, C>(
    component: Fmi2Component,
    function: &Function,
    kind: c_int,
    answer: *mut C,
    value: impl FnOnce(&Instance<Fmi2, M>, Fmi2StatusKind) -> Result<C, Fmi2Error>,
) -> RawStatus {
    // SAFETY: `answer` points to room for one value; see the module.
    unsafe {
        call::<Fmi2, M>(component, function, |instance| {
            let answer = memory::place("value", answer)?;
            let kind = Fmi2StatusKind::from_raw(kind).ok_or(Fmi2Error::UnknownStatusKind { raw: kind })?;
            answer.write(value(instance, kind)?);
            Ok(Status::Ok)
        })
    }
}

pub unsafe fn get_status<M: Exported<Fmi2>>(component: Fmi2Component, kind: c_int, value: *mut RawStatus) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        status::<M, _>(component, &order::GET_STATUS, kind, value, |_, kind| {
            Err(Fmi2Error::not_available(kind))
        })
    }
}

pub unsafe fn get_real_status<M: Exported<Fmi2>>(
    component: Fmi2Component,
    kind: c_int,
    value: *mut Fmi2Real,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        status::<M, _>(
            component,
            &order::GET_REAL_STATUS,
            kind,
            value,
            |instance, kind| match kind {
                Fmi2StatusKind::LastSuccessfulTime => Ok(instance.time()),
                other => Err(Fmi2Error::not_available(other)),
            },
        )
    }
}

pub unsafe fn get_integer_status<M: Exported<Fmi2>>(
    component: Fmi2Component,
    kind: c_int,
    value: *mut Fmi2Integer,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        status::<M, _>(component, &order::GET_INTEGER_STATUS, kind, value, |_, kind| {
            Err(Fmi2Error::not_available(kind))
        })
    }
}

pub unsafe fn get_boolean_status<M: Exported<Fmi2>>(
    component: Fmi2Component,
    kind: c_int,
    value: *mut Fmi2Boolean,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        status::<M, _>(
            component,
            &order::GET_BOOLEAN_STATUS,
            kind,
            value,
            |_, kind| match kind {
                // The slave never wants to stop.
                Fmi2StatusKind::Terminated => Ok(boolean(false)),
                other => Err(Fmi2Error::not_available(other)),
            },
        )
    }
}

pub unsafe fn get_string_status<M: Exported<Fmi2>>(
    component: Fmi2Component,
    kind: c_int,
    value: *mut Fmi2String,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        status::<M, _>(component, &order::GET_STRING_STATUS, kind, value, |_, kind| {
            Err(Fmi2Error::not_available(kind))
        })
    }
}

unsafe fn not_supported<M: Exported<Fmi2>>(
    component: Fmi2Component,
    function: &Function,
    why: &'static str,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<Fmi2, M>(component, function, |_| Err(CallError::NotSupported { why })) }
}

pub unsafe fn set_real_input_derivatives<M: Exported<Fmi2>>(
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

pub unsafe fn get_real_output_derivatives<M: Exported<Fmi2>>(
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
pub unsafe fn get_directional_derivative<M: Exported<Fmi2>>(
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
