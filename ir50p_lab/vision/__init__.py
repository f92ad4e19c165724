"""Seeing the ball: pictures, the camera and its calibration, the ball, from pixel to table, reaching.

Pictures are uint8 arrays (height, width, 3) in the order red, green, blue. Pixels are (x, y), with (0, 0) at the centre
of the top left one; camera axes are x right, y down, z forward. Names are loaded on first use: importing this package
costs nothing, and OpenCV is loaded only by what uses it.
"""

from ir50p_lab import lazy

__getattr__, __dir__, __all__ = lazy.attach(
    __name__,
    submodules=["camera", "rendering"],
    submod_attrs={
        "camera": ["PictureFolder", "Webcam", "open_camera"],
        "frame": ["Camera", "Frame"],
        "image": ["check_image", "is_rendered", "list_images", "load_image", "save_image", "to_grey"],
        "calibration.calibrate": ["calibrate", "calibrate_corners"],
        "calibration.board": ["Checkerboard"],
        "calibration.reject_reasons": ["Reason", "Rejected"],
        "calibration.calibration_result": ["Calibration"],
        "ball.find": ["Ball", "Balls", "find_balls"],
        "board_pose": ["board_points", "board_pose"],
        "ball.colour": ["RED", "Colour"],
        "pinhole": ["Pinhole"],
        "rendering": ["render_scene"],
        "reaching.budget": ["error_budget"],
        "reaching.moving": ["Mover"],
        "reaching.plan": ["plan", "reach_pose"],
        "reaching.reach": ["Reacher", "reach"],
        "reaching.rendered_bench": ["RenderedBench", "camera_over"],
        "reaching.ball_locator": ["BallLocator", "Seen"],
        "calibration.corners": ["find_checkerboard"],
        "table_plane": ["TablePlane"],
    },
)
