"""People as landmarks in pictures: MediaPipe, OpenPose, .pose."""
