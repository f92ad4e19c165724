"""What ``python3 -m ir50p_lab`` does. Standard library only: it runs before anything is installed.

commands     the command line: lab, test, setup, doctor
environment  the folder .venv: is it ready, build it, repair it
installer    packages into .venv: uv, told what pip is told (pip_settings.toml); else pip
file_lock    one set-up at a time; so that compiled code comes from one process, too
inventory    what is installed beside what the lock asks for, what can be imported; serial ports (runs inside .venv)
boards       USB ids of the boards that fit the bench (boards.toml); who may open a port
doctor       a report on the machine and a verdict
problems     every error as one line that says what to do next (problems.toml)
labconfig/   JupyterLab's settings, put into .venv
"""
