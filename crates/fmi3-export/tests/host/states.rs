//! Saved states, in memory and as bytes.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ptr;

use fmi3_export::abi::Fmi3Status;

use crate::host::{Host, vr};
use crate::probe::{GOOD, fmi3};

use Fmi3Status::{Error, Ok as Fine};

/// Every output after each of ten steps of uneven length, as bits.
fn run(host: &Host, from: f64) -> Vec<Vec<u64>> {
    let mut t = from;
    (0..10)
        .map(|k| {
            let h = 0.1 + 0.01 * f64::from(k);
            assert_eq!(host.set_float64(&[vr("u")], &[t.sin(), t.cos(), 1.0]), Fine);
            assert_eq!(host.do_step(t, h), Fine);
            t += h;
            let y = host.get_float64(&["y", "angle", "time"].map(vr), 5).unwrap();
            y.into_iter().map(f64::to_bits).collect()
        })
        .collect()
}

#[test]
fn a_state_brings_back_every_bit() {
    let host = Host::stepping(GOOD);
    assert_eq!(host.do_step(0.0, 0.3), Fine);
    let mut state = ptr::null_mut();
    assert_eq!(host.get_fmu_state(&mut state), Fine);
    let bytes = host.bytes().unwrap();
    let first = run(&host, 0.3);
    assert_eq!(host.set_fmu_state(state), Fine);
    assert_eq!(host.bytes().unwrap(), bytes);
    assert_eq!(run(&host, 0.3), first);
    // a new instance, from bytes, before it was even initialised
    let other = Host::new();
    other.restore(&bytes);
    assert_eq!(run(&other, 0.3), first);
    // a handle is used again
    let handle = state;
    assert_eq!(host.get_fmu_state(&mut state), Fine);
    assert_eq!(state, handle);
    assert_eq!(host.free_fmu_state(&mut state), Fine);
    assert!(state.is_null());
    assert_eq!(host.free_fmu_state(&mut state), Fine);
}

#[test]
fn a_state_keeps_phase_and_pending_initialisation() {
    let host = Host::new();
    assert_eq!(host.enter_initialization_mode(1, 1e-3, 4.0, 1, 8.0), Fine);
    assert_eq!(host.set_float64(&[vr("gain")], &[9.0]), Fine); // not yet in the outputs
    let other = Host::new();
    other.restore(&host.bytes().unwrap());
    assert_eq!(other.get_float64(&[vr("y")], 3), Ok(vec![9.0; 3]));
    assert_eq!(other.exit_initialization_mode(), Fine);
    assert_eq!(other.do_step(0.0, 1.0), Error); // the start time came along
    assert_eq!(other.do_step(4.0, 1.0), Fine);
}

#[test]
fn what_is_no_state_is_refused() {
    let host = Host::new();
    let mut foreign = [0_u64; 64];
    for state in [ptr::null_mut(), foreign.as_mut_ptr().cast(), host.instance] {
        assert_eq!(host.set_fmu_state(state), Error);
        assert_eq!(host.serialized_size(state), Err(Error));
        assert_eq!(host.serialize_into(state, &mut [0; 8]), Error);
        let messages = host.messages();
        assert_eq!(messages.len(), 3);
        assert!(
            messages
                .iter()
                .all(|m| m.text.ends_with("argument FMUState is no state of this FMU"))
        );
    }
    let c = host.instance;
    // SAFETY: null is to be recognised.
    let answers = unsafe {
        [
            fmi3::fmi3GetFMUState(c, ptr::null_mut()),
            fmi3::fmi3FreeFMUState(c, ptr::null_mut()),
            fmi3::fmi3SerializedFMUStateSize(c, ptr::null_mut(), ptr::null_mut()),
            fmi3::fmi3DeserializeFMUState(c, ptr::null(), 9, &mut ptr::null_mut()),
            fmi3::fmi3DeserializeFMUState(c, [0; 9].as_ptr(), 9, ptr::null_mut()),
        ]
    };
    assert_eq!(answers, [Error.raw(); 5]);
}

/// Each single bit of each byte, and each length.
#[test]
fn damaged_bytes_are_refused() {
    let host = Host::stepping(GOOD);
    let bytes = host.bytes().unwrap();
    for place in 0..bytes.len() {
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[place] ^= 1 << bit;
            assert_eq!(host.deserialize(&damaged), Err(Error), "byte {place}");
        }
    }
    for length in 0..bytes.len() {
        assert_eq!(host.deserialize(&bytes[..length]), Err(Error), "{length}");
    }
    host.messages();
    assert_eq!(host.deserialize(&[0; 40]), Err(Error));
    assert!(
        host.reason(Error)
            .contains("no serialized state of an FMU made with fmi3-export")
    );
    assert_eq!(host.bytes().unwrap(), bytes);
}

#[test]
fn buffers_may_be_too_large_but_not_too_small() {
    let host = Host::new();
    let mut state = ptr::null_mut();
    assert_eq!(host.get_fmu_state(&mut state), Fine);
    let size = host.serialized_size(state).unwrap();
    let mut small = vec![7; size - 1];
    assert_eq!(host.serialize_into(state, &mut small), Error);
    assert!(small.iter().all(|byte| *byte == 7));
    let mut large = vec![7; size + 3];
    assert_eq!(host.serialize_into(state, &mut large), Fine);
    assert_eq!(large[size..], [7; 3]);
    assert_eq!(large[..size], host.bytes().unwrap());
    assert_eq!(host.free_fmu_state(&mut state), Fine);
}
