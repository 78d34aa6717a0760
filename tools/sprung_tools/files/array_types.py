"""Types of NumPy arrays, for annotations. Shapes stand in the doc comments."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int_]
Flags = NDArray[np.bool_]
