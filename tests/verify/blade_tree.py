"""The rotor as a tree of rigid bodies carrying point masses, and its small motions about steady rotation.

Pinocchio does the dynamics; this module only says what hangs on what:

    hub x, y, z · hub αx, αy, αz · yoke tilt (two axes, not spinning) · spin ─┬─ flap ── lag      blade 1
                                                                              ├─ flap ── lag      blade 2
                                                                              ⋮

The tilts precede the spin, which makes the two-axis joint a constant-velocity one: the blades spin in the
tilted yoke. Each joint has one coordinate, so the engine's tangent derivatives are plain partial derivatives.
Successive rotations and the rotation vectors of hub and gimbal agree to first order; at second order they
differ by a rotation, whose stiffness is the steady moment at the hub. The inertia forces of N ≥ 3 like blades
have none.
"""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

X, Y, Z = np.eye(3)

# Joint names are those of the coordinates they carry. β_GS tilts about +I, β_GC about −J.
HUB_JOINTS = {
    "x": pin.JointModelPX(),
    "y": pin.JointModelPY(),
    "z": pin.JointModelPZ(),
    "alpha_x": pin.JointModelRX(),
    "alpha_y": pin.JointModelRY(),
    "alpha_z": pin.JointModelRZ(),
    "gimbal_1s": pin.JointModelRX(),
    "gimbal_1c": pin.JointModelRevoluteUnaligned(-Y),
    "azimuth": pin.JointModelRZ(),
}
FLAP = pin.JointModelRX()  # about +i, which lifts the tip towards k
LAG = pin.JointModelRevoluteUnaligned(-Z)  # swings the tip from j towards +i, against the rotation


@dataclass(frozen=True)
class PointMassBlade:
    """Point masses at radii r: on the yoke up to the flap hinge, on the lag body beyond the lag hinge."""

    radii: np.ndarray
    masses: np.ndarray
    flap_hinge_offset: float
    lag_hinge_offset: float
    precone: float

    def mass_integrals(self):
        """The seven integrals, exact for point masses, by the names `proprotor.Rotor` gives them."""
        r, m = self.radii, self.masses
        flap_arm = np.maximum(r - self.flap_hinge_offset, 0.0)
        lag_arm = np.maximum(r - self.lag_hinge_offset, 0.0)
        return {
            "blade_mass": np.sum(m),
            "blade_first_moment": np.sum(m * r),
            "blade_inertia": np.sum(m * r**2),
            "flap_first_moment": np.sum(m * flap_arm),
            "flap_inertia": np.sum(m * flap_arm**2),
            "lag_first_moment": np.sum(m * lag_arm),
            "lag_inertia": np.sum(m * lag_arm**2),
        }


def blade_azimuths(n_blades):
    """Azimuths of the blades ahead of the shaft's."""
    return 2.0 * np.pi * np.arange(n_blades) / n_blades


def blade_tree(blade, n_blades, hub_joints=HUB_JOINTS):
    """The rotor as a Pinocchio model, each point mass marked by a frame named after its blade and number."""
    tree = pin.Model()
    tree.gravity.setZero()
    joint = 0
    for name, kind in hub_joints.items():
        joint = tree.addJoint(joint, kind, pin.SE3.Identity(), name)
    for number, azimuth in enumerate(blade_azimuths(n_blades)):
        _add_blade(tree, joint, blade, number, azimuth)
    return tree


def _add_blade(tree, spin, blade, number, azimuth):
    """Hang one blade on the spin joint; its axes are x trailing (i), y outboard and z up (k at zero cone)."""
    inboard, outboard = blade.flap_hinge_offset, blade.lag_hinge_offset
    # At zero azimuth the blade lies along I and is trailed by i = −J.
    root = pin.SE3(_rotation(Z, azimuth - np.pi / 2) @ _rotation(X, blade.precone), np.zeros(3))
    flap = tree.addJoint(spin, FLAP, root * _along_blade(inboard), f"flap[{number}]")
    lag = tree.addJoint(flap, LAG, _along_blade(outboard - inboard), f"lag[{number}]")
    for point, (r, mass) in enumerate(zip(blade.radii, blade.masses, strict=True)):
        if r <= inboard:
            joint, place = spin, root * _along_blade(r)
        elif r <= outboard:
            joint, place = flap, _along_blade(r - inboard)
        else:
            joint, place = lag, _along_blade(r - outboard)
        tree.appendBodyToJoint(joint, pin.Inertia(mass, np.zeros(3), np.zeros((3, 3))), place)
        tree.addFrame(pin.Frame(f"mass[{number}, {point}]", joint, place, pin.FrameType.OP_FRAME))


