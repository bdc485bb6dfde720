"""The widget that notebooks show: the modules of the page, and a session in the kernel that answers them."""

from typing import Any

import anywidget

from molviz.viewer.notebook import PAGE, joined
from molviz.viewer.session import Session


class ViewWidget(anywidget.AnyWidget):
    """One molecule to turn, style and save; notebooks that cannot run show it as SVG."""

    _esm = joined("notebook.js")
    _css = (PAGE / "viewer.css").read_text(encoding="utf-8")

    def __init__(self, session: Session) -> None:
        super().__init__()
        self._session = session
        self.on_msg(self._asked)

    def _asked(self, widget: object, question: object, buffers: object) -> None:
        head, body = self._session.answer(question)
        self.send(head, [body])

    def _repr_mimebundle_(self, **more: Any) -> Any:
        bundle = super()._repr_mimebundle_(**more)
        if bundle is not None:
            data = bundle[0] if isinstance(bundle, tuple) else bundle
            data["image/svg+xml"] = self._session.answer({"ask": "save", "format": "svg"}).body.decode()
        return bundle
