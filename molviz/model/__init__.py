"""What is there: molecules, spheres, elements and radii, selection."""
