"""The table that all geometry starts from."""

from typing import NamedTuple

from molviz.arrays import Floats


class Spheres(NamedTuple):
    """n spheres; row i is atom i everywhere."""

    center: Floats  # (n, 3) ångström
    radius: Floats  # (n,) ångström
