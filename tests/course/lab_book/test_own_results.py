"""The chain of the student's results: what is kept comes back, for the bench it was measured on and for no other."""

import numpy as np
import pytest
from fake_board import FakeBoard

from ir50p_lab.bench import JointCalibration, ReplayBench, SerialBench, SimulatedBench, nominal_calibration
from ir50p_lab.course import arm_that_answers, load_result, results, save_result
from ir50p_lab.course.lab_book import results as own_results
from ir50p_lab.course.torque import views
from ir50p_lab.errors import InputError, NotMeasuredError
from ir50p_lab.identification import identify
from ir50p_lab.modelling import IR50P
from ir50p_lab.vision import Calibration
from ir50p_lab.vision.calibration.fit import NAMES


@pytest.fixture(autouse=True)
def home(monkeypatch, tmp_path):
    monkeypatch.setenv("IR50P_HOME", str(tmp_path / "home"))
    return tmp_path / "home"


@pytest.fixture(scope="module")
def recording():
    return views.training_run(IR50P)


@pytest.fixture(scope="module")
def model(recording):
    return identify(recording, l2=IR50P.l[1])


def real_bench():
    board = FakeBoard(nominal_calibration(IR50P), np.zeros(3))
    bench = SerialBench(board, clock=board, arm=IR50P, record_to=False).open()
    bench.give_id()
    return bench


def simulated(unit=0):
    return SimulatedBench(IR50P, seed=unit, record_to=False).open()


def test_what_is_kept_comes_back(model, recording, capsys):
    save_result("model", model, recording)
    unit = int(recording.header["seed"])
    back = load_result("model", simulated(unit))
    np.testing.assert_array_equal(back.theta, model.theta)
    assert str(back) == str(model) and np.allclose(back.score(recording).fit, model.score(recording).fit)
    assert "model-1 of 20" in capsys.readouterr().out
    (row,) = results().itertuples()
    assert (row.state, row.bench_id, row.unit) == ("counts", f"simulated-unit-{unit}", str(unit))


@pytest.mark.parametrize("named", [True, False])
def test_a_model_of_ones_own_comes_back_with_its_errors(named, recording, capsys):
    theta, errors = np.array(IR50P.theta_pwm), np.full((3, 20), np.nan)
    errors[:, :6], errors[1, 7] = 0.5, np.inf
    if named:
        save_result("model", theta, errors, recording)
        back = load_result("model", simulated(int(recording.header["seed"])))
    else:  # no bench: the simulated arm
        save_result("model", theta, errors)
        back = load_result("model", simulated())
    assert "measured on simulated" in capsys.readouterr().out
    np.testing.assert_array_equal(back.theta, theta)
    np.testing.assert_array_equal(back.stderr, errors)
    assert back.unit == "PWM" and back.columns[0][:2] == ("theta1", "theta2") and "theta6" in str(back)
    assert (back.score(recording).fit > 70).all()


@pytest.mark.parametrize(
    "theta, errors",
    [(np.zeros((3, 19)), None), (IR50P, None), (np.full((3, 20), np.nan), None), (np.ones((3, 20)), -1)],
)
def test_what_is_no_model_is_not_kept(theta, errors):
    with pytest.raises(InputError, match="theta"):
        save_result("model", theta, errors)
    assert results().empty


def test_the_newest_counts_until_it_is_withdrawn_or_another_chosen(model):
    bench = simulated()
    for k in (1, 2, 3):
        save_result("calibration", JointCalibration((100 + k,) * 3, (512,) * 3, source=f"try {k}"), bench)
    state = results()["state"]
    assert dict(state) == {"calibration-1": "", "calibration-2": "", "calibration-3": "counts"}
    assert results(withdraw="calibration-3")["state"]["calibration-2"] == "counts"
    assert results(choose="calibration-1")["state"]["calibration-1"] == "counts"
    assert results(choose="calibration-3")["state"]["calibration-3"] == "counts"
    with pytest.raises(InputError, match="no result 'model-9': calibration-2, "):
        results(withdraw="model-9")


def test_a_real_arm_uses_only_what_was_measured_on_it(model, recording, capsys):
    """Not the model of a simulated arm, nor of another board, nor the course's; the simulated arm takes no real one."""
    mine, other = real_bench(), real_bench()
    save_result("model", model, recording)
    save_result("model", model, other)
    with pytest.raises(NotMeasuredError, match="13_is_the_model_good"):
        load_result("model", mine, course=lambda: model)
    assert load_result("model", simulated(9), course=lambda: "course's") == "course's"
    assert "The course's model: no model of yours was measured on simulated IR50P, unit 9" in capsys.readouterr().out
    save_result("model", model, mine)
    assert load_result("model", mine).unit == "PWM" and "measured on board" in capsys.readouterr().out


def test_a_camera_of_rendered_pictures_serves_simulated_arms_only(capsys):
    K = np.array([[700.0, 0, 320], [0, 700, 240], [0, 0, 1]])
    stderr = dict.fromkeys(NAMES, 0.1)
    camera = Calibration(K=K, distortion=np.zeros(5), rms=0.1, size=(640, 480), stderr=stderr)
    save_result("camera", camera)
    assert load_result("camera", simulated(7)).fx == 700 and load_result("camera", simulated(7)).T_base_cam is None
    stands = np.diag([1.0, -1, -1, 1])
    save_result("camera", camera, stands)
    np.testing.assert_array_equal(load_result("camera", simulated(7)).T_base_cam, stands)
    with pytest.raises(InputError, match="T_base_cam is not a rigid"):
        save_result("camera", camera, 2 * stands)
    with pytest.raises(NotMeasuredError, match="17_camera"):
        load_result("camera", real_bench())


def test_a_board_without_an_id_owns_nothing(model, capsys):
    board = FakeBoard(nominal_calibration(IR50P), np.zeros(3))
    with SerialBench(board, clock=board, arm=IR50P, record_to=False) as bench:
        save_result("model", model, bench)
        assert "Not kept" in capsys.readouterr().out and results().empty
        with pytest.raises(NotMeasuredError):
            load_result("model", bench)


def test_who_cannot_answer_gives_way_to_the_simulated_arm(monkeypatch, capsys, model):
    real, recorded = real_bench(), simulated()
    list(recorded.run(0.1))
    found = [ReplayBench(recorded.recording).open(), real, real]
    simulate = own_results.connect
    monkeypatch.setattr(own_results, "connect", lambda *port, **more: simulate(*port) if port else found.pop(0))
    assert arm_that_answers().kind == "simulated" and "a recording does not answer" in capsys.readouterr().out
    assert arm_that_answers("model").kind == "simulated" and "measure first: no model" in capsys.readouterr().out
    assert not real.is_open  # nothing moved, and the port is free
    real._given.is_open = True
    real.open()
    save_result("model", model, real)
    assert arm_that_answers("model") is real


@pytest.mark.parametrize("text", ["", "[]", "[" * 100_000, '{"name": "model-1"}'])
def test_a_damaged_description_is_named(home, text):
    (home / "results").mkdir(parents=True)
    (home / "results" / "model-1.json").write_text(text)
    with pytest.raises(InputError, match=r"model-1\.json describes no result"):
        results()
