//! Steps.

use fmi_export::{Exported, call, memory};
use fmi3_abi::{Fmi3Boolean, Fmi3Float64, Fmi3Instance, RawStatus, boolean};

use crate::order;
use crate::version::Fmi3;

/// No step ends early, asks for event handling or for an end; where it ended is told of a failed one, too.
#[allow(clippy::too_many_arguments, reason = "those of the standard")]
pub unsafe fn do_step<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    t: Fmi3Float64,
    h: Fmi3Float64,
    _no_state_set_before_t: Fmi3Boolean,
    event_handling_needed: *mut Fmi3Boolean,
    terminate_simulation: *mut Fmi3Boolean,
    early_return: *mut Fmi3Boolean,
    last_successful_time: *mut Fmi3Float64,
) -> RawStatus {
    // SAFETY: each pointer has room for one value; see the module.
    unsafe {
        call::<Fmi3, M>(instance, &order::DO_STEP, |instance| {
            let never = [
                memory::place("eventHandlingNeeded", event_handling_needed)?,
                memory::place("terminateSimulation", terminate_simulation)?,
                memory::place("earlyReturn", early_return)?,
            ];
            let last = memory::place("lastSuccessfulTime", last_successful_time)?;
            let answer = instance.do_step(t, h);
            for flag in never {
                flag.write(boolean(false));
            }
            last.write(instance.time());
            answer
        })
    }
}
