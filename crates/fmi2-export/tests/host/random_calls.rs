//! Any sequence of calls: nothing crashes, what is refused changes nothing, and a saved state replays to the bit.

use fmi2_export::Model;
use fmi2_export::abi::Fmi2Status;
use proptest::prelude::*;

use crate::host::Host;
use crate::probe::Probe;

/// One call with arguments that may or may not fit.
#[derive(Debug, Clone)]
enum Call {
    Setup(f64, Option<f64>),
    Enter,
    Exit,
    /// Step size, and whether the communication point is where it should be.
    Step(f64, bool),
    SetReal(Vec<(u32, f64)>),
    SetInteger(Vec<(u32, i32)>),
    SetBoolean(u32, i32),
    SetString(u32, u8),
    Get(u32),
    Terminate,
    Reset,
}

fn reference() -> impl Strategy<Value = u32> {
    // a few beyond the last, and not the switch that makes the probe misbehave
    1..u32::try_from(Probe::table().entry_count() + 3).unwrap()
}

fn real() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -2.0..120.0,
        1 => prop::sample::select(vec![-1.0, 0.0, f64::NAN, f64::INFINITY, 1e-300]),
    ]
}

fn a_call() -> impl Strategy<Value = Call> {
    prop_oneof![
        1 => (real(), prop::option::of(real())).prop_map(|(start, stop)| Call::Setup(start, stop)),
        2 => Just(Call::Enter),
        3 => Just(Call::Exit),
        6 => (real(), prop::bool::weighted(0.9)).prop_map(|(h, fits)| Call::Step(h, fits)),
        4 => prop::collection::vec((reference(), real()), 0..4).prop_map(Call::SetReal),
        4 => prop::collection::vec((reference(), -2..12), 0..3).prop_map(Call::SetInteger),
        1 => (reference(), -1..2).prop_map(|(vr, value)| Call::SetBoolean(vr, value)),
        1 => (reference(), any::<u8>()).prop_map(|(vr, value)| Call::SetString(vr, value)),
        4 => reference().prop_map(Call::Get),
        1 => Just(Call::Terminate),
        1 => Just(Call::Reset),
    ]
}

/// Where the next step should start, followed alongside.
#[derive(Clone, Copy)]
struct Clock(f64);

fn perform(host: &Host, clock: &mut Clock, call: &Call) -> Fmi2Status {
    match call {
        Call::Setup(start, stop) => {
            let defined = i32::from(stop.is_some());
            let status = host.setup_experiment(0, 0.0, *start, defined, stop.unwrap_or(0.0));
            if status == Fmi2Status::Ok {
                clock.0 = *start;
            }
            status
        }
        Call::Enter => host.enter_initialization_mode(),
        Call::Exit => host.exit_initialization_mode(),
        Call::Step(h, fits) => {
            let t = if *fits { clock.0 } else { clock.0 + 1e3 };
            let status = host.do_step(t, *h);
            if status == Fmi2Status::Ok {
                assert!(*fits && *h > 0.0 && h.is_finite());
                clock.0 = t + h;
            }
            status
        }
        Call::SetReal(pairs) => {
            let (references, values): (Vec<_>, Vec<_>) = pairs.iter().copied().unzip();
            host.set_real(&references, &values)
        }
        Call::SetInteger(pairs) => {
            let (references, values): (Vec<_>, Vec<_>) = pairs.iter().copied().unzip();
            host.set_integer(&references, &values)
        }
        Call::SetBoolean(reference, value) => host.set_boolean(&[*reference], &[*value]),
        Call::SetString(reference, byte) => {
            let bytes = [*byte, 0];
            let text = std::ffi::CStr::from_bytes_until_nul(&bytes).unwrap();
            host.set_string(&[*reference], &[text])
        }
        Call::Get(reference) => {
            let found = [
                host.get_real(&[*reference]).err(),
                host.get_integer(&[*reference]).err(),
                host.get_boolean(&[*reference]).err(),
                host.get_string(&[*reference]).err(),
            ];
            assert!(found.iter().filter(|error| error.is_none()).count() <= 1);
            Fmi2Status::Ok
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
            prop_assert!(matches!(status, Fmi2Status::Ok | Fmi2Status::Error));
            if status == Fmi2Status::Error {
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
        host.restore(&bytes);
        prop_assert_eq!(&replay(&host, clock), &once);
    }
}
