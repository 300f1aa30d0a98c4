//! Saved states, in memory and as bytes.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ptr;

use fmi2_export::abi::Fmi2Status;

use crate::host::{Host, vr};
use crate::probe::fmi2;

use Fmi2Status::{Error, Ok as Fine};

/// Every output after each of ten steps of uneven length, as bits.
fn run(host: &Host, from: f64) -> Vec<Vec<u64>> {
    let mut t = from;
    (0..10)
        .map(|k| {
            let h = 0.1 + 0.01 * f64::from(k);
            assert_eq!(host.set_real(&[vr("u[1]")], &[t.sin()]), Fine);
            assert_eq!(host.do_step(t, h), Fine);
            t += h;
            let y = host.get_real(&["y[1]", "y[2]", "angle"].map(vr)).unwrap();
            y.into_iter().map(f64::to_bits).collect()
        })
        .collect()
}

#[test]
fn a_state_brings_back_every_bit() {
    let host = Host::stepping(&[]);
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
    assert_eq!(host.free_fmu_state(&mut state), Fine);
    assert!(state.is_null());
    assert_eq!(host.free_fmu_state(&mut state), Fine);
}

#[test]
fn a_state_keeps_phase_and_pending_initialisation() {
    let host = Host::new();
    assert_eq!(host.setup_experiment(1, 1e-3, 4.0, 1, 8.0), Fine);
    assert_eq!(host.enter_initialization_mode(), Fine);
    assert_eq!(host.set_real(&[vr("gain")], &[9.0]), Fine); // not yet in the outputs
    let other = Host::new();
    other.restore(&host.bytes().unwrap());
    assert_eq!(other.get_real(&[vr("y[1]")]), Ok(vec![9.0]));
    assert_eq!(other.exit_initialization_mode(), Fine);
    assert_eq!(other.do_step(0.0, 1.0), Error); // the start time came along
    assert_eq!(other.do_step(4.0, 1.0), Fine);
}

#[test]
fn a_handle_is_used_again() {
    let host = Host::stepping(&[]);
    let mut state = ptr::null_mut();
    assert_eq!(host.get_fmu_state(&mut state), Fine);
    let handle = state;
    assert_eq!(host.do_step(0.0, 1.0), Fine);
    assert_eq!(host.get_fmu_state(&mut state), Fine);
    assert_eq!(state, handle);
    let now = host.bytes().unwrap();
    assert_eq!(host.reset(), Fine);
    assert_eq!(host.set_fmu_state(state), Fine);
    assert_eq!(host.bytes().unwrap(), now);
    assert_eq!(host.free_fmu_state(&mut state), Fine);
}

#[test]
fn what_is_no_state_is_refused() {
    let host = Host::new();
    let mut foreign = [0_u64; 64];
    for state in [ptr::null_mut(), foreign.as_mut_ptr().cast(), host.component] {
        assert_eq!(host.set_fmu_state(state), Error);
        assert_eq!(host.serialized_size(state), Err(Error));
        assert_eq!(host.serialize_into(state, &mut [0; 8]), Error);
        let messages = host.messages();
        assert_eq!(messages.len(), 3);
        assert!(
            messages
                .iter()
                .all(|m| m.text.ends_with("argument FMUstate is no state of this FMU"))
        );
    }
    let mut wrong = foreign.as_mut_ptr().cast();
    assert_eq!(host.get_fmu_state(&mut wrong), Error);
    assert_eq!(host.free_fmu_state(&mut wrong), Error);
    let c = host.component;
    // SAFETY: null is to be recognised.
    let answers = unsafe {
        [
            fmi2::fmi2GetFMUstate(c, ptr::null_mut()),
            fmi2::fmi2FreeFMUstate(c, ptr::null_mut()),
            fmi2::fmi2SerializedFMUstateSize(c, ptr::null_mut(), ptr::null_mut()),
            fmi2::fmi2DeSerializeFMUstate(c, ptr::null(), 9, &mut ptr::null_mut()),
            fmi2::fmi2DeSerializeFMUstate(c, [0; 9].as_ptr(), 9, ptr::null_mut()),
        ]
    };
    assert_eq!(answers, [Error.raw(); 5]);
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
    let reason = host.reason(Error);
    assert!(reason.contains(&format!("needs {size} bytes, the buffer has {}", size - 1)));
    let mut large = vec![7; size + 3];
    assert_eq!(host.serialize_into(state, &mut large), Fine);
    assert_eq!(large[size..], [7; 3]);
    assert_eq!(large[..size], host.bytes().unwrap());
    assert_eq!(host.free_fmu_state(&mut state), Fine);
}

/// Each single bit of each byte, and each length, with the reason for one of each kind.
#[test]
fn damaged_bytes_are_refused() {
    let host = Host::stepping(&[]);
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
    let change = |place: usize, with: u8| {
        let mut bytes = bytes.clone();
        bytes[place] ^= with;
        bytes
    };
    let longer = [&bytes[..], &[0]].concat();
    for (damaged, part) in [
        (change(0, 1), "no serialized state of an FMU made with fmi2-export"),
        (change(8, 1), "of format 3, this FMU reads format 2"),
        (change(12, 1), "of the FMU with GUID"),
        (change(28, 1), "should have"),
        (change(40, 1), "checksum does not match"),
        (longer, "should have"),
        (bytes[..20].to_vec(), "should have"),
    ] {
        assert_eq!(host.deserialize(&damaged), Err(Error));
        let reason = host.reason(Error);
        assert!(reason.contains(part), "{reason}");
    }
    assert_eq!(host.bytes().unwrap(), bytes);
}

/// A sound envelope around nonsense: the checksum is right, the content is not.
#[test]
fn a_payload_that_is_no_state_is_refused() {
    let host = Host::new();
    let bytes = host.bytes().unwrap();
    let mut forged = bytes[..bytes.len() - 8].to_vec();
    forged[36] = 200; // no such phase
    let checksum = forged.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    });
    forged.extend(checksum.to_le_bytes());
    assert_eq!(host.deserialize(&forged), Err(Error));
    assert!(host.reason(Error).contains("could not be put into or read from bytes"));
}
