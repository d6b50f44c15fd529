"""Files that other programs read, made out of the cache of a run: surfaces, USD, VDB, Alembic."""
