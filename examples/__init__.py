"""One plant each, from the equations of motion to the exported law."""
