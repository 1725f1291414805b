"""Model of a camera chip with per-pixel coded exposure: light in, packed samples out, and back to video."""

from ._stipple import __version__

__all__ = ["__version__"]
