"""From a person's posture to the robot's: frames, features, arms."""
