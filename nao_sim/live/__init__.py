"""Live imitation: a person's frames in over a socket, the robot's state out, 50 times a second.

`session` is one person and one robot and knows no socket and no clock; `host`
steps several of them in a process; `pool` keeps such processes; `server` is what
browsers and programs talk to, in the words of `protocol`.
"""
