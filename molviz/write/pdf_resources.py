"""What the operators of a PDF page call by name: gradients, opacities, and forms, which are painted as one."""

from collections.abc import Iterable, Sequence
from typing import Any

import pydyf

from molviz.picture.picture import Gradient, Picture
from molviz.write.font import Font, characters, font_of
from molviz.write.paint import shading
from molviz.write.pdf_font import embedded
from molviz.write.text import number


class SharedFont:
    """The font of all pages, with the characters of all their texts; added to the document once."""

    def __init__(self, pictures: Sequence[Picture]) -> None:
        wanted = frozenset[str]().union(*map(characters, pictures))
        self.font: Font | None = font_of(wanted) if wanted else None
        self.entries: dict[str, Any] | None = None

    def add_to(self, pdf: pydyf.PDF) -> dict[str, Any]:
        """Return the entries of a page's resources."""
        if self.entries is None:
            reference = self.font and embedded(pdf, self.font).reference
            self.entries = {"Font": pydyf.Dictionary({"F": reference})} if reference else {}
        return self.entries


class Resources:
    """Gathers names while operators are written; equal things have one name."""

    def __init__(self, picture: Picture, font: Font | None) -> None:
        self.box = pydyf.Array([0, 0, number(picture.width, 3), number(picture.height, 3)])
        self.shared = pydyf.Dictionary()  # what page and forms have in common
        self.forms: list[pydyf.Stream] = []
        self.names: dict[Any, str] = {}
        self.font = font  # with the characters of all texts

    def shading(self, gradient: Gradient) -> str:
        """Return the name of a gradient."""
        return self._name("Shading", gradient, shading(gradient))

    def opacity(self, value: float) -> str:
        """Return the name of the state in which fills, lines and groups have that opacity."""
        text = number(value, 4)
        return self._name("ExtGState", value, pydyf.Dictionary({"ca": text, "CA": text}))

    def _name(self, kind: str, key: Gradient | float, value: Any) -> str:
        if key not in self.names:
            entries = self.shared.setdefault(kind, pydyf.Dictionary())
            self.names[key] = f"{kind[0]}{len(entries)}"
            entries[self.names[key]] = value
        return f"/{self.names[key]}"

    def form(self, lines: Iterable[str], group: bool) -> str:
        """Return the name of a form of these operators, which paint in the colour that is set where it is called.

        A group is made opaque first and then let through as a whole: overlaps in it do not show.
        """
        content = [line.encode() for line in lines]
        entries = {"Type": "/XObject", "Subtype": "/Form", "BBox": self.box, "Resources": self.shared}
        if group:
            entries["Group"] = transparency_group()
        self.forms.append(pydyf.Stream(content, entries, compress=True))
        return f"/F{len(self.forms) - 1}"

    def add_to(self, pdf: pydyf.PDF) -> dict[str, Any]:
        """Add all forms to a document and return the entries of the page's resources."""
        for form in self.forms:
            pdf.add_object(form)
        forms = {f"F{row}": form.reference for row, form in enumerate(self.forms)}
        return {**self.shared, **({"XObject": pydyf.Dictionary(forms)} if forms else {})}

    def page_entries(self) -> dict[str, Any]:
        """Return what a page with opacities has to say: its colours mix as a screen's do, whatever a printer has."""
        return {"Group": transparency_group()} if "ExtGState" in self.shared else {}


def transparency_group() -> pydyf.Dictionary:
    """Return the attributes of a group that mixes in RGB."""
    return pydyf.Dictionary({"S": "/Transparency", "CS": "/DeviceRGB"})
