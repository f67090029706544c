"""Color: spectra, illuminants, RGB spaces, chromatic adaptation and display curves."""
