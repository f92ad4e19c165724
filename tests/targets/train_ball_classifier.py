"""Train the classifier of the ball detector: `python -m tests.targets.train_ball_classifier [--scenes N] [--folder DIR]`.

Scenes 100 to 6149 of the kinds 'ball' and 'no_ball' (no evaluation uses these seeds; every fifth is held out to choose
the threshold by) and crowded ones from 110000 on are rendered, kept in the folder, and searched; what the search
proposes in them and in changed copies trains a few small networks, which are written to
ir50p_lab/vision/ball/classifier.npz. NumPy only, single precision; the same seeds give the same weights on the same machine.
Rendering and searching take two seconds a scene, training ten minutes a network and 6 GB.

The weights in the package come from examples collected in several steps: scenes 1200 to 3199 by an earlier order of
guesses, rods `behind` things in two thirds of the scenes (in half of these what is in front may be a red ball), crowded
scenes (800 without and 400 with balls) with paler things in front, and 800 and 200 further plain ones from 130000 on.
One of the four networks saw them for 24 epochs only. Training anew gives others.
"""

import argparse
import sys
import time

import numpy as np

from ir50p_lab.vision.ball.classifier import FAR, NEAR, WEIGHTS, around
from ir50p_lab.vision.ball.features import RAYS
from tests.targets.ball_examples import NEARLY, crowded_examples, examples

LAYERS = ("w1", "b1", "w2", "b2", "w3", "b3", "w4", "b4")
FIRST = 100
CROWDED = 110_000  # first seed of crowded scenes
WIDTHS = (56, 56, 40)  # of the layers
NETWORKS = 4
EPOCHS, BATCH, RATE, DECAY = 40, 96, 2.5e-3, 0.2
EASY, SPARED = (
    5.0,
    4,
)  # log odds beyond which the classifier before is right for sure; of these an epoch sees one in SPARED
NOISE, DROP = 0.25, 0.3  # added to the scaled inputs; share of the pooled features left out, in training
FALSE_COSTS = 2.0  # a false alarm is worse than a miss
OF_CROWDED = 2.5  # what a crowded scene counts for


def logit(rays, numbers, net, keep=1.0):
    """Log odds (n,) of one network, and the layers on the way: what training goes back through.

    keep: factors of the pooled features, in training.
    """
    n = len(rays)
    x1 = rays[:, around(NEAR)].reshape(n, rays.shape[1], -1)
    h1 = np.maximum(x1 @ net["w1"] + net["b1"], 0)
    x2 = h1[:, around(FAR)].reshape(n, rays.shape[1], -1)
    h2 = np.maximum(x2 @ net["w2"] + net["b2"], 0)
    top = h2.argmax(axis=1)
    pooled = np.concatenate([h2.mean(axis=1), np.take_along_axis(h2, top[:, None], axis=1)[:, 0], numbers], axis=1)
    pooled *= keep
    h3 = np.maximum(pooled @ net["w3"] + net["b3"], 0)
    return h3 @ net["w4"] + net["b4"], (x1, h1, x2, h2, top, pooled, h3)


def start(rng, channels, numbers):
    """Weights of an untrained network (He's initialisation)."""
    a, b, c = WIDTHS
    shapes = {"w1": (channels * len(NEAR), a), "w2": (a * len(FAR), b), "w3": (2 * b + numbers, c), "w4": (c,)}
    net = {name: rng.normal(0, np.sqrt(2 / shape[0]), shape) for name, shape in shapes.items()}
    net |= {"b1": np.zeros(a), "b2": np.zeros(b), "b3": np.zeros(c), "b4": np.zeros(())}
    return {name: value.astype(np.float32) for name, value in net.items()}


def gradient(rays, numbers, labels, weights, net, keep=1.0):
    """Gradient of the weighted cross-entropy, and its mean; keep: factors of the pooled features (dropout)."""
    z, (x1, h1, x2, h2, top, pooled, h3) = logit(rays, numbers, net, keep)
    p = 1 / (1 + np.exp(-z))
    loss = float(np.mean(weights * (np.logaddexp(0, z) - labels * z)))
    n, a, b = len(z), h1.shape[2], h2.shape[2]
    dz = (weights * (p - labels) / n).astype(np.float32)
    grad = {"w4": h3.T @ dz, "b4": dz.sum()}
    d3 = np.outer(dz, net["w4"]) * (h3 > 0)
    grad |= {"w3": pooled.T @ d3, "b3": d3.sum(axis=0)}
    dp = (d3 @ net["w3"].T) * keep
    d2 = np.repeat(dp[:, None, :b] / RAYS, RAYS, axis=1)
    rows = np.arange(n)[:, None], top, np.arange(b)[None]
    d2[rows] += dp[:, b : 2 * b]
    d2 *= h2 > 0
    grad |= {"w2": x2.reshape(-1, x2.shape[2]).T @ d2.reshape(-1, b), "b2": d2.sum(axis=(0, 1))}
    dx2 = (d2.reshape(-1, b) @ net["w2"].T).reshape(n, RAYS, len(FAR), a)
    d1 = np.zeros_like(h1)
    for k, column in enumerate(around(FAR).T):
        d1[:, column] += dx2[:, :, k]  # a column names every ray once
    d1 *= h1 > 0
    grad |= {"w1": x1.reshape(-1, x1.shape[2]).T @ d1.reshape(-1, a), "b1": d1.sum(axis=(0, 1))}
    return grad, loss


