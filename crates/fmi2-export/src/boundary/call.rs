//! From an opaque pointer to a call on the instance behind it.

use fmi_model::guarded;
use fmi2_abi::{Fmi2Component, Fmi2Status, RawStatus};

use super::handle::Handle;
use crate::identity::Exported;
use crate::instance::{Answer, Instance};
use crate::order::Function;

/// Runs `body` on the instance behind `component`. Without a recognisable instance there is no logger to tell, and the answer is
/// `fmi2Error`.
///
/// # Safety
/// `component` is null or an instance; see the module above.
pub(super) unsafe fn call<M: Exported>(
    component: Fmi2Component,
    function: &Function,
    body: impl FnOnce(&mut Instance<M>) -> Answer,
) -> RawStatus {
    // SAFETY: `component` is null or an instance, as the caller vouches.
    let Ok(Some(handle)) = guarded(|| unsafe { Handle::<M>::recognise(component) }) else {
        return Fmi2Status::Error.raw();
    };
    match handle.claim(function) {
        Some(mut instance) => instance.run(function, body).raw(),
        None => Fmi2Status::Error.raw(),
    }
}
