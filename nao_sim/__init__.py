"""A person moves; a NAO H25 does the same, safely, in MuJoCo physics."""

__version__ = "0.1.0"
