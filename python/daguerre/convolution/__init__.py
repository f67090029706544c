"""Linear pictures convolved with large kernels, by Fourier transforms in tiles."""
