"""Labels of a picture: objects, their categories, masks, and boxes in 2D and 3D."""
