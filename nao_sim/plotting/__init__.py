"""Pictures of recordings, drawn with matplotlib and without a display."""

from nao_sim.plotting.picture import save_picture

__all__ = ["save_picture"]
