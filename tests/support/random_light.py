"""Light, lens and sensor drawn at random: overcast day to desk lamp, sharp to shaken, clean to noisy."""

import numpy as np

from ir50p_lab.vision.rendering.rays import rays_through
from ir50p_lab.vision.rendering.render import RayTracer, table_light
from ir50p_lab.vision.rendering.scene import Lamp, Sky, Sun
from tests.support.desk import ShakenLens, WebcamSensor, WindowSun


def warm(amount):
    """Colour (3,) of light: 0 neutral, 1 a filament lamp (about 2700 K against 6500 K), -0.5 blue sky."""
    return (1.0 + 0.15 * amount, 1.0 - 0.12 * amount, 1.0 - 0.52 * amount)


def random_lights(rng, position):
    """Lights of one of five rooms: overcast, ceiling, sunlight, desk lamp, window and lamp."""
    x, y = position[:2]
    room = str(rng.choice(["overcast", "ceiling", "sunlight", "lamp", "mixed"], p=[0.15, 0.25, 0.25, 0.2, 0.15]))
    azimuth = rng.uniform(0, 2 * np.pi)
    height = rng.uniform(0.35, 1.5)  # of a sun over the horizon, tangent
    towards = (np.cos(azimuth), np.sin(azimuth), height)
    lamp = Lamp(
        position=(x + rng.uniform(-0.6, 0.6), y + rng.uniform(-0.6, 0.6), rng.uniform(0.3, 0.9)),
        colour=warm(rng.uniform(0.3, 1.0)),
        strength=rng.uniform(0.15, 0.6),
        size=rng.uniform(0.02, 0.08),
    )
    if room == "overcast":
        return (
            Sky(strength=0.85, colour=warm(rng.uniform(-0.3, 0.1))),
            Sun(towards=towards, strength=0.15, softness=0.6),
        )
    if room == "ceiling":
        high = (0.5 * np.cos(azimuth), 0.5 * np.sin(azimuth), 1.0)
        return (Sky(strength=0.5, colour=warm(rng.uniform(0, 0.5))), Sun(towards=high, strength=0.5, softness=0.15))
    if room == "sunlight":
        # the shadow of a window frame may cross the table
        edge = None
        if rng.random() < 0.4:
            angle = rng.uniform(0, 2 * np.pi)
            through = np.cos(angle) * x + np.sin(angle) * y + rng.uniform(-0.1, 0.1)
            edge = (angle, through, rng.uniform(0.003, 0.04))
        sun = WindowSun(
            towards=towards, strength=rng.uniform(0.6, 1.2), colour=warm(rng.uniform(0, 0.4)), softness=0.01, edge=edge
        )
        return (Sky(strength=rng.uniform(0.15, 0.35), colour=warm(rng.uniform(-0.5, 0))), sun)
    if room == "lamp":
        return (Sky(strength=rng.uniform(0.08, 0.3), colour=warm(rng.uniform(0, 0.6))), lamp)
    window = Sun(towards=towards, strength=0.4, colour=warm(rng.uniform(-0.5, 0)), softness=0.3)
    return (Sky(strength=0.3), window, lamp)


def random_lens(rng, radius, size):
    """Blur for a ball of this radius, pixels: at most a quarter of it, and 5 pixels of a VGA picture."""
    pixel = size[0] / 640  # a larger picture of the same shake
    most = min(0.25 * radius, 5.0 * pixel)
    motion = (0.0, 0.0)
    if rng.random() < 0.25:
        length, angle = rng.uniform(0, most), rng.uniform(0, np.pi)
        motion = (length * np.cos(angle), length * np.sin(angle))
    return ShakenLens(
        defocus=rng.uniform(0, most) if rng.random() < 0.4 else 0.0,
        motion=motion,
        sigma=rng.uniform(0.35, 0.9),
        vignetting=rng.uniform(0, 0.35),
    )


def random_sensor(rng, scene, position):
    """Exposure, white balance, noise, JPEG: an automatic that is nearly right.

    The light of the picture is brought to a middle grey, up to 0.9 stops off either way; the colour of the light around
    the ball is taken out to between 40 and 100 %.
    """
    angle = np.arange(12) * 2.4
    ring = 0.03 + 0.02 * np.arange(12)
    lit = table_light(scene, position[0] + ring * np.cos(angle), position[1] + ring * np.sin(angle)).mean(axis=0)
    balance = (lit.mean() / lit) ** rng.uniform(0.4, 1.0)
    # square roots, as the tone curve about does: a window in the corner does not darken everything
    exposure = 0.2 / np.sqrt(sparse_light(scene)).mean() ** 2 * 2.0 ** rng.uniform(-0.9, 0.9)
    return WebcamSensor(
        exposure=float(exposure),
        balance=tuple(map(float, balance * 1.05 ** rng.normal(0, 1, 3))),
        read_noise=rng.uniform(0.001, 0.008),
        shot_noise=rng.uniform(0.005, 0.03),
        mosaic=bool(rng.random() < 0.5),
        sharpen=rng.uniform(0, 0.8) if rng.random() < 0.5 else 0.0,
        saturation=rng.uniform(0.8, 1.3),
        jpeg=int(rng.integers(50, 98)) if rng.random() < 0.8 else None,
    )


def sparse_light(scene, across=16, down=12):
    """Light (n, 3) along a few rays spread over the picture: what an exposure meter sees."""
    w, h = scene.pinhole.size
    x, y = np.meshgrid((np.arange(across) + 0.5) / across * w - 0.5, (np.arange(down) + 0.5) / down * h - 0.5)
    return RayTracer(scene).trace(rays_through(scene.pinhole, x.ravel(), y.ravel()))[0]
