"""Exact vector drawings and exact numbers of anything made of spheres."""
