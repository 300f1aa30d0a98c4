//! Inquiry, logging, creation, initialization, end.

use std::ffi::c_char;
use std::path::PathBuf;

use fmi_export::lifecycle::{self, Resources, Wish};
use fmi_export::{CallError, Exported, Function, Instance, call};
use fmi_model::Experiment;
use fmi3_abi::{
    ClockUpdateCallback, FMI_VERSION, Fmi3Boolean, Fmi3Float64, Fmi3Instance, Fmi3InstanceEnvironment, Fmi3String,
    Fmi3ValueReference, IntermediateUpdateCallback, LockPreemptionCallback, LogMessageCallback, RawStatus,
    UnlockPreemptionCallback, truth,
};

use crate::error::Fmi3Error;
use crate::log::Sink;
use crate::order;
use crate::version::Fmi3;

pub fn get_version() -> *const c_char {
    FMI_VERSION.as_ptr()
}

pub unsafe fn set_debug_logging<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    logging_on: Fmi3Boolean,
    count: usize,
    categories: *const Fmi3String,
) -> RawStatus {
    let (function, on) = (&order::SET_DEBUG_LOGGING, truth(logging_on));
    // SAFETY: `categories` has `count` strings; see the module.
    unsafe { lifecycle::set_debug_logging::<Fmi3, M>(instance, function, on, count, categories) }
}

/// Answers null for a wrong token, an empty name, a faulty definition, or what there is not (an event mode, intermediate updates), and
/// says which to the logger if logging is on. Visibility is not used, steps never return early, and a resource path that is no folder of this machine is
/// taken as none.
#[allow(clippy::too_many_arguments, reason = "those of the standard")]
pub unsafe fn instantiate_co_simulation<M: Exported<Fmi3>>(
    name: Fmi3String,
    token: Fmi3String,
    resource_path: Fmi3String,
    _visible: Fmi3Boolean,
    logging_on: Fmi3Boolean,
    event_mode_used: Fmi3Boolean,
    _early_return_allowed: Fmi3Boolean,
    _required: *const Fmi3ValueReference,
    required_count: usize,
    environment: Fmi3InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
    _intermediate_update: Option<IntermediateUpdateCallback>,
) -> Fmi3Instance {
    let sink = Sink::new(log_message, environment);
    let wish = Wish {
        name,
        identifier: ("instantiationToken", token),
        logging_on: truth(logging_on),
    };
    let resources = || {
        if truth(event_mode_used) {
            return Err(Fmi3Error::NoEventMode.into());
        }
        if required_count > 0 {
            let count = required_count;
            return Err(Fmi3Error::NoIntermediateUpdate { count }.into());
        }
        // SAFETY: null or a string; see the module.
        Ok(unsafe { Resources::read("resourcePath", resource_path, |path| Some(PathBuf::from(path))) })
    };
    // SAFETY: `name` and `token` are strings; see the module.
    unsafe { lifecycle::create::<Fmi3, M>(&order::INSTANTIATE_CO_SIMULATION, &sink, wish, resources) }
}

/// Tells the logger, if logging is on, that there is only co-simulation.
unsafe fn refuse<M: Exported<Fmi3>>(
    function: &Function,
    name: Fmi3String,
    token: Fmi3String,
    logging_on: Fmi3Boolean,
    environment: Fmi3InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
) -> Fmi3Instance {
    let wish = Wish {
        name,
        identifier: ("instantiationToken", token),
        logging_on: truth(logging_on),
    };
    let sink = Sink::new(log_message, environment);
    let none = || Err(CallError::CoSimulationOnly);
    // SAFETY: `name` and `token` are strings; see the module.
    unsafe { lifecycle::create::<Fmi3, M>(function, &sink, wish, none) }
}

pub unsafe fn instantiate_model_exchange<M: Exported<Fmi3>>(
    name: Fmi3String,
    token: Fmi3String,
    _resource_path: Fmi3String,
    _visible: Fmi3Boolean,
    logging_on: Fmi3Boolean,
    environment: Fmi3InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
) -> Fmi3Instance {
    let function = &order::INSTANTIATE_MODEL_EXCHANGE;
    // SAFETY: see the module.
    unsafe { refuse::<M>(function, name, token, logging_on, environment, log_message) }
}

#[allow(clippy::too_many_arguments, reason = "those of the standard")]
pub unsafe fn instantiate_scheduled_execution<M: Exported<Fmi3>>(
    name: Fmi3String,
    token: Fmi3String,
    _resource_path: Fmi3String,
    _visible: Fmi3Boolean,
    logging_on: Fmi3Boolean,
    environment: Fmi3InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
    _clock_update: Option<ClockUpdateCallback>,
    _lock_preemption: Option<LockPreemptionCallback>,
    _unlock_preemption: Option<UnlockPreemptionCallback>,
) -> Fmi3Instance {
    let function = &order::INSTANTIATE_SCHEDULED_EXECUTION;
    // SAFETY: see the module.
    unsafe { refuse::<M>(function, name, token, logging_on, environment, log_message) }
}

/// Frees the instance in whatever phase it is. Null is fine.
pub unsafe fn free_instance<M: Exported<Fmi3>>(instance: Fmi3Instance) {
    // SAFETY: see the module.
    unsafe { lifecycle::free_instance::<Fmi3, M>(instance, &order::FREE_INSTANCE) }
}

pub unsafe fn enter_initialization_mode<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    tolerance_defined: Fmi3Boolean,
    tolerance: Fmi3Float64,
    start_time: Fmi3Float64,
    stop_time_defined: Fmi3Boolean,
    stop_time: Fmi3Float64,
) -> RawStatus {
    let experiment = Experiment {
        start_time,
        stop_time: truth(stop_time_defined).then_some(stop_time),
        tolerance: truth(tolerance_defined).then_some(tolerance),
    };
    // SAFETY: see the module.
    unsafe {
        call::<Fmi3, M>(instance, &order::ENTER_INITIALIZATION_MODE, |instance| {
            instance.setup_experiment(experiment)?;
            instance.enter_initialization_mode()
        })
    }
}

pub unsafe fn exit_initialization_mode<M: Exported<Fmi3>>(instance: Fmi3Instance) -> RawStatus {
    let function = &order::EXIT_INITIALIZATION_MODE;
    // SAFETY: see the module.
    unsafe { call::<Fmi3, M>(instance, function, Instance::exit_initialization_mode) }
}

pub unsafe fn terminate<M: Exported<Fmi3>>(instance: Fmi3Instance) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<Fmi3, M>(instance, &order::TERMINATE, Instance::terminate) }
}

pub unsafe fn reset<M: Exported<Fmi3>>(instance: Fmi3Instance) -> RawStatus {
    // SAFETY: see the module.
    unsafe { call::<Fmi3, M>(instance, &order::RESET, Instance::reset) }
}
