"""What hides: one module per kind of solid, with its silhouette curves and the half-spaces and quadrics behind it."""
