//! The root package owns the end-to-end tests under `tests/`; the code lives in the workspace members.
//! Start with the README, then `trade-harness/src/main.rs`.
