"""Pictures that are not complete, shown in a terminal or in a file."""
