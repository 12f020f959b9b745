"""Topics: what their messages mean for frames and joints, and why one shows nothing."""
