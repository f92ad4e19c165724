"""OpenCV in one thread: times and numbers are the same on any computer."""

import cv2
import pytest


@pytest.fixture(scope="session", autouse=True)
def one_thread():
    before = cv2.getNumThreads()
    cv2.setNumThreads(1)
    yield
    cv2.setNumThreads(before)
