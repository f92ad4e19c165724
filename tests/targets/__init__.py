"""What the project set out to reach, measured by command: `python -m tests.targets [NAME] [--quick]`."""
