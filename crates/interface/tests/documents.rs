//! The documents in `docs/` are what the code renders; `UPDATE_EXPECT=1 cargo test -p interface` rewrites them.

use expect_test::expect_file;
use interface::render::{interface_document, mission_document};

#[test]
fn interface_document_is_the_committed_one() {
    expect_file!["../../../docs/INTERFACE.md"].assert_eq(&interface_document());
}

#[test]
fn mission_document_is_the_committed_one() {
    expect_file!["../../../docs/MISSION.md"].assert_eq(&mission_document());
}
