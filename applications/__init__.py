"""Complete uses of gpsynth, each on one plant."""
