"""Real clusters whose processes are stopped, and the outputs that their logs hold."""
