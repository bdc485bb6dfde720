"""What the eye sees: view, painter's pieces, hidden lines, visibility map."""
