"""The way to the ball, filled from the lab book."""

import numpy as np

from ir50p_lab.course import lab_book


def test_the_way_to_the_ball_is_filled_from_the_lab_book():
    assert [text.get_text() for text in lab_book.so_far().axes[0].texts] == ["not yet"] * 11
    lab_book.measured("ball.miss.by_hand", 34.2, "mm")
    lab_book.measured("ball.seconds.by_hand", 41, "s")
    lab_book.measured("ball.miss.by_formula", 1e-13, "mm")
    ax = lab_book.so_far().axes[0]
    said = [text.get_text() for text in ax.texts]
    assert said[0] == "34.2 mm, 41 s" and said[4] == "1e-13 mm" and said.count("not yet") == 9
    by_hand, by_formula = ax.lines[:2]
    np.testing.assert_allclose(by_hand.get_xydata(), [[34.2, 0]])
    np.testing.assert_allclose(by_formula.get_xydata(), [[0.01, 4]])  # the edge of what is drawn
