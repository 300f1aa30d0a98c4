//! The functions of model exchange: there for hosts that resolve every symbol, and each answered with the reason why not.

use fmi_export::{CallError, Exported, Function, call};
use fmi2_abi::{Fmi2Boolean, Fmi2Component, Fmi2EventInfo, Fmi2Real, RawStatus};

use crate::order;
use crate::version::Fmi2;

unsafe fn refuse<M: Exported<Fmi2>>(component: Fmi2Component, function: &Function) -> RawStatus {
    // SAFETY: see the module above.
    unsafe { call::<Fmi2, M>(component, function, |_| Err(CallError::CoSimulationOnly)) }
}

macro_rules! refused {
    ($($name:ident($($argument:ty),*) as $function:ident;)*) => {
        $(
            pub unsafe fn $name<M: Exported<Fmi2>>(component: Fmi2Component, $(_: $argument),*) -> RawStatus {
                // SAFETY: see the module above; the other arguments are not looked at.
                unsafe { refuse::<M>(component, &order::$function) }
            }
        )*
    };
}

refused! {
    enter_event_mode() as ENTER_EVENT_MODE;
    new_discrete_states(*mut Fmi2EventInfo) as NEW_DISCRETE_STATES;
    enter_continuous_time_mode() as ENTER_CONTINUOUS_TIME_MODE;
    completed_integrator_step(Fmi2Boolean, *mut Fmi2Boolean, *mut Fmi2Boolean) as COMPLETED_INTEGRATOR_STEP;
    set_time(Fmi2Real) as SET_TIME;
    set_continuous_states(*const Fmi2Real, usize) as SET_CONTINUOUS_STATES;
    get_derivatives(*mut Fmi2Real, usize) as GET_DERIVATIVES;
    get_event_indicators(*mut Fmi2Real, usize) as GET_EVENT_INDICATORS;
    get_continuous_states(*mut Fmi2Real, usize) as GET_CONTINUOUS_STATES;
    get_nominals_of_continuous_states(*mut Fmi2Real, usize) as GET_NOMINALS_OF_CONTINUOUS_STATES;
}
