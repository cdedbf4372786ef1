"""The ROSbot: stabilizer synthesis, motion planning among obstacles, and driving."""
