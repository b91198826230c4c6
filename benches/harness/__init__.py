"""What the benchmark programs share: parts, processes, references and what a result file says about its origin."""
