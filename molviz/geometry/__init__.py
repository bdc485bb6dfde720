"""Space without an eye: grid index, circles, free arcs, union boundary, measures."""
