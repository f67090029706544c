"""Values over time: keys, spins, and how they are sampled."""
