"""One module for each question of the evaluation; each adds rows, tables, plots and pictures to the Context."""
