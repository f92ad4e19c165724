"""Which files and folders are timed, need the emulated board, or rest on numerics of this processor."""

from pathlib import Path

TESTS = Path(__file__).parents[1]
#: Marks of whole files and folders (pyproject.toml says what they mean).
MARKS = {
    "timing": (
        "benchmarks",
        "bench/test_background.py",
        "bench/test_background_board.py",
        "bench/test_board_process.py",
        "bench/test_real_time.py",
        "bench/test_stopped_process.py",
    ),
    "emulator": (
        "bench/test_background_board.py",
        "bench/test_board_process.py",
        "bench/test_firmware.py",
        "bench/test_firmware_faults.py",
        "bench/test_firmware_noise.py",
        "bench/test_real_time.py",
        "bench/test_stopped_process.py",
        "benchmarks/test_serial_speed.py",
    ),
    "numeric": (
        "identification",
        "simulation",
        "bench/test_calibration.py",
        "controllers/test_adaptive.py",
        "controllers/test_computed_torque.py",
        "controllers/test_identified_model.py",
        "course/test_calibration_views.py",
        "course/test_identification_views.py",
        "modelling/test_dynamics.py",
        "modelling/test_kinematics.py",
        "vision/test_calibration_corners.py",
        "vision/test_camera_calibration.py",
        "vision/test_hand_eye.py",
        "vision/test_pinhole.py",
        "vision/test_table_plane.py",
    ),
}
