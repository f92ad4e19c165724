"""The IR50P lab book: robot control taught on a real arm."""

__version__ = "0.1.0"
