"""Picture files: reads and writes their bytes; light, colours and facts that they state."""
