"""Recognising what a person shows: poses, frame by frame, and movements, over a window."""
