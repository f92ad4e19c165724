"""Train the classifier of the ball detector on: `python -m tests.targets.train_ball_classifier [--scenes N]`.

Scenes from 300000 on of the kinds 'ball' and 'no_ball' (no evaluation uses these seeds) are rendered and searched, every
fifth pair as crowded ones, too; what the detector proposes in them and in changed copies trains the networks of the
package further, and they are written to ir50p_lab/vision/ball/classifier.npz. NumPy only, single precision; the same
seeds give the same weights on the same machine. A pair of scenes takes two seconds of a processor, a network two
minutes and 5 GB. --anew begins with untrained networks, and trains them for longer.

Where the networks began: from nothing, with the examples of an earlier detector in scenes 100 to 6149 (and 130000 to
130999), in shapes painted into them, and in crowded ones from 110000 on. The weights in the package went on from there
with 3000 pairs.
"""

import argparse
import sys

import numpy as np

from ir50p_lab.vision.ball.classifier import FAR, NEAR, WEIGHTS, around
from ir50p_lab.vision.ball.features import RAYS
from tests.targets.ball_examples import NEARLY, crowded_examples, examples
from tests.targets.in_parallel import mapped

LAYERS = ("w1", "b1", "w2", "b2", "w3", "b3", "w4", "b4")
FIRST, SCENES = 300_000, 3000
CROWDED, SHAPES = 5, 6  # of so many pairs one is also drawn crowded, one has shapes painted into it, which takes long
WIDTHS = (56, 56, 40)  # of the layers
NETWORKS = 4
BATCH, DECAY = 96, 0.2
EPOCHS, RATE = 12, 1e-3
EPOCHS_ANEW, RATE_ANEW = 40, 2.5e-3
EASY, SPARED = 5.0, 4  # log odds beyond which the networks are surely right: of these an epoch sees one in SPARED
NOISE, DROP = 0.25, 0.3  # added to the scaled inputs; share of the pooled features left out, in training
OF_BALL, OF_CROWDED = 1.4, 2.5  # what a ball counts for, as most of what is proposed is none; what a crowded scene does


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


def train(net, rays, numbers, labels, weights, easy, rng, epochs=EPOCHS, top_rate=RATE):
    """Train a network in place, by Adam with a rate that falls to nothing; examples are mirrored as they come.

    easy (n,): examples of which each epoch draws one in SPARED, with as much more weight.
    """
    hard, rest = np.flatnonzero(~easy), np.flatnonzero(easy)
    weights = np.where(easy, SPARED, 1).astype(np.float32) * weights
    first = {name: np.zeros_like(value) for name, value in net.items()}
    second = {name: np.zeros_like(value) for name, value in net.items()}
    batches = (len(hard) + len(rest) // SPARED) // BATCH
    steps, step = epochs * batches, 0
    for epoch in range(epochs):
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
            rate = top_rate * 0.5 * (1 + np.cos(np.pi * step / steps)) * min(1, step / 200)
            for name in LAYERS:
                first[name] += 0.1 * (grad[name] - first[name])
                second[name] += 0.001 * (grad[name] ** 2 - second[name])
                size = np.sqrt(second[name] / (1 - 0.999**step)) + 1e-8
                net[name] -= np.float32(rate) * (first[name] / (1 - 0.9**step) / size + DECAY * net[name])
        print(f"epoch {epoch}: loss {np.mean(losses):.4f}", flush=True)


def fit(rays, numbers, labels, scenes, crowded, anew=False):
    """Weights of the classifier from examples (n, ...); scenes (n,): number of the scene; crowded (n,): of such a one."""
    with np.load(WEIGHTS) as file:
        net = {name: file[name].astype(np.float32) for name in file.files}
    rays = (rays.astype(np.float32) - net["ray_mean"]) / net["ray_std"]
    numbers = ((numbers - net["number_mean"]) / net["number_std"]).astype(np.float32)
    nets = [{name: net[name][k] for name in LAYERS} for k in range(len(net["w1"]))]
    before = odds(rays, numbers, nets)
    nearly = labels == NEARLY
    labels = (labels > 0).astype(np.float32)
    easy = np.where(labels == 1, before, -before) > EASY
    # a scene counts once, however much was proposed in it
    count = np.bincount(scenes)[scenes]
    share = np.minimum(np.where(crowded, OF_CROWDED, 1) * 5 / (count + 5), 1)
    weights = np.where(labels == 1, OF_BALL, share).astype(np.float32)
    weights[nearly] = 0.5 * OF_BALL
    plan = (EPOCHS_ANEW, RATE_ANEW) if anew else (EPOCHS, RATE)
    if anew:
        nets = [start(np.random.default_rng([7, k]), rays.shape[2], numbers.shape[1]) for k in range(NETWORKS)]
    for k, one in enumerate(nets):
        train(one, rays, numbers, labels, weights, easy, np.random.default_rng([8, k]), *plan)
    return net | {name: np.stack([one[name] for one in nets]) for name in LAYERS}


def odds(rays, numbers, nets):
    """Log odds (n,) of scaled examples: the mean of several networks."""
    parts = [slice(k, k + 1000) for k in range(0, len(rays), 1000)]
    return np.concatenate([np.mean([logit(rays[p], numbers[p], one)[0] for one in nets], axis=0) for p in parts])


def of_one_seed(seed):
    """Examples of a pair of scenes, and of a crowded pair: (rays, measures, label, number of the scene, crowded)."""
    pair, found = seed // 2, []
    for scene, kind in enumerate(("no_ball", "ball"), start=4 * seed):
        found += [(*one, scene, False) for one in examples(seed, kind, shapes=pair % SHAPES == 0)]
        if pair % CROWDED == 0:
            found += [(*one, scene + 2, True) for one in crowded_examples(seed, kind)]
    return found


def main(arguments):
    """Collect, train, write."""
    parser = argparse.ArgumentParser(prog="python -m tests.targets.train_ball_classifier", description=__doc__)
    parser.add_argument("--scenes", type=int, default=SCENES, help="pairs of scenes, with and without a ball")
    parser.add_argument("--anew", action="store_true", help="begin with untrained networks")
    options = parser.parse_args(arguments)
    found = mapped(of_one_seed, range(FIRST, FIRST + options.scenes), "pairs of scenes")
    rays, numbers, labels, scenes, crowded = map(np.array, zip(*(one for seed in found for one in seed), strict=True))
    parts = fit(rays, numbers, labels, np.unique(scenes, return_inverse=True)[1], crowded, options.anew)
    np.savez_compressed(WEIGHTS, **{name: value.astype(np.float16) for name, value in parts.items()})
    print(f"{WEIGHTS}: {WEIGHTS.stat().st_size / 1000:.0f} kB from {len(labels)} examples")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
