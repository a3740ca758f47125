"""One constructor for each of the library's models, made when the package is imported.

_models.pyi, which tells type checkers and editors their parameters, is made from the same table when the package is built.

SPDX-License-Identifier: MIT
"""
from ._table import MODELS

globals().update(MODELS)
__all__ = list(MODELS)
