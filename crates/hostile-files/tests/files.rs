//! Every kind of file through its readers: seeds, what fuzzing has found, and every truncation of each.
//!
//! Readers may refuse as they like; they must not panic, take more memory than a few times the file, write where they should not or
//! leave anything behind.

#![allow(clippy::print_stdout, reason = "counts, for whoever looks")]
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "what fails in a helper is a failed test"
)]
#![allow(unsafe_code, reason = "an allocator that counts")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use hostile_files::{KINDS, Kind};

/// Counts what is allocated.
struct Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

fn more(size: usize) {
    let now = NOW.fetch_add(size, Ordering::Relaxed) + size;
    MOST.fetch_max(now, Ordering::Relaxed);
}

// SAFETY: every call goes on to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        more(layout.size());
        // SAFETY: the caller vouches for the layout.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        more(layout.size());
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller vouches for pointer and layout.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What a reader may take beside a multiple of the file: tables that are made once, buffers, an archive's small bomb.
const BASE: usize = 48 << 20;
/// Bytes for each of the file.
const TIMES: usize = 200;

fn feed(kind: &Kind, name: &str, bytes: &[u8]) {
    let before = NOW.load(Ordering::Relaxed);
    MOST.store(before, Ordering::Relaxed);
    (kind.feed)(bytes);
    let most = MOST.load(Ordering::Relaxed).saturating_sub(before);
    let allowed = BASE + TIMES * bytes.len();
    assert!(
        most <= allowed,
        "{}/{name}: {most} bytes of memory for a file of {}",
        kind.name,
        bytes.len()
    );
}

/// Files of one kind: seeds, hand-written ones, and those that a reader has stumbled over.
fn files(kind: &Kind) -> Vec<(String, Vec<u8>)> {
    let mut all = (kind.seeds)();
    for folder in ["corpus", "regressions"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../fuzz")
            .join(folder)
            .join(kind.name);
        let mut entries: Vec<_> = std::fs::read_dir(&path)
            .into_iter()
            .flatten()
            .map(|e| e.unwrap().path())
            .collect();
        entries.sort();
        for file in entries {
            all.push((
                format!("{folder}/{}", file.file_name().unwrap().display()),
                std::fs::read(&file).unwrap(),
            ));
        }
    }
    all
}

/// All in one test: memory is counted for the whole process.
#[test]
fn every_file_and_every_truncation_of_it_is_read_or_refused() {
    for kind in KINDS {
        let (mut whole, mut cut) = (0, 0);
        for (name, bytes) in files(kind) {
            feed(kind, &name, &bytes);
            whole += 1;
            for length in truncations(bytes.len()) {
                feed(kind, &format!("{name} cut to {length} bytes"), &bytes[..length]);
                cut += 1;
            }
        }
        assert!(whole > 3, "{}: too few files to say anything", kind.name);
        println!("{}: {whole} files, {cut} truncations", kind.name);
    }
}

/// Every length of a small file; of a larger one those near both ends, and some hundred between.
fn truncations(length: usize) -> Vec<usize> {
    const EVERY: usize = 300;
    let step = (length / EVERY).max(1);
    let near = |n: &usize| length <= EVERY || *n < 60 || *n + 60 >= length;
    (0..length).filter(|n| near(n) || n.is_multiple_of(step)).collect()
}
