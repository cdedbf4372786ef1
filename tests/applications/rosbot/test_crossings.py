"""Random crossings are what they are said to be."""

import numpy as np

from applications.rosbot.crossings import ROOM, crossing


def test_scenes_are_within_what_is_promised_and_differ():
    scenes = [crossing(number) for number in range(40)]
    counts = {len(scene.circles) for scene in scenes}
    assert counts <= set(range(3, 11))
    assert {3, 10} <= counts
    for scene in scenes:
        speeds = np.hypot(*scene.circles[:, 2:4].T)
        assert np.all((speeds > 0.0) & (speeds <= 0.4))
        gaps = np.hypot(*(scene.circles[:, :2] - scene.start[:2]).T) - scene.circles[:, 4] - scene.radius
        assert gaps.min() >= ROOM


def test_every_mover_crosses_the_straight_way():
    scene = crossing(7)
    way = scene.goal[:2] - scene.start[:2]
    for circle in scene.circles:
        instants = np.arange(0.0, 60.0, 0.01)[:, np.newaxis]
        places = circle[:2] + instants * circle[2:4] - scene.start[:2]
        along = np.clip(places @ way / (way @ way), 0.0, 1.0)[:, np.newaxis] * way
        assert np.hypot(*(places - along).T).min() < 0.01


def test_a_scene_is_a_function_of_its_number_and_seed():
    assert np.array_equal(crossing(3, seed=5).circles, crossing(3, seed=5).circles)
    assert not np.array_equal(crossing(3, seed=5).start, crossing(3, seed=6).start)
