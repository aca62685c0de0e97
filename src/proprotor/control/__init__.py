"""Control: laws that lead sensors to actuators, with delays, as records that a model closes its loops with.

In come gains, transfer functions and state spaces, of other programs too; out go control loops. The room knows no
model: `model.closed_loop` puts loops into the equations of motion, `stability.margins` tells how far each one may
change.

    control_law    a law as state space, from gains, transfer functions, state spaces and objects that have them
    pade           a delay as a chain of all-pass sections, and the frequency up to which it is a delay
    control_loop   the record ControlLoop: sensors, law, gain, delay, actuator, inputs; its exact frequency response

The room may import the ground (`errors`, `typing`) and `rotor`.
"""

from proprotor.control.control_law import ControlLaw
from proprotor.control.control_loop import NUMBERS, ControlLoop, loop_text
from proprotor.control.pade import phase_limit, sections

__all__ = ["NUMBERS", "ControlLaw", "ControlLoop", "loop_text", "phase_limit", "sections"]
