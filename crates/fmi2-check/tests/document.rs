//! `docs/check.md` is what the rules render, with the scores of the tests of defects; `UPDATE_EXPECT=1 cargo test -p fmi2-check`
//! rewrites it.

mod common;

#[test]
fn the_document_of_the_rules_is_the_committed_one() {
    common::documented(&fmi2_check::document());
}
