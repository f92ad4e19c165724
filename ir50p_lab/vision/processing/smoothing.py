"""Smoothing with a Gaussian kernel: the one of (3.2), any other, and the convolution itself."""

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.inputs import number

KERNEL_3_2 = np.array([[2, 4, 5, 4, 2], [4, 9, 12, 9, 4], [5, 12, 15, 12, 5], [4, 9, 12, 9, 4], [2, 4, 5, 4, 2]]) / 159
KERNEL_3_2.setflags(write=False)


def gaussian_kernel(size, sigma):
    """exp(-(x^2 + y^2)/(2 sigma^2)) on `size` x `size` pixels, divided by its sum. size: odd; sigma > 0, pixels."""
    if size % 2 != 1:
        raise InputError(f"size = {size!r}: a kernel has a middle, give an odd number of pixels")
    x = np.arange(size) - size // 2
    kernel = np.exp(-(x[:, None] ** 2 + x**2) / (2 * number("sigma", sigma, "> 0", unit="px") ** 2))
    return kernel / kernel.sum()


def convolve(grey, kernel):
    """Convolution of a grey picture (h, w) with a kernel (odd, odd): (h, w) float; the border is mirrored.

    The kernel is turned by half a turn, as in the definition; for a symmetric one this makes no difference.
    """
    from scipy import ndimage

    grey, kernel = np.asarray(grey, dtype=float), np.asarray(kernel, dtype=float)
    if grey.ndim != 2 or kernel.ndim != 2 or kernel.shape[0] % 2 == 0 or kernel.shape[1] % 2 == 0:
        raise InputError(f"give a grey picture (h, w) and a kernel of odd size; got {grey.shape} and {kernel.shape}")
    return ndimage.convolve(grey, kernel, mode="mirror")
