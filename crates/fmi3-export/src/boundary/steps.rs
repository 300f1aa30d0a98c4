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
                ("eventHandlingNeeded", event_handling_needed),
                ("terminateSimulation", terminate_simulation),
                ("earlyReturn", early_return),
            ];
            let last = ("lastSuccessfulTime", last_successful_time);
            // A host may give one place for all that it does not read, so each is borrowed for a moment only.
            for (name, flag) in never {
                memory::place(name, flag)?;
            }
            memory::place(last.0, last.1)?;
            let answer = instance.do_step(t, h);
            for (name, flag) in never {
                memory::place(name, flag)?.write(boolean(false));
            }
            memory::place(last.0, last.1)?.write(instance.time());
            answer
        })
    }
}
