"""How atoms are shown: as space-filling balls, as balls and sticks, as sticks alone, or not at all."""

from typing import NamedTuple

SPACEFILL, BALL_AND_STICK, STICKS, HIDE = "spacefill", "ball-and-stick", "sticks", "hide"
REPRESENTATIONS = (SPACEFILL, BALL_AND_STICK, STICKS, HIDE)
BALL_SCALE = 0.25  # of the space-filling radius: the balls of a bond are well apart, and hydrogens wider than sticks
USUAL_STICK = {BALL_AND_STICK: 0.15, STICKS: 0.2}  # ångström


class Sizes(NamedTuple):
    """How large balls and sticks are."""

    ball_scale: float = BALL_SCALE  # of the space-filling radius, in ball-and-stick
    stick_radius: float | None = None  # ångström; None: as usual for the representation

    def stick(self, representation: str) -> float:
        """Return the radius of a stick in ångström, for ``ball-and-stick`` or ``sticks``."""
        return USUAL_STICK[representation] if self.stick_radius is None else self.stick_radius


USUAL = Sizes()
