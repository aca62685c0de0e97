"""M, C, K and B: the equations of motion of a rotor, of a support that carries one, and of both together.

In come a rotor, its operation and its support (`rotor`, `support`); out go linear models, alone or as part of a
configuration, and the stamp that every result has.

    linear_model         the record LinearModel: M q̈ + C q̇ + K q = B u about a trim, over a batch of points
    quantities           the numbers of rotor, operation and options by the names of the derivation
    rotor_model          the rotor alone on its six hub coordinates, from the generated functions
    rigid_propeller      a propeller with published whirl derivatives in place of a rotor
    mass_at_rest         the rotor's mass matrix at rest with locked blades
    rotor_share          the rotor's share, taken off a support whose masses include the rotor
    mount                one rotor on a support
    several_rotors       several rotors on a support
    massless             motions that move no mass, which have no eigenvalue
    first_order          which points and coordinates have states, and the state matrix
    state_space          A, B, C, D with names
    structural_damping   structural damping at which a model is neutrally stable
    configuration        the record Configuration: rotor, operation, support, sources; `linearize`
    provenance           which numbers of a configuration were not read in a source
    doubts               marks and reasons of doubtful numbers
    options_in_force     the options of a model as plain data and in words
    deck_fingerprint     a short text that identifies a deck
    stamp                the case, options and sources that a result carries
    options_of_result    options taken back from a result

The room may import the ground (`errors`, `typing`, `needs`, `units`, `datum`, `files`), `rotor` and `support`. One
deferred import goes down: `LinearModel.modes` calls `stability`.
"""

from proprotor.model import doubts, first_order, options_in_force, stamp, state_space
from proprotor.model.configuration import Configuration
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.model.linear_model import INPUTS, SWASHPLATE, LinearModel
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.massless import with_reasons
from proprotor.model.mount import mount
from proprotor.model.options_of_result import check_options, options_of
from proprotor.model.provenance import doubtful_inputs, reservations
from proprotor.model.quantities import COUPLINGS, batch_shape, couplings, model_quantities, rotor_quantities
from proprotor.model.rigid_propeller import WhirlDerivatives, rigid_propeller, whirl_derivatives
from proprotor.model.rotor_model import in_closed_form, rotor_model
from proprotor.model.rotor_share import rotor_share, settled, spring_warnings, without_rotors
from proprotor.model.several_rotors import MountedRotor, mount_rotors
from proprotor.model.structural_damping import NeutralDamping, neutral_damping

__all__ = [
    "COUPLINGS",
    "INPUTS",
    "SWASHPLATE",
    "Configuration",
    "LinearModel",
    "MountedRotor",
    "NeutralDamping",
    "WhirlDerivatives",
    "batch_shape",
    "check_options",
    "couplings",
    "deck_fingerprint",
    "doubtful_inputs",
    "doubts",
    "first_order",
    "in_closed_form",
    "mass_at_rest",
    "model_quantities",
    "mount",
    "mount_rotors",
    "neutral_damping",
    "options_in_force",
    "options_of",
    "reservations",
    "rigid_propeller",
    "rotor_model",
    "rotor_quantities",
    "rotor_share",
    "settled",
    "spring_warnings",
    "stamp",
    "state_space",
    "whirl_derivatives",
    "with_reasons",
    "without_rotors",
]
