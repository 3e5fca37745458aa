"""Makes every x86-64 machine compute the same bits.

NumPy and OpenBLAS choose their kernels by the processor they find, and each kernel sums in its own
order. The asset's hash must not depend on that, so the build runs itself again with the choice
fixed: one thread, OpenBLAS's Haswell kernels, NumPy's baseline kernels.
"""

import os
import sys

FIXED = {
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_CORETYPE": "Haswell",
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",
    "PYTHONHASHSEED": "0",
    "PYTHONWARNINGS": "ignore::ImportWarning",
}


def run_again_with_fixed_kernels():
    """Replaces this process by one in the fixed environment; returns if it is already there."""
    if all(os.environ.get(name) == value for name, value in FIXED.items()):
        return
    os.environ.update(FIXED)
    os.execv(sys.executable, [sys.executable, *sys.argv])
