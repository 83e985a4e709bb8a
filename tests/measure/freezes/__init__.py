"""Real clusters whose processes are stopped, and the outputs that their logs hold."""
import common  # noqa: F401  makes the package tactus importable
