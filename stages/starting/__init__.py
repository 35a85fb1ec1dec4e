"""How the workflow starts stages: in processes forked from one that has loaded their packages."""
