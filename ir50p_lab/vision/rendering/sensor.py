"""From light on the sensor to the bytes of a picture: blur, noise, tone, JPEG."""

import numpy as np

_SPAN = 16  # sub-steps per pixel of the kernels


def blur(light, lens):
    """Light (h, w, 3) through the lens: out of focus, moved, softened, darker in the corners."""
    import cv2

    if lens.defocus > 0:
        light = cv2.filter2D(light, -1, disc(lens.defocus), borderType=cv2.BORDER_REPLICATE)
    if np.hypot(*lens.motion) > 0:
        light = cv2.filter2D(light, -1, streak(*lens.motion), borderType=cv2.BORDER_REPLICATE)
    if lens.sigma > 0:
        light = cv2.GaussianBlur(light, (0, 0), lens.sigma, borderType=cv2.BORDER_REPLICATE)
    if lens.vignetting > 0:
        h, w = light.shape[:2]
        y, x = np.arange(h)[:, None] - (h - 1) / 2, np.arange(w)[None, :] - (w - 1) / 2
        r2 = (x * x + y * y) / (w * w / 4 + h * h / 4)
        light = light * (1 - lens.vignetting * r2).astype(np.float32)[..., None]
    return light


def disc(diameter):
    """Kernel of a disc of this diameter, pixels, sum 1: a point out of focus."""
    n = int(np.ceil(diameter / 2 + 0.5))
    sub = (np.arange((2 * n + 1) * _SPAN) + 0.5) / _SPAN - n - 0.5
    radius = max(diameter / 2, 1 / _SPAN)  # at least the four places around the middle
    inside = (sub[:, None] ** 2 + sub[None, :] ** 2 <= radius**2).astype(float)
    kernel = inside.reshape(2 * n + 1, _SPAN, 2 * n + 1, _SPAN).sum(axis=(1, 3))
    return (kernel / kernel.sum()).astype(np.float32)


def streak(dx, dy):
    """Kernel of a straight move by (dx, dy) pixels while the shutter is open, sum 1, centred."""
    n = int(np.ceil(max(abs(dx), abs(dy)) / 2 + 1))
    kernel = np.zeros((2 * n + 1, 2 * n + 1))
    steps = max(2, int(_SPAN * np.hypot(dx, dy)))
    along = (np.arange(steps) + 0.5) / steps - 0.5
    x, y = along * dx + n, along * dy + n
    i, j = np.floor(y).astype(int), np.floor(x).astype(int)
    fy, fx = y - i, x - j
    for di, wy in ((0, 1 - fy), (1, fy)):
        for dj, wx in ((0, 1 - fx), (1, fx)):
            np.add.at(kernel, (i + di, j + dj), wy * wx)
    return (kernel / kernel.sum()).astype(np.float32)


def expose(light, sensor, rng):
    """Bytes (h, w, 3) of light (h, w, 3): exposure, noise, tone curve, JPEG."""
    light = light * np.float32(sensor.exposure)
    if sensor.read_noise > 0 or sensor.shot_noise > 0:
        light = np.minimum(light, 1.0)  # full wells
        sigma = np.sqrt(sensor.read_noise**2 + sensor.shot_noise**2 * np.maximum(light, 0))
        light = light + sigma * rng.standard_normal(light.shape, dtype=np.float32)
    image = sensor.developed(light)
    if sensor.jpeg is not None:
        image = through_jpeg(image, sensor.jpeg)
    return image


def through_jpeg(image, quality):
    """The picture after saving as JPEG of this quality (colour at half the resolution, as cameras do)."""
    import cv2

    _, data = cv2.imencode(".jpg", image[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, int(quality)])
    return np.ascontiguousarray(cv2.imdecode(data, cv2.IMREAD_COLOR)[..., ::-1])
