"""Which files and folders are timed, are slow, need the emulated board, or rest on numerics of this processor."""

from pathlib import Path

TESTS = Path(__file__).parents[1]
#: Marks of whole files and folders (pyproject.toml says what they mean).
MARKS = {
    "timing": (
        "benchmarks/test_bench_speed.py",
        "bench/test_background.py",
        "bench/test_real_time.py",
        "bench/test_stopped_process.py",
        "course/at_the_bench/test_bench_panel.py",
        "vision/test_vision_times.py",
    ),
    "emulator": (
        "bench/test_firmware.py",
        "bench/test_firmware_noise.py",
        "bench/test_real_time.py",
        "bench/test_stopped_process.py",
    ),
    "slow": (
        "benchmarks",
        "browser",
        "launcher",
        "bench/test_bench_test.py",
        "bench/test_recorder_killed.py",
        "course/draw/test_figures.py",
        "course/checking/test_functions.py",
        "course/grading/test_judge.py",
        "course/live_arm/test_live_arm.py",
        "course/draw/test_painter.py",
        "identification/test_fit.py",
        "identification/test_fopdt.py",
        "identification/test_output_error.py",
        "modelling/test_symbolic.py",
        "simulation/test_sweep.py",
        "test_command.py",
        "vision/test_ball.py",
        "vision/test_calibration_corners.py",
        "vision/test_calibration_file.py",
        "vision/test_camera_calibration.py",
        "vision/test_reaching.py",
        "vision/test_rendering.py",
        "vision/test_vision_times.py",
    ),
    "numeric": (
        "identification",
        "simulation",
        "bench/test_calibration.py",
        "controllers/test_computed_torque.py",
        "controllers/test_identified_model.py",
        "course/camera/test_calibration_views.py",
        "course/fitting/test_identification_views.py",
        "modelling/test_dynamics.py",
        "modelling/test_kinematics.py",
        "vision/test_calibration_corners.py",
        "vision/test_camera_calibration.py",
        "vision/test_pinhole.py",
        "vision/test_table_plane.py",
    ),
}
