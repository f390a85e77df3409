"""Elementary transforms, of which a chain is made."""

from .._core import ET

__all__ = ["ET"]
