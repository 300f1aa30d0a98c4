//! Getting and setting variables of every type.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ffi::CStr;
use std::ptr;

use fmi2_export::Model;
use fmi2_export::abi::Fmi2Status;

use crate::host::{Host, vr};
use crate::probe::{Probe, SAYS_NUL, fmi2};

use Fmi2Status::{Error, Ok as Fine};

#[test]
fn start_values_read_back() {
    let host = Host::new();
    assert_eq!(host.enter_initialization_mode(), Fine);
    let weights = ["gain", "weights[1]", "weights[2]", "weights[3]", "u[1]"];
    assert_eq!(host.get_real(&weights.map(vr)), Ok(vec![-1.0, 1.0, 2.0, 0.5, 0.0]));
    assert_eq!(host.get_integer(&["limit", "k", "kind"].map(vr)), Ok(vec![3, 0, 1]));
    assert_eq!(host.get_boolean(&["invert", "on"].map(vr)), Ok(vec![1, 0]));
    assert_eq!(
        host.get_string(&["label", "note", "echo"].map(vr)),
        Ok(["a <b> & \"c\"", "", "a <b> & \"c\""].map(str::to_owned).into())
    );
}

#[test]
fn every_type_is_set_and_read() {
    let host = Host::stepping(&[("kind", 2), ("k", i32::MIN)]);
    assert_eq!(host.set_boolean(&[vr("on")], &[-1]), Fine); // any non-zero is true, as in C
    assert_eq!(host.set_string(&[vr("note")], &[c"gr\xc3\xbc\xc3\x9f"]), Fine);
    assert_eq!(host.set_real(&[vr("u[2]"), vr("u[1]")], &[2.0, 1.0]), Fine);
    assert_eq!(host.do_step(0.0, 0.5), Fine);
    assert_eq!(
        host.get_integer(&["kind_used", "k", "steps"].map(vr)),
        Ok(vec![2, i32::MIN, 1])
    );
    assert_eq!(host.get_boolean(&["on", "started"].map(vr)), Ok(vec![1, 1]));
    assert_eq!(host.get_string(&[vr("note")]), Ok(vec!["grüß".to_owned()]));
    // y starts at gain = -1: -1 + 1*1*0.5, -1 + 2*2*0.5, -1 + 0.5*0*0.5
    let y = ["y[1]", "y[2]", "y[3]"].map(vr);
    assert_eq!(host.get_real(&y), Ok(vec![-0.5, 1.0, -1.0]));
}

#[test]
fn matrices_are_row_major_with_consecutive_references() {
    let host = Host::stepping(&[]);
    assert_eq!(host.set_real(&["u[1]", "u[2]"].map(vr), &[1.0, 10.0]), Fine);
    assert_eq!(host.do_step(0.0, 1.0), Fine);
    let first = vr("outer[1,1]");
    assert_eq!(vr("outer[2,3]"), first + 5);
    let references: Vec<u32> = (first..first + 6).collect();
    // u = (1, 10), y = -1 + (1, 20, 0)
    let outer = vec![0.0, 19.0, -1.0, 0.0, 190.0, -10.0];
    assert_eq!(host.get_real(&references), Ok(outer));
}

/// A refused set names the culprit and leaves even the good values before it unset.
#[test]
fn refused_sets_change_nothing_and_say_why() {
    let good = ("u[1]", 7.0);
    for (name, value, part) in [
        ("u[2]", f64::NAN, "'u[2]' = NaN is not finite"),
        ("u[2]", f64::NEG_INFINITY, "'u[2]' = -inf is not finite"),
        (
            "gain",
            0.0,
            "'gain' = 0.0 m must be greater than 0 and at most 100.0, or -1 for the mission's own",
        ),
        ("gain", 101.0, "'gain' = 101.0 m must be"),
        ("weights[2]", -0.5, "'weights[2]' = -0.5 rad/s must be at least 0.0"),
        (
            "y[1]",
            1.0,
            "'y[1]' cannot be set in phase 'instantiated': it has causality output",
        ),
        ("outer[1,2]", 1.0, "causality local"),
        ("limit", 1.0, "'limit' (value reference 2) is of type Integer"),
    ] {
        let host = Host::new();
        let before = host.bytes().unwrap();
        assert_eq!(host.set_real(&[vr(good.0), vr(name)], &[good.1, value]), Error);
        let reason = host.reason(Error);
        assert!(reason.contains(part), "{reason}");
        assert_eq!(host.bytes().unwrap(), before);
    }
    for (name, value, part) in [
        ("limit", 10, "'limit' = 10 must be at least 0 and at most 9"),
        ("limit", -1, "'limit' = -1 must be"),
        ("kind", 0, "'kind' = 0 is not an item of its enumeration: 1 one, 2 two"),
        ("kind", 3, "'kind' = 3 is not"),
        ("kind", i32::MIN, "is not an item"),
        ("gain", 1, "is of type Real"),
    ] {
        let host = Host::new();
        assert_eq!(host.set_integer(&[vr("k"), vr(name)], &[7, value]), Error);
        let reason = host.reason(Error);
        assert!(reason.contains(part), "{reason}");
        assert_eq!(host.bytes(), Host::new().bytes());
    }
    let host = Host::new();
    let (count, bad) = (u32::try_from(Probe::table().entry_count()).unwrap(), u32::MAX);
    for reference in [count, bad] {
        assert_eq!(host.set_real(&[reference], &[1.0]), Error);
        let reason = host.reason(Error);
        assert!(reason.contains(&format!("value reference {reference}; there are {count}")));
    }
    assert_eq!(host.set_string(&[vr("note")], &[c"\xff"]), Error);
    assert!(host.reason(Error).contains("value is not UTF-8"));
    assert_eq!(host.set_boolean(&[vr("note")], &[1]), Error);
    assert!(host.reason(Error).contains("is of type String"));
}

