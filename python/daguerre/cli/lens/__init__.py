"""``daguerre lens``: numbers, drawings and exports of a lens."""
