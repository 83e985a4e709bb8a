"""Renders a recorded run again and compares the renderings."""
