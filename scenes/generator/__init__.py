"""Makes the models of scenes/. See ../generate.py."""
