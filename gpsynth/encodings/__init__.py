"""Ways to write a formula that a search can change: genomes, each of which decodes to a program."""