#[test]
fn parameters_are_fixed_after_initialization() {
    let host = Host::stepping(&[]);
    assert_eq!(host.set_real(&[vr("u[1]"), vr("gain")], &[1.0, 1.0]), Error);
    assert_eq!(
        host.reason(Error),
        "fmi2SetReal: 'gain' cannot be set in phase 'step complete': it has causality parameter"
    );
    assert_eq!(host.get_real(&[vr("u[1]")]), Ok(vec![0.0]));
}

#[test]
fn minus_one_is_the_scenarios_own() {
    let host = Host::new();
    assert_eq!(host.set_real(&[vr("gain")], &[3.0]), Fine);
    assert_eq!(host.set_real(&[vr("gain")], &[-1.0]), Fine);
    assert_eq!(host.set_real(&[vr("gain")], &[-0.5]), Error);
    assert_eq!(host.enter_initialization_mode(), Fine);
    assert_eq!(host.get_real(&[vr("gain")]), Ok(vec![-1.0]));
}

#[test]
fn refused_gets_leave_the_buffer_alone() {
    let host = Host::stepping(&[]);
    let mut values = [5.0, 6.0];
    let references = [vr("y[1]"), vr("steps")];
    // SAFETY: both arrays have two elements.
    let raw = unsafe { fmi2::fmi2GetReal(host.component, references.as_ptr(), 2, values.as_mut_ptr()) };
    assert_eq!((raw, values), (Error.raw(), [5.0, 6.0]));
    assert!(host.reason(Error).contains("'steps' (value reference"));
}

#[test]
fn null_and_misaligned_arrays_are_refused_unless_empty() {
    let host = Host::stepping(&[]);
    let c = host.component;
    let (reference, mut value) = (vr("y[1]"), [0.0_f64; 2]);
    let misaligned = value.as_mut_ptr().cast::<u8>().wrapping_add(1).cast::<f64>();
    // SAFETY: lengths are those of the arrays; null and misaligned pointers are not read.
    let answers = unsafe {
        [
            fmi2::fmi2GetReal(c, ptr::null(), 0, ptr::null_mut()),
            fmi2::fmi2SetReal(c, ptr::null(), 0, ptr::null()),
            fmi2::fmi2SetString(c, ptr::null(), 0, ptr::null()),
            fmi2::fmi2GetReal(c, ptr::null(), 1, value.as_mut_ptr()),
            fmi2::fmi2GetReal(c, &reference, 1, ptr::null_mut()),
            fmi2::fmi2GetReal(c, &reference, 1, misaligned),
            fmi2::fmi2GetReal(c, &reference, usize::MAX, value.as_mut_ptr()),
            fmi2::fmi2SetString(c, &vr("note"), 1, &ptr::null()),
        ]
    };
    assert_eq!(answers, [0, 0, 0, 3, 3, 3, 3, 3]);
    let texts: Vec<_> = host.messages().into_iter().map(|m| m.text).collect();
    for (text, part) in texts.iter().zip([
        "argument vr is a null",
        "argument value is a null",
        "argument value is a null or misaligned",
        "argument vr would have 18446744073709551615 elements",
        "argument value is a null",
    ]) {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn strings_hold_until_the_next_call_of_get_string() {
    let host = Host::stepping(&[]);
    let mut pointer = ptr::null();
    // SAFETY: one element each.
    let raw = unsafe { fmi2::fmi2GetString(host.component, &vr("label"), 1, &mut pointer) };
    assert_eq!(raw, 0);
    assert_eq!(host.do_step(0.0, 1.0), Fine);
    // SAFETY: handed out by the last fmi2GetString.
    assert_eq!(unsafe { CStr::from_ptr(pointer) }, c"a <b> & \"c\"");
}

#[test]
fn a_text_with_nul_cannot_be_handed_out() {
    let host = Host::stepping(&[("behaviour", SAYS_NUL)]);
    assert_eq!(host.get_string(&[vr("label"), vr("echo")]), Err(Error));
    assert!(host.reason(Error).contains("the value of 'echo' holds a NUL"));
}
