"""Other programs and methods that solve the same loops, each tuned for these cases, behind one small interface.

Importing the package asks the linear algebra libraries for one thread, before anything loads them.
"""

import os

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")
