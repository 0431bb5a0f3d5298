"""People in tables: rows of numbers, named columns, motion-capture exports, arrays."""
