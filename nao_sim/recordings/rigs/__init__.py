"""People as rigs of bones that turn: BVH, ASF/AMC."""
