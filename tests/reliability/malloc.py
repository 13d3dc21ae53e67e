"""Every malloc() by Eigen and by libraries in C fails once, in turn: as in faults.py, where operator new does."""
import faults


def study(rigcal, folder, size):
    return faults.study(rigcal, folder, "small" if size == "small" else "every", kinds=("malloc",))
