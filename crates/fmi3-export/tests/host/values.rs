//! Getting and setting variables of every type, scalars and arrays.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ffi::CStr;
use std::ptr;

use fmi3_export::abi::Fmi3Status;
use fmi3_export::{Model, TIME};

use crate::host::{Host, vr};
use crate::probe::{GOOD, Probe, SAYS_NUL, fmi3};

use Fmi3Status::{Error, Ok as Fine};

/// Start values are there from the beginning, before initialization, too.
#[test]
fn start_values_read_back() {
    let host = Host::new();
    for initialising in [false, true] {
        if initialising {
            assert_eq!(host.enter(), Fine);
        }
        let reals = ["gain", "weights", "u"].map(vr);
        assert_eq!(
            host.get_float64(&reals, 7),
            Ok(vec![-1.0, 1.0, 2.0, 0.5, 0.0, 0.0, 0.0])
        );
        assert_eq!(host.get_int32(&["limit", "k"].map(vr), 2), Ok(vec![3, 0]));
        assert_eq!(host.get_int64(&["behaviour", "kind"].map(vr), 2), Ok(vec![1, 1]));
        assert_eq!(host.get_boolean(&["invert", "on"].map(vr), 2), Ok(vec![1, 0]));
        assert_eq!(
            host.get_string(&["label", "note"].map(vr)),
            Ok(["a <b> & \"c\"", ""].map(str::to_owned).into())
        );
    }
}

#[test]
fn every_type_is_set_and_read() {
    let host = Host::stepping(GOOD);
    assert_eq!(host.set_int64(&[vr("kind")], &[2]), Fine);
    assert_eq!(host.set_int32(&[vr("k")], &[i32::MIN]), Fine);
    assert_eq!(host.set_boolean(&[vr("on")], &[255]), Fine); // any non-zero is true, as in C
    assert_eq!(host.set_string(&[vr("note")], &[c"gr\xc3\xbc\xc3\x9f"]), Fine);
    assert_eq!(host.set_float64(&[vr("u")], &[1.0, 2.0, 4.0]), Fine);
    assert_eq!(host.do_step(0.0, 0.5), Fine);
    assert_eq!(host.get_int32(&["k", "steps"].map(vr), 2), Ok(vec![i32::MIN, 1]));
    assert_eq!(host.get_int64(&[vr("kind_used")], 1), Ok(vec![2]));
    assert_eq!(host.get_boolean(&["on", "started"].map(vr), 2), Ok(vec![1, 1]));
    assert_eq!(host.get_string(&[vr("note")]), Ok(vec!["grüß".to_owned()]));
    // y starts at gain = -1: -1 + 1*1*0.5, -1 + 2*2*0.5, -1 + 0.5*4*0.5
    assert_eq!(host.get_float64(&[vr("y")], 3), Ok(vec![-0.5, 1.0, 0.0]));
}

#[test]
fn a_matrix_is_read_whole_row_by_row() {
    let host = Host::stepping(GOOD);
    assert_eq!(host.set_float64(&[vr("u")], &[1.0, 10.0, 0.0]), Fine);
    assert_eq!(host.do_step(0.0, 1.0), Fine);
    // u = (1, 10), y = -1 + (1, 20, 0); then a scalar behind it
    let outer = vec![0.0, 19.0, -1.0, 0.0, 190.0, -10.0, 0.0];
    assert_eq!(host.get_float64(&["outer", "angle"].map(vr), 7), Ok(outer));
}

#[test]
fn time_is_a_variable_that_steps_change() {
    let host = Host::new();
    assert_eq!(host.enter_initialization_mode(0, 0.0, 20.0, 0, 0.0), Fine);
    assert_eq!(host.get_float64(&[vr(TIME)], 1), Ok(vec![20.0]));
    assert_eq!(host.exit_initialization_mode(), Fine);
    assert_eq!(host.do_step(20.0, 0.5), Fine);
    let mixed = ["gain", TIME, "y", TIME].map(vr);
    assert_eq!(
        host.get_float64(&mixed, 6),
        Ok(vec![-1.0, 20.5, -1.0, -1.0, -1.0, 20.5])
    );
    assert_eq!(host.set_float64(&[vr(TIME)], &[0.0]), Error);
    assert!(
        host.reason(Error)
            .contains("'time' (value reference 19) is the independent variable")
    );
    assert_eq!(host.get_int32(&[vr(TIME)], 1), Err(Error));
    assert!(host.reason(Error).contains("is of type Float64"));
}

