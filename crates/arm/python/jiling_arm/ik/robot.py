"""Arms: where their tool is, and the joint values that bring it somewhere."""

from .._core import Robot, create_so101_5dof

__all__ = ["Robot", "create_so101_5dof"]
