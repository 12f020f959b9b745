"""RobotModel: the shapes of a robot at its frames, and what RViz draws at its links."""
