//! A step of a filter that has settled asks for no memory, where it keeps one model. Banks, MILTON at its updates and the conic solver
//! still do.
#![allow(unsafe_code, reason = "an allocator that counts")]
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod common;
mod formation;

use common::OwnWorld;
use filters::laws::FILTERS;
use filters::{Navigator, Settings};
use formation::{Formation, World};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

struct Counting;

thread_local! {
    static ASKED: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    // While a thread ends there is no place to count in.
    let _ = ASKED.try_with(|asked| asked.set(asked.get() + 1));
}

// SAFETY: every call goes on to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's contract is the system's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: likewise.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: likewise.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn a_settled_filter_of_one_model_asks_for_no_memory() {
    let mut table = Vec::new();
    for scenario in ["leo_venting", "formation"] {
        let navigation = interface::mission::embedded(scenario)
            .unwrap()
            .mission()
            .unwrap()
            .navigation();
        for (place, filter) in FILTERS.iter().enumerate() {
            if filter.no_meaning_in(&navigation).is_some() || filter.bound {
                continue;
            }
            let settings = Settings {
                filter: place,
                ..Settings::default()
            };
            let mut nav = Navigator::new(&navigation, &settings, 0.0).unwrap();
            let (mut world, start): (Box<dyn World>, _) = if scenario == "formation" {
                let (world, start) = Formation::new(3);
                (Box::new(world), start)
            } else {
                let (world, start) = OwnWorld::new(3, 1e-6);
                (Box::new(world), start)
            };
            let (mut steps, mut asking) = (0_u32, 0_u32);
            for k in 0..1500 {
                let sample = world.step();
                let before = ASKED.get();
                nav.process(&sample, &start).unwrap();
                if k >= 600 {
                    steps += 1;
                    asking += u32::from(ASKED.get() > before);
                }
            }
            table.push((scenario, filter.name, asking, steps));
        }
    }
    for (scenario, filter, asking, steps) in &table {
        println!("{scenario:12} {filter:14} {asking:4} of {steps} steps ask for memory");
    }
    let several = ["milton", "constrained_q", "change_point", "hybrid", "imm", "mmae"];
    for (scenario, filter, asking, _) in table {
        assert!(
            asking == 0 || several.contains(&filter),
            "{scenario}, {filter}: {asking}"
        );
    }
}
