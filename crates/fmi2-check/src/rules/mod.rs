//! Every rule, by group: what is demanded, where the standard says so, what to do.

pub mod archive;
pub mod binary;
pub mod description;
pub mod structure;
pub mod variable;
pub mod xml;

use crate::rule::Rule;

/// Every rule, group by group.
pub fn all() -> impl Iterator<Item = &'static Rule> {
    [
        archive::ALL,
        xml::ALL,
        description::ALL,
        variable::ALL,
        structure::ALL,
        binary::ALL,
    ]
    .into_iter()
    .flatten()
    .copied()
}

/// The rule of this id.
pub fn by_id(id: &str) -> Option<&'static Rule> {
    all().find(|rule| rule.id == id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_unique_and_every_rule_says_all() {
        let mut ids: Vec<&str> = all().map(|rule| rule.id).collect();
        ids.sort_unstable();
        let count = ids.len();
        ids.dedup();
        assert_eq!(ids.len(), count);
        for rule in all() {
            assert!(rule.section.starts_with(['2', '3', '4']), "{rule:?}");
            assert!(!rule.demands.is_empty() && !rule.advice.is_empty(), "{rule:?}");
            assert_eq!(by_id(rule.id), Some(rule));
        }
        assert_eq!(by_id("nothing"), None);
    }
}
