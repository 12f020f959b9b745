"""The robot of a session: joints, added frames, driving."""
