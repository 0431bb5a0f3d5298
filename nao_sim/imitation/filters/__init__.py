"""Filters of what people's trackers see: `clean` for files, `Kalman` for streams, both `.filter(skeleton)`."""

from nao_sim.imitation.filters.causal import Kalman
from nao_sim.imitation.filters.cleaning import Cleaning, Filter, clean
from nao_sim.imitation.filters.gaps import Fill
from nao_sim.imitation.filters.rejection import Reject
from nao_sim.imitation.filters.smoothing import Smooth

__all__ = ["Cleaning", "Fill", "Filter", "Kalman", "Reject", "Smooth", "clean"]
