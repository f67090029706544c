"""Convolves linear pictures with large kernels, by Fourier transforms of tiles."""
