"""The page: a display list of exact arcs, and how its parts look."""