def _along_blade(distance):
    return pin.SE3(np.eye(3), distance * Y)


def _rotation(axis, angle):
    return pin.AngleAxis(angle, axis).toRotationMatrix()


def coordinate_names(tree):
    return list(tree.names)[1:]  # the first is the inertial frame


def steady_rotation(tree, rotor_speed, azimuth, coning, lag):
    """Position and velocity of the rotor turning steadily, hub still and blades at their trim angles."""
    trim = {"azimuth": azimuth, "flap": coning, "lag": lag}
    q = np.array([trim.get(name.split("[")[0], 0.0) for name in coordinate_names(tree)])
    v = np.array([rotor_speed * (name == "azimuth") for name in coordinate_names(tree)])
    return q, v


def steady_loads(tree, rotor_speed, azimuth, coning, lag):
    """Generalised inertia forces of steady rotation by coordinate, with the sign of mass × acceleration."""
    q, v = steady_rotation(tree, rotor_speed, azimuth, coning, lag)
    data = tree.createData()
    loads = pin.rnea(tree, data, q, v, np.zeros(tree.nv)).tolist()
    return dict(zip(coordinate_names(tree), loads, strict=True))


def rotating_matrices(tree, rotor_speed, azimuth, coning, lag):
    """M, C, K at one azimuth, blade by blade: acceleration, rate and position derivatives of the loads."""
    q, v = steady_rotation(tree, rotor_speed, azimuth, coning, lag)
    data = tree.createData()
    pin.computeRNEADerivatives(tree, data, q, v, np.zeros(tree.nv))
    # Copies, for the engine's arrays do not outlive its data.
    return data.M.copy(), data.dtau_dv.copy(), data.dtau_dq.copy()


def blade_modes(n_blades, azimuth, derivative=0):
    """Multiblade columns by name, one row a blade, or a derivative of them with respect to azimuth.

    After the collective 0 and the cyclic 1c, 1s come the reactionless: 2c, 2s … and, for an even number, d.
    """
    psi = azimuth + blade_azimuths(n_blades)
    turned = derivative * np.pi / 2  # each derivative of a sine or cosine is a quarter turn
    steady = float(derivative == 0)
    columns = {"0": steady * np.ones(n_blades)}
    for n in range(1, (n_blades - 1) // 2 + 1):
        columns[f"{n}c"] = n**derivative * np.cos(n * psi + turned)
        columns[f"{n}s"] = n**derivative * np.sin(n * psi + turned)
    if n_blades % 2 == 0:
        columns["d"] = steady * (-1.0) ** np.arange(n_blades)
    return columns


def multiblade_transform(tree, n_blades, azimuth, derivative=0):
    """B(ψ) of q_blade = B q, or a derivative of it: {multiblade coordinate: column}."""
    rows = {name: row for row, name in enumerate(coordinate_names(tree))}
    columns = {name: float(derivative == 0) * np.eye(tree.nv)[rows[name]] for name in HUB_JOINTS}
    for hinge in ("flap", "lag"):
        blades = [rows[f"{hinge}[{number}]"] for number in range(n_blades)]
        for mode, amplitudes in blade_modes(n_blades, azimuth, derivative).items():
            columns[f"{hinge}_{mode}"] = np.zeros(tree.nv)
            columns[f"{hinge}_{mode}"][blades] = amplitudes
    return columns


def multiblade_matrices(tree, n_blades, rotor_speed, azimuth, coning, lag):
    """Names, M, C, K in multiblade coordinates with virtual-work rows, the reactionless ones included."""
    M, C, K = rotating_matrices(tree, rotor_speed, azimuth, coning, lag)
    transforms = [multiblade_transform(tree, n_blades, azimuth, derivative) for derivative in range(3)]
    B, dB, ddB = (np.column_stack(list(columns.values())) for columns in transforms)
    W = rotor_speed
    return (
        list(transforms[0]),
        B.T @ M @ B,
        B.T @ (2 * W * M @ dB + C @ B),
        B.T @ (W**2 * M @ ddB + W * C @ dB + K @ B),
    )
