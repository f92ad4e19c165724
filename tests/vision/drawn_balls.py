"""Balls drawn by casting rays, sixteen a pixel: another route than the renderer of the package, for its tests."""

import numpy as np


def empty(size=(640, 480), colour=(0.2, 0.22, 0.25), grain=0.0, seed=0):
    """A background in linear light, (h, w, 3): one colour with some coarse grain."""
    width, height = size
    rng = np.random.default_rng(seed)
    tiles = 1 + grain * rng.normal(0, 1, (height // 8 + 1, width // 8 + 1, 1))
    return np.clip(np.kron(tiles, np.ones((8, 8, 1)))[:height, :width] * np.array(colour), 0, 1)


def add_ball(light, f, centre, radius, colour=(0.6, 0.02, 0.03), sun=(-0.5, -1.0, -0.8), ambient=0.4, fine=4):
    """Draw a ball in place: seen at pixel `centre`, `radius` pixels on the axis, camera of focal length f pixels."""
    height, width = light.shape[:2]
    cx, cy = (width - 1) / 2, (height - 1) / 2
    axis = np.array([(centre[0] - cx) / f, (centre[1] - cy) / f, 1.0])
    axis /= np.linalg.norm(axis)
    sine = np.sin(np.arctan(radius / f))
    x0, x1 = (int(np.clip(centre[0] + s * (1.5 * radius + 3), 0, width)) for s in (-1, 1))
    y0, y1 = (int(np.clip(centre[1] + s * (1.5 * radius + 3), 0, height)) for s in (-1, 1))
    steps = (np.arange(fine) + 0.5) / fine - 0.5
    x, y = np.meshgrid((np.arange(x0, x1)[:, None] + steps).ravel(), (np.arange(y0, y1)[:, None] + steps).ravel())
    ray = np.stack([(x - cx) / f, (y - cy) / f, np.ones_like(x)], axis=-1)
    ray /= np.linalg.norm(ray, axis=-1, keepdims=True)
    along = ray @ axis
    inside = along**2 - (1 - sine**2)
    normal = (ray * (along - np.sqrt(np.maximum(inside, 0)))[..., None] - axis) / sine
    sun = np.array(sun) / np.linalg.norm(sun)
    shade = ambient + (1 - ambient) * np.maximum(normal @ sun, 0)
    hit = (inside > 0)[..., None]
    paint = np.array(colour) * shade[..., None] * hit
    blocks = (y1 - y0, fine, x1 - x0, fine, -1)
    cover, paint = hit.reshape(blocks).mean(axis=(1, 3)), paint.reshape(blocks).mean(axis=(1, 3))
    light[y0:y1, x0:x1] = light[y0:y1, x0:x1] * (1 - cover) + paint
    return light


def add_polygon(light, corners, colour=(0.6, 0.02, 0.03), fine=4):
    """Fill a polygon (n, 2) pixels in place, smoothed at its border."""
    import cv2

    height, width = light.shape[:2]
    mask = np.zeros((height * fine, width * fine), np.uint8)
    cv2.fillPoly(mask, [np.round((np.asarray(corners) + 0.5) * fine - 0.5).astype(np.int32)], 255)
    cover = cv2.resize(mask, (width, height), interpolation=cv2.INTER_AREA)[..., None] / 255
    light[:] = light * (1 - cover) + np.array(colour) * cover
    return light


def circle_corners(centre, radius, n=90, turn=0.0):
    """Corners (n, 2) of a regular polygon."""
    angle = turn + np.arange(n) * 2 * np.pi / n
    return np.array(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def photograph(light, *, blur=0.8, noise=3.0, jpeg=None, seed=0):
    """Bytes of linear light: a little blur, gamma, noise (grey levels), and JPEG if asked."""
    import cv2

    rng = np.random.default_rng(seed)
    light = cv2.GaussianBlur(light, (0, 0), blur)
    levels = 255 * np.clip(light, 0, 1) ** (1 / 2.2) + rng.normal(0, noise, light.shape)
    picture = np.clip(np.rint(levels), 0, 255).astype(np.uint8)
    if jpeg:
        data = cv2.imencode(".jpg", picture[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, jpeg])[1]
        picture = np.ascontiguousarray(cv2.imdecode(data, cv2.IMREAD_COLOR)[..., ::-1])
    return picture
