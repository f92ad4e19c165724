"""Scenes that show much of what is easily taken for a ball, in small pictures that are drawn quickly: to train on."""

from dataclasses import replace

import numpy as np

from ir50p_lab.errors import InputError
from ir50p_lab.vision.rendering import SceneBall
from ir50p_lab.vision.rendering.scene import Stick
from tests.support.random_scene import random_scene
from tests.support.random_things import distractor, hider, other_colour, random_red

CROWD = {
    "red stick": 0.35, "red box": 0.15, "red cable": 0.08, "ball": 0.18, "skin": 0.12, "tape": 0.06, "red blob": 0.06,
}  # fmt: skip
_WIDEST = 640  # pixels


def crowded_scene(seed, kind):
    """A Scene of kind 'ball' or 'no_ball' with many more things in it, red sticks and half-hidden ones most of all."""
    rng = np.random.default_rng([seed, kind == "ball", 81])
    scene = _smaller(random_scene(seed, kind))
    camera = -scene.T_cam_world[:3, :3].T @ scene.T_cam_world[:3, 3]
    objects, patches = list(scene.objects), list(scene.patches)
    for _ in range(rng.integers(5, 13)):
        place = _place_in_view(rng, scene, camera)
        if place is None:
            continue
        if kind == "ball" and rng.random() < 0.4:
            objects.append(replace(place, colour=random_red(rng), gloss=rng.uniform(0, 0.7)))
            if rng.random() < 0.5:
                objects += hider(rng, camera, place)
            continue
        what = str(rng.choice(list(CROWD), p=list(CROWD.values())))
        things, flat = distractor(rng, camera, place, near=rng.random() < 0.5, what=what)
        if what == "red stick":
            things = _thicker(rng, things[0], camera)
        objects += things
        patches += flat
    return replace(scene, objects=tuple(objects), patches=tuple(patches))


def _smaller(scene):
    width, height = scene.pinhole.size
    if width <= _WIDEST:
        return scene
    scale = _WIDEST / width
    lens = replace(scene.lens, defocus=scale * scene.lens.defocus, motion=tuple(scale * x for x in scene.lens.motion))
    return replace(scene, pinhole=scene.pinhole.scaled((_WIDEST, round(scale * height))), lens=lens)


def _place_in_view(rng, scene, camera):
    """A SceneBall on the table somewhere in the picture, as large as those that are sought; None where no table is near."""
    width, height = scene.pinhole.size
    try:
        ray = scene.T_cam_world[:3, :3].T @ scene.pinhole.rays(rng.uniform((0, 0), (width, height)))
    except InputError:
        return None
    if ray[2] > -0.15:
        return None
    distance = camera[2] / -ray[2]
    r = np.exp(rng.uniform(np.log(7), np.log(0.15 * height))) * distance / scene.pinhole.fx
    x, y = camera[:2] + distance * ray[:2]
    return SceneBall(position=(x, y, r), radius=float(r))


def _thicker(rng, stick, camera):
    """A stick as thick or up to three times thicker, often with something in front of it near an end."""
    r = stick.radius * rng.uniform(1, 3)
    start, end = (np.array((*p[:2], r)) for p in (stick.start, stick.end))
    things = [replace(stick, start=tuple(start), end=tuple(end), radius=r)]
    if rng.random() < 0.6:
        along = (end - start) / np.linalg.norm(end - start)
        at = end - along * r * rng.uniform(0.5, 2.5)
        things.append(_across(rng, at, along, r, camera))
    return things


def _across(rng, at, along, r, camera):
    """A ball or a finger between the camera and a point (3,) of a stick: it hides what is further along it."""
    towards = (camera - at) / np.linalg.norm(camera - at)
    size = r * rng.uniform(0.8, 4)
    middle = at + towards * (r + size) - along * size
    colour = other_colour(rng)
    if rng.random() < 0.5:
        return SceneBall(position=tuple(middle), radius=size, colour=colour, gloss=rng.uniform(0, 0.7))
    turned = np.cross(along, towards) + rng.normal(0, 0.3, 3)
    half = turned / np.linalg.norm(turned) * size * rng.uniform(2, 8)
    return Stick(start=tuple(middle - half), end=tuple(middle + half), radius=size, colour=colour)
