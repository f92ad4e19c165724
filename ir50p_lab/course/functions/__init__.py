"""What the student writes: the functions of `my_robot`, how they are tried, kept and lent."""
