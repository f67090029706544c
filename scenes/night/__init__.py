"""The parts of the example scene night_table."""
