"""Files become molecules: one reader per format, chosen by content and suffix."""
