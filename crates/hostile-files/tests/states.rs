//! Saved states that somebody has changed and sealed again: refused, or gone on from; an instance always comes back with an answer.

#![allow(clippy::print_stdout, reason = "counts, for whoever looks")]

use std::collections::BTreeMap;

use hostile_files::kind;
use hostile_files::saved_state::{Stepped, step};

/// Changes of each state: bytes that a good one never has, at places all over it.
const CHANGES: usize = 1000;
const BYTES: [u8; 6] = [0x00, 0x01, 0x7f, 0x80, 0xf0, 0xff];

#[test]
fn an_instance_comes_back_from_any_state_that_it_takes() {
    // Panics are caught as an FMU catches them, and their texts are many.
    std::panic::set_hook(Box::new(|_| ()));
    let mut counts: BTreeMap<Stepped, usize> = BTreeMap::new();
    for (name, state) in (kind("saved-state").seeds)() {
        if name.ends_with("-whole") {
            continue;
        }
        assert_ne!(step(&state), Stepped::Refused, "{name}");
        for change in 0..CHANGES {
            let mut changed = state.clone();
            // Eight bytes in a row make any number of one.
            let place = 1 + change * (state.len() - 1) / CHANGES;
            let end = (place + 1 + change % 8).min(state.len());
            changed[place..end].fill(BYTES[change % BYTES.len()]);
            *counts.entry(step(&changed)).or_default() += 1;
        }
    }
    let _ = std::panic::take_hook();
    println!("changed states: {counts:?}");
    assert!(counts.values().sum::<usize>() > 20_000);
    // What cannot be a state is told, and most of what can be is gone on from.
    assert!(counts[&Stepped::Well] > 100, "{counts:?}");
}
