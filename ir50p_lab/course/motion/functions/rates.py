"""Rates of change, f(t, x), on which the steps of 06 are tried: each says in a line what it is."""

import numpy as np


def swinging(t, x):
    """A weight on a spring: x' = (x[1], -4 x[0])."""
    return np.array([x[1], -4 * x[0]])


def by_the_clock(t, x):
    """Of the time alone: x' = (cos t, t^2)."""
    return np.array([np.cos(t), t**2])


def growing(t, x):
    """Of both: x' = t x - x^2."""
    return t * x - x**2


def cooling(t, x):
    """Of the state alone: x' = -x^2."""
    return -(x**2)


def three_joints(t, x):
    """Six numbers, angles and speeds: x' = (speeds, -sin(angles) - 0.1 t speeds)."""
    return np.concatenate([x[3:], -np.sin(x[:3]) - 0.1 * t * x[3:]])


SIX = np.array([0.3, -0.5, 0.8, 0.1, 0.4, -0.2])
