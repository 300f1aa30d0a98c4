"""What a master may do to an FMI 3.0 FMU beside running it, with FMPy: twin.py TRUTH NAV

Life cycles, saved states in memory and as bytes, and everything that must be refused: prints one line for each that is as it should
be, and ends at the first that is not.
"""

import math
import sys

from fmpy import read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Model, FMU3Slave
from couple import slave

ERROR = 3


class Heard:
    """Messages of an instance."""

    def __init__(self):
        self.texts = []

    def __call__(self, _environment, _status, _category, message):
        self.texts.append(message.decode())


def again(fmu):
    """Frees the instance and makes another one in the same library, which hears itself."""
    fmu.heard = Heard()
    fmu.fmu.fmi3FreeInstance(fmu.fmu.component)
    fmu.fmu.instantiate(loggingOn=True, logMessage=fmu.heard)
    fmu.fmu.setDebugLogging(True, ["logStatusError", "logStatusFatal"])


def steps(fmu, first, last):
    """Position of the target after each second, as text that reads back to the same bits."""
    shown = []
    for k in range(first, last):
        event, terminate, early, reached = fmu.fmu.doStep(float(k), 1.0)
        assert not (event or terminate or early) and reached == k + 1.0, (k, reached)
        shown.append(repr((fmu.get("time"), fmu.get("truth.r_tc_n"), fmu.get("lidar.range"))))
    return shown


def world(truth):
    truth.set("run", 3)
    truth.set("vent.scale", 10.0)
    truth.start()


def refused(fmu, call, part):
    """The call must end in an error whose reason names `part`."""
    fmu.heard.texts.clear()
    try:
        call()
    except FMICallException as refusal:
        assert refusal.status == ERROR, refusal
    else:
        raise AssertionError(f"not refused: {part}")
    assert len(fmu.heard.texts) == 1 and part in fmu.heard.texts[0], (part, fmu.heard.texts)
    refused.count += 1


refused.count = 0


def life_cycles(truth):
    again(truth)
    world(truth)
    first = steps(truth, 0, 30)
    for _ in range(20):
        truth.fmu.reset()
        world(truth)
        assert steps(truth, 0, 30) == first
        truth.fmu.terminate()
        assert truth.get("time") == 30.0
    for _ in range(20):
        again(truth)
        world(truth)
        assert steps(truth, 0, 30) == first
    return "40 life cycles to the same bits"


def states(truth):
    again(truth)
    world(truth)
    steps(truth, 0, 20)
    state = truth.fmu.getFMUState()
    code = truth.fmu.serializeFMUState(state)
    onward = steps(truth, 20, 60)
    truth.fmu.setFMUState(state)
    assert steps(truth, 20, 60) == onward
    truth.fmu.freeFMUState(state)
    # Another instance, which was never initialised, from bytes.
    again(truth)
    state = truth.fmu.deserializeFMUState(code)
    truth.fmu.setFMUState(state)
    assert truth.fmu.serializeFMUState(state) == code
    truth.fmu.freeFMUState(state)
    assert steps(truth, 20, 60) == onward
    damaged = bytearray(code)
    damaged[len(code) // 2] ^= 1
    refused(truth, lambda: truth.fmu.deserializeFMUState(bytes(damaged)), "checksum does not match")
    return f"a state of {len(code)} bytes goes on to the same bits"


def wrong_calls(truth, nav):
    again(truth)
    again(nav)
    reference = truth.variables["truth.r_tc_n"].valueReference
    nan = [math.nan, 0.0, 0.0]
    command = truth.variables["a_cmd_c_n"].valueReference
    refused(truth, lambda: truth.fmu.doStep(0.0, 1.0), "not allowed in phase 'instantiated'")
    refused(truth, lambda: truth.fmu.exitInitializationMode(), "not allowed in phase")
    refused(truth, lambda: truth.fmu.terminate(), "not allowed in phase")
    refused(truth, lambda: truth.set("a_cmd_c_n", nan), "'a_cmd_c_n[1]' = NaN is not finite")
    refused(truth, lambda: truth.set("a_cmd_c_n", [0.0, 0.0]), "3 values together, nValues is 2")
    refused(truth, lambda: truth.set("vent.scale", -2.0), "'vent.scale' = -2.0")
    refused(truth, lambda: truth.set("truth.r_tc_n", [0.0] * 3), "causality output")
    refused(truth, lambda: truth.set("time", 1.0), "independent variable")
    refused(truth, lambda: truth.fmu.getFloat64([9999]), "no variable has value reference 9999")
    refused(truth, lambda: truth.fmu.getInt32([reference]), "is of type Float64")
    refused(truth, lambda: truth.fmu.getFloat32([command]), "is of type Float64")
    refused(truth, lambda: truth.fmu.enterInitializationMode(startTime=math.nan), "start time = NaN")
    refused(nav, lambda: nav.set("filter", 2**40), "is not an item of its enumeration")
    assert truth.fmu.getFloat32([]) == [] and truth.fmu.getClock([]) == []
    world(truth)
    refused(truth, lambda: truth.fmu.enterInitializationMode(), "not allowed in phase")
    refused(truth, lambda: truth.set("vent.scale", 1.0), "cannot be set in phase 'step complete'")
    refused(truth, lambda: truth.fmu.doStep(5.0, 1.0), "does not follow on the end of the last step")
    refused(truth, lambda: truth.fmu.doStep(0.0, -1.0), "must be greater than 0")
    refused(truth, lambda: truth.fmu.doStep(0.0, math.nan), "is not finite")
    refused(truth, lambda: truth.fmu.enterEventMode(), "hasEventMode = false")
    refused(truth, lambda: truth.fmu.updateDiscreteStates(), "hasEventMode = false")
    refused(truth, lambda: truth.fmu.getDirectionalDerivative([reference], [command], [1.0]), "providesDirectional")
    # None of it has left a trace.
    shown = steps(truth, 0, 10)
    again(truth)
    world(truth)
    assert steps(truth, 0, 10) == shown
    return f"{refused.count} wrong calls refused without a trace"


def instantiations(path, folder):
    """Wrong token, event mode, intermediate variables, model exchange."""
    description = read_model_description(path)
    identifier = description.coSimulation.modelIdentifier
    for kind, token, asked, part in [
        (FMU3Slave, "{wrong}", {}, "instantiation token given is '{wrong}'"),
        (FMU3Slave, description.instantiationToken, {"eventModeUsed": True}, "hasEventMode = false"),
        (FMU3Slave, description.instantiationToken, {"requiredIntermediateVariables": [0]}, "1 intermediate variables"),
        (FMU3Model, description.instantiationToken, {}, "co-simulation only"),
    ]:
        heard = Heard()
        fmu = kind(guid=token, unzipDirectory=folder, modelIdentifier=identifier, instanceName="x")
        try:
            fmu.instantiate(loggingOn=True, logMessage=heard, **asked)
        except Exception:  # FMPy's own class for a null answer
            assert len(heard.texts) == 1 and part in heard.texts[0], heard.texts
        else:
            raise AssertionError(f"not refused: {part}")
    return "4 instances refused with the reason"


def main(truth_path, nav_path):
    truth, nav = slave(truth_path, "truth"), slave(nav_path, "nav")
    print(life_cycles(truth))
    print(states(truth))
    print(wrong_calls(truth, nav))
    print(instantiations(truth_path, truth.folder))
    truth.close()
    nav.fmu.freeInstance()


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
