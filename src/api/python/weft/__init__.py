"""Simulation of cloth: scenes, models of arrays, frames as numpy arrays, pictures, errors, frame caches, comparison of pictures."""
import reprlib as _reprlib

from . import _weft
from ._weft import *  # noqa: F401,F403
from ._weft import __version__  # noqa: F401


def _repr(self):
    """The properties; arrays by their shape, other long values shortened."""
    values = {name: getattr(self, name) for name, member in vars(type(self)).items() if isinstance(member, property)}
    texts = (f"{name}={getattr(value, 'shape', None) or _reprlib.repr(value)}" for name, value in values.items())
    return f"weft.{type(self).__name__}({', '.join(texts)})"


for _class in vars(_weft).values():
    if isinstance(_class, type):
        _class.__module__ = "weft"  # the module that programs import
        if _class.__repr__ is _weft.Scene.__base__.__repr__:
            _class.__repr__ = _repr
