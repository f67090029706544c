"""Labels of a picture: things, their categories, masks, and boxes in the picture and in space."""
