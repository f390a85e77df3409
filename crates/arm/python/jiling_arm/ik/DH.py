"""Rows of Denavit-Hartenberg parameters, of which a chain is made."""

from .._core import DHLink

__all__ = ["DHLink"]
