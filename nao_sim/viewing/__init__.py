"""Looking at a recording by hand: MuJoCo's viewer, and a page for a browser.

`stage` is what both show, `playback` the moment and the layers that are shown;
`window` is a thin skin over them.  The page carries its own player (`web/`), so
that it works from a file as from the server.
"""
