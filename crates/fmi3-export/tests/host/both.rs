//! Two interfaces in one library: the same bits, and no handle of one is taken for one of the other.
#![allow(unsafe_code, reason = "calls the C functions")]

use std::ffi::CString;
use std::ptr;

use fmi2_export::abi::Fmi2CallbackFunctions;
use fmi3_export::Model;
use fmi3_export::abi::Fmi3Status;

use crate::host::{Host, vr};
use crate::probe::{GOOD, Probe, fmi2, fmi3};

/// An instance through FMI 2.0, ready to step.
fn of_fmi2() -> fmi2_export::abi::Fmi2Component {
    let guid = CString::new(format!("{{{}}}", fmi2_export::guid::<Probe>().unwrap())).unwrap();
    let functions = Fmi2CallbackFunctions {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: ptr::null_mut(),
    };
    // SAFETY: pointers are null or to live values.
    unsafe {
        let c = fmi2::fmi2Instantiate(c"x".as_ptr(), 1, guid.as_ptr(), ptr::null(), &functions, 0, 0);
        assert!(!c.is_null());
        assert_eq!(fmi2::fmi2EnterInitializationMode(c), 0);
        assert_eq!(fmi2::fmi2ExitInitializationMode(c), 0);
        c
    }
}

#[test]
fn a_run_has_the_same_bits_in_both() {
    let (three, two) = (Host::stepping(GOOD), of_fmi2());
    let first = |name: &str| Probe::table().find(&format!("{name}[1]")).unwrap();
    let (u, y) = ([0, 1, 2].map(|k| first("u") + k), [0, 1, 2].map(|k| first("y") + k));
    for k in 0..50 {
        let t = 0.1 * f64::from(k);
        let input = [t.sin(), 1.0 / (1.0 + t), t.exp()];
        assert_eq!(three.set_float64(&[vr("u")], &input), Fmi3Status::Ok);
        assert_eq!(three.do_step(t, 0.1), Fmi3Status::Ok);
        let mut values = [0.0; 3];
        // SAFETY: three elements each.
        unsafe {
            assert_eq!(fmi2::fmi2SetReal(two, u.as_ptr(), 3, input.as_ptr()), 0);
            assert_eq!(fmi2::fmi2DoStep(two, t, 0.1, 1), 0);
            assert_eq!(fmi2::fmi2GetReal(two, y.as_ptr(), 3, values.as_mut_ptr()), 0);
        }
        let arrays = three.get_float64(&[vr("y")], 3).unwrap();
        assert_eq!(
            arrays.iter().map(|v| v.to_bits()).collect::<Vec<_>>(),
            values.map(f64::to_bits)
        );
    }
    // SAFETY: alive, and not used again.
    unsafe { fmi2::fmi2FreeInstance(two) };
}

#[test]
fn neither_takes_a_handle_or_bytes_of_the_other() {
    let (three, two) = (Host::stepping(GOOD), of_fmi2());
    let error = Fmi3Status::Error.raw();
    let (mut of_three, mut of_two) = (ptr::null_mut(), ptr::null_mut());
    assert_eq!(three.get_fmu_state(&mut of_three), Fmi3Status::Ok);
    // SAFETY: all handles are alive; those of the other interface must be recognised.
    unsafe {
        assert_eq!(fmi2::fmi2GetFMUstate(two, &mut of_two), 0);
        assert_eq!(fmi2::fmi2Reset(three.instance), error);
        assert_eq!(fmi3::fmi3Reset(two), error);
        fmi3::fmi3FreeInstance(two);
        fmi2::fmi2FreeInstance(three.instance);
        assert_eq!(fmi2::fmi2SetFMUstate(two, of_three), error);
        assert_eq!(fmi3::fmi3SetFMUState(three.instance, of_two), error);
        let bytes = three.bytes().unwrap();
        let mut none = ptr::null_mut();
        assert_eq!(
            fmi2::fmi2DeSerializeFMUstate(two, bytes.as_ptr().cast(), bytes.len(), &mut none),
            error
        );
        assert_eq!(fmi2::fmi2FreeFMUstate(two, &mut of_two), 0);
        assert_eq!(fmi2::fmi2DoStep(two, 0.0, 1.0, 1), 0);
        fmi2::fmi2FreeInstance(two);
    }
    assert_eq!(three.free_fmu_state(&mut of_three), Fmi3Status::Ok);
    assert_eq!(three.do_step(0.0, 1.0), Fmi3Status::Ok);
}
