"""Keep the memory that numpy gives back.

glibc returns arrays above 128 kB to the system at once, and every new one of that size is paid for with page faults:
on a machine with other work they double the time of factoring 32 cells.
"""

import ctypes
import sys

M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3
KEPT_BYTES = 64 * 2**20


def keep_freed_memory() -> bool:
    """Ask the allocator of this process to keep freed memory; False where that is not glibc's."""
    if not sys.platform.startswith("linux"):
        return False
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is None:
        return False
    return bool(mallopt(M_MMAP_THRESHOLD, KEPT_BYTES // 2) and mallopt(M_TRIM_THRESHOLD, KEPT_BYTES))
