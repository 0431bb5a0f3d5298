"""Pages about a result: one file each, to be mailed, read on a phone or printed."""
