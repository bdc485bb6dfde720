"""How many digits of results are told: those that are the same whatever processor and numpy computed them.

Sines, cosines and their inverses differ in the last bit from one version of numpy to the next, sums and square roots
do not. What is told has far fewer digits than doubles, and far more than the displacement of drawings leaves certain.
"""

import math

import numpy as np

from molviz.arrays import Floats

LENGTH_DIGITS = 7  # decimals of ångström, or of the unit that a scene is drawn in, and of its square
ANGLE_DIGITS = 8  # decimals of radians
DIRECTION_DIGITS = 12  # decimals of unit vectors
MEASURE_DIGITS = 10  # significant digits of volumes, and of the largest of several areas
SUM_DIGITS = 15  # significant digits of sums of numbers that were rounded


def rounded(values: Floats, digits: int, unit: float = 1.0) -> Floats:
    """Return numbers with so many decimals, times ``unit``; zero has no sign."""
    return np.asarray((np.round(values, digits) + 0.0) * unit)


def significant(value: float, digits: int = MEASURE_DIGITS) -> float:
    """Return a measure with as many digits as are told."""
    return float(f"{value:.{digits}g}")


def shares(values: Floats) -> Floats:
    """Return areas (n,) with the decimals that the largest is told with, so that they add up to what is told."""
    largest = float(np.max(values, initial=0.0))
    return values if largest <= 0 else np.round(values, MEASURE_DIGITS - 1 - math.floor(math.log10(largest)))


def total(values: Floats) -> float:
    """Return the sum of rounded numbers."""
    return significant(float(np.sum(values)), SUM_DIGITS)
