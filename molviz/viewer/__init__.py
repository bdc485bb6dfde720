"""Turn it in your hands: a page, in the browser or in a notebook, that asks for pictures; a preview in a terminal."""
