"""Published experiments, repeated with simulated participants."""
