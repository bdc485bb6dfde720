"""How colours look to eyes that lack one kind of cone.

G. M. Machado, M. M. Oliveira, L. A. F. Fernandes (2009) A physiologically-based model for simulation of color vision
deficiency. IEEE Trans. Vis. Comput. Graph. 15, 1291-1298: matrices of full severity, applied to linear sRGB.
"""

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.picture.oklab import color_of_light, linear_light, to_oklab

VISIONS = {
    "normal": np.eye(3),
    "deutan": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "protan": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "tritan": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}


def seen(color: Ints, vision: str) -> Ints:
    """The colours (..., 3) as such an eye sees them."""
    return color_of_light(linear_light(color) @ VISIONS[vision].T)


def distances(one: Ints, other: Ints, vision: str) -> Floats:
    """OKLab distance (n, m) of each of n colours to each of m."""
    gap = to_oklab(seen(one, vision))[:, None] - to_oklab(seen(other, vision))[None]
    return np.sqrt((gap**2).sum(axis=2))
