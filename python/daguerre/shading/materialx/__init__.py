"""MaterialX documents: reads ``.mtlx`` text to a graph of shading nodes."""
