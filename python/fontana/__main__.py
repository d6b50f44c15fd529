"""`python -m fontana` is the command `fontana`."""

from fontana.cli import main

main()
