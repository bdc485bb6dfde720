"""Every stage in order: one module per command."""
