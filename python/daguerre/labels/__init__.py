"""What a picture shows: things, their categories, masks, and boxes in the picture and in space."""
