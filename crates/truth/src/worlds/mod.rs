//! One file per world.

pub(crate) mod formation;
pub(crate) mod leo_venting;
pub(crate) mod nrho_venting;
