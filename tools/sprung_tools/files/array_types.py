"""Types of NumPy arrays, for annotations. Shapes stand in the doc comments."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.floating[Any]]
Integers = NDArray[np.integer[Any]]
Flags = NDArray[np.bool_]
ComplexNumbers = NDArray[np.complexfloating[Any, Any]]
