//! Callbacks: what is logged, and what need not be there.

use std::collections::BTreeSet;
use std::ptr;

use crate::binary::instance::{Bench, Ended, Instance, Manner};
use crate::binary::logger::Offered;
use crate::binary::run::Failed;
use crate::rules::binary as rules;

fn lived<'a>(bench: &'a Bench<'a>, manner: Manner<'_>) -> Result<Option<Instance<'a>>, Failed> {
    // To refuse is allowed.
    let Some(instance) = Instance::new(bench, "checked", manner) else {
        return Ok(None);
    };
    bench.initialize(&instance)?;
    bench.record(&instance, 0..bench.job.steps.min(2))?;
    Ok(Some(instance))
}

pub(super) fn logging(bench: &Bench<'_>) -> Result<(), Failed> {
    let manner = Manner {
        logging: true,
        ..bench.manner()
    };
    let Some(instance) = Instance::new(bench, "checked", manner) else {
        let what = "it returned NULL with loggingOn true";
        bench.journal.found(&rules::INSTANTIATE, "fmi2Instantiate", what);
        return Err(Failed);
    };
    if !bench.job.categories.is_empty()
        && let Ended::Refused(status) = instance.set_debug_logging(&bench.job.categories)
    {
        let what = format!("it returned {status} for the categories of LogCategories");
        bench.journal.found(&rules::CALL, "fmi2SetDebugLogging", what);
    }
    bench.initialize(&instance)?;
    bench.record(&instance, 0..bench.job.steps)?;
    bench.expect("fmi2Terminate", instance.terminate(), &instance)?;
    let messages = instance.sink.messages();
    let used: BTreeSet<&str> = messages.iter().map(|message| message.category.as_str()).collect();
    for category in used {
        if !bench.job.categories.iter().any(|known| known == category) {
            let what = format!("it logs under \"{category}\", which LogCategories has not");
            bench.journal.found(&rules::CATEGORY, "fmi2CallbackLogger", what);
        }
    }
    Ok(())
}

pub(super) fn logger_null(bench: &Bench<'_>) -> Result<(), Failed> {
    let manner = Manner {
        logging: true,
        offered: Offered {
            logger: false,
            memory: true,
        },
        ..bench.manner()
    };
    lived(bench, manner).map(drop)
}

pub(super) fn memory_null(bench: &Bench<'_>) -> Result<(), Failed> {
    let manner = Manner {
        offered: Offered {
            logger: true,
            memory: false,
        },
        ..bench.manner()
    };
    if lived(bench, manner)?.is_none() {
        let what = "it returned NULL without memory functions";
        bench.journal.found(&rules::MEMORY_NULL, "fmi2Instantiate", what);
    }
    Ok(())
}

pub(super) fn free_null(bench: &Bench<'_>) -> Result<(), Failed> {
    let free = bench.loaded.functions.free_instance.ok_or(Failed)?;
    bench.journal.calling("fmi2FreeInstance");
    // SAFETY: the standard says that NULL is ignored; what does not is found by dying.
    unsafe { free(ptr::null_mut()) };
    Ok(())
}
