"""Result files: what is in them, how they are written while a run goes on, how they are read."""
