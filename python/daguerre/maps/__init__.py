"""Maps of a camera: the ray of each pixel, and STMaps that undistort and distort pictures."""
