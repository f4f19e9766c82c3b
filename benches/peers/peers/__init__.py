"""cplan beside what people use now: the same problems, in one run."""
