"""A picture becomes bytes: one writer per format, chosen by suffix."""
