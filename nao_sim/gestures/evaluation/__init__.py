"""How well gestures are recognised: data sets, learners that are tried on them, and figures."""
