"""Franklin's SPHERES (1980): opaque discs ordered by depth, their grid, visible arcs and regions."""
