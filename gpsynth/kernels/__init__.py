"""The functions of `operations`, compiled: the only importer of numba. Arrays in, arrays out."""
