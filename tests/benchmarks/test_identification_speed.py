"""Speed of identification beside NumPy in the same run: `pytest tests/benchmarks --benchmark-enable -s`.

Ratios, not times, are what counts: the machine is the same for both. The targets are printed with the result.
"""

import time

import numpy as np

from ir50p_lab.identification import fit, regressor
from ir50p_lab.modelling import IR50P

N = 11_000  # 110 s at 100 Hz, as the thesis


def measured(n=N):
    """q, qd, qdd and PWM of n random states, with noise."""
    rng = np.random.default_rng(0)
    q, qd, qdd = rng.uniform(-2, 2, (n, 3)), rng.normal(0, 1, (n, 3)), rng.normal(0, 3, (n, 3))
    y = np.einsum("nij,ij->ni", regressor(q, qd, qdd), IR50P.theta_pwm) + rng.normal(0, 3, (n, 3))
    return q, qd, qdd, y


def numpy_fit(q, qd, qdd, y):
    """By the book: a NumPy block per sample in a Python loop, then lstsq."""

    def run():
        Phi = np.zeros((len(q), 3, 20))
        for k in range(len(q)):
            (a, b, c), (A, B, C) = qd[k], qdd[k]
            c2, s2, c3, s3 = np.cos(q[k, 1]), np.sin(q[k, 1]), np.cos(q[k, 2]), np.sin(q[k, 2])
            c23, s23 = np.cos(q[k, 1] + q[k, 2]), np.sin(q[k, 1] + q[k, 2])
            mixed = s23 * c2 + c23 * s2
            Phi[k] = np.array(
                [
                    [A, c2**2 * A - 2 * s2 * c2 * a * b, 0, 0, c23**2 * A - 2 * s23 * c23 * a * (b + c),
                     2 * c2 * c23 * A - 2 * mixed * a * b - 2 * s23 * c2 * a * c, B, B + C, 0, 0,
                     a, np.sign(a), 0, 0, 0, 0, 1, 0, 0, 0],
                    [0, B + s2 * c2 * a**2, 9.81 * c2, 9.81 * c23, B + C + s23 * c23 * a**2,
                     2 * c3 * B + c3 * C + mixed * a**2 - s3 * c**2 - 2 * s3 * b * c, A, A, B, B + C,
                     0, 0, b, np.sign(b), 0, 0, 0, 1, 0, 0],
                    [0, 0, 0, 9.81 * c23, B + C + s23 * c23 * a**2, c3 * B + s23 * c2 * a**2 + s3 * b**2, 0, A, 0, B + C,
                     0, 0, 0, 0, c, np.sign(c), 0, 0, 1, C],
                ]
            )  # fmt: skip
        return Phi.reshape(-1, 20) @ np.linalg.lstsq(Phi.reshape(-1, 20), y.ravel(), rcond=None)[0]

    return run


def our_fit(q, qd, qdd, y):
    """Regressor, then theta by QR alone: what the peers do."""

    def run():
        Phi = regressor(q, qd, qdd).reshape(-1, 20)
        R = np.linalg.qr(np.column_stack([Phi, y.ravel()]), mode="r")
        return np.linalg.solve(R[:20, :20], R[:20, 20])

    return run


def whole_fit(q, qd, qdd, y, rows):
    """Regressor and `fit`, with standard errors, diagnostics and summary."""
    return lambda: fit(regressor(q, qd, qdd), y, rows=rows, columns="thesis")


def best_of(call, repeats):
    """Shortest time of `repeats` calls, s."""
    call()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)


def test_both_compute_the_same():
    data = measured(400)
    theta = our_fit(*data)()
    np.testing.assert_allclose(theta, whole_fit(*data, "shared")().theta[0], rtol=1e-9)
    predicted = regressor(*data[:3]).reshape(-1, 20) @ theta
    np.testing.assert_allclose(predicted, numpy_fit(*data)(), atol=1e-8 * np.abs(predicted).max())


def test_ratio_to_the_peer(request):
    enabled = request.config.getoption("benchmark_enable")
    data, repeats = measured(N if enabled else 500), 7 if enabled else 1
    theirs, ours = best_of(numpy_fit(*data), repeats), best_of(our_fit(*data), 3 * repeats)
    shared, joint = (best_of(whole_fit(*data, rows), 3 * repeats) for rows in ("shared", "joint"))
    print(
        f"\nregressor and fit of {len(data[0])} x 3 x 20: NumPy in a loop and lstsq {theirs * 1e3:.0f} ms; "
        f"ours {ours * 1e3:.1f} ms: {theirs / ours:.0f}x (target 4x); with standard errors and summary, "
        f"shared {shared * 1e3:.0f} ms: {theirs / shared:.1f}x, row-wise {joint * 1e3:.0f} ms: {theirs / joint:.1f}x"
    )
    if enabled:
        assert theirs > 2 * ours, "half the target: something is broken, not just a busy machine"
