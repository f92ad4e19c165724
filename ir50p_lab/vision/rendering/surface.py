"""What surfaces look like in even white light: the table's texture, patches on it, the room behind."""

import functools

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.vision.rendering.colours import light_of

_TILE = 512


def table_albedo(table, patches, X, Y, seed):
    """Linear colours (n, 3) of the table at X, Y (n,) m and a code (n,) of what lies there (for edges)."""
    c, s = np.cos(table.angle), np.sin(table.angle)
    shade, edges = table.grained((c * X + s * Y) / table.grain, (c * Y - s * X) / table.grain, seed)
    albedo = np.clip(shade[:, None], 0.1, 1.9) * light_of(table.colour).astype(np.float32)
    code = np.full(X.shape, edges, dtype=np.int16)
    for number, patch in enumerate(patches):
        reach = 0.75 * np.float32(np.hypot(*patch.size))
        x, y = X - np.float32(patch.position[0]), Y - np.float32(patch.position[1])
        near = np.flatnonzero((np.abs(x) < reach) & (np.abs(y) < reach))
        where = near[_inside(patch, x[near], y[near])]
        albedo[where] = light_of(patch.colour) * np.clip(1 + 0.15 * (shade[where, None] - 1), 0.5, 1.5)
        code[where] = (number + 2) % 60
    return np.minimum(albedo, 0.95), code


def _inside(patch, x, y):
    """Whether the points x, y (n,) m from its middle are on the patch."""
    c, s = np.cos(patch.angle), np.sin(patch.angle)
    u, v = (c * x + s * y) / (patch.size[0] / 2), (c * y - s * x) / (patch.size[1] / 2)
    if patch.outline == "rectangle":
        return (np.abs(u) <= 1) & (np.abs(v) <= 1)
    if patch.outline == "blob":
        rng = np.random.default_rng([int(patch.seed), 7])
        angle, rim = np.arctan2(v, u), np.ones(len(u))
        for k in range(2, 6):
            rim += rng.uniform(-0.3, 0.3) / k * np.cos(k * angle + rng.uniform(0, 2 * np.pi))
        return np.hypot(u, v) <= np.minimum(rim, 1.4)
    raise InputError(f"outline {patch.outline!r} of a patch: give 'rectangle' or 'blob'")


def room_light(table, rays_x, rays_y, seed):
    """Linear colours (n, 3) of the room behind the table: broad blurred areas, by direction x, y of the rays."""
    colour = light_of(table.room).astype(np.float32)
    areas = [noise("broad", seed + 11 * i, 220 * rays_x + 60 * i, 220 * rays_y) for i in range(3)]
    # mostly light and dark, a little colour
    tint = np.exp(np.stack([0.4 * areas[0] + 0.12 * a for a in (areas[1], 0.3 * areas[2], -areas[1])], axis=-1))
    return np.clip(tint, 0.1, 2.2) * colour


_SPECTRA = {"broad": 2.2, "soft": 1.4, "rough": 0.6}  # amplitude falls with frequency to this power


@functools.lru_cache(maxsize=24)
def _tile(kind, seed):
    """A square of noise (512, 512) that repeats without a seam, mean 0, standard deviation 1."""
    rng = np.random.default_rng([int(seed), sorted(_SPECTRA).index(kind)])
    spectrum = np.fft.rfft2(rng.standard_normal((_TILE, _TILE)))
    frequency = np.hypot(np.fft.fftfreq(_TILE)[:, None], np.fft.rfftfreq(_TILE)[None, :]) * _TILE
    gain = np.where(frequency > 0, 1 / np.maximum(frequency, 1 if kind == "rough" else 2) ** _SPECTRA[kind], 0)
    gain *= np.exp(-((frequency / (_TILE / 5)) ** 2))  # nothing finer than the interpolation can show
    noise = np.fft.irfft2(spectrum * gain, s=(_TILE, _TILE))
    return (noise / noise.std()).astype(np.float32)


def noise(kind, seed, u, v):
    """The noise at u, v (n,), in its own pixels, interpolated."""
    import cv2

    n, rows = len(u), -(-len(u) // 4096)  # OpenCV takes no long rows
    # np.mod takes five times as long
    u, v = (np.resize(one - _TILE * np.floor(one / np.float32(_TILE)), (rows, 4096)) for one in (u, v))
    u, v = u.astype(np.float32), v.astype(np.float32)
    return cv2.remap(_tile(kind, int(seed)), u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP).ravel()[:n]
