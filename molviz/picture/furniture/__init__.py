"""What stands beside a molecule: labels, legend, scale bar, title, laid out together."""

from molviz.picture.furniture.box import Box
from molviz.picture.furniture.labels import Label
from molviz.picture.furniture.layout import ROUND, Furnished, Furniture, furnish
from molviz.picture.furniture.legend import Ramp, Swatches

__all__ = ["ROUND", "Box", "Furnished", "Furniture", "Label", "Ramp", "Swatches", "furnish"]
