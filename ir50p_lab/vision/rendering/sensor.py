"""From light on the sensor to the bytes of a picture: noise, tone, JPEG."""

import numpy as np


def expose(light, sensor, rng):
    """Bytes (h, w, 3) of light (h, w, 3): exposure, noise, tone curve, JPEG."""
    import cv2

    light = light * np.float32(sensor.exposure)
    light = np.minimum(light, 1.0)  # full wells
    sigma = np.sqrt(sensor.read_noise**2 + sensor.shot_noise**2 * np.maximum(light, 0))
    light = light + sigma * rng.standard_normal(light.shape, dtype=np.float32)
    image = sensor.developed(light)
    if sensor.jpeg is not None:  # colour at half the resolution, as cameras save it
        _, data = cv2.imencode(".jpg", image[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, int(sensor.jpeg)])
        image = np.ascontiguousarray(cv2.imdecode(data, cv2.IMREAD_COLOR)[..., ::-1])
    return image
