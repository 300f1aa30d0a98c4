//! Any sequence of calls: nothing crashes, what is refused changes nothing, and a saved state replays to the bit.

use fmi3_export::Model;
use fmi3_export::abi::Fmi3Status;
use proptest::prelude::*;

use crate::host::Host;
use crate::probe::Probe;

/// One call with arguments that may or may not fit.
#[derive(Debug, Clone)]
enum Call {
    Enter(f64, Option<f64>),
    Exit,
    /// Step size, and whether the communication point is where it should be.
    Step(f64, bool),
    SetFloat64(Vec<u32>, Vec<f64>),
    SetInt32(u32, Vec<i32>),
    SetInt64(u32, Vec<i64>),
    SetBoolean(u32, Vec<u8>),
    SetString(u32, u8),
    Get(u32, usize),
    Terminate,
    Reset,
}

fn reference() -> impl Strategy<Value = u32> {
    // a few beyond the last, and not the switch that makes the probe misbehave
    1..u32::try_from(Probe::table().rows().len() + 3).unwrap()
}

fn real() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -2.0..120.0,
        1 => prop::sample::select(vec![-1.0, 0.0, f64::NAN, f64::INFINITY, 1e-300]),
    ]
}

fn a_call() -> impl Strategy<Value = Call> {
    let float64 = (
        prop::collection::vec(reference(), 0..3),
        prop::collection::vec(real(), 0..7),
    );
    prop_oneof![
        3 => (real(), prop::option::of(real())).prop_map(|(start, stop)| Call::Enter(start, stop)),
        3 => Just(Call::Exit),
        6 => (real(), prop::bool::weighted(0.9)).prop_map(|(h, fits)| Call::Step(h, fits)),
        6 => float64.prop_map(|(vr, values)| Call::SetFloat64(vr, values)),
        3 => (reference(), prop::collection::vec(-2..12, 0..3)).prop_map(|(vr, values)| Call::SetInt32(vr, values)),
        2 => (reference(), prop::collection::vec(any::<i64>(), 0..2)).prop_map(|(vr, v)| Call::SetInt64(vr, v)),
        2 => (reference(), prop::collection::vec(0_i64..4, 0..2)).prop_map(|(vr, v)| Call::SetInt64(vr, v)),
        1 => (reference(), prop::collection::vec(any::<u8>(), 1)).prop_map(|(vr, v)| Call::SetBoolean(vr, v)),
        1 => (reference(), any::<u8>()).prop_map(|(vr, value)| Call::SetString(vr, value)),
        4 => (reference(), 0_usize..7).prop_map(|(vr, count)| Call::Get(vr, count)),
        1 => Just(Call::Terminate),
        1 => Just(Call::Reset),
    ]
}

/// Where the next step should start, followed alongside.
#[derive(Clone, Copy)]
struct Clock(f64);

fn perform(host: &Host, clock: &mut Clock, call: &Call) -> Fmi3Status {
    match call {
        Call::Enter(start, stop) => {
            let status = host.enter_initialization_mode(0, 0.0, *start, stop.is_some().into(), stop.unwrap_or(0.0));
            if status == Fmi3Status::Ok {
                clock.0 = *start;
            }
            status
        }
        Call::Exit => host.exit_initialization_mode(),
        Call::Step(h, fits) => {
            let t = if *fits { clock.0 } else { clock.0 + 1e3 };
            let status = host.do_step(t, *h);
            if status == Fmi3Status::Ok {
                assert!(*fits && *h > 0.0 && h.is_finite());
                clock.0 = t + h;
            }
            status
        }
        Call::SetFloat64(references, values) => host.set_float64(references, values),
        Call::SetInt32(reference, values) => host.set_int32(&[*reference], values),
        Call::SetInt64(reference, values) => host.set_int64(&[*reference], values),
        Call::SetBoolean(reference, values) => host.set_boolean(&[*reference], values),
        Call::SetString(reference, byte) => {
            let bytes = [*byte, 0];
            let text = std::ffi::CStr::from_bytes_until_nul(&bytes).unwrap();
            host.set_string(&[*reference], &[text])
        }
        Call::Get(reference, count) => {
            let found = [
                host.get_float64(&[*reference], *count).err(),
                host.get_int32(&[*reference], *count).err(),
                host.get_int64(&[*reference], *count).err(),
                host.get_boolean(&[*reference], *count).err(),
                host.get_string(&[*reference]).err(),
            ];
            assert!(found.iter().filter(|error| error.is_none()).count() <= 1);
            Fmi3Status::Ok
        }
        Call::Terminate => host.terminate(),
        Call::Reset => {
            clock.0 = 0.0;
            host.reset()
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn refused_calls_change_nothing(calls in prop::collection::vec(a_call(), 0..60)) {
        let host = Host::new();
        let mut clock = Clock(0.0);
        for call in &calls {
            let before = host.bytes().unwrap();
            host.messages();
            let status = perform(&host, &mut clock, call);
            prop_assert!(matches!(status, Fmi3Status::Ok | Fmi3Status::Error));
            if status == Fmi3Status::Error {
                prop_assert_eq!(host.bytes().unwrap(), before, "{:?}", call);
                prop_assert_eq!(host.messages().len(), 1, "{:?}", call);
            }
        }
    }

    #[test]
    fn a_saved_state_replays(
        before in prop::collection::vec(a_call(), 0..30),
        after in prop::collection::vec(a_call(), 0..30),
    ) {
        let replay = |host: &Host, mut clock: Clock| -> Vec<_> {
            after
                .iter()
                .map(|call| (perform(host, &mut clock, call), host.bytes().unwrap()))
                .collect()
        };
        let host = Host::new();
        let mut clock = Clock(0.0);
        for call in &before {
            perform(&host, &mut clock, call);
        }
        let bytes = host.bytes().unwrap();
        let once = replay(&host, clock);
        let other = Host::new();
        other.restore(&bytes);
        prop_assert_eq!(&other.bytes().unwrap(), &bytes);
        prop_assert_eq!(&replay(&other, clock), &once);
    }
}
