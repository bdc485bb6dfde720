"""Every stage in order: one module per thing a user can ask for."""
