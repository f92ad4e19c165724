"""Seeing the ball: pictures, the camera and its calibration, the ball, from pixel to table, reaching.

Pictures are uint8 arrays (height, width, 3) in the order red, green, blue. Pixels are (x, y) with (0, 0) the centre of
the top left one; camera axes are x right, y down, z forward. Names are loaded on first use: importing this package
costs nothing, and OpenCV is loaded only by what uses it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=["rendering"],
    submod_attrs={
        "board_pose": ["BoardPose", "board_points", "board_pose"],
        "pinhole": ["Pinhole"],
        "rendering": ["render_scene"],
        "table_plane": ["TablePlane"],
    },
)
