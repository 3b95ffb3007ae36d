"""Between pan, tilt and roll and the rotations of other programs: Euler angles of any order, matrices, quaternions.

Here y is up, and a camera that is not turned looks along -z, as in Nuke, USD and glTF; matrices are for columns, so
that M @ v turns v. A head pans about the upright axis, tilts about the axis that the pan has turned, and rolls about
the lens: M = Ry(-pan) Rx(tilt) Rz(-roll), because pan + is right, tilt + is up, roll + is clockwise from behind.
As Euler angles that is the order ZXY: about z first, then x, then y. Source: Foundry's reference of the Camera node
(rotation order), and the formula of the three elementary rotations.

The way back has two answers for every attitude (pan + 180, 180 - tilt, roll + 180 is the same one), and each angle may
have whole turns: the answer nearest to the frame before is taken. Straight up and down pan and roll turn about one
axis: there the roll stays as it was.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from teleop.planner.polynomial import Array

ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
HEAD = "ZXY"
LOCKED = 1e-9  # of the cosine of the tilt: nearer to straight up, nothing tells pan from roll
SQUARE = 1e-3  # that a rotation may be off a right angle, or a unit of length, after its scale is taken away

Matrices = NDArray[np.float64]  # (n, 3, 3)


def _about(axis: str, degrees: Array) -> Matrices:
    angle = np.radians(degrees)
    cos, sin = np.cos(angle), np.sin(angle)
    index = "XYZ".index(axis)
    first, second = (index + 1) % 3, (index + 2) % 3
    matrix = np.zeros((len(angle), 3, 3))
    matrix[:, index, index] = 1.0
    matrix[:, first, first] = matrix[:, second, second] = cos
    matrix[:, second, first], matrix[:, first, second] = sin, -sin
    return matrix


def euler_matrices(x: Array, y: Array, z: Array, order: str = HEAD) -> Matrices:
    """Of Euler angles in degrees: the first letter of the order turns first."""
    angles = {"X": x, "Y": y, "Z": z}
    first, second, third = (_about(letter, angles[letter]) for letter in order)
    return third @ second @ first


def head_matrices(pan: Array, tilt: Array, roll: Array) -> Matrices:
    """Of a head's angles in degrees."""
    return euler_matrices(tilt, -pan, -roll)


def z_up(matrices: Matrices) -> Matrices:
    """The same attitudes where z is up and a camera that is panned by 0 looks along +y, as in Blender."""
    return np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]) @ matrices


def y_up(matrices: Matrices) -> Matrices:
    """The way back of `z_up`."""
    return np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]) @ matrices


def pure(matrices: Matrices) -> Matrices:
    """Without the scale of each axis. Raises ValueError where one is no rotation: mirrored, sheared or empty."""
    with np.errstate(all="ignore"):
        lengths = np.linalg.norm(matrices, axis=1, keepdims=True)
        scaled = matrices / lengths
        off = np.abs(np.swapaxes(scaled, 1, 2) @ scaled - np.eye(3)).max(axis=(1, 2))
        good = np.isfinite(off) & (off < SQUARE) & (np.linalg.det(np.nan_to_num(scaled)) > 0)
    if not good.all():
        raise ValueError(f"its rotation is mirrored, sheared or empty in row {int(np.argmin(good)) + 1}")
    left, _, right = np.linalg.svd(scaled)
    return left @ right


def head_angles(matrices: Matrices, start: tuple[float, float, float] | None = None) -> tuple[Array, Array, Array]:
    """Pan, tilt, roll (n,) in degrees; of rotations in exact arithmetic they are exact.

    `start` is where the first is near, for heads that begin in another turn, or upside down.
    """
    flat = np.hypot(matrices[:, 1, 0], matrices[:, 1, 1])
    tilts = np.degrees(np.arctan2(-matrices[:, 1, 2], flat))
    pans = -np.degrees(np.arctan2(matrices[:, 0, 2], matrices[:, 2, 2]))
    rolls = -np.degrees(np.arctan2(matrices[:, 1, 0], matrices[:, 1, 1]))
    last = start or (float(pans[0]), float(tilts[0]), float(rolls[0]))
    found = np.empty((len(matrices), 3))
    for place, (matrix, level) in enumerate(zip(matrices, flat.tolist(), strict=True)):
        angles = (float(pans[place]), float(tilts[place]), float(rolls[place]))
        if level < LOCKED:
            angles = _locked(matrix, angles[1], last[2])
        last = _nearest(angles, last)
        found[place] = last
    return found[:, 0], found[:, 1], found[:, 2]


def _locked(matrix: NDArray[np.float64], tilt: float, roll: float) -> tuple[float, float, float]:
    """Straight up or down: the roll is what it was, and the pan the rest."""
    level = matrix @ _about("Z", np.array([roll]))[0]
    return -float(np.degrees(np.arctan2(-level[2, 0], level[0, 0]))), tilt, roll


def _nearest(angles: tuple[float, float, float], last: tuple[float, float, float]) -> tuple[float, float, float]:
    pan, tilt, roll = angles
    answers = [
        tuple(angle + 360.0 * round((before - angle) / 360.0) for angle, before in zip(answer, last, strict=True))
        for answer in (angles, (pan + 180.0, 180.0 - tilt, roll + 180.0))
    ]
    best = min(answers, key=lambda answer: sum(abs(angle - before) for angle, before in zip(answer, last, strict=True)))
    return best[0], best[1], best[2]


def quaternions(matrices: Matrices) -> Array:
    """Unit quaternions w, x, y, z (n, 4), each on the side of the one before, so that what is between stays short."""
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(matrices).as_quat().T
    found = np.array([w, x, y, z]).T
    flips = np.cumprod(np.where((found[1:] * found[:-1]).sum(axis=1) < 0, -1.0, 1.0))
    found[1:] *= flips[:, None]
    return found


def quaternion_matrices(values: Array) -> Matrices:
    """Of quaternions w, x, y, z (n, 4). Raises ValueError for one that has no length."""
    from scipy.spatial.transform import Rotation

    lengths = np.linalg.norm(values, axis=1)
    if not (np.isfinite(lengths) & (lengths > SQUARE)).all():
        raise ValueError("a quaternion has no length")
    return Rotation.from_quat(np.roll(values, -1, axis=1)).as_matrix()