/// A refused set names the culprit and leaves even the good values before it unset.
#[test]
fn refused_sets_change_nothing_and_say_why() {
    let u = [7.0, 7.0, 7.0];
    for (name, values, part) in [
        ("weights", &[1.0, f64::NAN, 1.0][..], "'weights[2]' = NaN is not finite"),
        (
            "weights",
            &[1.0, 1.0, f64::INFINITY],
            "'weights[3]' = inf is not finite",
        ),
        (
            "weights",
            &[0.0, -0.5, 1.0],
            "'weights[2]' = -0.5 rad/s must be at least 0.0",
        ),
        (
            "gain",
            &[0.0],
            "'gain' = 0.0 m must be greater than 0 and at most 100.0, or -1 for the mission's own",
        ),
        (
            "gain",
            &[1.0, 2.0],
            "the variables have 4 values together, nValues is 5",
        ),
        ("weights", &[1.0], "the variables have 6 values together, nValues is 4"),
        (
            "y",
            &[1.0; 3],
            "'y[1]' cannot be set in phase 'instantiated': it has causality output",
        ),
        ("outer", &[1.0; 6], "causality local"),
        ("limit", &[1.0], "'limit' (value reference 2) is of type Int32"),
        ("kind", &[1.0], "'kind' (value reference 10) is of type Enumeration"),
    ] {
        let host = Host::new();
        let before = host.bytes().unwrap();
        assert_eq!(
            host.set_float64(&[vr("u"), vr(name)], &[&u[..], values].concat()),
            Error
        );
        let reason = host.reason(Error);
        assert!(
            reason.starts_with("fmi3SetFloat64: ") && reason.contains(part),
            "{reason}"
        );
        assert_eq!(host.bytes().unwrap(), before);
    }
    let host = Host::new();
    for value in [0, 3, i64::from(i32::MIN), i64::MAX] {
        assert_eq!(host.set_int64(&["behaviour", "kind"].map(vr), &[2, value]), Error);
        let part = format!("'kind' = {value} is not an item of its enumeration: 1 one, 2 two");
        assert!(host.reason(Error).contains(&part));
    }
    assert_eq!(host.set_int64(&[vr("limit")], &[1]), Error);
    assert!(host.reason(Error).contains("is of type Int32"));
    assert_eq!(host.set_int32(&["k", "limit"].map(vr), &[7, 10]), Error);
    assert!(
        host.reason(Error)
            .contains("'limit' = 10 must be at least 0 and at most 9")
    );
    let count = u32::try_from(Probe::table().rows().len()).unwrap() + 1;
    for reference in [count, u32::MAX] {
        assert_eq!(host.set_float64(&[reference], &[1.0]), Error);
        let part = format!("value reference {reference}; there are {count}");
        assert!(host.reason(Error).contains(&part));
    }
    assert_eq!(host.set_string(&[vr("note")], &[c"\xff"]), Error);
    assert!(host.reason(Error).contains("values is not UTF-8"));
    assert_eq!(host.bytes(), Host::new().bytes());
}

#[test]
fn parameters_are_fixed_after_initialization() {
    let host = Host::stepping(GOOD);
    assert_eq!(host.set_float64(&["u", "gain"].map(vr), &[1.0; 4]), Error);
    assert_eq!(
        host.reason(Error),
        "fmi3SetFloat64: 'gain' cannot be set in phase 'step complete': it has causality parameter"
    );
    assert_eq!(host.get_float64(&[vr("u")], 3), Ok(vec![0.0; 3]));
}

#[test]
fn refused_gets_leave_the_buffer_alone() {
    let host = Host::stepping(GOOD);
    let mut values = [5.0; 4];
    for (references, part) in [
        (["y", "steps"].map(vr), "'steps' (value reference"),
        (["y", "outer"].map(vr), "9 values together, nValues is 4"),
    ] {
        // SAFETY: both arrays are as long as is said.
        let raw = unsafe { fmi3::fmi3GetFloat64(host.instance, references.as_ptr(), 2, values.as_mut_ptr(), 4) };
        assert_eq!((raw, values), (Error.raw(), [5.0; 4]));
        let reason = host.reason(Error);
        assert!(reason.contains(part), "{reason}");
    }
}

