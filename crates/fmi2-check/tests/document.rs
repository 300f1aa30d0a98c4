//! `docs/check.md` is what the rules render; `UPDATE_EXPECT=1 cargo test -p fmi2-check` rewrites it.

use expect_test::expect_file;

#[test]
fn the_document_of_the_rules_is_the_committed_one() {
    expect_file!["../../../docs/check.md"].assert_eq(&fmi2_check::document());
}
