"""Rays from the middle of a ball outwards, and the colours of a picture along them."""

import cv2
import numpy as np

RAYS = 64
ANGLES = np.arange(RAYS) * (2 * np.pi / RAYS)
UNIT = np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])  # (rays, 2)


def cast(image, x, y, rho):
    """Return the colours (rays, m, 3) at distances rho (m,) px from (x, y) px.

    Also returns which of these places are in the picture, bool (rays, m).
    """
    px, py = x + rho * UNIT[:, :1], y + rho * UNIT[:, 1:]
    places = np.float32(px), np.float32(py)
    rgb = cv2.remap(image, *places, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    h, w = image.shape[:2]
    return rgb, (px >= -0.5) & (px <= w - 0.5) & (py >= -0.5) & (py <= h - 0.5)