def train(rays, numbers, labels, weights, easy, rng, report=print):
    """One network, by Adam with a rate that falls to nothing; examples are mirrored as they come.

    easy (n,): examples of which each epoch draws one in SPARED, with as much more weight.
    """
    hard, rest = np.flatnonzero(~easy), np.flatnonzero(easy)
    weights = np.where(easy, SPARED, 1).astype(np.float32) * weights
    net = start(rng, rays.shape[2], numbers.shape[1])
    first = {name: np.zeros_like(value) for name, value in net.items()}
    second = {name: np.zeros_like(value) for name, value in net.items()}
    batches = (len(hard) + len(rest) // SPARED) // BATCH
    steps, step = EPOCHS * batches, 0
    for epoch in range(EPOCHS):
        drawn, losses = rng.choice(rest, len(rest) // SPARED, replace=False), []
        order = rng.permutation(np.concatenate([hard, drawn]))
        for k in range(batches):
            chosen = order[k * BATCH : (k + 1) * BATCH]
            turn = np.arange(RAYS)[:: rng.choice([-1, 1])]
            x = rays[chosen][:, turn] + NOISE * rng.standard_normal((BATCH, *rays.shape[1:]), np.float32)
            y = numbers[chosen] + NOISE * rng.standard_normal((BATCH, numbers.shape[1]), np.float32)
            keep = (rng.random((BATCH, len(net["w3"])), np.float32) > DROP) / np.float32(1 - DROP)
            grad, loss = gradient(x, y, labels[chosen], weights[chosen], net, keep)
            losses.append(loss)
            step += 1
            rate = RATE * 0.5 * (1 + np.cos(np.pi * step / steps)) * min(1, step / 200)
            for name in LAYERS:
                first[name] += 0.1 * (grad[name] - first[name])
                second[name] += 0.001 * (grad[name] ** 2 - second[name])
                size = np.sqrt(second[name] / (1 - 0.999**step)) + 1e-8
                net[name] -= np.float32(rate) * (first[name] / (1 - 0.9**step) / size + DECAY * net[name])
        report(f"epoch {epoch}: loss {np.mean(losses):.4f}")
    return net


def fit(rays, numbers, labels, scenes, crowded, report=print):
    """The weights of the classifier from examples (n, ...); scenes (n,): number of the scene; crowded (n,): of such a one."""
    rays = rays.astype(np.float32)
    before = odds(rays, numbers) if WEIGHTS.exists() else np.zeros(len(labels))
    flat = rays.reshape(-1, rays.shape[2])
    scale = {
        "ray_mean": flat.mean(axis=0),
        "ray_std": flat.std(axis=0) + 1e-3,
        "number_mean": numbers.mean(axis=0),
        "number_std": numbers.std(axis=0) + 1e-3,
    }
    rays = (rays - scale["ray_mean"]) / scale["ray_std"]
    numbers = ((numbers - scale["number_mean"]) / scale["number_std"]).astype(np.float32)
    nearly = labels == NEARLY
    labels = (labels > 0).astype(np.float32)
    easy = np.where(labels == 1, before, -before) > EASY
    # a scene counts once, however much was proposed in it
    count = np.bincount(scenes)[scenes]
    share = np.minimum(np.where(crowded, OF_CROWDED, 1) * 5 / (count + 5), 1)
    weights = np.where(labels == 1, 1.0, FALSE_COSTS * share).astype(np.float32)
    weights[nearly] = 0.5
    nets = [train(rays, numbers, labels, weights, easy, np.random.default_rng([7, k]), report) for k in range(NETWORKS)]
    return scale | {name: np.stack([net[name] for net in nets]) for name in LAYERS}


def odds(rays, numbers):
    """Log odds (n,) of examples by the classifier in the package: the mean of its networks."""
    with np.load(WEIGHTS) as file:
        net = {name: file[name].astype(np.float32) for name in file.files}
    x = (rays - net["ray_mean"]) / net["ray_std"]
    y = (numbers - net["number_mean"]) / net["number_std"]
    each = [{name: net[name][k] for name in LAYERS} for k in range(len(net["w1"]))]
    parts = [slice(k, k + 1000) for k in range(0, len(x), 1000)]
    return np.concatenate([np.mean([logit(x[p], y[p], one)[0] for one in each], axis=0) for p in parts])


def collect(scenes, crowded, folder, report=print):
    """Examples of that many scenes of each kind: rays, numbers, labels, number of the scene, whether it is crowded."""
    ways = [(examples, FIRST, scenes), (crowded_examples, CROWDED, crowded)]
    found, scene, begun = [], 0, time.monotonic()
    for make, first, many in ways:
        for seed in range(first, first + many):
            if make is examples and seed % 5 == 0:
                continue  # held out
            for kind in ("ball", "no_ball"):
                scene += 1
                found += [(*one, scene, make is crowded_examples) for one in make(seed, kind, folder=folder)]
            if seed % 50 == 49:
                report(f"{make.__name__} {seed}: {len(found)} examples, {time.monotonic() - begun:.0f} s", flush=True)
    return [np.array(part) for part in zip(*found, strict=True)]


def main(arguments):
    """Collect, train, write."""
    parser = argparse.ArgumentParser(prog="python -m tests.targets.train_ball_classifier", description=__doc__)
    parser.add_argument("--scenes", type=int, default=6050, help="of each kind")
    parser.add_argument("--crowded", type=int, default=800, help="of each kind")
    parser.add_argument("--folder", help="where rendered scenes are kept")
    options = parser.parse_args(arguments)
    rays, numbers, labels, scenes, crowded = collect(options.scenes, options.crowded, options.folder)
    parts = fit(rays, numbers, labels, scenes, crowded)
    np.savez_compressed(WEIGHTS, **{name: value.astype(np.float16) for name, value in parts.items()})
    print(f"{WEIGHTS}: {WEIGHTS.stat().st_size / 1000:.0f} kB from {len(labels)} examples")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
