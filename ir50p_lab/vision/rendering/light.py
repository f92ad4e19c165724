"""Light on surfaces: from everywhere, from the sun, from lamps."""

import numpy as np

from ir50p_lab.vision.rendering.scene import Sky

_BOUNCE = 0.55  # what a table sends up of the light from everywhere, times its colour; things shade it
_BOUNCE_DIRECT = 0.35  # of direct light: their own shadow lies around them


def irradiance(scene, X, N, table_colour):
    """Light (n, 3) on points X (3, n) in world coordinates with normals N (3, n), and highlights' directions.

    Returns light (n, 3) and a list of (colour (3,), strength (n,), towards (3, n)) per lamp.
    """
    light = np.zeros((X.shape[1], 3), dtype=np.float32)
    up, direct = 0.5 * (1 + N[2]), []
    for source in scene.lights:
        colour = np.asarray(source.colour, dtype=np.float32)
        if isinstance(source, Sky):
            light += source.strength * (up[:, None] * colour + (1 - up)[:, None] * colour * _BOUNCE * table_colour)
            continue
        towards, strength, _ = source.direction(X)
        light += (np.maximum(np.sum(N * towards, axis=0), 0) * strength)[:, None] * colour
        ground = (1 - up) * np.maximum(towards[2], 0) * strength * _BOUNCE_DIRECT
        light += ground[:, None] * colour * table_colour
        direct.append((colour, strength, towards))
    return light, direct


def highlight(ball, N, V, direct):
    """Light (n, 3) of the mirror image of the sources on a glossy ball (Blinn): normals N, view directions V (3, n)."""
    shine = np.zeros((N.shape[1], 3), dtype=np.float32)
    for colour, strength, towards in direct:
        H = towards + V
        H = H / np.sqrt(np.sum(H * H, axis=0))
        spot = np.maximum(np.sum(N * H, axis=0), 0) ** ball.shininess
        lit = np.sum(N * towards, axis=0) > 0
        shine += (ball.gloss * spot * lit * strength)[:, None] * colour
    return shine
