"""Rendered pictures of the bench, honest down to lens, light and sensor, with the truth beside each."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "arm_shape": ["arm_sticks"],
        "scene": ["Lamp", "Lens", "Patch", "Scene", "SceneBall", "Sensor", "Sky", "Stick", "Sun", "Tabletop"],
        "places": ["bench_camera", "bench_scene", "look_at", "pose"],
        "render": ["render_scene"],
        "truth": ["BallTruth", "SceneTruth"],
    },
)
