//! A study as another process takes it up: a worker, or whoever merges its parts.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use study::{Models, NAV, OwnFmus, Plan, Shard, TRUTH};

use crate::HarnessError;

/// What a part keeps beside its journals: how to make the study again.
pub(super) const KEPT: &str = "plan.json";

/// Where the parts are, below the folder of the study.
pub(super) const SHARDS: &str = "shards";

/// A plan with the FMUs that it was made with.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Kept {
    plan: Plan,
    truth: Option<PathBuf>,
    nav: Option<PathBuf>,
}

impl Kept {
    /// With whole paths, so that it may be read from anywhere.
    pub(super) fn new(plan: &Plan, models: &Models) -> Result<Self, HarnessError> {
        let whole = |path: &Path| {
            std::path::absolute(path).map_err(|source| HarnessError::Read {
                path: path.to_owned(),
                source,
            })
        };
        let own = |name: &str| {
            let model = models.all().find(|model| model.name == name);
            model.map(|model| whole(model.fmu.path())).transpose()
        };
        Ok(Self {
            plan: plan.clone().with_whole_paths()?,
            truth: own(TRUTH)?,
            nav: own(NAV)?,
        })
    }

    /// The plan, and our FMUs.
    pub(super) fn parts(self) -> (Plan, OwnFmus) {
        let own = OwnFmus {
            truth: self.truth,
            nav: self.nav,
        };
        (self.plan, own)
    }
}

/// The folder of one part.
pub(super) fn shard_folder(out: &Path, shard: Shard) -> PathBuf {
    out.join(SHARDS).join(shard.to_string().replace('/', "-of-"))
}