#[test]
fn null_and_misaligned_arrays_are_refused_unless_empty() {
    let host = Host::stepping(GOOD);
    let c = host.instance;
    let (reference, mut value) = (vr("gain"), [0.0_f64; 2]);
    let misaligned = value.as_mut_ptr().cast::<u8>().wrapping_add(1).cast::<f64>();
    // SAFETY: lengths are those of the arrays; null and misaligned pointers are not read.
    let answers = unsafe {
        [
            fmi3::fmi3GetFloat64(c, ptr::null(), 0, ptr::null_mut(), 0),
            fmi3::fmi3SetFloat64(c, ptr::null(), 0, ptr::null(), 0),
            fmi3::fmi3SetString(c, ptr::null(), 0, ptr::null(), 0),
            fmi3::fmi3GetFloat64(c, ptr::null(), 1, value.as_mut_ptr(), 1),
            fmi3::fmi3GetFloat64(c, &reference, 1, ptr::null_mut(), 1),
            fmi3::fmi3GetFloat64(c, &reference, 1, misaligned, 1),
            fmi3::fmi3GetFloat64(c, &reference, 1, value.as_mut_ptr(), usize::MAX),
            fmi3::fmi3SetString(c, &vr("note"), 1, &ptr::null(), 1),
        ]
    };
    assert_eq!(answers, [0, 0, 0, 3, 3, 3, 3, 3]);
    let texts: Vec<_> = host.messages().into_iter().map(|m| m.text).collect();
    for (text, part) in texts.iter().zip([
        "argument valueReferences is a null",
        "argument values is a null",
        "argument values is a null or misaligned",
        "argument values would have 18446744073709551615 elements",
        "argument values is a null",
    ]) {
        assert!(text.contains(part), "{text}");
    }
}

/// The standard has more types than the table: none of them can be read or set, and asking for nothing is no mistake.
#[test]
fn types_without_variables_take_nothing_and_refuse_the_rest() {
    let host = Host::new();
    macro_rules! without {
        ($($name:literal: $set:ident, $get:ident, $zero:expr;)*) => {
            $(
                assert_eq!(host.$set(&[], &[]), Fine, $name);
                assert_eq!(host.$get(&[], 0), Ok(vec![]), $name);
                assert_eq!(host.$set(&[vr("k")], &[$zero]), Error, $name);
                assert!(host.reason(Error).contains(concat!("fmi3Set", $name, ": 'k'")));
                assert_eq!(host.$get(&[vr("gain")], 1), Err(Error), $name);
                assert!(host.reason(Error).ends_with("is of type Float64"), $name);
                assert_eq!(host.$get(&[99], 1), Err(Error), $name);
                assert!(host.reason(Error).contains("no variable has value reference 99"), $name);
                assert_eq!(host.$get(&[], 1), Err(Error), $name);
                assert!(host.reason(Error).contains("0 values together, nValues is 1"), $name);
            )*
        };
    }
    without! {
        "Float32": set_float32, get_float32, 0.0;
        "Int8": set_int8, get_int8, 0;
        "UInt8": set_uint8, get_uint8, 0;
        "Int16": set_int16, get_int16, 0;
        "UInt16": set_uint16, get_uint16, 0;
        "UInt32": set_uint32, get_uint32, 0;
        "UInt64": set_uint64, get_uint64, 0;
    }
    let (c, k, mut size, mut bytes, mut tick) = (host.instance, vr("k"), 0, ptr::null(), 0);
    // SAFETY: one element each.
    let answers = unsafe {
        [
            fmi3::fmi3GetBinary(c, ptr::null(), 0, ptr::null_mut(), ptr::null_mut(), 0),
            fmi3::fmi3SetBinary(c, ptr::null(), 0, ptr::null(), ptr::null(), 0),
            fmi3::fmi3GetClock(c, ptr::null(), 0, ptr::null_mut()),
            fmi3::fmi3SetClock(c, ptr::null(), 0, ptr::null()),
            fmi3::fmi3GetBinary(c, &k, 1, &mut size, &mut bytes, 1),
            fmi3::fmi3SetBinary(c, &k, 1, &size, &bytes, 1),
            fmi3::fmi3GetClock(c, &k, 1, &mut tick),
            fmi3::fmi3SetClock(c, &k, 1, &tick),
        ]
    };
    assert_eq!(answers, [0, 0, 0, 0, 3, 3, 3, 3]);
    assert!(host.messages().iter().all(|m| m.text.ends_with("is of type Int32")));
}

#[test]
fn strings_hold_until_the_next_call_of_get_string() {
    let host = Host::stepping(GOOD);
    let mut pointer = ptr::null();
    // SAFETY: one element each.
    let raw = unsafe { fmi3::fmi3GetString(host.instance, &vr("label"), 1, &mut pointer, 1) };
    assert_eq!(raw, 0);
    assert_eq!(host.do_step(0.0, 1.0), Fine);
    // SAFETY: handed out by the last fmi3GetString.
    assert_eq!(unsafe { CStr::from_ptr(pointer) }, c"a <b> & \"c\"");
}

#[test]
fn a_text_with_nul_cannot_be_handed_out() {
    let host = Host::stepping(SAYS_NUL);
    assert_eq!(host.get_string(&["label", "echo"].map(vr)), Err(Error));
    assert!(host.reason(Error).contains("the value of 'echo' holds a NUL"));
}
