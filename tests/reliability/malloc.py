"""Makes every malloc() by Eigen and C libraries fail once, in turn, as faults.py does for
operator new."""
import faults


def study(rigcal, folder, size):
    return faults.study(rigcal, folder, "small" if size == "small" else "every", kinds=("malloc",))
