"""`fontana render`: the frames of a run as pictures or as a film."""
