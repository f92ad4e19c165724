def step_metrics(t, q, target):
    start = q[0]
    jump = target - start
    done = (q - start) / jump
    rise = np.nan
    if np.any(done >= 0.9):
        rise = t[np.argmax(done >= 0.9)] - t[np.argmax(done >= 0.1)]
    overshoot = max(0.0, np.max(np.sign(jump) * (q - target)))
    last_second = q[t >= t[-1] - 1]
    band = max(0.02 * abs(jump), 3 * np.std(last_second))
    outside = np.abs(q - target) > band
    settling = np.nan
    if not outside[-1]:
        settling = t[np.flatnonzero(outside)[-1] + 1] - t[0] if np.any(outside) else 0.0
    return rise, overshoot, settling, target - np.mean(last_second)
