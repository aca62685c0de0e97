"""M, C, K and B: the equations of motion of a rotor, of a support that carries one, and of both together.

In come a rotor, its operation and its support (`rotor`, `support`); out go linear models, alone or as part of a
configuration, and the stamp that every result has.

    linear_model         the record LinearModel: M q̈ + C q̇ + K q = B u about a trim, over a batch of points
    batches              shapes of batches, their points a few at a time, designs at many airspeeds, memory kept
    quantities           the numbers of rotor, operation and options by the names of the derivation
    inflow               induced velocity, added to the matrices of a rotor
    lift_lag             the lag of lift, added to the matrices of a rotor
    theodorsen           lift that lags by Theodorsen's function, at one frequency after the other
    wing_lift_lag        the lag of a wing's lift, added to a coupled model
    rotor_model          the rotor alone on its six hub coordinates, from the generated functions
    tilted_rotor         the rotor alone about a periodic trim, around the turn and averaged
    floquet              Floquet exponents beside the roots of the average
    rigid_propeller      a propeller with published whirl derivatives in place of a rotor
    blade_comparison     a hinged blade beside the elastic blade that it stands for
    mass_at_rest         the rotor's mass matrix at rest with locked blades
    rotor_share          the rotor's share, taken off a support whose masses include the rotor
    unit_doubts          doubts about the units of a structure from a file
    mount                one rotor on a support
    pair                 two mirrored rotors on an airframe, in symmetric and antisymmetric coordinates
    mast                 a mast that twists between a rotor and its engine
    several_rotors       several rotors on a support
    massless             motions that move no mass, which have no eigenvalue
    sensors              what a sensor reads, by its name
    closed_loop          control loops closed around a model
    first_order          which points and coordinates have states, and the state matrix
    state_space          A, B, C, D with names
    structural_damping   structural damping at which a model is neutrally stable
    side                 the left side of an aircraft where it differs from the right side
    configuration        the record Configuration: rotor, operation, support, sources; `linearize`
    amounts              what the inputs of a configuration amount to: Lock number, frequencies, couplings
    amount_rules         the range of each amount, and what a value outside suggests
    provenance           which numbers of a configuration were not read in a source
    doubts               marks and reasons of doubtful numbers
    options_in_force     the options of a model as plain data and in words
    deck_fingerprint     a short text that identifies a deck
    designs              how many designs a case stands for, and the inputs that vary
    stamp                the case, options and sources that a result carries
    html                 pieces of HTML for notebooks
    in_notebook          a case and a model as HTML
    options_of_result    options taken back from a result

The room may import the ground (`errors`, `typing`, `needs`, `units`, `datum`, `files`), `rotor`, `support` and
`control`. One deferred import goes down: `LinearModel.modes` calls `stability`.
"""

from proprotor.model.closed_loop import close_loops, taken_apart
from proprotor.model.configuration import Configuration
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.model.inflow import with_inflow
from proprotor.model.lift_lag import lagging_blade, with_lift_lag
from proprotor.model.linear_model import GUSTS, INPUTS, SWASHPLATE, LinearModel
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.massless import with_reasons
from proprotor.model.mast import with_mast
from proprotor.model.mount import mount
from proprotor.model.pair import mount_pair, rotors_on, shares
from proprotor.model.rotor_model import airload_moments, in_closed_form, rotor_model
from proprotor.model.side import Side
from proprotor.model.theodorsen import at_frequencies
from proprotor.model.wing_lift_lag import with_wing_lag

__all__ = [
    "GUSTS",
    "INPUTS",
    "SWASHPLATE",
    "Configuration",
    "LinearModel",
    "Side",
    "airload_moments",
    "amount_rules",
    "amounts",
    "at_frequencies",
    "batches",
    "blade_comparison",
    "close_loops",
    "deck_fingerprint",
    "doubts",
    "first_order",
    "floquet",
    "html",
    "in_closed_form",
    "lagging_blade",
    "mass_at_rest",
    "mount",
    "mount_pair",
    "options_in_force",
    "options_of_result",
    "provenance",
    "quantities",
    "rigid_propeller",
    "rotor_model",
    "rotor_share",
    "rotors_on",
    "sensors",
    "several_rotors",
    "shares",
    "stamp",
    "state_space",
    "structural_damping",
    "taken_apart",
    "unit_doubts",
    "with_inflow",
    "with_lift_lag",
    "with_mast",
    "with_reasons",
    "with_wing_lag",
]
