"""Simulation of cloth: scenes, models of arrays, frames as numpy arrays, pictures, errors, frame caches, comparison of pictures."""
from ._weft import *  # noqa: F401,F403
from ._weft import __version__  # noqa: F401
