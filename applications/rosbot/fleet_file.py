"""Fleet files of format `rosbot-fleet/1`: what scenarios of several robots have in common, and what each has of its own."""
