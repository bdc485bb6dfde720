"""How near counts as equal in the geometry of balls; every tolerance with its reason."""

TOUCH = 1e-10
"""Balls overlapping by less than this share of the smaller radius are apart, and a ball that sticks out of another
by less lies inside it. A cap that thin has less than 1e-9 Å² for radii of a few Å, while its circle, of radius
r √(2 · 1e-10), is still wide enough for angles on it to be good to 1e-10."""

COINCIDE = 1e-8
"""Creases of one sphere whose planes differ by less (in radii, and in radians of tilt) are one circle, and the tie rule
of ``boundary`` decides. Where two such circles cross is known to 1e-16 / 1e-8 at best: here the error of measuring a
near coincidence equals that of ignoring it."""

SINGLE = 4e-6
"""Rounding in single precision of sums of five products of cosines is below 1e-6; what the pre-tests of ``caps``
decide, they decide by a wider margin than that."""

SHORT = 1e-10
"""Arcs shorter than this share of a radius are in doubt: their ends, good to 1e-15, would give directions between them
to five digits only, and a face as small as that has no area (1e-20)."""

CLUSTER = 1e-6
"""Probes that arcs shorter than this share of their radius connect do not cut each other (their circle is wider than
the probe): the direction from one to the other is known to 1e-15 / 1e-6, and what decides is of the order of 1e-6."""
